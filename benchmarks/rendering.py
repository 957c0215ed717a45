"""Frames, uploads, outlines and pictures; on a GPU, frames by its own clock.

python -m benchmarks.rendering [--quick]
"""

from __future__ import annotations

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import moderngl
import numpy as np

from benchmarks.figures import Figure, median_s
from stippler.camera import Camera
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.preview import Footprint, Preview
from stippler.drawing.shape_change import ShapeChange, to
from stippler.files.write.svg import svg_chunks
from stippler.headless import is_software, open_context, open_gpu_context
from stippler.kernels.shapes.dot_shape import bezier_outlines
from stippler.render.frame import Frame
from stippler.render.renderer import Renderer
from stippler.render.state import release_target

PAGE = Page(200.0, 125.0)
WINDOW = (1280, 800)
UHD = (3840, 2160)

_PICTURE = """
import sys
from stippler.kernels.machine.numba_import import skip_blas
skip_blas()  # as the command line does
from benchmarks.rendering import drawing
from stippler.export import save
save(drawing(int(sys.argv[1])), sys.argv[2], dpi=3840 / 200 * 25.4)
"""


def drawing(n: int, kind: str = "round") -> Drawing:
    """Make a page that dots cover to about a half, of sizes 1 : 2, evenly spread."""
    rng = np.random.default_rng(0)
    per_row = round((n * PAGE.width_mm / PAGE.height_mm) ** 0.5)
    row, column = np.divmod(np.arange(n), per_row)
    grid = np.column_stack([column, row]) + 0.5 + rng.uniform(-0.3, 0.3, (n, 2))
    step = PAGE.width_mm / per_row
    one = Drawing.blank(PAGE)
    one.dots = Dots.round(grid * step, rng.uniform(0.26, 0.52, n) * step)
    if kind != "round":
        one.dots.elongation[:] = rng.uniform(1, 4, n)
        one.dots.angle_rad[:] = rng.uniform(0, 6, n)
    if kind == "rough":
        one.dots.roughness[:] = rng.uniform(0, 1, n)
    return one


def figures(quick: bool = False) -> list[Figure]:
    """Measure all; `quick` repeats less."""
    repeats = 7 if quick else 15
    ctx = open_context()
    try:
        results = _frames(ctx, repeats) + _previews(ctx, repeats) + _uploads(ctx, repeats)
    finally:
        ctx.release()
    results += _gpu_frames(repeats)
    return results + _outlines(repeats) + _pictures(3 if quick else 5)


class _Stage:
    """A renderer and a framebuffer with a drawing on it."""

    def __init__(self, ctx: moderngl.Context, one: Drawing, size: tuple[int, int]) -> None:
        self.ctx, self.size = ctx, size
        self.renderer = Renderer(ctx)
        self.renderer.scene.set_page(one.page.width_mm, one.page.height_mm)
        self.renderer.scene.set_dots(one.dots)
        self.target = ctx.framebuffer([ctx.renderbuffer(size, 4)])
        self.camera = Camera.fit(one.page, size)

    def frame(self, preview: Preview | None = None) -> None:
        """Draw, and wait until it is drawn."""
        self.renderer.draw(Frame(self.camera, self.size, preview=preview), self.target)
        self.ctx.finish()

    def release(self) -> None:
        release_target(self.ctx, self.target)
        self.renderer.release()


def _frames(ctx: moderngl.Context, repeats: int) -> list[Figure]:
    results = []
    name = "software GL" if is_software(ctx) else "this GPU"
    for kind in ("round", "smooth", "rough"):
        stage = _Stage(ctx, drawing(100_000, kind), WINDOW)
        wall = 1e3 * median_s(stage.frame, repeats, warm=2)
        cpu = 1e3 * cpu_s(stage.frame, repeats)
        note = f"{name}; {cpu:.0f} ms of CPU time"
        label = {"round": "round", "smooth": "elongated", "rough": "rough, elongated"}[kind]
        results.append(
            Figure(f"frame, 100,000 {label} dots, 1280 x 800", wall, "ms", 60.0, note=note)
        )
        if kind == "round":
            results.append(_zoomed(stage, repeats))
        stage.release()
    return results


def cpu_s(call: Callable[[], None], repeats: int) -> float:
    """Return the median CPU time of a call, of all cores: other programs change it little."""
    times = []
    for _ in range(repeats):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return statistics.median(times)


def _zoomed(stage: _Stage, repeats: int) -> Figure:
    stage.camera = stage.camera.zoomed(40.0, (640, 400), WINDOW)
    return Figure(
        "frame, the same zoomed in 40 times", 1e3 * median_s(stage.frame, repeats, warm=2), "ms"
    )


def _previews(ctx: moderngl.Context, repeats: int) -> list[Figure]:
    """Time what a preview asks of the CPU, its uniforms; and what a hovering brush draws."""
    stage = _Stage(ctx, drawing(200_000), WINDOW)
    stage.frame()
    under = Footprint((100.0, 60.0), (0.25, 0.0, 0.0, 0.25), 4.0, hardness=0.5)
    tip = Preview(ShapeChange(stretch=1.0, angle_rad=1.0), under)
    whole = Preview(ShapeChange(elongation=to(2.0)))
    size = (64, 64)
    tile = stage.camera.tile((610, 355), size, WINDOW)

    def hover() -> None:
        camera = replace(tile, center_mm=next(places))
        stage.renderer.draw(Frame(camera, size, preview=tip), stage.target)
        ctx.finish()

    places = ((100.0 + 0.01 * k, 60.0) for k in range(10_000))
    hovering = 1e3 * median_s(hover, 4 * repeats, warm=3)
    held = 1e3 * median_s(lambda: stage.frame(whole), repeats, warm=2)
    stage.release()
    return [
        Figure("what a brush of 4 mm hovers over, in 200,000 dots", hovering, "ms"),
        Figure("frame, 200,000 round dots, elongated by a held slider", held, "ms"),
    ]


def _uploads(ctx: moderngl.Context, repeats: int) -> list[Figure]:
    one = drawing(200_000, "rough")
    dots = one.dots
    stage = _Stage(ctx, one, WINDOW)
    away = np.hypot(*(dots.position_mm - (100.0, 60.0)).T)
    rows = np.argsort(away)[:500]

    def timed(call: Callable[[], None]) -> float:
        def whole() -> None:
            call()
            ctx.finish()

        return 1e3 * median_s(whole, 4 * repeats, warm=3)

    part = timed(lambda: stage.renderer.scene.update_dots(dots, rows))
    places = timed(lambda: stage.renderer.scene.set_positions(dots.position_mm, dots.radius_mm))
    everything = timed(lambda: stage.renderer.scene.set_dots(dots))
    stage.release()
    return [
        Figure("upload of a stroke on 500 of 200,000 dots", part, "ms", 0.2),
        Figure("upload of all positions, 200,000 dots", places, "ms"),
        Figure("upload of everything, 200,000 dots", everything, "ms"),
    ]


def _gpu_frames(repeats: int) -> list[Figure]:
    """Time a million deformed dots at 4k by a GPU's own clock; not on software GL."""
    name = "frame, 1,000,000 deformed dots, 3840 x 2160"
    ctx = open_gpu_context()
    try:
        driver = ctx.info["GL_RENDERER"]
        if is_software(ctx):
            print(f"{name}: not measured, no GPU here ({driver})", file=sys.stderr)
            return []
        median = _by_the_gpu_ms(ctx, repeats)
    finally:
        ctx.release()
    return [Figure(name, median, "ms", 4.0, note=f"{driver}, timer queries")]


def _by_the_gpu_ms(ctx: moderngl.Context, repeats: int) -> float:
    stage = _Stage(ctx, drawing(1_000_000, "rough"), UHD)
    clock = ctx.query(time=True)
    times = []
    for _ in range(4 * repeats):
        with clock:
            stage.frame()
        times.append(clock.elapsed / 1e6)
    stage.release()
    return statistics.median(times[repeats:])


def _outlines(repeats: int) -> list[Figure]:
    round_ones, rough = drawing(100_000), drawing(100_000, "rough")
    outlines = median_s(lambda: bezier_outlines(rough.dots, 24), repeats)
    as_circles = median_s(lambda: b"".join(svg_chunks(round_ones)), repeats)
    as_paths = median_s(lambda: b"".join(svg_chunks(rough)), repeats)
    size = [len(b"".join(svg_chunks(one))) / 1e6 for one in (round_ones, rough)]
    return [
        Figure("outlines of 100,000 rough dots, 24 segments", outlines, "s", 0.3),
        Figure("SVG of 100,000 round dots", as_circles, "s", note=f"{size[0]:.1f} MB"),
        Figure("SVG of 100,000 rough dots", as_paths, "s", note=f"{size[1]:.1f} MB"),
    ]


def _pictures(repeats: int) -> list[Figure]:
    results = []
    for n, reach, stretch in ((100_000, 2.0, 1.0), (1_000_000, None, None)):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out.png"
            command = [sys.executable, "-c", _PICTURE, str(n), str(out)]
            times = []
            before = _cpu_of_children_s()
            for _ in range(repeats):
                start = time.perf_counter()
                subprocess.run(command, check=True, capture_output=True)
                times.append(time.perf_counter() - start)
            cpu = (_cpu_of_children_s() - before) / repeats
            note = f"{out.stat().st_size / 1e6:.1f} MB; {cpu:.1f} s of CPU time"
        name = f"PNG 3840 x 2400 of {n:,} dots, whole process"
        results.append(Figure(name, statistics.median(times), "s", reach, stretch, note=note))
    return results


def _cpu_of_children_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main() -> None:
    """Print a line for each figure."""
    for figure in figures("--quick" in sys.argv):
        promised = "" if figure.reach is None else f"{figure.reach:g}"
        print(
            f"{figure.name:52} {figure.value:9.3g} {figure.unit:3} {promised:5} "
            f"{figure.verdict:8} {figure.note}"
        )


if __name__ == "__main__":
    main()
