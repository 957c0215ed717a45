"""First dots without pulses: the baselines, and starts that need no picture."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.style import MAX_DOTS
from stippler.drawing.validation import whole
from stippler.errors import GeometryError, ParameterError
from stippler.kernels.halftone.grow_regions import diffuse
from stippler.stippling.compartments import polygon_of
from stippler.stippling.fill import ARRANGEMENTS

_NO_DOTS = np.empty((0, 2))
_CORNER = np.zeros((1, 2))

_MOST_EMPTY = 8.0  # times its area that the boxes around an area may cover
_MOST_BOXES = 50_000
_LEAST_SHARE = 0.02  # of boxes that is the area's; below, triangles find it
_ROUNDS = 100
_MORE, _TRIES = 1.02, 14  # factor of a step towards a number of dots, and how many steps
_LEAST_STEP = 0.7  # of a spacing that is changed: a grid that misses an area would else explode


def floyd_steinberg(density: NDArray[np.float32]) -> NDArray[np.float64]:
    """Halftone a density field by error diffusion; return (n, 2) pixels.

    The grid is so fine that the densest part sets half of its cells. Floyd and Steinberg 1976,
    serpentine: what the paper tried first, kept as a baseline.
    """
    h, w = density.shape
    densest = float(density.max(initial=0.0))
    if densest <= 0.0:
        return _NO_DOTS
    zoom = math.sqrt(2.0 * densest)
    rows, columns = max(1, round(h * zoom)), max(1, round(w * zoom))
    y = np.minimum((np.arange(rows) + 0.5) * (h / rows), h - 1).astype(np.intp)
    x = np.minimum((np.arange(columns) + 0.5) * (w / columns), w - 1).astype(np.intp)
    charge = density[np.ix_(y, x)].astype(np.float64) * ((h / rows) * (w / columns))
    total, asked = charge.sum(), density.sum(dtype=np.float64)
    if total > 0:
        charge *= asked / total
    points = np.empty((charge.size, 2))

    def diffused(factor: float) -> NDArray[np.float64]:
        n = diffuse(charge * factor, points)
        return _on_ink(points[:n] * (w / columns, h / rows), density)

    return _exactly(round(asked), 1.0, diffused, _MORE)


def random_dots(density: NDArray[np.float32], seed: int) -> NDArray[np.float64]:
    """Draw independent dots with probability in proportion to the density; (n, 2) pixels."""
    sums = np.cumsum(density, axis=None, dtype=np.float64)
    n = round(float(sums[-1]))
    if n == 0:
        return _NO_DOTS
    rng = np.random.default_rng(seed)
    which = np.searchsorted(sums, rng.random(n) * sums[-1], side="right")
    which = np.minimum(which, np.flatnonzero(density.ravel())[-1])
    w = density.shape[1]
    return np.column_stack((which % w, which // w)) + rng.random((n, 2))


def hexagonal(density: NDArray[np.float32]) -> NDArray[np.float64]:
    """Lay a hexagonal grid over all that is not white, with as many dots as the density asks."""
    h, w = density.shape
    wanted = float(density.sum(dtype=np.float64))
    inked = int(np.count_nonzero(density))
    if inked == 0 or wanted < 0.5:
        return _NO_DOTS
    return _exactly(
        round(wanted),
        math.sqrt(2.0 / math.sqrt(3.0) * inked / wanted),
        lambda spacing: _on_ink(_hexagons_in(_CORNER, np.array([(w, h)]), spacing), density),
        1.0 / _MORE,
    )


def fill_area(
    area: Polygon | MultiPolygon, n: int, arrangement: str, seed: int
) -> NDArray[np.float64]:
    """Fill a polygon with n dots in one of the `ARRANGEMENTS`; see `random_in`."""
    if arrangement not in ARRANGEMENTS:
        raise ParameterError(
            f"{arrangement!r} is unknown", "arrangement", f"one of {', '.join(ARRANGEMENTS)}"
        )
    return hexagonal_in(area, n) if arrangement == "hexagonal" else random_in(area, n, seed)


def random_in(area: Polygon | MultiPolygon, n: int, seed: int) -> NDArray[np.float64]:
    """Draw n independent dots in a polygon.

    Parameters
    ----------
    area : shapely Polygon or MultiPolygon
    n : int
    seed : int

    Returns
    -------
    (n, 2) float64, in the polygon's unit

    Raises
    ------
    GeometryError
        If the polygon is empty or not valid.
    """
    n = _checked(area, n)
    if whole(seed, "seed") < 0:
        raise ParameterError(f"{seed} is no seed", "seed", "give 0 or more")
    rng = np.random.default_rng(seed)
    low, size = _boxes(area)
    ends = np.cumsum(size[:, 0] * size[:, 1])
    share = area.area / ends[-1]
    if share < _LEAST_SHARE:
        return _random_in_triangles(area, n, rng)
    parts: list[NDArray[np.float64]] = []
    missing = n
    while missing:
        tries = min(int(1.1 * missing / share) + 16, 4_000_000)
        k = 0
        if len(low) > 1:
            k = np.minimum(np.searchsorted(ends, rng.random(tries) * ends[-1]), len(low) - 1)
        some = rng.random((tries, 2)) * size[k] + low[k]
        some = some[shapely.contains_xy(area, some[:, 0], some[:, 1])][:missing]
        parts.append(some)
        missing -= len(some)
    return np.concatenate(parts) if parts else _NO_DOTS


def _random_in_triangles(
    area: Polygon | MultiPolygon, n: int, rng: np.random.Generator
) -> NDArray[np.float64]:
    """Draw dots in an area so thin that most of any boxes around it is empty."""
    triangles = shapely.get_parts(shapely.constrained_delaunay_triangles(area))
    corners = shapely.get_coordinates(shapely.get_exterior_ring(triangles)).reshape(-1, 4, 2)[:, :3]
    ends = np.cumsum(shapely.area(triangles))
    points = np.empty((n, 2))
    missing = np.arange(n)
    for _ in range(_ROUNDS):  # rounding puts dots beside an area that is hardly wider than it
        a, b, c = corners[np.searchsorted(ends, rng.random(len(missing)) * ends[-1])].swapaxes(0, 1)
        u, v = rng.random((2, len(missing), 1))
        flip = u + v > 1.0
        u, v = np.where(flip, 1.0 - u, u), np.where(flip, 1.0 - v, v)
        points[missing] = a + u * (b - a) + v * (c - a)
        missing = missing[~shapely.contains_xy(area, *points[missing].T)]
        if not len(missing):
            return points
    raise GeometryError("is too narrow to be filled", "area", "make it wider")


def hexagonal_in(area: Polygon | MultiPolygon, n: int) -> NDArray[np.float64]:
    """Lay a hexagonal grid of about n dots over a polygon; arguments as for `random_in`."""
    n = _checked(area, n)
    if n == 0:
        return _NO_DOTS
    low, size = _boxes(area)

    def inside(spacing: float) -> NDArray[np.float64]:
        grid = _hexagons_in(low - low.min(axis=0), size, spacing) + low.min(axis=0)
        kept: NDArray[np.float64] = grid[shapely.contains_xy(area, grid[:, 0], grid[:, 1])]
        return kept

    points = _fitted(n, math.sqrt(2.0 / math.sqrt(3.0) * area.area / n), inside)
    if not len(points):
        raise GeometryError(
            f"is too narrow for a hexagonal grid of {n} dots",
            "area",
            "ask for more, or random ones",
        )
    return points


def _checked(area: Polygon | MultiPolygon, n: int) -> int:
    n = whole(n, "dots")
    if not 0 <= n <= MAX_DOTS:
        raise ParameterError(f"{n} dots cannot be drawn", "dots", f"give 0 to {MAX_DOTS:,}")
    polygon_of(area, "area")
    return n


def _boxes(area: Polygon | MultiPolygon) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return corners and sizes, (k, 2) each, of boxes side by side that cover an area.

    The area's own box, unless most of that is empty: then it is quartered, and so on.
    """
    shapely.prepare(area)
    x0, y0, x1, y1 = area.bounds
    low, size = np.array([(x0, y0)]), np.array([(x1 - x0, y1 - y0)])
    quarters = np.array([(0, 0), (1, 0), (0, 1), (1, 1)])
    while size.prod(axis=1).sum() > _MOST_EMPTY * area.area and len(low) < _MOST_BOXES:
        size = np.repeat(size / 2.0, 4, axis=0)
        low = np.repeat(low, 4, axis=0) + size * np.tile(quarters, (len(low), 1))
        touched = shapely.intersects(area, shapely.box(*low.T, *(low + size).T))
        low, size = low[touched], size[touched]
    return low, size


def _hexagons_in(
    low: NDArray[np.float64], size: NDArray[np.float64], spacing: float
) -> NDArray[np.float64]:
    """Return the dots of a hexagonal grid from (0, 0) on that lie in boxes, row by row."""
    pitch = spacing * math.sqrt(0.75)
    box, row = _counted(low[:, 1] / pitch - 0.5, (low + size)[:, 1] / pitch - 0.5)
    shift = 0.25 + 0.5 * (row % 2)
    left, right = low[box, 0] / spacing - shift, (low + size)[box, 0] / spacing - shift
    run, column = _counted(left, right)
    row, shift = row[run], shift[run]
    points = np.column_stack(((column + shift) * spacing, (row + 0.5) * pitch))
    return points[np.lexsort((column, row))] if len(low) > 1 else points


def _counted(
    start: NDArray[np.float64], stop: NDArray[np.float64]
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """List the whole numbers of ranges ``start <= i < stop``: which range, and the number."""
    first = np.ceil(start).astype(np.intp)
    n = np.maximum(np.ceil(stop).astype(np.intp) - first, 0)
    which = np.repeat(np.arange(len(n)), n)
    return which, np.arange(len(which)) - np.repeat(np.cumsum(n) - n - first, n)


def _fitted(
    wanted: float, spacing: float, place: Callable[[float], NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Change the spacing until `place(spacing)` gives nearly the wanted number; the best try."""
    best = place(spacing)
    points = best
    for _ in range(8):
        if abs(len(points) - wanted) <= 0.002 * wanted:
            break
        spacing *= max(math.sqrt(len(points) / wanted), _LEAST_STEP)
        points = place(spacing)
        if abs(len(points) - wanted) < abs(len(best) - wanted):
            best = points
    return best


def _exactly(
    n: int, value: float, place: Callable[[float], NDArray[np.float64]], towards_more: float
) -> NDArray[np.float64]:
    """Find the value whose `place(value)` has least too many dots, and leave out what is too many.

    `towards_more`: a factor to the value that gives more dots. Those left out lie evenly among the
    others, in the order given.
    """
    best, few, many = place(value), 0.0, 0.0
    points = best
    for _ in range(_TRIES):
        if len(points) >= n:
            many = value
            best = points if len(best) < n or len(points) < len(best) else best
        else:
            few = value
        if len(best) == n:
            return best
        if few and many:
            value = math.sqrt(few * many)
        else:
            value *= towards_more if not many else 1.0 / towards_more
        points = place(value)
    n_over = len(best) - n
    if n_over <= 0:
        return best
    over = (np.arange(n_over) + 0.5) * (len(best) / n_over)
    return np.delete(best, over.astype(np.intp), axis=0)


def _on_ink(position: NDArray[np.float64], density: NDArray[np.float32]) -> NDArray[np.float64]:
    h, w = density.shape
    x = np.minimum(position[:, 0].astype(np.intp), w - 1)
    y = np.minimum(position[:, 1].astype(np.intp), h - 1)
    kept: NDArray[np.float64] = position[density[y, x] > 0]
    return kept
