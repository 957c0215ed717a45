"""Run every kernel with all indexes checked: ``python -m tests.long.bounds_checked``.

Compiles them anew, with checks, in a folder of its own; an index out of bounds is an `IndexError`.
Numbers that kernels keep in vectors are no arrays, and have no bounds to check.
"""

import os
import subprocess
import sys
import tempfile

import numpy as np
import shapely
from shapely.geometry import Polygon, box

SHAPES = {
    "narrow strip": ((1, 5000), 500),
    "broad strip": ((2, 50_000), 500),
    "one pixel": ((1, 1), 40),
    "one pixel of ink": ((300, 300), 160),
    "white": ((40, 40), 50),
}


def odd_pictures() -> None:
    """Stipple pictures of odd shapes, by every way to place first dots."""
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import FIRST_DOTS, Style
    from stippler.stippling.stipple import stages

    for name, (shape, n) in SHAPES.items():
        values = np.full(shape, 0.5 if "strip" in name or name == "one pixel" else 0.0, np.float32)
        if name == "one pixel of ink":
            values[150, 150] = 1.0
        for method in FIRST_DOTS:
            style = Style(n_dots=n, iterations=2, first_dots=method)
            for _ in stages(Reference(values, max(20.0, 0.1 * shape[1])), style):
                pass


def odd_cells() -> None:
    """Relax dots of odd places in odd compartments."""
    from stippler.stippling.relax import Relaxation
    from stippler.stippling.tessellation import Tessellation
    from tests.stippling.degenerate import shape_and_dots

    for seed in range(60):
        shape, xy = shape_and_dots(seed)
        if len(xy):
            Tessellation.of(xy, shape)
            for method in ("lloyd", "even"):
                Relaxation(xy, shape, method=method).run(3)
    rng = np.random.default_rng(1)
    turn = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)]) * 4.0 + 5.0
    comb = [(0, 0), (10, 0)] + [
        (10 - 0.05 * k, 10 if k % 2 else 1) for k in range(1, 200)
    ]  # fmt: skip
    for dots, shape in (
        (np.vstack([circle, [(5.0, 5.0)]]), box(0, 0, 10, 10)),
        (np.full((30, 2), 5.0), box(0, 0, 10, 10)),
        (rng.random((300, 2)) * 1e-9 + 5.0, box(0, 0, 10, 10)),
        (rng.random((300, 2)) * (10, 0.9), Polygon(comb).buffer(0)),
    ):
        inside = dots[shapely.intersects_xy(shape, *dots.T)]
        for method in ("lloyd", "even"):
            Relaxation(inside, shape, method=method).run(3)


def rings() -> None:
    """Relax dots along curves about a void, in a square and where walls cut the curves."""
    from stippler.stippling.relax import Relaxation
    from tests.regressions.test_relax_rings_about_nothing import CURVES, SIDE

    square = box(-SIDE, -SIDE, SIDE, SIDE)
    comb = shapely.union_all([box(x, -1.0, x + 0.01, 1.2) for x in np.arange(-1.2, 1.2, 0.2)])
    hole = shapely.Point(0.1, 0.0).buffer(0.9)
    for dots in CURVES.values():
        for shape in (square, square - hole, square - comb):
            inside = dots[shapely.intersects_xy(shape, *dots.T)]
            for method in ("lloyd", "even"):
                Relaxation(inside, shape, method=method).run(2)


def areas() -> None:
    """Draw areas with every border between them, all at once and one of them again."""
    from stippler.drawing.style import BORDERS
    from stippler.jobs.processing import process_now
    from tests.stippling.test_tone_of_each_area import divided, pictured

    for kind in ("light", "dark", "edges"):
        for border in BORDERS:
            page = divided(pictured(kind), 12, 1, n_dots=800, iterations=4, border=border)
            process_now(page, list(page.drawing.areas))
            process_now(page, list(page.drawing.areas)[3:4])


def run() -> None:
    """Do all of it in this process."""
    from stippler.warm import parts

    own = (odd_pictures, odd_cells, rings, areas)
    for name, part in (*parts(), *((one.__name__, one) for one in own)):
        part()
        print(name, flush=True)


def main() -> int:
    """Do it in a process whose kernels check their indexes."""
    with tempfile.TemporaryDirectory() as folder:
        checked = {
            "NUMBA_BOUNDSCHECK": "1", "STIPPLER_KERNELS": "numba", "STIPPLER_CACHE_DIR": folder,
        }  # fmt: skip
        command = [sys.executable, "-m", "tests.long.bounds_checked", "--here"]
        return subprocess.run(command, env={**os.environ, **checked}, check=False).returncode


if __name__ == "__main__":
    if sys.argv[1:] == ["--here"]:
        run()
    else:
        sys.exit(main())
