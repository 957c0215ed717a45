"""Cells of very many corners, cut by all dots of a ring of grid cells at once.

Cutting by one dot after another takes n passes over n corners. Here the dots of a ring are sorted
by direction and met with the sides there are, which are in that order already: one pass, in which
each line takes away those before it whose corners it leaves outside.
"""

from __future__ import annotations

import math

from stippler.kernels.cells.grid import ring_span
from stippler.kernels.cells.tables import F8, Dots, Grid, Pads, Spot
from stippler.kernels.cells.voronoi import OVERFLOW, TOLERANCE, reach2_of_cell
from stippler.kernels.machine.jit import ZERO, inline, inner

MANY = 64
"""Room for corners from which on a cell is cut by rings at once."""

_PARALLEL = 1e-15
"""Sine of the angle below which two sides are one."""

_KEY, _A, _B, _C, _NUMBER = 0, 1, 2, 3, 4  # rows of lines not yet met, in ``pads.cell2``


@inline
def _direction(a: float, b: float) -> float:
    """Return a number from 0 to 4 that grows with the angle of (a, b), counted from -y."""
    total = abs(a) + abs(b)
    return 1.0 + b / total if a >= 0.0 else 3.0 - b / total


@inline
def _swap(line: F8, i: int, k: int) -> None:
    for r in range(5):
        line[r, i], line[r, k] = line[r, k], line[r, i]


@inner
def _sort_by_direction(line: F8, n: int) -> None:
    """Sort the first n columns by their keys: a heap sort, n log n at worst."""
    for start in range(n // 2 - 1, -n, -1):
        end, i = n, start
        if start < 0:  # the heap is made: the greatest goes to the end
            end, i = n + start, ZERO
            _swap(line, 0, end)
        while 2 * i + 1 < end:
            k = 2 * i + 1
            if k + 1 < end and line[_KEY, k + 1] > line[_KEY, k]:
                k += 1
            if line[_KEY, k] <= line[_KEY, i]:
                break
            _swap(line, i, k)
            i = k


@inline
def _put_corner(side: F8, p: int, q: int) -> None:
    """Write where side q meets side p, which comes before it, as the first corner of q."""
    a, b, c = side[p, 2], side[p, 3], side[p, 4]
    da, db = side[q, 2] - a, side[q, 3] - b
    dc = side[q, 4] - c
    if side[p, 5] >= 0.0 and side[q, 5] >= 0.0:  # bisectors: without taking like squares apart
        dc = 0.5 * (da * (a + side[q, 2]) + db * (b + side[q, 3]))
    det = a * db - b * da
    side[q, 0], side[q, 1] = (c * db - b * dc) / det, (a * dc - c * da) / det


@inline
def _is_beyond(side: F8, k: int, line: int) -> bool:
    """Whether the first corner of side k lies on or beyond the line of another."""
    c = side[line, 4]
    off = side[line, 2] * side[k, 0] + side[line, 3] * side[k, 1] - c
    return bool(off >= -TOLERANCE * c)


@inline
def _is_same_way(side: F8, p: int, q: int) -> bool:
    a, b, da, db = side[p, 2], side[p, 3], side[q, 2], side[q, 3]
    length = math.sqrt((a * a + b * b) * (da * da + db * db))
    return bool(a * da + b * db > 0.0 and a * db - b * da <= _PARALLEL * length)


@inner
def _meet(side: F8, first: int, last: int) -> tuple[int, int]:
    """Take the line in row ``last + 1`` among sides ``first..last``; return which are left."""
    new, end = last + 1, last
    while end > first and _is_beyond(side, end, new):
        end -= 1
    while end > first and _is_beyond(side, first + 1, new):
        first += 1
    if end >= first and _is_same_way(side, end, new):
        is_nearer = side[new, 4] * math.hypot(side[end, 2], side[end, 3]) < side[end, 4] * (
            math.hypot(side[new, 2], side[new, 3])
        )
        if not (is_nearer and end == first):
            return first, end
        end -= 1
    for r in range(2, 6):
        side[end + 1, r] = side[new, r]
    if end >= first:
        _put_corner(side, end, end + 1)
    return first, end + 1


@inner
def _meet_all(pads: Pads, m: int, n: int) -> int:
    """Cut the cell of m corners by n lines; return its corners, or `OVERFLOW`."""
    cell, line, side = pads.cell, pads.cell2, pads.out
    _sort_by_direction(line, n)
    first, last = ZERO, ZERO - 1
    i = k = ZERO
    while i < m or k < n:
        new = last + 1
        if k == n or (i < m and _direction(cell[2, i], cell[3, i]) <= line[_KEY, k]):
            for r in range(2, 6):
                side[new, r] = cell[r, i]
            i += 1
        else:
            side[new, 2], side[new, 3] = line[_A, k], line[_B, k]
            side[new, 4], side[new, 5] = line[_C, k], line[_NUMBER, k]
            k += 1
        first, last = _meet(side, first, last)
    while last > first + 1 and _is_beyond(side, last, first):
        last -= 1
    while last > first + 1 and _is_beyond(side, first + 1, last):
        first += 1
    _put_corner(side, last, first)
    m = last - first + 1
    if m > cell.shape[1]:
        return OVERFLOW
    for k in range(m):
        for r in range(6):
            cell[r, k] = side[first + k, r]
    return int(m)


@inner
def cut_big_cell_by_ring(pads: Pads, m: int, dots: Dots, grid: Grid, spot: Spot, ring: int) -> int:
    """Cut the cell in ``pads.cell`` by the dots of a ring; return its corners, or `OVERFLOW`."""
    cell, line = pads.cell, pads.cell2
    reach2, n = reach2_of_cell(cell, m), ZERO
    for s in range(3 if ring == 1 else 4 * ring):
        row, first, last = ring_span(ring, s, spot)
        if last < first:
            continue
        start = spot.first_cell + row * spot.nx
        for j in range(grid.cell_start[start + first], grid.cell_start[start + last + 1]):
            a, b = dots.x[j] - spot.x, dots.y[j] - spot.y
            d2 = a * a + b * b
            if d2 >= 4.0 * reach2 or d2 == 0.0:
                continue
            line[_KEY, n], line[_A, n], line[_B, n] = _direction(a, b), a, b
            line[_C, n], line[_NUMBER, n] = 0.5 * d2, float(j)
            n += 1
            if n == cell.shape[1]:
                m = _meet_all(pads, m, n)
                if m == OVERFLOW:
                    return m
                reach2, n = reach2_of_cell(cell, m), ZERO
    return _meet_all(pads, m, n) if n > 0 else m
