"""Cells that reach far: dots looked for row by row, and only where they can still cut.

A dot takes a corner from a cell only if it is nearer to it than the cell's own dot, so only the
circles about the corners, through the dot, have to be searched. Beside white paper a cell is long
and leans away from its neighbours; of the disc around it that holds all those circles they fill
little, and what they leave out is where the dots are.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.kernels.cells.grid import column_of
from stippler.kernels.cells.tables import Dots, Grid, Spot
from stippler.kernels.cells.tree_search import APART, cut_lanes_by_span
from stippler.kernels.cells.voronoi import OVERFLOW
from stippler.kernels.machine.jit import ZERO, inline, inner
from stippler.kernels.machine.simd import get, reach2_of

SWEEP_FROM = 4
"""Ring from which rows take the place of rings."""

_MANY = 1024
"""Dots of the rows seen after which corners far off are looked at first."""

_MOST_LOOKS = 48


@inline
def _columns_that_cut(
    U: Any, V: Any, m: int, below: float, above: float, slack: float
) -> tuple[float, float]:
    """Return from where to where, in x from the dot, dots at y in below..above can cut."""
    low, high = math.inf, -math.inf
    for k in range(m):
        u, v = get(U, k), get(V, k)
        dy = max(max(below - v, v - above), 0.0)
        half2 = (u * u + v * v) * (1.0 + 1e-9) - dy * dy
        if half2 > 0.0:
            half = math.sqrt(half2) + slack
            low, high = min(low, u - half), max(high, u + half)
    return low, high


@inner
def cut_far_corners(U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, spot: Spot) -> int:
    """Cut a dot's cell by the dots around its far corners; return its corners, or `OVERFLOW`.

    Where very many dots lie all but on the circle about a corner, rows would bring each of them
    before the one that takes the corner away. By a dot that is not near the dot's own place may be
    cut twice: a corner on its bisector is not rounded across it then.
    """
    inverse, k, looks = 1.0 / spot.h, ZERO, ZERO
    reach2, far2 = reach2_of(U, V, m), 36.0 * spot.h * spot.h
    while k < m and looks < _MOST_LOOKS:
        u, v = get(U, k), get(V, k)
        k += 1
        if u * u + v * v < max(far2, reach2 / 256.0):
            continue
        looks += 1
        column = column_of(spot.x + u, spot.gx, inverse, spot.nx)
        row = column_of(spot.y + v, spot.gy, inverse, spot.ny)
        p, q = max(column - 1, 0), min(column + 1, spot.nx - 1)
        before = m
        for near in range(max(row - 1, 0), min(row + 2, spot.ny)):
            m = cut_lanes_by_span(
                U, V, N, m, dots, grid, spot, near, p, q, APART, 4.0 * reach2, ZERO - 1
            )  # fmt: skip
            if m == OVERFLOW:
                return m
        if m != before or get(U, k - 1) != u or get(V, k - 1) != v:
            k, reach2 = ZERO, reach2_of(U, V, m)
    return m


@inner
def sweep_rows(U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, spot: Spot) -> int:
    """Cut a dot's cell by all dots from ring `SWEEP_FROM` on.

    Returns the cell's corners, or `OVERFLOW`.
    """
    h, slack, nx = spot.h, grid.slack, spot.nx
    n_seen = ZERO
    for k in range(2 * spot.ny + 1):
        away = (k + 1) >> 1
        row = spot.iy + away if k & 1 else spot.iy - away
        limit = 4.0 * reach2_of(U, V, m) * (1.0 + 1e-9)
        least = max((away - 1) * h - slack, 0.0)
        if least * least > limit:
            break
        if row < 0 or row >= spot.ny:
            continue
        top = spot.gy + row * h - spot.y
        low, high = _columns_that_cut(U, V, m, top - slack, top + h + slack, slack)
        if low > high:
            continue
        first = max(math.floor((spot.x + low - spot.gx) / h), 0)
        last = min(math.floor((spot.x + high - spot.gx) / h), nx - 1)
        # what the rings have seen is not cut by again: a corner on a bisector may round across it
        is_seen = away < SWEEP_FROM
        for side in range(2 if is_seen else 1):
            p, q = first, last
            if is_seen and side == 0:
                q = min(last, spot.ix - SWEEP_FROM)
            elif is_seen:
                p = max(first, spot.ix + SWEEP_FROM)
            if p <= q and m != OVERFLOW:
                a = spot.first_cell + row * nx
                n_seen += grid.cell_start[a + q + 1] - grid.cell_start[a + p]
                m = cut_lanes_by_span(
                    U, V, N, m, dots, grid, spot, row, p, q, APART, limit, ZERO - 1
                )
        if n_seen > _MANY and m != OVERFLOW:
            n_seen = ZERO - (ZERO + (1 << 62))
            m = cut_far_corners(U, V, N, m, dots, grid, spot)
        if m == OVERFLOW:
            break
    return m
