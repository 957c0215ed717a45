"""Relaxation beside its peers: ``python -m benchmarks.relaxation [--quick]``.

All figures come from one run on one machine, so ratios can be compared where times can't. A time
is the least of several runs, ours and the peers' alike, as other work on the machine only ever
adds. Dots are random and uniform unless a name says otherwise; seeds are fixed.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import Delaunay
from shapely.geometry import Point, Polygon, box

from benchmarks.figures import Figure
from stippler.stippling.relax import DensityField, Relaxation
from stippler.stippling.relax_local import LocalRelaxation

Points = NDArray[np.float64]

N = 50_000
SETTLED = 100
"""Steps after which dots count as settled."""

_D3 = Path(__file__).with_name("d3_delaunay.mjs")


def figures(quick: bool = False) -> list[Figure]:
    """Measure everything; `quick` leaves out what takes long."""
    repeats = 5 if quick else 15
    found = _square(repeats) + _shapes(repeats) + _weighted(repeats) + _uneven(repeats)
    found += _curves() + _sizes(quick) + _brush(repeats) + _run_from_halftone(repeats)
    found += _beside_a_ticking_thread(quick)
    return found


def dots(n: int, seed: int = 1) -> Points:
    """Return n random dots in the unit square."""
    return np.random.default_rng(seed).random((n, 2))


def least_s(call: Callable[[], object], repeats: int, warm: int = 1) -> float:
    """Return the least time of a call."""
    for _ in range(warm):
        call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def first_step_s(make: Callable[[], Relaxation], repeats: int) -> float:
    """Return the time of an engine's first step."""
    make().step()
    times = []
    for _ in range(repeats):
        engine = make()
        start = time.perf_counter()
        engine.step()
        times.append(time.perf_counter() - start)
    return min(times)


def later_step_s(engine: Relaxation, after: int, repeats: int) -> float:
    """Return the time of a step that follows `after` others."""
    engine.run(after)
    return least_s(engine.step, repeats, warm=0)


def _square(repeats: int) -> list[Figure]:
    xy, square = dots(N), box(0, 0, 1, 1)
    first = first_step_s(lambda: Relaxation(xy, square), repeats)
    engine = Relaxation(xy, square)
    out = [
        Figure("50k, square, first step", first * 1e3, "ms", 20, 14),
        Figure("50k, square, step 20", later_step_s(engine, 18, 5) * 1e3, "ms", 9, 4),
        Figure(
            "50k, square, settled", later_step_s(engine, SETTLED - 23, 9) * 1e3, "ms", 5, 2.5
        ),
    ]  # fmt: skip
    out.append(_even_against(engine, Relaxation(xy, square, method="even"), repeats))
    peers = {"scipy Delaunay + numpy": lambda: scipy_step(xy), "shapely": lambda: shapely_step(xy)}
    promised = {"scipy Delaunay + numpy": 20.0}
    for name, step in peers.items():
        seconds = least_s(step, max(repeats // 3, 1), warm=0)
        out.append(Figure(f"50k, {name}", seconds * 1e3, "ms", note="peer"))
        out.append(_times_faster(f"50k, first step against {name}", seconds, first,
                                 promised.get(name)))  # fmt: skip
    seconds_d3 = d3_step_s(N)
    if seconds_d3 is not None:
        out.append(Figure("50k, d3-delaunay in node", seconds_d3 * 1e3, "ms", note="peer"))
        out.append(_times_faster("50k, first step against d3-delaunay", seconds_d3, first, 2.5))
    for method in ("delaunay-mean", "springs"):
        seconds = least_s(Relaxation(xy, square, method=method).step, 2, warm=0)
        note = "for comparison"
        out.append(Figure(f"50k, square, {method}, a step", seconds * 1e3, "ms", note=note))
    return out


def _even_against(lloyd: Relaxation, even: Relaxation, repeats: int) -> Figure:
    """Compare settled steps, in turns."""
    even.run(SETTLED)
    engines = (even, lloyd)
    turns = [[least_s(one.step, 1, warm=0) for one in engines] for _ in range(repeats)]
    ratio = float(np.divide(*np.min(turns, axis=0)))
    return Figure("50k, a settled step of the even rules", ratio, "x Lloyd", 1.3)


def _times_faster(name: str, theirs: float, ours: float, reach: float | None) -> Figure:
    return Figure(name, theirs / ours, "x faster", reach, higher_is_better=True)


def _more(name: str, seconds: float, base: float, reach: float, stretch: float) -> Figure:
    return Figure(name, seconds / base, "x square", reach, stretch)


def holed(n_edges: int) -> Polygon:
    """Return a wavy polygon of about n edges with two holes."""
    a = np.linspace(0, 2 * np.pi, n_edges - 64 + 1)[:-1]
    r = 1 + 0.25 * np.sin(5 * a) + (0.002 * np.cos(200 * a) if n_edges > 1000 else 0.0)
    outline = Polygon(np.c_[r * np.cos(a), r * np.sin(a)])
    for x, y, radius in ((0.3, 0.0, 0.15), (-0.4, 0.1, 0.12)):
        outline = outline.difference(Point(x, y).buffer(radius, quad_segs=8))
    return outline


def points_in(polygon: Polygon, n: int, seed: int = 1) -> Points:
    """Return n random dots in a polygon."""
    shapely.prepare(polygon)
    x0, y0, x1, y1 = polygon.bounds
    xy = dots(4 * n + 100, seed) * [x1 - x0, y1 - y0] + [x0, y0]
    inside: Points = xy[shapely.contains_xy(polygon, xy[:, 0], xy[:, 1])][:n]
    return inside


def hexagons() -> list[Polygon]:
    """Return 500 compartments side by side."""
    corners = np.array([(1, 2), (10, 1), (19, 2), (18, 18), (10, 19), (2, 18)]) / 20
    return [Polygon(corners + np.array([i, j])) for i in range(25) for j in range(20)]


def _shapes(repeats: int) -> list[Figure]:
    xy, square = dots(N), box(0, 0, 1, 1)
    base = first_step_s(lambda: Relaxation(xy, square), repeats)
    out = []
    for n_edges, reach, stretch in ((250, 1.3, 1.15), (10_000, 1.5, 1.25)):
        polygon = holed(n_edges)
        inside = points_in(polygon, N)
        seconds = first_step_s(lambda p=polygon, q=inside: Relaxation(q, p), repeats)  # type: ignore[misc]
        name = f"50k, polygon of {n_edges} edges with holes, first step"
        out.append(_more(name, seconds, base, reach, stretch))
    parts = hexagons()
    inside = np.concatenate([points_in(p, N // len(parts), i) for i, p in enumerate(parts)])
    owner = np.repeat(np.arange(len(parts)), N // len(parts))
    seconds = first_step_s(lambda: Relaxation(inside, parts, None, owner), repeats)
    out.append(_more("50k in 500 compartments, first step", seconds, base, 1.5, 1.25))
    return out


def _weighted(repeats: int) -> list[Figure]:
    xy, square = dots(N), box(0, 0, 1, 1)
    base = first_step_s(lambda: Relaxation(xy, square), repeats)
    field = DensityField(np.random.default_rng(0).random((2000, 2000)) + 0.5, 1 / 2000)
    seconds = first_step_s(lambda: Relaxation(xy, square, density=field), repeats)
    return [_more("50k, density of 4 megapixels, first step", seconds, base, 2.0, 1.4)]


def _uneven(repeats: int) -> list[Figure]:
    xy, square = dots(N), box(0, 0, 1, 1)
    base = first_step_s(lambda: Relaxation(xy, square), repeats)
    gradient = xy.copy()  # density from 1 to 50 along x
    gradient[:, 0] = (np.sqrt(1 + xy[:, 0] * (50**2 - 1)) - 1) / 49
    rng = np.random.default_rng(2)
    centres = rng.random((40, 2)) * 0.9 + 0.05
    clusters = centres[rng.integers(0, 40, N)] + 0.005 * rng.standard_normal((N, 2))
    return [
        _more(f"50k, {name}, first step",
              first_step_s(lambda p=p: Relaxation(p, square), repeats), base, *promised)  # type: ignore[misc]
        for name, p, promised in (("density gradient of 50:1", gradient, (1.2, 1.1)),
                                  ("40 tight clusters", clusters, (2.0, 1.3)))
    ]  # fmt: skip


def _curves() -> list[Figure]:
    """Time steps of dots along curves, whose cells are long and thin."""
    a = np.arange(100_000) * 2 * np.pi / 100_000
    ring = np.c_[np.cos(a), np.sin(a)]
    found: list[Figure] = []
    for name, xy in (
        ("100k in a ring about one more dot", np.vstack([[[0.0, 0.0]], ring])),
        ("100k in a ring about nothing", ring),
        ("100k in half a ring", np.c_[np.cos(a / 2), np.sin(a / 2)]),
        ("100k in an ellipse", ring * [1.0, 0.6]),
    ):
        found += _first_and_third(name, xy, box(-1.25, -1.25, 1.25, 1.25))
    wall = Point(0, 0).buffer(1.05, 64).difference(Point(0, 0).buffer(0.95, 64))
    return found + _first_and_third("100k in a ring between two walls", ring, wall)


def _first_and_third(name: str, xy: Points, shape: Polygon) -> list[Figure]:
    engine = Relaxation(xy, shape)
    times = [least_s(engine.step, 1, warm=0) for _ in range(3)]
    return [
        Figure(f"{name}, first step", times[0], "s", 1.0),
        Figure(f"{name}, third step", times[2], "s", 1.0),
    ]


def _sizes(quick: bool) -> list[Figure]:
    square, out, at = box(0, 0, 1, 1), [], {}
    for n in (1_000, 10_000, 100_000) if quick else (1_000, 10_000, 100_000, 1_000_000):
        xy = dots(n)
        at[n] = first_step_s(lambda p=xy: Relaxation(p, square), 3 if n > 10**5 else 9)  # type: ignore[misc]
        promised = (400.0, 250.0) if n == 10**6 else (None, None)
        out.append(Figure(f"{n // 1000}k, square, first step", at[n] * 1e3, "ms", *promised))
    growth = [(at[10 * n] / at[n]) / (10 * np.log(10 * n) / np.log(n)) for n in at if 10 * n in at]
    out.append(Figure("growth from 1k on, worst decade", max(growth), "x n log n", 1.0))
    return out


def _brush(repeats: int) -> list[Figure]:
    side = 200_000**0.5
    xy = dots(200_000) * side
    brush = LocalRelaxation(xy, box(0, 0, side, side))
    within = np.hypot(*(xy - side / 2).T) <= (500 / np.pi) ** 0.5
    chosen = np.flatnonzero(within).astype(np.int32)
    seconds = least_s(lambda: brush.relax(chosen), 20 * repeats, warm=5)
    note = f"{len(chosen)} dots"
    return [Figure("500 dots under a brush in 200k", seconds * 1e3, "ms", 1.0, 0.4, note=note)]


def _run_from_halftone(repeats: int) -> list[Figure]:
    """Jittered rows stand for a halftone's start: even, but not relaxed."""
    side = round(N**0.5)
    rows = np.stack(np.meshgrid(np.arange(side), np.arange(side)), -1).reshape(-1, 2) + 0.5
    xy = (rows + np.random.default_rng(3).uniform(-0.35, 0.35, rows.shape)) / side
    times = []
    for _ in range(max(repeats // 2, 2)):
        engine = Relaxation(xy, box(0, 0, 1, 1))
        start = time.perf_counter()
        engine.run(20)
        times.append(time.perf_counter() - start)
    note = "start: jittered rows"
    value = min(times) * 1e3
    return [Figure("20 iterations of 50k from an even start", value, "ms", 200, 120, note=note)]


def _beside_a_ticking_thread(quick: bool) -> list[Figure]:
    engine = Relaxation(dots(200_000), box(0, 0, 1, 1))
    engine.step()
    stop = threading.Event()
    worker = threading.Thread(target=lambda: engine.run(10**6, cancel=stop))
    worker.start()
    gaps, last = [], time.perf_counter()
    end = last + (2.0 if quick else 6.0)
    while last < end:
        time.sleep(max(1 / 60 - (time.perf_counter() - last), 0.0))
        now = time.perf_counter()
        gaps.append(now - last)
        last = now
    asked = time.perf_counter()
    stop.set()
    worker.join()
    answered = time.perf_counter() - asked
    return [
        Figure("longest gap of a 60 Hz thread beside 200k", max(gaps) * 1e3, "ms", 25, 20),
        Figure("from cancel to stop at 200k", answered * 1e3, "ms", 50),
    ]


def scipy_step(xy: Points) -> Points:
    """Return Lloyd's step by scipy's triangulation and numpy: circumcentres, then fans.

    Cells are not clipped at all, which is less work than ours does.
    """
    triangles = Delaunay(xy)
    t = triangles.simplices
    a, b, c = xy[t[:, 0]], xy[t[:, 1]], xy[t[:, 2]]
    ab, ac = b - a, c - a
    d = 2 * (ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0])
    ab2, ac2 = (ab**2).sum(1), (ac**2).sum(1)
    centre = (
        a + np.c_[ac[:, 1] * ab2 - ab[:, 1] * ac2, ab[:, 0] * ac2 - ac[:, 0] * ab2] / d[:, None]
    )
    np.clip(centre, 0, 1, out=centre)
    total, moment = np.zeros(len(xy)), np.zeros((len(xy), 2))
    for k in range(3):  # a side of a cell joins the centres on both sides of a Delaunay edge
        beyond = triangles.neighbors[:, k]
        inner = beyond >= 0
        p, q = centre[inner], centre[beyond[inner]]
        for end in (t[inner, (k + 1) % 3], t[inner, (k + 2) % 3]):
            dot = xy[end]
            u, v = p - dot, q - dot
            area = 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
            total += np.bincount(end, area, len(xy))
            middle = dot + (u + v) / 3
            for axis in (0, 1):
                moment[:, axis] += np.bincount(end, area * middle[:, axis], len(xy))
    return moment / np.maximum(total, 1e-300)[:, None]


def shapely_step(xy: Points) -> Points:
    """Return the centroids of shapely's Voronoi polygons, clipped to the square."""
    square = box(0, 0, 1, 1)
    cells = shapely.get_parts(shapely.voronoi_polygons(shapely.multipoints(xy), extend_to=square))
    x0, y0, x1, y1 = shapely.bounds(cells).T
    out = (x0 < 0) | (y0 < 0) | (x1 > 1) | (y1 > 1)
    cells[out] = shapely.intersection(cells[out], square)
    centroids: Points = shapely.get_coordinates(shapely.centroid(cells))
    return centroids


def d3_step_s(n: int) -> float | None:
    """Return the time of d3-delaunay's step in node; None, with a line said, where it can't be."""
    node, npm = shutil.which("node"), shutil.which("npm")
    if node is None or npm is None:
        print("d3-delaunay skipped: no node here", file=sys.stderr)
        return None
    with tempfile.TemporaryDirectory() as folder:
        install = [npm, "install", "--silent", "--no-audit", "--prefix", folder, "d3-delaunay@6"]
        if subprocess.run(install, capture_output=True, check=False).returncode:
            print("d3-delaunay skipped: npm could not fetch it", file=sys.stderr)
            return None
        script = Path(folder) / _D3.name
        shutil.copy(_D3, script)
        run = subprocess.run(
            [node, str(script), str(n)], capture_output=True, text=True, check=True
        )
    return float(run.stdout) / 1e3


def main() -> None:
    """Print a table."""
    for figure in figures("--quick" in sys.argv):
        promised = [f"{p:g}" for p in (figure.reach, figure.stretch) if p is not None]
        print(
            f"{figure.name:58} {figure.value:9.2f} {figure.unit:9} "
            f"{' / '.join(promised):12} {figure.note}"
        )


if __name__ == "__main__":
    main()
