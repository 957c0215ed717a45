"""First dots without pulses: the baselines, and starts that need no picture."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.errors import GeometryError, ParameterError
from stippler.kernels.pulse_density import diffuse
from stippler.stippling.plan import ARRANGEMENTS, MAX_DOTS

_NO_DOTS = np.empty((0, 2))


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
    total = charge.sum()
    if total > 0:
        charge *= density.sum(dtype=np.float64) / total
    points = np.empty((charge.size, 2))
    n = diffuse(charge, points)
    return _on_ink(points[:n] * (w / columns, h / rows), density)


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
    return _fitted(
        wanted,
        math.sqrt(2.0 / math.sqrt(3.0) * inked / wanted),
        lambda spacing: _on_ink(_hexagons(w, h, spacing), density),
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
    _check(area, n)
    rng = np.random.default_rng(seed)
    x0, y0, x1, y1 = area.bounds
    shapely.prepare(area)
    parts: list[NDArray[np.float64]] = []
    missing = n
    while missing:
        share = area.area / ((x1 - x0) * (y1 - y0))
        tries = min(int(1.1 * missing / max(share, 1e-6)) + 16, 4_000_000)
        some = rng.random((tries, 2)) * (x1 - x0, y1 - y0) + (x0, y0)
        some = some[shapely.contains_xy(area, some[:, 0], some[:, 1])][:missing]
        parts.append(some)
        missing -= len(some)
    return np.concatenate(parts) if parts else _NO_DOTS


def hexagonal_in(area: Polygon | MultiPolygon, n: int) -> NDArray[np.float64]:
    """Lay a hexagonal grid of about n dots over a polygon; arguments as for `random_in`."""
    _check(area, n)
    if n == 0:
        return _NO_DOTS
    x0, y0, x1, y1 = area.bounds
    shapely.prepare(area)

    def inside(spacing: float) -> NDArray[np.float64]:
        grid = _hexagons(x1 - x0, y1 - y0, spacing) + np.array((x0, y0))
        kept: NDArray[np.float64] = grid[shapely.contains_xy(area, grid[:, 0], grid[:, 1])]
        return kept

    return _fitted(n, math.sqrt(2.0 / math.sqrt(3.0) * area.area / n), inside)


def check_area(area: Polygon | MultiPolygon) -> None:
    """Refuse a polygon that has no inside."""
    if area.is_empty or not area.is_valid or not area.area > 0:
        raise GeometryError("is no valid polygon", "area", "give one with an inside")


def _check(area: Polygon | MultiPolygon, n: int) -> None:
    if not 0 <= n <= MAX_DOTS:
        raise ParameterError(f"{n} dots cannot be drawn", "dots", f"give 0 to {MAX_DOTS:,}")
    check_area(area)


def _fitted(
    wanted: float, spacing: float, place: Callable[[float], NDArray[np.float64]]
) -> NDArray[np.float64]:
    """Change the spacing until `place(spacing)` gives nearly the wanted number; the best try."""
    best = place(spacing)
    points = best
    for _ in range(8):
        if abs(len(points) - wanted) <= 0.002 * wanted:
            break
        spacing *= math.sqrt(max(len(points), 1) / wanted)
        points = place(spacing)
        if abs(len(points) - wanted) < abs(len(best) - wanted):
            best = points
    return best


def _hexagons(width: float, height: float, spacing: float) -> NDArray[np.float64]:
    pitch = spacing * math.sqrt(0.75)
    y = np.arange(pitch / 2, height, pitch)
    x = np.arange(spacing / 4, width, spacing)
    grid = np.empty((len(y), len(x), 2))
    grid[..., 0] = x
    grid[1::2, :, 0] += spacing / 2
    grid[..., 1] = y[:, None]
    flat = grid.reshape(-1, 2)
    return flat[flat[:, 0] < width]


def _on_ink(position: NDArray[np.float64], density: NDArray[np.float32]) -> NDArray[np.float64]:
    h, w = density.shape
    x = np.minimum(position[:, 0].astype(np.intp), w - 1)
    y = np.minimum(position[:, 1].astype(np.intp), h - 1)
    kept: NDArray[np.float64] = position[density[y, x] > 0]
    return kept
