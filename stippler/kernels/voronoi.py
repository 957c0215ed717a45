"""Convex Voronoi cells, cut bisector by bisector out of the compartment's box.

A cell is kept relative to its dot: corners ``u[k], v[k]`` counter-clockwise (x right, y up), and
for the side from corner k to corner k + 1 the line ``a x + b y = c`` it lies on, dot inside, with
the number of the dot beyond (-1 for a side of the box). `Cell` rows: u, v, a, b, c, number, and
one row of scratch.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.jit import inline, kernel

F8 = NDArray[np.float64]
I4 = NDArray[np.int32]

TOLERANCE = 1e-14
"""A corner that a bisector passes closer than this share of its distance is not cut."""

OVERFLOW = -1


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
        cell[5, k] = -1.0
    return 4


@kernel
def cut_cell(cell: F8, m: int, a: float, b: float, c: float, number: float) -> int:
    """Cut away the part with ``a x + b y > c``; return the corners left, `OVERFLOW` if too many.

    The corners beyond the line are consecutive; the first and last crossed sides are shortened
    and the cut becomes a new side.
    """
    limit = c * (1.0 + TOLERANCE)
    n_out = 0
    for k in range(m):
        s = a * cell[0, k] + b * cell[1, k]
        cell[6, k] = s - c
        if s > limit:
            n_out += 1
    if n_out == 0:
        return m
    eps = limit - c
    first = 0  # the first corner out after one that is in
    if cell[6, 0] > eps:
        first = m - 1
        while first > 0 and cell[6, first] > eps:
            first -= 1
        first = first + 1 if cell[6, first] <= eps else 0
        if first == m:
            first = 0
    else:
        while cell[6, first] <= eps:
            first += 1
    last = first  # the last corner out
    n_out = 1
    while n_out < m:
        k = last + 1 if last + 1 < m else 0
        if cell[6, k] <= eps:
            break
        last = k
        n_out += 1
    if n_out == m:
        return m  # only rounding can put the dot itself beyond its own bisector
    if m - n_out + 2 > cell.shape[1]:
        return OVERFLOW
    p = first - 1 if first > 0 else m - 1
    q = last + 1 if last + 1 < m else 0
    t = cell[6, p] / (cell[6, p] - cell[6, first])
    au = cell[0, p] + t * (cell[0, first] - cell[0, p])
    av = cell[1, p] + t * (cell[1, first] - cell[1, p])
    t = cell[6, q] / (cell[6, q] - cell[6, last])
    bu = cell[0, q] + t * (cell[0, last] - cell[0, q])
    bv = cell[1, q] + t * (cell[1, last] - cell[1, q])
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


@kernel
def reach2_of_cell(cell: F8, m: int) -> float:
    """Return the square of the largest distance of a corner from the dot."""
    best = 0.0
    for k in range(m):
        best = max(best, cell[0, k] * cell[0, k] + cell[1, k] * cell[1, k])
    return best
