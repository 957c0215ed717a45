"""The editor under random input at full speed: what fails, and whether memory grows.

``python -m benchmarks.soak [MINUTES] [SEED]`` prints what it did and what it found; ten minutes are
what is promised, one is the topic's. Mouse, wheel, keys, text, dropped pictures (broken ones, too),
dialogs, new pages and relaxations come from a seeded generator, through the same callbacks as a
person's, into an offscreen window; so do saves, copies, exports, files opened again, and edits of
areas. Every file saved is opened and compared. Every other round has `N_DOTS` dots.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
import logging
import os
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from imgui_bundle import imgui  # noqa: F401 - before glfw, so that both share one library

# isort: split
import glfw
import numpy as np

from benchmarks.random_areas import EDITS
from stippler.app import App
from stippler.drawing.area_edits import edit_areas
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.style import Style
from stippler.errors import GeometryError
from stippler.opening import open_file

if TYPE_CHECKING:
    from benchmarks.figures import Figure

_SIZE = (1000, 700)
_ROUND_S = 20.0
N_DOTS = 100_000
MOST_MB = 150.0
"""What memory in use may grow by after the third round, however long it goes on.

It is measured once the allocator has given back what is free: its arenas keep 60 to 170 MB of that,
more or less from round to round, which says nothing about growth.
"""

_EXPORTS = (".svg", ".png", ".pdf", ".csv", ".dxf")
_KEYS = (
    *"asxheiuljbwgkcmvfrtp1",
    *("left_bracket", "right_bracket", "enter", "delete", "space", "tab", "f1"),
    *("escape",) * 8,
    *("up", "down", "home", "backspace", "left_alt", "left_shift"),
)
_CTRL_KEYS = (*"zzzzzzyyyyyylllldddaapnos", "enter")
_BUTTONS = (glfw.MOUSE_BUTTON_LEFT, glfw.MOUSE_BUTTON_MIDDLE, glfw.MOUSE_BUTTON_RIGHT)
_CHANCES = (0.4, 0.4, 0.05, 0.1, 0.05)  # of the pictures
_MOD_BITS = (glfw.MOD_CONTROL, glfw.MOD_SHIFT, glfw.MOD_ALT)


class Faults(logging.Handler):
    """Collects what the editor reports as a fault of its own, not of a person or a file."""

    def __init__(self) -> None:
        super().__init__(logging.ERROR)
        self.found: list[str] = []

    def emit(self, record: logging.LogRecord) -> None:
        """Take a line of the log."""
        text = record.getMessage()
        if " failed (" in text or "unexpected" in text:
            why = self.format(record) if record.exc_info else text
            self.found.append(why)


class Hand:
    """Random input for an editor; the same for the same seed and the same course of things.

    Attributes
    ----------
    n_frames : int
    acts : Counter
        How often each kind of input was given.
    pictures : list of Path
        The last two cannot be read.
    """

    def __init__(self, app: App, folder: Path, seed: int) -> None:
        self.app, self._folder = app, folder
        self._rng = np.random.default_rng(seed)
        self._at = np.array([500.0, 350.0])
        self._mods = 0
        self._down: set[int] = set()
        self.n_frames, self.acts = 0, Counter[str]()
        self.saved: Path | None = None
        self.pictures = _pictures(folder, self._rng)
        self.app.window.input.focus(True)
        acts: dict[str, tuple[float, Callable[[], None]]] = {
            "move": (60.0, self._move),
            "button": (16.0, self._button),
            "wheel": (4.0, self._wheel),
            "key": (6.0, self._key),
            "command": (3.0, self._command),
            "text": (1.0, self._text),
            "modifier": (2.0, self._modifier),
            "control": (2.0, self._control),
            "drop": (0.05, self._drop),
            "new page": (0.02, self._new_page),
            "save": (0.15, self._save),
            "load": (0.03, self._load),
            "export": (0.05, self._export),
            "area": (0.3, self._edit_areas),
            "relax": (0.05, self._relax),
            "focus": (0.2, self._focus),
            "resize": (0.1, self._resize),
        }
        weights = np.array([weight for weight, _ in acts.values()])
        self._share = weights / weights.sum()
        self._acts = [(name, act) for name, (_, act) in acts.items()]

    def act(self) -> None:
        """Give one random input, and draw a frame if one is due."""
        name, act = self._acts[self._rng.choice(len(self._acts), p=self._share)]
        self.acts[name] += 1
        act()
        if self._rng.random() < 0.7:  # else several inputs come in one frame
            self.n_frames += self.app.step(0.0)

    def let_go(self) -> None:
        """Release what is held, and leave dialogs and fields."""
        for button in list(self._down):
            self._press(button, glfw.RELEASE)
        self._mods = 0
        for _ in range(3):
            self._type("escape", 0)
            self.n_frames += self.app.step(0.0)

    def _move(self) -> None:
        chance = self._rng.random()
        if chance < 0.03:
            self._at = self._rng.uniform((-20, -20), (_SIZE[0] + 20, _SIZE[1] + 20))
        elif chance < 0.12:  # back to the page
            self._at = self._rng.uniform((360, 20), (_SIZE[0], _SIZE[1] - 40))
        else:
            self._at = self._at + self._rng.normal(0, 15, 2)
        self.app.window.input.move(*map(float, self._at))

    def _button(self) -> None:
        if self._down and self._rng.random() < 0.7:
            self._press(next(iter(self._down)), glfw.RELEASE)
        else:
            which = _BUTTONS[self._rng.choice(3, p=(0.85, 0.1, 0.05))]
            self._press(which, glfw.RELEASE if which in self._down else glfw.PRESS)

    def _press(self, which: int, action: int) -> None:
        (self._down.add if action == glfw.PRESS else self._down.discard)(which)
        self.app.window.input.button(which, action, self._mods)

    def _wheel(self) -> None:
        self.app.window.input.scroll(0.0, float(self._rng.normal(0, 2)))

    def _key(self) -> None:
        self._type(str(self._rng.choice(_KEYS)), self._mods)

    def _command(self) -> None:
        shift = glfw.MOD_SHIFT if self._rng.random() < 0.3 else 0
        self._type(str(self._rng.choice(_CTRL_KEYS)), glfw.MOD_CONTROL | shift)

    def _type(self, name: str, mods: int) -> None:
        code = getattr(glfw, f"KEY_{name.upper()}")
        self.app.window.input.key(code, 0, glfw.PRESS, mods)
        if self._rng.random() < 0.3:
            self.n_frames += self.app.step(0.0)
        self.app.window.input.key(code, 0, glfw.RELEASE, mods)

    def _text(self) -> None:
        for sign in self._rng.choice(list("0123456789.-eab"), self._rng.integers(1, 5)):
            self.app.window.input.character(ord(str(sign)))

    def _modifier(self) -> None:
        self._mods = int(self._rng.choice([0, *_MOD_BITS]))

    def _control(self) -> None:
        """Click one of the controls that are shown."""
        marks = list(self.app.editor.widgets.marks.values())
        if marks:
            x0, y0, x1, y1 = marks[self._rng.integers(len(marks))]
            self._at = self._rng.uniform((x0, y0), (max(x0, x1), max(y0, y1)))  # some have no room
            self.app.window.input.move(*map(float, self._at))
            for action in (glfw.PRESS, glfw.RELEASE):
                self.n_frames += self.app.step(0.0)
                self._press(glfw.MOUSE_BUTTON_LEFT, action)

    def _drop(self) -> None:
        n = 1 if self._rng.random() < 0.9 else 2
        self.app.window.input.drop(
            [str(self.pictures[k]) for k in self._rng.choice(5, n, p=_CHANCES)]
        )

    def _new_page(self) -> None:
        self.app.session.new(Page(*map(float, self._rng.uniform(20, 200, 2))))

    def _save(self) -> None:
        """Save, and look whether the file holds what was in the drawing then."""
        session = self.app.session
        if session.document is None or session.exporting or session.document.in_stroke:
            return
        path = self._folder / f"saved-{self._rng.integers(3)}.stipple"
        dots = session.document.dots.copy()
        session.saving.wishes.history = bool(self._rng.random() < 0.3)
        session.save(path, is_copy=bool(self._rng.random() < 0.3))
        self._until_written()
        found = open_file(path).dots
        assert np.array_equal(found.id, dots.id), "a file lacks dots"
        assert np.array_equal(found.position_mm, dots.position_mm), "a file has dots elsewhere"
        self.saved = path

    def _until_written(self) -> None:
        while self.app.session.exporting:
            self.n_frames += self.app.step(0.005)

    def _load(self) -> None:
        if self.saved is not None and not self.app.editor.painting.is_busy:
            self.app.session.open_drawing(self.saved)

    def _export(self) -> None:
        session = self.app.session
        if session.n_dots and not session.exporting:
            ending = _EXPORTS[self._rng.integers(len(_EXPORTS))]
            session.export(self._folder / f"export{ending}", 100.0)

    def _edit_areas(self) -> None:
        session = self.app.session
        document = session.document
        if document is None or not session.paintable or document.in_stroke or document.in_run:
            return
        name = str(self._rng.choice(list(EDITS)))
        with contextlib.suppress(GeometryError):  # refused, as it may be
            edit_areas(document, name, lambda borders: EDITS[name](borders, self._rng))

    def _relax(self) -> None:
        if not self.app.editor.painting.is_busy:
            self.app.session.relax(3, weighted=False)

    def _focus(self) -> None:
        for focused in (0, 1):
            self.app.window.input.focus(bool(focused))

    def _resize(self) -> None:
        size = self._rng.integers((200, 150), (1400, 900))
        glfw.set_window_size(self.app.window._handle, *map(int, size))


def _pictures(folder: Path, rng: np.random.Generator) -> list[Path]:
    """Write a few pictures: noise, a ramp, white, one that is cut off, and one that is none."""
    from PIL import Image

    ramp = np.tile(np.linspace(0, 255, 300, dtype=np.uint8), (200, 1))
    noise = rng.integers(0, 256, (120, 90, 3), np.uint8)
    white = np.full((60, 80), 255, np.uint8)
    paths = [folder / f"{name}.png" for name in ("noise", "ramp", "white", "cut", "none")]
    for path, values in zip(paths, (noise, ramp, white, ramp), strict=False):
        Image.fromarray(values).save(path)
    paths[3].write_bytes(paths[3].read_bytes()[:200])
    paths[4].write_text("no picture")
    return paths


def _dense(n: int) -> Drawing:
    drawing = Drawing.blank(Page(100.0, 80.0))
    at = np.random.default_rng(n).random((n, 2)) * (100, 80)
    drawing.dots = Dots.round(at, 0.05)
    return drawing


def check_drawing(app: App) -> None:
    """Raise if the drawing is not whole: ids unique and found, dots on the page, kept by place."""
    document = app.session.document
    if document is None:
        return
    dots, page = document.dots, document.drawing.page
    assert len(np.unique(dots.id)) == len(dots), "ids are not unique"
    assert np.array_equal(document.rows(dots.id), np.arange(len(dots))), "ids are not found"
    assert np.isfinite(dots.position_mm).all(), "a place is not finite"
    size = (page.width_mm, page.height_mm)
    on_page = (dots.position_mm >= 0) & (dots.position_mm <= size)
    assert on_page.all(), "a dot is off the page"
    assert (dots.radius_mm > 0).all(), "a dot has no size"
    x, y = dots.position_mm.T
    box = (0.2 * size[0], 0.3 * size[1], 0.6 * size[0], 0.7 * size[1])
    inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
    assert np.array_equal(document.in_box(box), np.flatnonzero(inside)), "the index has lost dots"


class Soak:
    """An editor under random input for so long.

    Attributes
    ----------
    hand : Hand
    faults : list of str
    memory_mb : list of float
        At the end of each round, after its history is gone and garbage is collected.
    n_steps : int
        Of the histories at the ends of the rounds.
    """

    def __init__(self, folder: Path, seed: int, n_dots: int = N_DOTS) -> None:
        os.environ["STIPPLER_CONFIG_DIR"] = str(folder / "config")
        self._n_dots = n_dots
        self._log = Faults()
        logging.getLogger("stippler").addHandler(self._log)
        style = Style(n_dots=3000, iterations=5)
        self.app = App(
            style, tone="linear", width_mm=100.0, size=_SIZE, offscreen=True,
            recovery=folder / "recovery", backups=folder / "backups",
        )  # fmt: skip
        self.app.editor.gui.fields.is_watched = True  # the hand clicks where controls are
        self.hand = Hand(self.app, folder, seed)
        self.memory_mb: list[float] = []
        self.n_steps = 0

    @property
    def faults(self) -> list[str]:
        """What the editor reported as its own faults."""
        return self._log.found

    def run_round(self, goes_on: Callable[[], bool]) -> None:
        """Begin with a drawing, give random input for as long as asked, check, note the memory."""
        if len(self.memory_mb) % 2:
            self.app.session.show(_dense(self._n_dots))
        else:
            self.app.session.open(self.hand.pictures[len(self.memory_mb) // 2 % 2])
        self._wait()
        while goes_on():
            self.hand.act()
            if self.hand.n_frames % 200 == 0 and not self.app.editor.painting.is_busy:
                check_drawing(self.app)
        self.hand.let_go()
        check_drawing(self.app)
        if self.app.session.document is not None:
            self.n_steps += len(self.app.session.document.history.steps)
        self.app.session.new(Page(100.0, 70.0))
        glfw.set_window_size(self.app.window._handle, *_SIZE)  # its pixels are memory here, too
        self._wait()
        self._show()
        gc.collect()
        self.memory_mb.append(_memory_mb())

    def _wait(self) -> None:
        while self.app.session.busy:
            self.app.step(0.02)

    def _show(self) -> None:
        """Draw what there is: until then the page and its tools are those of the drawing before."""
        self.app.step(0.0)
        while not self.app.editor.idle:
            self.app.step(0.02)

    def close(self) -> None:
        """Close the editor."""
        self.app.session.keeping.close()
        self.app.close()
        logging.getLogger("stippler").removeHandler(self._log)


def _memory_mb() -> float:
    """Return the memory that this process holds, without what is free in it; Linux."""
    trim = getattr(ctypes.CDLL(None), "malloc_trim", None)  # glibc's
    if trim is not None:
        trim(0)
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def figures(quick: bool = False, minutes: float = 1.0, seed: int = 1) -> list[Figure]:
    """Soak the editor; `quick` for ten seconds."""
    from benchmarks.figures import Figure

    before = Path.cwd()
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        soak = Soak(Path(folder), seed)
        try:
            end = time.monotonic() + (10.0 if quick else 60.0 * minutes)
            while time.monotonic() < end:
                round_end = min(time.monotonic() + _ROUND_S, end)
                soak.run_round(lambda: time.monotonic() < round_end)  # noqa: B023
        finally:
            soak.close()
            os.chdir(before)
    for fault in soak.faults:
        sys.stderr.write(f"{fault}\n")
    # the first rounds load kernels, fonts and file formats
    settled = soak.memory_mb[min(2, len(soak.memory_mb) - 1)]
    acts = ", ".join(f"{n} {name}" for name, n in soak.hand.acts.most_common())
    return [
        Figure("random input: faults", len(soak.faults), "faults", 0.0, note=f"seed {seed}"),
        Figure("random input: frames", soak.hand.n_frames, "frames", note=acts),
        Figure("random input: steps of history at the ends of rounds", soak.n_steps, "steps"),
        Figure(
            "random input: memory grown since the third round", soak.memory_mb[-1] - settled, "MB",
            MOST_MB,
            note=f"{len(soak.memory_mb)} rounds, {_course(soak.memory_mb)} MB at their quarters",
        ),
    ]  # fmt: skip


def _course(memory_mb: list[float]) -> str:
    """Return what a level and a growth tell apart: the third round, the quarters, the end."""
    last = len(memory_mb) - 1
    at = [min(2, last), *(round(last * k / 4) for k in (1, 2, 3)), last]
    return ", ".join(f"{memory_mb[k]:.0f}" for k in at)


def main() -> None:
    """Print the figures."""
    numbers = [float(text) for text in sys.argv[1:]]
    minutes = numbers[0] if numbers else 1.0
    seed = int(numbers[1]) if len(numbers) > 1 else 1
    for figure in figures(minutes=minutes, seed=seed):
        sys.stdout.write(f"{figure.name:<52}{figure.value:9.1f} {figure.unit:<7} {figure.note}\n")


if __name__ == "__main__":
    main()
