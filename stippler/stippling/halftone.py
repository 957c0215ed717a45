"""First dots by pulse-density modulation: regions that hold one pulse each.

Deussen et al. 2000, section 4.2; Eschbach 1990. A density field holds dots per square pixel; the
number of dots is its integral. Positions are in pixels, x right, y down, pixel (0, 0) spans 0..1.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.style import GROWTHS, STARTS
from stippler.errors import ParameterError
from stippler.kernels.halftone.grow_regions import fill_cells, grow
from stippler.kernels.halftone.scan_order import (
    FRONT_STEP,
    along_front,
    chamfer,
    order_by_distance,
)
from stippler.kernels.machine.pool import begun, parallel_for
from stippler.stippling.tone import DotRule

CELLS_PER_DOT = 14.0
"""Super-sampling aims at this many cells in the smallest region."""

ENLARGED, REDUCED, DROPPED = 0.75, 0.25, 0.02
"""Darkness at which the paper's thresholds for the size of a region lie."""

_REACH = 200  # cells; the farthest a region looks for its charge
_SEEDS_AT_ONCE = 250_000
_FEWEST_AT_ONCE, _MOST_AT_ONCE = 200_000, 1_000_000  # cells across levels that are listed together
_LISTS = 64  # of seeds, where these bounds allow
_ROWS_A_LEVEL = 3  # that the front passes over at most where it falls back
_SPARE, _SPARE_EACH = 0.01, 5e-7  # of a dot: what rounding may take without a dot being lost
_MANY_CELLS = 50_000_000
_VARIANTS = 8
_SKEW = {"circular": 0.7, "triangular": 0.15}
_SLOPE = {"circular": 0.8, "triangular": 0.2}  # of the undulating front
_WAVES, _WAVELENGTH, _TURN = 4, 24.0, 0.25  # lengths in dot spacings


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
    density: NDArray[np.float32],
    growth: str = "circular",
    *,
    start: str = "top",
    seed: int = 1,
    origin_px: float = 0.0,
) -> Iterator[tuple[float, FirstDots]]:
    """Grow regions that hold one pulse each; yield the share done and all dots so far.

    Parameters
    ----------
    density : (h, w) float32, dots per square pixel
    growth : {"circular", "triangular"}
        Order in which a region takes cells.
    start : {"top", "border"}
        "border" begins along the border of what has to be filled and works inwards, so that the
        outermost dots line up with it.
    seed : int
        Each region's growth is skewed a little, and the front from the top undulates, as if by
        chance, so that constant density shows no direction; this is the chance.
    origin_px : float
        Where in the field, to the right and down, positions are counted from.

    Notes
    -----
    As many dots as the density adds up to, rounded. 4 bytes for each super-sampled cell, 10 with
    "border". Regions line up with the front that they grow from. From the top it is no row of
    cells but undulates, so that they line up in every direction somewhere.
    """
    if start not in STARTS:
        raise ParameterError(f"{start!r} is no start", "start", f"one of {', '.join(STARTS)}")
    s = supersampling(density)
    corner, density = _window(density, s)
    asked = float(density.sum(dtype=np.float64))
    charge = np.empty((density.shape[0] * s, density.shape[1] * s), np.float32)
    parallel_for(fill_cells, len(density), density, s, whole_dots(asked), charge, grain=64)
    reach = _reach(density, s)
    spacing = s * _spacing(density)
    most, n = _most_dots(asked), 0
    position, region = np.empty((most, 2)), np.empty(most, np.float32)
    for share, first in grown(charge, asked, growth, start, seed, reach, spacing):
        before, n = n, len(first.position_px)
        position[before:n] = first.position_px[before:] / s + corner - origin_px
        region[before:n] = first.region_px[before:] / np.float32(s * s)
        yield share, FirstDots(position[:n], region[:n])


def whole_dots(asked: float) -> float:
    """Return by what a charge is multiplied so that a whole number of dots comes of it."""
    return (round(asked) + _SPARE) / asked + _SPARE_EACH if asked >= 0.5 else 1.0


def _most_dots(asked: float) -> int:
    return math.ceil(asked * 1.0001) + 16


def grown(
    charge: NDArray[np.float32], asked: float, growth: str, start: str, seed: int, reach: int,
    spacing: float,
) -> Iterator[tuple[float, FirstDots]]:  # fmt: skip
    """Grow regions over cells whose charge, used up in place, holds about `asked` dots.

    `reach`: how far a region looks; `spacing`: of the dots; both in cells, as what is yielded.
    """
    n_max = _most_dots(asked)
    points, areas = np.empty((n_max, 2)), np.empty(n_max, np.float32)
    dy, dx = growth_orders(growth, reach)
    cursor = np.zeros(2)
    if start == "border":
        seeds = _border_first(charge)
    else:
        seeds = _front(charge, spacing, _SLOPE[growth], seed)
    for share, order in seeds:
        n = grow(charge, order, cursor, dy, dx, seed, points, areas, n_max)
        yield share, FirstDots(points[:n], areas[:n])


def _window(
    density: NDArray[np.float32], s: int
) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Cut off what is white all around where there are many cells; return the corner and the rest.

    A few black pixels on a white page ask for very fine cells, of which it takes few.
    """
    corner = np.zeros(2)
    if density.size * s * s > _MANY_CELLS:
        rows, columns = ink_box(density)
        corner = np.array([columns.start, rows.start], np.float64)
        density = np.ascontiguousarray(density[rows, columns])
    return corner, density


def ink_box(field: NDArray[np.float32]) -> tuple[slice, slice]:
    """Return the rows and columns of the box around all that is not white; all, if all is."""
    y, x = np.flatnonzero(field.any(axis=1)), np.flatnonzero(field.any(axis=0))
    if not len(y):
        return slice(0, field.shape[0]), slice(0, field.shape[1])
    return slice(int(y[0]), int(y[-1]) + 1), slice(int(x[0]), int(x[-1]) + 1)


def sizes_by_region(
    region_px: NDArray[np.float32], rule: DotRule
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Size dots of one pulse as the paper does: by how far their regions had to grow.

    Parameters
    ----------
    region_px : (n,) float32
        Area of each dot's region.
    rule : DotRule
        Even, in pixels: the radius of an ordinary dot, and the range that none leaves.

    Returns
    -------
    radius_px : (n,) float64
    keep : (n,) bool

    Notes
    -----
    Dots with a region below that of the darkness `ENLARGED` are enlarged, above that of
    `REDUCED` reduced, above that of `DROPPED` dropped; the region stays used.
    """
    levels = np.array([ENLARGED, REDUCED, DROPPED])
    small, large, omit = 1.0 / np.maximum(rule.density(levels), 1e-300)
    radius = float(rule.radius(levels)[0])
    region = np.asarray(region_px, np.float64)
    scale = np.sqrt(np.where(region < small, small, np.where(region > large, large, region)))
    scale = np.where((region < small) | (region > large), scale / np.sqrt(region), 1.0)
    return np.clip(radius * scale, rule.radius_min, rule.radius_max), region <= omit


def supersampling(density: NDArray[np.float32]) -> int:
    """Return how many cells a side of a pixel needs, for sub-pixel centres in the densest part."""
    densest = float(density.max(initial=0.0))
    return max(1, math.ceil(math.sqrt(CELLS_PER_DOT * densest)))


@lru_cache(maxsize=8)
def growth_orders(growth: str, reach: int) -> tuple[NDArray[np.int16], NDArray[np.int16]]:
    """Return row and column offsets from a seed, in the order in which its region grows.

    Several variants, skewed a little to either side, one a row.
    """
    if growth not in GROWTHS:
        raise ParameterError(
            f"{growth!r} is no growth order", "growth", f"one of {', '.join(GROWTHS)}"
        )
    y, x = (side.ravel() for side in np.mgrid[-reach : reach + 1, -reach : reach + 1])
    rows: list[tuple[NDArray[np.int16], NDArray[np.int16]]] = []
    for skew in np.linspace(-_SKEW[growth], _SKEW[growth], _VARIANTS):
        if growth == "circular":
            measure = x * x + y * y + skew * x * y
        else:
            measure = (np.abs(x) + np.abs(y) + skew * x) ** 2
        best = np.lexsort((x, y, measure))
        best = best[measure[best] <= (1.0 - _SKEW[growth] / 2) * reach * reach]
        rows.append((y[best].astype(np.int16), x[best].astype(np.int16)))
    length = min(len(row) for row, _ in rows)
    dy = np.stack([row[:length] for row, _ in rows])
    return dy, np.stack([column[:length] for _, column in rows])


def _reach(density: NDArray[np.float32], s: int) -> int:
    asked = density[density > 0]
    return reach_for(float(asked.min()) / s**2) if asked.size else 1


def reach_for(faintest: float) -> int:
    """Return how far regions have to look, in cells, where the least charge is this; bounded."""
    faint = max(faintest, 1e-9)
    need = 2.0 * math.sqrt(2.0 / (math.pi * faint))
    return int(min(max(16, 2 ** math.ceil(math.log2(need))), _REACH))


_Seeds = Iterator[tuple[float, NDArray[np.int32]]]
"""The next seeds, and the share of all that is done with them."""


def _front(charge: NDArray[np.float32], spacing: float, slope: float, seed: int) -> _Seeds:
    """Yield the cells that hold charge as an undulating front passes over them from the top.

    The next ones are listed in another thread while regions grow from those before. So some are
    listed that are used up by then, which growing passes over: the dots are the same.
    """
    h, w = charge.shape
    lag = _undulation(h, w, spacing, slope, seed)
    height = math.ceil(float(np.abs(lag).max())) + 1
    levels = 1 + min(max(charge.size // _LISTS, _FEWEST_AT_ONCE), _MOST_AT_ONCE) // w
    room = min(_ROWS_A_LEVEL * levels * w, charge.size) + 1
    next_row, due = np.zeros(w, np.int32), lag[0].copy()
    at = np.array((-height, 0), np.int64)
    last = h + height

    def listed(order: NDArray[np.int32]) -> tuple[float, NDArray[np.int32]]:
        stop = min(int(at[0]) + levels, last)
        n = along_front(charge, lag, next_row, due, at, stop, order)
        return (int(at[0]) + height) / (last + height), order[:n]

    lists = itertools.cycle((np.empty(room, np.int32), np.empty(room, np.int32)))
    seeds = listed(next(lists))
    while at[0] < last:
        coming = begun(listed, next(lists))
        try:
            yield seeds
        finally:
            seeds = coming()
    yield seeds


def _spacing(density: NDArray[np.float32]) -> float:
    """Return the mean spacing of dots where there are any, in pixels."""
    asked = float(density.sum(dtype=np.float64)) / max(int(np.count_nonzero(density)), 1)
    return 1.0 / math.sqrt(max(asked, 1e-12))


def _undulation(h: int, w: int, spacing: float, slope: float, seed: int) -> NDArray[np.float32]:
    """Return how many cells a front lags behind, by waves along it that turn a little."""
    rng = np.random.default_rng(seed)
    x, y = np.arange(w), np.arange(h // FRONT_STEP + 2)[:, None] * FRONT_STEP
    lag = np.zeros((len(y), w), np.float32)
    for _ in range(_WAVES):
        q = 2.0 * math.pi / (_WAVELENGTH * spacing * rng.uniform(0.7, 1.4))
        turn, phase = rng.uniform(-_TURN, _TURN), rng.uniform(0.0, 2.0 * math.pi)
        high = min(slope / q * math.sqrt(2.0 / _WAVES), float(h))
        across, down = q * math.cos(turn) * x + phase, q * math.sin(turn) * y
        lag += (high * np.cos(across)).astype(np.float32) * np.cos(down).astype(np.float32)
        lag -= (high * np.sin(across)).astype(np.float32) * np.sin(down).astype(np.float32)
    return lag


def _border_first(charge: NDArray[np.float32]) -> _Seeds:
    """Yield the cells that hold charge, the nearest to the border first."""
    distance = np.empty(charge.shape, np.uint16)
    chamfer(charge, distance)
    order = np.empty(int(np.count_nonzero(charge)), np.int32)
    order_by_distance(distance, order)
    for begin in range(0, len(order), _SEEDS_AT_ONCE):
        seeds = order[begin : begin + _SEEDS_AT_ONCE]
        yield (begin + len(seeds)) / len(order), seeds
    if not len(order):
        yield 1.0, order
