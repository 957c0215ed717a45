"""First dots: halftones of a density field, and starts without a picture.

Deussen et al. 2000, section 4.2. A density field holds dots per square pixel; the number of dots
is its integral. Positions are in pixels, x right, y down, pixel (0, 0) spans 0..1.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.kernels.pulse_density import diffuse, grow

GROWTHS = ("circular", "triangular")
"""Orders in which a region takes cells (Eschbach 1990)."""

CELLS_PER_DOT = 14.0
"""Super-sampling aims at this many cells in the smallest region."""

_REACH = 200  # cells; the farthest a region looks for its charge
_SEEDS_AT_ONCE = 400_000


@dataclass(frozen=True, slots=True, eq=False)
class FirstDots:
    """Dots and the size of the region each stands for.

    Attributes
    ----------
    position_px : (n, 2) float64
    region_px : (n,) float32
        Area of each dot's region, in square pixels.
    """

    position_px: NDArray[np.float64]
    region_px: NDArray[np.float32]


def pulse_density(
    density: NDArray[np.float32], growth: str = "circular"
) -> Iterator[tuple[float, FirstDots]]:
    """Grow regions that hold one pulse each; yield the share done and all dots so far.

    Parameters
    ----------
    density : (h, w) float32, dots per square pixel
    growth : {"circular", "triangular"}
        Order in which a region takes cells.
    """
    s = supersampling(density)
    charge = np.repeat(np.repeat(density * np.float32(1.0 / s**2), s, 0), s, 1)
    n_max = math.ceil(float(density.sum(dtype=np.float64)) * 1.0001) + 16
    points = np.empty((n_max, 2))
    areas = np.empty(n_max, np.float32)
    dy, dx = growth_order(growth, _reach(charge))
    cursor = np.zeros(3)
    order = np.empty(0, np.int32)
    for stop in _stops(charge.size):
        n = grow(charge, order, cursor, stop, dy, dx, 1.0, points, areas, n_max)
        yield stop / charge.size, FirstDots(points[:n] / s, areas[:n] / np.float32(s * s))


def supersampling(density: NDArray[np.float32]) -> int:
    """Return how many cells a side of a pixel needs, for sub-pixel centres in the densest part."""
    densest = float(density.max(initial=0.0))
    return max(1, math.ceil(math.sqrt(CELLS_PER_DOT * densest)))


@lru_cache(maxsize=8)
def growth_order(growth: str, reach: int) -> tuple[NDArray[np.int16], NDArray[np.int16]]:
    """Return row and column offsets from a seed, in the order in which its region grows.

    Everything above the seed, and to its left, is used already.
    """
    if growth not in GROWTHS:
        raise ParameterError(f"{growth!r} is no growth order", "growth", f"one of {GROWTHS}")
    y, x = np.mgrid[0 : reach + 1, -reach : reach + 1]
    ahead = (y > 0) | (x >= 0)
    y, x = y[ahead], x[ahead]
    measure = x * x + y * y if growth == "circular" else (np.abs(x) + y) ** 2
    inside = measure <= reach * reach
    y, x, measure = y[inside], x[inside], measure[inside]
    best = np.lexsort((x, y, measure))
    return y[best].astype(np.int16), x[best].astype(np.int16)


def _reach(charge: NDArray[np.float32]) -> int:
    """Return how far the faintest regions have to look, in cells, within bounds."""
    asked = charge[charge > 0]
    if not asked.size:
        return 1
    faint = max(float(asked.min()), 1e-9)
    need = 2.0 * math.sqrt(2.0 / (math.pi * faint))
    return int(min(max(16, 2 ** math.ceil(math.log2(need))), _REACH))


def _stops(n: int) -> Iterator[int]:
    yield from range(_SEEDS_AT_ONCE, n, _SEEDS_AT_ONCE)
    yield n


def floyd_steinberg(density: NDArray[np.float32]) -> FirstDots:
    """Diffuse the error over cells of which the densest part would set every one.

    Floyd and Steinberg 1976, serpentine: what the paper tried first, kept as a baseline.
    """
    h, w = density.shape
    densest = float(density.max(initial=0.0))
    if densest <= 0.0:
        return FirstDots(np.empty((0, 2)), np.empty(0, np.float32))
    zoom = max(math.sqrt(2.0 * densest), 1e-3)
    rows, columns = max(1, round(h * zoom)), max(1, round(w * zoom))
    y = np.minimum((np.arange(rows) + 0.5) * (h / rows), h - 1).astype(np.intp)
    x = np.minimum((np.arange(columns) + 0.5) * (w / columns), w - 1).astype(np.intp)
    charge = density[np.ix_(y, x)].astype(np.float64) * (h / rows) * (w / columns)
    total = charge.sum()
    if total > 0:
        charge *= density.sum(dtype=np.float64) / total
    points = np.empty((charge.size, 2))
    n = diffuse(charge, points)
    position = points[:n] * (w / columns, h / rows)
    return FirstDots(*_on_ink(position, density))


def random_dots(density: NDArray[np.float32], seed: int) -> FirstDots:
    """Draw independent dots with probability in proportion to the density."""
    rng = np.random.default_rng(seed)
    mass = density.sum(axis=1, dtype=np.float64)
    n = round(float(mass.sum()))
    if n == 0:
        return FirstDots(np.empty((0, 2)), np.empty(0, np.float32))
    w = density.shape[1]
    sums = np.cumsum(density, axis=None, dtype=np.float64)
    which = np.searchsorted(sums, rng.random(n) * sums[-1], side="right")
    which = np.minimum(which, np.flatnonzero(density.ravel())[-1])
    position = np.column_stack((which % w, which // w)) + rng.random((n, 2))
    return FirstDots(position, _regions(position, density))


def _on_ink(
    position: NDArray[np.float64], density: NDArray[np.float32]
) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    h, w = density.shape
    x = np.minimum(position[:, 0].astype(np.intp), w - 1)
    y = np.minimum(position[:, 1].astype(np.intp), h - 1)
    keep = position[density[y, x] > 0]
    return keep, _regions(keep, density)


def _regions(position: NDArray[np.float64], density: NDArray[np.float32]) -> NDArray[np.float32]:
    h, w = density.shape
    x = np.minimum(position[:, 0].astype(np.intp), w - 1)
    y = np.minimum(position[:, 1].astype(np.intp), h - 1)
    region: NDArray[np.float32] = 1.0 / np.maximum(density[y, x], np.float32(1e-12))
    return region


def hexagonal(density: NDArray[np.float32]) -> FirstDots:
    """Lay a regular hexagonal grid over all that is not white, as many dots as the density asks."""
    wanted = float(density.sum(dtype=np.float64))
    inked = int(np.count_nonzero(density))
    if inked == 0 or wanted < 0.5:
        return FirstDots(np.empty((0, 2)), np.empty(0, np.float32))
    spacing = math.sqrt(2.0 / math.sqrt(3.0) * inked / wanted)
    first = FirstDots(np.empty((0, 2)), np.empty(0, np.float32))
    for _ in range(4):
        grid = _hexagons(density.shape, spacing)
        first = FirstDots(*_on_ink(grid, density))
        n = len(first.position_px)
        if abs(n - wanted) <= 0.005 * wanted:
            break
        spacing *= math.sqrt(max(n, 1) / wanted)
    return first


def _hexagons(shape: tuple[int, ...], spacing: float) -> NDArray[np.float64]:
    h, w = shape
    pitch = spacing * math.sqrt(0.75)
    y = np.arange(pitch / 2, h, pitch)
    x = np.arange(spacing / 4, w, spacing)
    grid = np.empty((len(y), len(x), 2))
    grid[..., 0] = x
    grid[1::2, :, 0] += spacing / 2
    grid[..., 1] = y[:, None]
    flat = grid.reshape(-1, 2)
    return flat[flat[:, 0] < w]
