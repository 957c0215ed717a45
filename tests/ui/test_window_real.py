"""A real window under Xvfb, driven by a real mouse."""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from PIL import ImageGrab

from stippler.app import App
from stippler.drawing.style import Style
from stippler.ui.theme import LIGHT, Colour
from stippler.ui.window.scripted_host import Host

pytestmark = pytest.mark.window

SIZE = (1280, 800)
_PATIENCE_S = 60.0


def until(condition: Callable[[], bool], what: str) -> None:
    deadline = time.monotonic() + _PATIENCE_S
    while not condition():
        assert time.monotonic() < deadline, f"{what} did not come true"
        time.sleep(0.02)


@pytest.fixture(scope="module")
def display() -> Iterator[str]:
    """An X server on a display number that it finds free.

    It must not start anew when the last window is closed: the next would meet it half way.
    """
    reads, writes = os.pipe()
    screen = f"{SIZE[0]}x{SIZE[1]}x24"
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writes), "-screen", "0", screen, "-nolisten", "tcp", "-noreset"],
        pass_fds=[writes],
        stderr=subprocess.DEVNULL,
    )
    os.close(writes)
    with os.fdopen(reads) as told:
        number = told.readline().strip()
    assert number, "Xvfb did not start"
    try:
        yield f":{number}"
    finally:
        server.terminate()
        server.wait()


@dataclass(frozen=True)
class Layout:
    """Where the controls are while a picture is open, and the canvas."""

    places: dict[str, tuple[float, float]]
    canvas: tuple[int, int, int, int]


@pytest.fixture(scope="module")
def layout(kernels: None, picture: Path) -> Layout:
    """Ask the same editor without a display."""
    style = Style(n_dots=200, iterations=3)
    app = App(style, tone="linear", width_mm=148.0, size=SIZE, offscreen=True)
    try:
        host = Host(app.window, app.editor, app.step)
        host.drop(picture)
        host.until(lambda: app.session.phase == "done", "the drawing")
        host.settle()
        marks = app.editor.widgets.marks
        return Layout({label: host.place(label) for label in marks}, host.canvas())
    finally:
        app.close()


@pytest.fixture(scope="module")
def places(layout: Layout) -> dict[str, tuple[float, float]]:
    return layout.places


class _Message(ctypes.Structure):
    """X's ClientMessage."""

    _fields_ = [
        ("type", ctypes.c_int),
        ("serial", ctypes.c_ulong),
        ("send_event", ctypes.c_int),
        ("display", ctypes.c_void_p),
        ("window", ctypes.c_ulong),
        ("message_type", ctypes.c_ulong),
        ("format", ctypes.c_int),
        ("data", ctypes.c_long * 5),
    ]


class Desk:
    """The editor as a process of its own, and hands on it."""

    def __init__(self, display: str, layout: Layout, settings: Path, *arguments: str) -> None:
        self._display, self.canvas = display, layout.canvas
        self._env = {**os.environ, "DISPLAY": display}
        self._env.pop("WAYLAND_DISPLAY", None)
        self._env.pop("STIPPLER_SCALE", None)
        self._env["STIPPLER_CONFIG_DIR"] = str(settings)
        self._env["STIPPLER_STATE_DIR"] = str(settings / "state")
        self.process = subprocess.Popen(
            [sys.executable, "-c", "from stippler.start import main; main()", *arguments],
            env=self._env,
            stderr=subprocess.PIPE,
            text=True,
        )

    def xdotool(self, *words: object) -> str:
        done = subprocess.run(
            ["xdotool", *map(str, words)],
            env=self._env,
            check=False,
            capture_output=True,
            text=True,
        )
        return done.stdout.strip()

    def shot(self) -> np.ndarray:
        return np.asarray(ImageGrab.grab(xdisplay=self._display).convert("RGB"))

    def middle(self) -> tuple[int, int]:
        x0, y0, x1, y1 = self.canvas
        return (x0 + x1) // 2, (y0 + y1) // 2

    def ink(self) -> np.ndarray:
        x0, y0, x1, y1 = self.canvas
        return self.shot()[y0:y1, x0:x1].mean(axis=2) < 100

    def has(self, place: tuple[float, float], colour: Colour) -> bool:
        x, y = (round(v) for v in place)
        seen = self.shot()[y, x - 45] / 255.0  # left of the label
        return bool(np.abs(seen - np.array(colour)).max() < 0.03)

    def title(self) -> str:
        assert self.process.poll() is None, f"it ended: {self.process.communicate()[1]}"
        window = self.xdotool("search", "--name", "Stippler").partition("\n")[0]
        return self.xdotool("getwindowname", window) if window else ""

    def focus(self) -> None:
        window = self.xdotool("search", "--name", "Stippler").partition("\n")[0]
        self.xdotool("windowfocus", "--sync", window)

    def close_button(self) -> None:
        """Ask as a window manager does."""
        window = self.xdotool("search", "--name", "Stippler").partition("\n")[0]
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype, x11.XInternAtom.restype = ctypes.c_void_p, ctypes.c_ulong
        display = ctypes.c_void_p(x11.XOpenDisplay(self._display.encode()))
        protocols, delete = (
            x11.XInternAtom(display, name, 0) for name in (b"WM_PROTOCOLS", b"WM_DELETE_WINDOW")
        )
        event = _Message(33, 0, 1, display, int(window), protocols, 32, (delete, 0, 0, 0, 0))
        room = ctypes.create_string_buffer(bytes(event), 192)  # as large as any event
        x11.XSendEvent(display, ctypes.c_ulong(int(window)), 0, ctypes.c_long(0), room)
        x11.XSync(display, 0)
        x11.XCloseDisplay(display)

    def is_dimmed(self) -> bool:
        """Whether a question takes the light off the rest of the window."""
        seen = self.shot()[SIZE[1] - 10, SIZE[0] // 3] / 255.0  # in the status bar
        return bool(np.abs(seen - np.array(LIGHT.panel)).max() > 0.02)

    def quit(self) -> tuple[int, str]:
        self.focus()
        self.xdotool("key", "ctrl+q")
        _, errors = self.process.communicate(timeout=_PATIENCE_S)
        return self.process.returncode, errors


@pytest.fixture
def start(layout: Layout, display: str, tmp_path: Path) -> Iterator[Callable[..., Desk]]:
    desks: list[Desk] = []

    def begin(*arguments: str) -> Desk:
        desks.append(Desk(display, layout, tmp_path / "settings", *arguments))
        return desks[-1]

    yield begin
    for desk in desks:
        if desk.process.poll() is None:
            desk.process.kill()
        desk.process.communicate()


def test_wheel_and_middle_button_move_the_page(
    start: Callable[..., Desk], places: dict[str, tuple[float, float]], picture: Path
) -> None:
    desk = start(str(picture), "--dots", "200", "--iterations", "3", "--tone", "linear")
    until(lambda: desk.title() == "disc.png – Stippler", "the title")
    until(lambda: desk.has(places["Start"], LIGHT.accent), "the end of the work")
    middle = desk.middle()
    fitted = desk.ink().sum()
    assert fitted > 1000
    desk.xdotool("mousemove", *middle)
    for _ in range(3):
        desk.xdotool("click", 5)  # the wheel towards the person
    until(lambda: 0.25 < desk.ink().sum() / fitted < 0.45, "the smaller page")  # 1.2**-6 = 0.33
    before = np.argwhere(desk.ink()).mean(axis=0)
    desk.xdotool("mousedown", 2)
    desk.xdotool("mousemove_relative", "--sync", "--", 60, -40)
    desk.xdotool("mouseup", 2)

    def moved() -> bool:
        dy, dx = np.argwhere(desk.ink()).mean(axis=0) - before
        return abs(dx - 60) < 2 and abs(dy + 40) < 2

    until(moved, "the moved page")
    desk.xdotool("key", "f")
    until(lambda: abs(desk.ink().sum() / fitted - 1) < 0.02, "the fitted page")
    assert desk.quit() == (0, "")


def test_stop_is_clicked_while_work_runs(
    start: Callable[..., Desk], places: dict[str, tuple[float, float]], picture: Path
) -> None:
    desk = start(str(picture), "--dots", "200", "--iterations", "100000")
    until(lambda: desk.title() == "disc.png – Stippler", "the title")
    until(lambda: desk.ink().sum() > 1000, "the first dots")
    assert not desk.has(places["Start"], LIGHT.accent)
    desk.xdotool("mousemove", *places["Stop"], "click", 1)
    until(lambda: desk.has(places["Start"], LIGHT.accent), "the stop")
    assert desk.ink().sum() > 1000
    assert desk.quit() == (0, "")


def test_the_window_is_closed_while_work_runs(start: Callable[..., Desk], picture: Path) -> None:
    desk = start(str(picture), "--dots", "200", "--iterations", "100000")
    until(lambda: desk.title() == "disc.png – Stippler", "the title")
    until(lambda: desk.ink().sum() > 1000, "the first dots")
    assert desk.quit() == (0, "")


def test_the_close_button_asks_when_something_was_painted(
    start: Callable[..., Desk], places: dict[str, tuple[float, float]], picture: Path
) -> None:
    desk = start(str(picture), "--dots", "200", "--iterations", "3", "--tone", "linear")
    until(lambda: desk.title() == "disc.png – Stippler", "the title")
    until(lambda: desk.has(places["Start"], LIGHT.accent), "the end of the work")
    desk.focus()
    desk.xdotool("mousemove", *desk.middle())
    desk.xdotool("key", "e")
    desk.xdotool("click", 1)
    until(lambda: desk.title() == "disc.png* – Stippler", "the mark of a change")
    for _ in range(2):
        desk.close_button()
        until(lambda: desk.is_dimmed(), "the question")
    desk.focus()
    desk.xdotool("key", "Escape")
    until(lambda: not desk.is_dimmed(), "the drawing")
    desk.xdotool("key", "ctrl+z")
    until(lambda: desk.title() == "disc.png – Stippler", "the drawing as it was")
    desk.close_button()
    _, errors = desk.process.communicate(timeout=_PATIENCE_S)
    assert (desk.process.returncode, errors) == (0, "")


def test_no_display_is_one_line(picture: Path) -> None:
    env = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    for display in ("", ":987"):
        done = subprocess.run(
            [sys.executable, "-c", "from stippler.start import main; main()", str(picture)],
            env={**env, "DISPLAY": display} if display else env,
            capture_output=True,
            text=True,
            timeout=_PATIENCE_S,
            check=False,
        )
        assert done.returncode == 1
        (line,) = done.stderr.splitlines()
        assert "display" in line
        assert display in line
        assert "stippler render" in line


def test_no_opengl_is_one_line(picture: Path) -> None:
    reads, writes = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writes), "-extension", "GLX", "-nolisten", "tcp", "-noreset"],
        pass_fds=[writes],
        stderr=subprocess.DEVNULL,
    )
    os.close(writes)
    try:
        with os.fdopen(reads) as told:
            display = f":{told.readline().strip()}"
        done = subprocess.run(
            [sys.executable, "-c", "from stippler.start import main; main()", str(picture)],
            env={**os.environ, "DISPLAY": display},
            capture_output=True,
            text=True,
            timeout=_PATIENCE_S,
            check=False,
        )
    finally:
        server.terminate()
        server.wait()
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert "OpenGL 3.3" in line
    assert "apt install" in line


def test_bursts_from_the_canvas_to_a_panel_and_back(
    start: Callable[..., Desk], places: dict[str, tuple[float, float]], picture: Path
) -> None:
    """Motion, press and release arrive in one batch each, as a pen's tap or xdotool sends them."""
    desk = start(str(picture), "--dots", "200", "--iterations", "3", "--tone", "linear")
    until(lambda: desk.title() == "disc.png – Stippler", "the title")
    until(lambda: desk.has(places["Start"], LIGHT.accent), "the end of the work")
    desk.focus()
    corner = (desk.canvas[2] - 250, desk.canvas[1] + 150)  # white paper
    desk.xdotool("key", "a")
    before = desk.ink().sum()
    burst: list[object] = []
    for k in range(6):  # a tool's button, then the canvas; every other dot is erased again
        tool = places["Add a dot"] if k % 2 == 0 else places["Remove a dot"]
        burst += ["mousemove", *map(round, tool), "click", 1]
        burst += ["mousemove", corner[0], corner[1] + 40 * (k // 2), "click", 1]
    burst += ["mousemove", *map(round, places["Add a dot"]), "click", 1]
    for k in range(3):
        burst += ["mousemove", corner[0], corner[1] + 40 * k, "click", 1]
    desk.xdotool(*burst)
    desk.xdotool("mousemove", corner[0] + 100, corner[1] + 20)

    def dots() -> int:
        x, y = corner[0] - desk.canvas[0], corner[1] - desk.canvas[1]
        column = desk.ink()[:, x - 3 : x + 4].any(axis=1)
        return sum(bool(column[y + 40 * k - 6 : y + 40 * k + 7].any()) for k in range(3))

    until(lambda: dots() == 3, "the three dots")
    assert desk.ink().sum() > before
    desk.xdotool("key", "ctrl+z", "ctrl+z", "ctrl+z")
    until(lambda: dots() == 0, "the empty corner")
    desk.xdotool("key", "v", "ctrl+shift+p", "d", "r", "a", "w", "i", "n", "g", "Return")
    until(lambda: desk.has(places["Start"], LIGHT.accent), "the panel Drawing")
    time.sleep(0.5)
    desk.xdotool("mousemove", *map(round, places["Number"]), "click", 1)
    desk.xdotool("key", "ctrl+a", "1", "2", "3", "Return")
    desk.xdotool("key", "ctrl+shift+z", "ctrl+shift+z")
    until(lambda: dots() == 2, "the dots again")
    desk.xdotool("mousemove", *map(round, places["Start"]), "click", 1)
    until(lambda: dots() == 0, "the new dots")
    desk.focus()
    desk.xdotool("key", "ctrl+q")  # asks, for there are strokes
    until(desk.is_dimmed, "the question")
    desk.xdotool("key", "Escape")
    until(lambda: not desk.is_dimmed(), "the drawing")


def test_f11_covers_the_screen_and_gives_it_back(start: Callable[..., Desk]) -> None:
    desk = start()
    until(lambda: desk.title() != "", "the window")
    window = desk.xdotool("search", "--name", "Stippler").partition("\n")[0]

    def size() -> str:
        told = desk.xdotool("getwindowgeometry", "--shell", window)
        return " ".join(line for line in told.split() if line.startswith(("WIDTH", "HEIGHT")))

    before, full = "WIDTH=1000 HEIGHT=700", f"WIDTH={SIZE[0]} HEIGHT={SIZE[1]}"
    desk.xdotool("windowsize", "--sync", window, 1000, 700)
    until(lambda: size() == before, "the smaller window")
    desk.focus()
    desk.xdotool("key", "F11")
    until(lambda: size() == full, "the full screen")
    desk.focus()
    desk.xdotool("key", "F11")
    until(lambda: size() == before, "the window as it was")
    assert desk.quit() == (0, "")
