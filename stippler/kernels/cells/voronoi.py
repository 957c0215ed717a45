"""Convex Voronoi cells, cut bisector by bisector out of the compartment's box.

Nearly all cells fit into vector lanes (see `simd`): pointers to corners U, V and to the numbers N
of the dots beyond each side, side k running from corner k to corner k + 1. Sides of the box have
the numbers `WALL` and below. A cell with more corners is cut in plain arrays, as follows.

A cell is kept relative to its dot: corners ``u[k], v[k]`` counter-clockwise (x right, y up), and
for the side from corner k to corner k + 1 the line ``a x + b y = c`` it lies on, dot inside, with
the number of the dot beyond (as in lanes). `Cell` rows: u, v, a, b, c, number, and
one row of scratch.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from stippler.kernels.cells.tables import F8, Spot
from stippler.kernels.machine.jit import ZERO, inline, inner
from stippler.kernels.machine.simd import (
    FRONT,
    LANES,
    SCAN,
    get,
    holds,
    lowest_bit,
    near_mask,
    out_mask,
    put,
    roll,
)

TOLERANCE = 1e-14
"""A corner that a bisector passes closer than this share of its distance is not cut."""

_MANY_CORNERS = 10
"""Corners from which on a cell loses no more of them for next to nothing."""

_NOTHING = 2e-18
"""Twice the area of next to nothing, of the square of a corner's distance."""

OVERFLOW = -1
"""Number of corners of a cell that has more than there is room for."""

FULL = LANES - 1
"""Corners of a cell in lanes that is left as it was, for one more side did not fit into them."""

WALL = -1
"""Sides of the box are numbered -1 (least y), -2 (most x), -3 (most y) and -4 (least x)."""


@inline
def start_lanes(U: Any, V: Any, N: Any, x0: float, y0: float, x1: float, y1: float) -> int:
    """Make the cell in lanes a box around the origin; return its number of corners."""
    for k in (0, 4, FRONT, FRONT + 4):
        put(U, k, x0)
        put(U, k + 1, x1)
        put(U, k + 2, x1)
        put(U, k + 3, x0)
        put(V, k, y0)
        put(V, k + 1, y0)
        put(V, k + 2, y1)
        put(V, k + 3, y1)
    for k in range(8):
        put(N, k, np.int32(WALL - (k & 3)))
    return int(ZERO + 4)


@inner
def _longest_out(U: Any, V: Any, m: int, a: float, b: float, mask: int) -> int:
    """Return the run of corners out around the one that is furthest out."""
    best = 0
    for k in range(1, m):
        if a * get(U, k) + b * get(V, k) > a * get(U, best) + b * get(V, best):
            best = k
    run = 1 << best
    for step in (1, m - 1):
        k = (best + step) % m
        while (mask >> k) & 1 and not (run >> k) & 1:
            run |= 1 << k
            k = (k + step) % m
    return run


@inline
def _cut_lanes(
    U: Any, V: Any, N: Any, m: int, a: float, b: float, c: float, number: int, mask: int
) -> int:
    """Cut away the corners in `mask`, those with ``a u + b v > c``; return the corners left.

    Positions count on from m around the end, which is what the second copy of the corners is for.
    """
    all_corners = (1 << m) - 1
    z = lowest_bit(~mask)
    turned = ((mask >> z) | (mask << (m - z))) & all_corners
    p = lowest_bit(turned)
    n_out = lowest_bit(~(turned >> p))
    if turned >> (p + n_out):  # rounding: corners that all but coincide fall to both sides
        mask = _longest_out(U, V, m, a, b, mask)
        z = lowest_bit(~mask)
        turned = ((mask >> z) | (mask << (m - z))) & all_corners
        p = lowest_bit(turned)
        n_out = lowest_bit(~(turned >> p))
    p += z  # first corner out
    q = p + n_out  # first corner in again
    s_p = a * get(U, p - 1) + b * get(V, p - 1) - c
    s_out = a * get(U, p) + b * get(V, p) - c
    t = s_p / (s_p - s_out)
    s_q = a * get(U, q) + b * get(V, q) - c
    s_out = a * get(U, q - 1) + b * get(V, q - 1) - c
    r = s_q / (s_q - s_out)
    kept = m - n_out
    last = get(N, q - 1)
    u, v = get(U, p - 1), get(V, p - 1)
    du, dv = get(U, q), get(V, q)
    roll(U, q, kept, u + t * (get(U, p) - u), du + r * (get(U, q - 1) - du))
    roll(V, q, kept, v + t * (get(V, p) - v), dv + r * (get(V, q - 1) - dv))
    roll(N, q, kept, np.int32(number), last)
    return int(kept + 2)


@inline
def cut_lanes_by_run(
    U: Any,
    V: Any,
    N: Any,
    m: int,
    xs: F8,
    ys: F8,
    x: float,
    y: float,
    first: int,
    end: int,
    least: float,
    limit: float,
    is_rough: bool = False,
) -> int:
    """Cut the cell of (x, y) by the dots first..end; return its corners, or `OVERFLOW`.

    Only dots with ``least <= distance² < limit`` count; of a rough cell, which some of them may
    have cut before, not those beyond its sides: a corner on a bisector may round across it.
    """
    j = first
    while j < end:
        near = near_mask(xs, ys, j, x, y, least, limit)
        if end - j < SCAN:
            near &= (1 << (end - j)) - 1
        while near != 0:
            k = j + lowest_bit(near)
            near &= near - 1
            a, b = xs[k] - x, ys[k] - y
            c = 0.5 * (a * a + b * b)
            mask = out_mask(U, V, a, b, c * (1.0 + TOLERANCE)) & ((1 << m) - 1)
            if mask != 0 and not (is_rough and holds(N, m, k)):
                if m >= FULL:
                    return OVERFLOW
                m = _cut_lanes(U, V, N, m, a, b, c, k, mask)
        j += SCAN
    return m


@inline
def start_cell(cell: F8, x0: float, y0: float, x1: float, y1: float) -> int:
    """Make the cell a box around the origin; return its number of corners."""
    cell[0, 0], cell[1, 0] = x0, y0
    cell[0, 1], cell[1, 1] = x1, y0
    cell[0, 2], cell[1, 2] = x1, y1
    cell[0, 3], cell[1, 3] = x0, y1
    cell[2, 0], cell[3, 0], cell[4, 0] = 0.0, -1.0, -y0
    cell[2, 1], cell[3, 1], cell[4, 1] = 1.0, 0.0, x1
    cell[2, 2], cell[3, 2], cell[4, 2] = 0.0, 1.0, y1
    cell[2, 3], cell[3, 3], cell[4, 3] = -1.0, 0.0, -x0
    for k in range(4):
        cell[5, k] = WALL - k
    return int(ZERO + 4)


@inline
def unpack_lanes(
    U: Any,
    V: Any,
    N: Any,
    m: int,
    xs: F8,
    ys: F8,
    spot: Spot,
    cell: F8,
) -> None:
    """Copy a cell from lanes into a plain array, with the lines its sides lie on."""
    for k in range(m):
        cell[0, k], cell[1, k] = get(U, k), get(V, k)
        j = get(N, k)
        cell[5, k] = j
        if j == -1:
            cell[2, k], cell[3, k], cell[4, k] = 0.0, -1.0, -spot.y0
        elif j == -2:
            cell[2, k], cell[3, k], cell[4, k] = 1.0, 0.0, spot.x1
        elif j == -3:
            cell[2, k], cell[3, k], cell[4, k] = 0.0, 1.0, spot.y1
        elif j == -4:
            cell[2, k], cell[3, k], cell[4, k] = -1.0, 0.0, -spot.x0
        else:
            a, b = xs[j] - spot.x, ys[j] - spot.y
            cell[2, k], cell[3, k], cell[4, k] = a, b, 0.5 * (a * a + b * b)


@inner
def cut_cell(cell: F8, m: int, a: float, b: float, c: float, number: float) -> int:
    """Cut away the part with ``a x + b y > c``; return the corners left, `OVERFLOW` if too many.

    Of a cell of many corners next to nothing is not cut away: where many dots lie on a circle,
    cells end in a point at its middle, in which each bisector takes a corner or not as rounded.

    The corners beyond the line are consecutive; the first and last crossed sides are shortened
    and the cut becomes a new side.
    """
    limit = c * (1.0 + TOLERANCE)
    most = 0
    for k in range(m):
        cell[6, k] = a * cell[0, k] + b * cell[1, k] - c
        if cell[6, k] > cell[6, most]:
            most = k
    eps = limit - c
    if cell[6, most] <= eps:
        return m
    first = last = most  # the run of corners out around the one that is furthest out
    n_out = 1
    while n_out < m:
        k = first - 1 if first > 0 else m - 1
        if cell[6, k] <= eps:
            break
        first = k
        n_out += 1
    while n_out < m:
        k = last + 1 if last + 1 < m else 0
        if cell[6, k] <= eps:
            break
        last = k
        n_out += 1
    if n_out == m:
        return m  # only rounding can put the dot itself beyond its own bisector
    p = first - 1 if first > 0 else m - 1
    q = last + 1 if last + 1 < m else 0
    before, after = min(cell[6, p], 0.0), min(cell[6, q], 0.0)
    t = before / (before - cell[6, first])
    au = cell[0, p] + t * (cell[0, first] - cell[0, p])
    av = cell[1, p] + t * (cell[1, first] - cell[1, p])
    t = after / (after - cell[6, last])
    bu = cell[0, q] + t * (cell[0, last] - cell[0, q])
    bv = cell[1, q] + t * (cell[1, last] - cell[1, q])
    if n_out == 1 and m >= _MANY_CORNERS:
        u, v = cell[0, first], cell[1, first]
        if abs((au - u) * (bv - v) - (av - v) * (bu - u)) <= _NOTHING * (u * u + v * v):
            return m
    if m - n_out + 2 > cell.shape[1]:
        return OVERFLOW
    if first <= last and n_out >= 2:  # room for both new corners in place
        cell[0, first], cell[1, first] = au, av
        _set_line(cell, first, a, b, c, number)
        cell[0, first + 1], cell[1, first + 1] = bu, bv
        _copy_line(cell, last, first + 1)
        gap = n_out - 2
        if gap:
            for k in range(last + 1, m):
                _copy_corner(cell, k, k - gap)
        return m - gap
    if first <= last:  # one corner out: shift the rest up by one
        for k in range(m - 1, first, -1):
            _copy_corner(cell, k, k + 1)
        _copy_line(cell, first, first + 1)
        cell[0, first], cell[1, first] = au, av
        _set_line(cell, first, a, b, c, number)
        cell[0, first + 1], cell[1, first + 1] = bu, bv
        return m + 1
    # the run wraps around the end: corners last + 1 .. first - 1 stay
    new_b_a, new_b_b, new_b_c, new_b_n = cell[2, last], cell[3, last], cell[4, last], cell[5, last]
    kept = first - last - 1
    for k in range(kept):
        _copy_corner(cell, last + 1 + k, k)
    cell[0, kept], cell[1, kept] = au, av
    _set_line(cell, kept, a, b, c, number)
    cell[0, kept + 1], cell[1, kept + 1] = bu, bv
    _set_line(cell, kept + 1, new_b_a, new_b_b, new_b_c, new_b_n)
    return kept + 2


@inline
def _set_line(cell: F8, k: int, a: float, b: float, c: float, number: float) -> None:
    cell[2, k], cell[3, k], cell[4, k], cell[5, k] = a, b, c, number


@inline
def _copy_line(cell: F8, source: int, target: int) -> None:
    for r in range(2, 6):
        cell[r, target] = cell[r, source]


@inline
def _copy_corner(cell: F8, source: int, target: int) -> None:
    for r in range(6):
        cell[r, target] = cell[r, source]


@inner
def reach2_of_cell(cell: F8, m: int) -> float:
    """Return the square of the largest distance of a corner from the dot."""
    best = 0.0
    for k in range(m):
        best = max(best, cell[0, k] * cell[0, k] + cell[1, k] * cell[1, k])
    return best
