"""The editor: its first frame, what it costs while nothing happens, and its frames.

``python -m benchmarks.editor`` prints the figures. The first frame and the idle share are taken in
a real window under Xvfb, with the whole process from the shell; frames in an offscreen window,
where the time inside GL calls is counted apart from our own Python and upload.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.figures import Figure

_SIZE = (1280, 800)
_N_DOTS = 100_000
_FIRST_FRAME = """
import os, sys, time
import imgui_bundle, glfw
show = glfw.swap_buffers
def swapped(window):
    show(window)
    sys.stdout.write(repr(time.time()))
    sys.stdout.flush()
    os._exit(0)
glfw.swap_buffers = swapped
from stippler.start import main
main()
"""
_IMPORT = """
import time
began = time.process_time()
import stippler.app
print(time.process_time() - began)
"""
_EDITOR = "from stippler.start import main; main()"


def figures(quick: bool = False) -> list[Figure]:
    """Measure the editor."""
    found = [_import(3 if quick else 7)]
    if shutil.which("Xvfb"):
        with _display() as env, _picture() as picture:
            found.append(_first_frame(env, picture, 3 if quick else 7))
            found.append(_idle(env, picture, 3.0 if quick else 8.0))
    return found + _frames(10 if quick else 40)


# --- a real window -------------------------------------------------------------------------------


@contextlib.contextmanager
def _display() -> Iterator[dict[str, str]]:
    """Start an X server on a free display; hand out the environment for it."""
    reads, writes = os.pipe()
    screen = f"{_SIZE[0]}x{_SIZE[1]}x24"
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writes), "-screen", "0", screen, "-nolisten", "tcp"],
        pass_fds=[writes],
        stderr=subprocess.DEVNULL,
    )
    os.close(writes)
    settings = tempfile.TemporaryDirectory()  # the editor as it is at first
    try:
        with os.fdopen(reads) as told:
            env = {**os.environ, "DISPLAY": f":{told.readline().strip()}"}
        env["STIPPLER_CONFIG_DIR"] = env["STIPPLER_STATE_DIR"] = settings.name
        env.pop("WAYLAND_DISPLAY", None)
        yield env
    finally:
        server.terminate()
        server.wait()
        settings.cleanup()


@contextlib.contextmanager
def _picture() -> Iterator[Path]:
    """Write a picture of one megapixel: a shaded ball."""
    from PIL import Image

    y, x = np.mgrid[-1:1:1000j, -1:1:1000j]
    z = np.sqrt(np.clip(0.7 - x * x - y * y, 0, None))
    light = np.where(z > 0, np.clip(0.5 * z - 0.4 * x - 0.4 * y + 0.35, 0, 1), 1.0)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "ball.png"
        Image.fromarray((255 * light).astype(np.uint8)).save(path)
        yield path


def _first_frame(env: dict[str, str], picture: Path, repeats: int) -> Figure:
    times = []
    for _ in range(repeats + 1):
        began = time.time()
        shown = subprocess.run(
            [sys.executable, "-c", _FIRST_FRAME, str(picture)],
            env=env,
            capture_output=True,
            check=True,
            text=True,
        ).stdout
        times.append(float(shown) - began)
    return Figure(
        "editor, first frame", statistics.median(times[1:]), "s", 0.6, 0.4, note="Xvfb, software GL"
    )


def _import(repeats: int) -> Figure:
    times = [
        float(subprocess.check_output([sys.executable, "-c", _IMPORT], text=True))
        for _ in range(repeats + 1)
    ]
    return Figure("editor, import, CPU time", min(times[1:]), "s")


def _idle(env: dict[str, str], picture: Path, seconds: float) -> Figure:
    """Measure the share of a core that an editor with a finished drawing takes."""
    editor = subprocess.Popen([sys.executable, "-c", _EDITOR, str(picture)], env=env)
    try:
        quiet = 0
        while quiet < 3:  # the work is over when two seconds and a half take nothing
            before = _cpu_s(editor.pid)
            time.sleep(0.8)
            quiet = quiet + 1 if _cpu_s(editor.pid) - before < 0.2 and before > 1.0 else 0
        before, began = _cpu_s(editor.pid), time.perf_counter()
        time.sleep(seconds)
        share = (_cpu_s(editor.pid) - before) / (time.perf_counter() - began)
    finally:
        editor.kill()
        editor.wait()
    return Figure("editor, idle", 100 * share, "% of a core", 3.0)


def _cpu_s(pid: int) -> float:
    """Return the processor time a process has had; Linux."""
    numbers = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(numbers[11]) + int(numbers[12])) / os.sysconf("SC_CLK_TCK")


# --- frames --------------------------------------------------------------------------------------


class Apart:
    """Adds up the time inside GL calls that draw, clear, or show."""

    def __init__(self) -> None:
        self.spent_s = 0.0
        self._wrapped: list[tuple[Any, str, Any]] = []

    def unwrap(self) -> None:
        """Leave the calls as they were."""
        for owner, name, call in self._wrapped:
            setattr(owner, name, call)

    def wrap(self, owner: Any, name: str) -> None:
        """Time one call wherever it is made."""
        call: Callable[..., Any] = getattr(owner, name)

        def timed(*args: Any, **options: Any) -> Any:
            began = time.perf_counter()
            try:
                return call(*args, **options)
            finally:
                self.spent_s += time.perf_counter() - began

        self._wrapped.append((owner, name, call))
        setattr(owner, name, timed)


@contextlib.contextmanager
def gl_apart() -> Iterator[Apart]:
    """Time the GL calls of frames for as long as this is entered."""
    from imgui_bundle import imgui  # isort: skip
    import glfw
    import moderngl

    gl = Apart()
    for owner, name in (
        (moderngl.VertexArray, "render"),
        (moderngl.Framebuffer, "clear"),
        (moderngl.Framebuffer, "use"),
        (imgui.backends, "opengl3_render_draw_data"),
        (glfw, "swap_buffers"),
    ):
        gl.wrap(owner, name)
    try:
        yield gl
    finally:
        gl.unwrap()


def _frames(repeats: int) -> list[Figure]:
    from stippler.app import App
    from stippler.drawing.style import Style

    with gl_apart() as gl:
        app = App(Style(), tone="linear", width_mm=148.0, size=_SIZE, offscreen=True)
        try:
            still, moving = _own_and_all(app, gl, repeats)
        finally:
            app.close()
    where = f"{_N_DOTS:,} dots, {_SIZE[0]} x {_SIZE[1]}"
    return [
        Figure(
            "editor, our own share of a frame, nothing changing", still[0], "ms", 2, 1, note=where
        ),
        Figure("editor, our own share of a frame, all moving", moving[0], "ms", 4, 2, note=where),
        Figure(
            "editor, whole frame, nothing changing", still[1], "ms", note=f"software GL, {where}"
        ),
        Figure(
            "editor, whole frame, all moving", moving[1], "ms", 60, note=f"software GL, {where}"
        ),
    ]


def _own_and_all(
    app: Any, gl: Apart, repeats: int
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the medians, own and whole, of still frames and of moving ones; ms."""
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import Style
    from stippler.editor.activity import Opening
    from stippler.jobs.work import Source, Work
    from stippler.jobs.worker import Update
    from stippler.stippling.stipple import Progress

    rng = np.random.default_rng(1)
    place = rng.random((_N_DOTS, 2)) * (148.0, 111.0)
    radius = np.full(_N_DOTS, 0.16, np.float32)
    reference = Reference(np.full((111, 148), 0.5, np.float32), 148.0)
    app.session.activity = Opening(1, "read", Source(Path("even"), "linear", 148.0), Style())

    def tell() -> None:
        moved = place + rng.normal(0, 0.01, place.shape)
        work = Work("relax", 1, 20, reference, Progress("relax", 1, 20, moved, radius))
        app.worker._update = Update(1, work, "", None, 1)

    def timed(prepare: Callable[[], None]) -> tuple[float, float]:
        own, whole = [], []
        for k in range(repeats + 5):
            prepare()
            app.window.ctx.finish()
            gl.spent_s, began = 0.0, time.perf_counter()
            app.editor._schedule.note_input()
            app.editor.step()
            spent = time.perf_counter() - began
            app.window.ctx.finish()
            if k >= 5:
                own.append(1e3 * (spent - gl.spent_s))
                whole.append(1e3 * (time.perf_counter() - began))
        return statistics.median(own), statistics.median(whole)

    tell()
    app.editor.step()
    return timed(lambda: None), timed(tell)


def main() -> None:
    """Print the figures."""
    for figure in figures("--quick" in sys.argv[1:]):
        print(
            f"{figure.name:<52}{figure.value:9.3f} {figure.unit:<12}{figure.reach or '':>5}  "
            f"{figure.note}"
        )


if __name__ == "__main__":
    main()
