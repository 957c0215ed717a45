"""The editor at work: its longest pause, from a click to the frame that shows it, a million dots.

``python -m benchmarks.live`` prints the figures. The whole editor runs in an offscreen window; the
time inside GL calls is counted apart from our own Python and upload.
"""

from __future__ import annotations

import contextlib
import math
import statistics
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import stippler.ui  # noqa: F401  # isort: skip  # first: it decides which library glfw takes
import glfw
import numpy as np

from benchmarks.editor import Apart, gl_apart
from benchmarks.figures import Figure
from stippler.app import App
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Page
from stippler.drawing.style import Style
from stippler.ui.window.scripted_host import Host

_SIZE = (1280, 800)
_PAGE = Page(200.0, 150.0)
_BIG_DOT_MM = 2.0
_DARK = 60  # mean of a pixel's three colours in the middle of a dot
_PATIENCE = 60  # frames


def figures(quick: bool = False) -> list[Figure]:
    """Measure; `quick` uses fewer dots and less time."""
    n = 50_000 if quick else 200_000
    return [
        *_pauses(n, 4.0 if quick else 60.0),
        *_latency(n // 2, 6 if quick else 30),
        *_many(100_000 if quick else 1_000_000),
    ]


class _Desk:
    """An editor on a page of even dots, and a pointer over it."""

    def __init__(self, app: App, gl: Apart) -> None:
        self.app, self.gl = app, gl
        self.host = Host(app.window, app.editor, app.step)

    def fill(self, n: int) -> None:
        """Open an empty page and put about so many dots on it."""
        session = self.app.session
        session.new(_PAGE)
        self.host.until(lambda: session.paintable, "an empty page")
        assert session.document is not None
        session.document.begin("even dots")
        session.document.insert(_even_dots(n))
        session.document.commit()

    def point(self, x_mm: float, y_mm: float) -> tuple[int, int]:
        """Move the pointer to a place of the page; return where that is in the window."""
        editor = self.app.editor
        x, y = editor.view.camera.page_to_screen((x_mm, y_mm), editor.view.size_px)
        left, top = editor.pointer.origin_px
        self.move(round(x + left), round(y + top))
        return round(x + left), round(y + top)

    def move(self, x_px: int, y_px: int) -> None:
        """Move the pointer to a place of the window."""
        self.app.window.input.move(float(x_px), float(y_px))

    def button(self, down: bool, which: int = glfw.MOUSE_BUTTON_LEFT) -> None:
        """Press a button or let go of it."""
        action = glfw.PRESS if down else glfw.RELEASE
        self.app.window.input.button(which, action, 0)

    def frame(self) -> tuple[float, float]:
        """Draw a frame for what has happened; return our own share and the whole, ms."""
        self.gl.spent_s, began = 0.0, time.perf_counter()
        self.app.step(0.0)
        spent = time.perf_counter() - began
        return 1e3 * (spent - self.gl.spent_s), 1e3 * spent


@contextlib.contextmanager
def _desk(
    n: int, opened: Callable[[tuple[float, float]], None] = lambda _: None
) -> Iterator[_Desk]:
    """Open an editor on about so many dots; tell `opened` what their first frame took."""
    with gl_apart() as gl:
        app = App(Style(), tone="linear", width_mm=_PAGE.width_mm, size=_SIZE, offscreen=True)
        try:
            desk = _Desk(app, gl)
            desk.fill(n)
            desk.point(1, 1)
            opened(desk.frame())
            desk.host.settle()
            yield desk
        finally:
            app.close()


def _even_dots(n: int) -> Dots:
    """Return one dot in each square of a grid: as even as a drawing that is being relaxed."""
    rng = np.random.default_rng(1)
    side = math.sqrt(_PAGE.width_mm * _PAGE.height_mm / n)
    columns, rows = int(_PAGE.width_mm / side), int(_PAGE.height_mm / side)
    corner = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    return Dots.round((corner + rng.uniform(0.1, 0.9, corner.shape)) * side, 0.25 * side)


def _pauses(n: int, seconds: float) -> list[Figure]:
    """Push dots along, a stroke every two seconds, while a worker relaxes all of them."""
    own: list[float] = []
    driver: list[float] = []
    with _desk(n) as desk:
        session = desk.app.session
        desk.app.editor.painting.toolbox.choose("push")
        session.relax(100_000, weighted=False)
        desk.host.until(lambda: session.done > 2, "the relaxation")
        held, began = False, time.perf_counter()
        while (t := time.perf_counter() - began) < seconds:
            desk.point(100 + 60 * math.sin(t), 75 + 50 * math.cos(1.7 * t))
            if held != (t % 2.0 < 1.8):
                held = not held
                desk.button(held)
            mine, whole = desk.frame()
            own.append(mine)
            driver.append(whole - mine)
            time.sleep(max(1 / 60 - whole / 1e3, 0.0))
        steps = session.done
    name = f"painting while {n // 1000}k dots relax, the whole editor, GL excluded"
    return [
        Figure(
            f"{name}: longest pause", max(own), "ms", 25.0, 17.0,
            note=f"{len(own)} frames in {seconds:g} s, {steps} steps of relaxation",
        ),
        Figure(
            f"{name}: our share, median", statistics.median(own), "ms",
            note=f"99 % within {np.percentile(own, 99):.1f} ms; "
            f"software GL {statistics.median(driver):.0f} ms",
        ),
    ]  # fmt: skip


def _latency(n: int, clicks: int) -> list[Figure]:
    """Count the frames from a click that adds a large dot to the first whose pixels show it."""
    counts = []
    with _desk(n) as desk:
        session, toolbox = desk.app.session, desk.app.editor.painting.toolbox
        toolbox.choose("add")
        assert toolbox.brush is not None
        toolbox.set_brush(replace(toolbox.brush.with_value("dot_mm", _BIG_DOT_MM), radius_mm=0.5))
        session.relax(100_000, weighted=False)
        desk.host.until(lambda: session.done > 2, "the relaxation")
        for k in range(clicks):
            x, y = desk.point(12 + 16 * (k % 10) + 5, 20 + 20 * (k // 10))
            desk.host.settle()
            x, y = x + 4, y + 4  # beside the pointer and what it shows
            desk.button(True)
            for count in range(1, _PATIENCE):
                desk.frame()
                if desk.app.window.pixels()[y - 1 : y + 2, x - 1 : x + 2].mean() < _DARK:
                    counts.append(count)
                    break
            else:
                counts.append(_PATIENCE)
            desk.button(False)
    return [
        Figure(
            f"from a click to the frame that shows it, {n // 1000}k dots relax", max(counts),
            "frames", 2, 1, note=f"the longest of {clicks}",
        )
    ]  # fmt: skip


def _many(n: int) -> list[Figure]:
    """Open, pan and paint a drawing of very many dots."""
    out = []

    def note(what: str, times: tuple[float, float]) -> None:
        told = f"{times[1]:.0f} ms with software GL"
        out.append(Figure(f"{n:,} dots: {what}, our share", times[0], "ms", note=told))

    with _desk(n, opened=lambda times: note("first frame", times)) as desk:
        note("a frame of panning", _drag(desk, glfw.MOUSE_BUTTON_MIDDLE))
        for kind in ("push", "size", "relax", "spray", "thin", "erase"):
            desk.app.editor.painting.toolbox.choose(kind)
            note(f"a frame of a stroke with {kind}", _drag(desk, glfw.MOUSE_BUTTON_LEFT))
    return out


def _drag(desk: _Desk, button: int) -> tuple[float, float]:
    """Drag across the page; return the medians of our own share of a frame and of the whole."""
    own, all_of_it = [], []
    x, y = desk.point(60, 75)
    desk.host.settle()
    desk.button(True, button)
    for k in range(24):
        desk.move(x + 8 * k, y)
        mine, whole = desk.frame()
        own.append(mine)
        all_of_it.append(whole)
        time.sleep(max(1 / 30 - whole / 1e3, 0.0))  # so that timed brushes act in each
    desk.button(False, button)
    desk.host.settle()
    return statistics.median(own), statistics.median(all_of_it)


def main() -> None:
    """Print the figures."""
    for figure in figures("--quick" in sys.argv[1:]):
        sys.stdout.write(f"{figure.name:<84}{figure.value:9.3f} {figure.unit:<7} {figure.note}\n")


if __name__ == "__main__":
    main()
