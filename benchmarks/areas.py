"""Settled dots in many areas, against one square: ``python -m benchmarks.areas [--quick]``.

A square's dots are relaxed first; then they are divided among areas, relaxed until they settle
again, and timed step by step in turn, so that other work on the machine falls on all alike.
"""

from __future__ import annotations

import sys
import time

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPoint, Polygon, box

from benchmarks.figures import Figure
from stippler.stippling.relax import Relaxation

N = 50_000
_BEFORE, _SETTLING = 12, 15


def subdivision(n: int, seed: int = 0) -> list[Polygon]:
    """Cut the unit square into n convex areas with corners all along their sides."""
    square = box(0, 0, 1, 1)
    seeds = MultiPoint(np.random.default_rng(seed).random((n, 2)))
    cells = shapely.get_parts(shapely.voronoi_polygons(seeds, extend_to=square))
    cells = shapely.intersection(cells, square)
    return [shapely.segmentize(cell, 1 / np.sqrt(n) / 8) for cell in cells if cell.area > 0]


def wavy(n_side: int) -> list[Polygon]:
    """Return n² areas with wavy outlines of 60 edges."""
    a = np.arange(60) * 2 * np.pi / 60
    out = []
    for i in range(n_side):
        for j in range(n_side):
            r = (0.8 + 0.2 * np.sin((3 + (i + j) % 4) * a)) / (2 * n_side)
            middle = (np.array([i, j]) + 0.5) / n_side
            out.append(Polygon(middle + np.c_[r * np.cos(a), r * np.sin(a)]))
    return out


def _points_in(areas: list[Polygon], n: int) -> NDArray[np.float64]:
    found = []
    for k, area in enumerate(areas):
        x0, y0, x1, y1 = area.bounds
        xy = np.random.default_rng(k).random((3 * n, 2)) * [x1 - x0, y1 - y0] + [x0, y0]
        found.append(xy[shapely.contains_xy(area, xy[:, 0], xy[:, 1])][:n])
    return np.concatenate(found)


def figures(quick: bool = False) -> list[Figure]:
    """Measure a settled step of all engines in turn."""
    first = Relaxation(np.random.default_rng(0).random((N, 2)), box(0, 0, 1, 1))
    first.run(_BEFORE)
    xy = first.points
    waves = wavy(14)
    engines = [
        Relaxation(xy, box(0, 0, 1, 1)),
        Relaxation(xy, subdivision(200)),
        Relaxation(xy, subdivision(2200)),
        Relaxation(_points_in(waves, N // len(waves)), waves),
    ]
    for engine in engines:
        engine.run(_SETTLING)
    least = [np.inf] * len(engines)
    for _ in range(8 if quick else 30):
        for k, engine in enumerate(engines):
            start = time.perf_counter()
            engine.step()
            least[k] = min(least[k], (time.perf_counter() - start) / len(engine))
    names = (
        ("50k in 200 convex areas, settled step", 1.5, 1.25),
        ("50k in 2,200 convex polygons, settled step", 2.5, 1.6),
        ("50k in 196 wavy areas, settled step", None, None),
    )
    note = "of one square's"
    return [
        Figure(name, seconds / least[0], "times", reach, stretch, note=note)
        for (name, reach, stretch), seconds in zip(names, least[1:], strict=True)
    ]


def main() -> None:
    """Print a line for each figure."""
    for figure in figures("--quick" in sys.argv):
        print(f"{figure.name:46} {figure.value:6.2f} {figure.unit} {figure.note}")


if __name__ == "__main__":
    main()
