"""Ink within Voronoi cells: how large a dot has to be to lay down what its cell asks for.

A point of the page that any disc covers is covered by the disc of the nearest dot, as long as
neighbours have about the same size. So the union of all discs is the sum, over the cells, of
disc ∩ cell; overlaps are counted once and each dot can be solved by itself, exactly.

Dots are sorted by the cells of a uniform grid. Lengths in pixels of the darkness field.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel

Array = NDArray[Any]

MAX_CORNERS = 16
"""Corners kept of a cell; a cell with more is rare and is solved as a free disc."""

_ROOM = 64
_NEAR = 3.5


@kernel
def sum_darkness(start: int, stop: int, darkness: Array, sums: Array) -> None:
    """Write the running sums of rows ``start..stop``, and the running integral of those.

    `sums` (h, w + 1, 2) holds both at the pixel borders.
    """
    w = darkness.shape[1]
    for y in range(start, stop):
        total = 0.0
        integral = 0.0
        for x in range(w):
            d = np.float64(darkness[y, x])
            sums[y, x, 0] = total
            sums[y, x, 1] = integral
            integral += total + 0.5 * d
            total += d
        sums[y, w, 0] = total
        sums[y, w, 1] = integral


@inline
def _ink_beside(sums: Array, ax: float, ay: float, bx: float, by: float) -> float:
    """Return the integral of the running sum G of darkness over an edge, ``G(x, y) dy``.

    Summed over a polygon's edges it is the ink the polygon asks for (Green's theorem). In a row
    of pixels G is a line or, beyond one pixel, its own integral in x tells the mean.
    """
    h = sums.shape[0]
    w = sums.shape[1] - 1
    if ay == by:
        return 0.0
    sign = 1.0
    if ay > by:
        ax, ay, bx, by = bx, by, ax, ay
        sign = -1.0
    slope = (bx - ax) / (by - ay)
    total: float = 0.0
    y = ay
    x = ax
    row = min(max(int(ay), 0), h - 1)
    while True:
        last = by <= row + 1.0 or row == h - 1
        y_end = by if last else row + 1.0
        x_end = bx if last else ax + (y_end - ay) * slope
        c = min(max(int(x), 0), w - 1)
        d = min(max(int(x_end), 0), w - 1)
        p = x - c
        q = x_end - d
        g0 = sums[row, c, 0]
        g1 = sums[row, d, 0]
        f0 = sums[row, c + 1, 0] - g0
        f1 = sums[row, d + 1, 0] - g1
        if c == d or abs(x_end - x) < 1e-3:
            mean = 0.5 * (g0 + f0 * p + g1 + f1 * q)
        else:
            i0 = sums[row, c, 1] + p * (g0 + 0.5 * f0 * p)
            i1 = sums[row, d, 1] + q * (g1 + 0.5 * f1 * q)
            mean = (i1 - i0) / (x_end - x)
        total += mean * (y_end - y)
        if last:
            return sign * total
        y = y_end
        x = x_end
        row += 1


@inline
def _cut(cell: Array, m: int, a: float, b: float, c: float, number: float) -> int:
    """Cut away the part of a cell with ``a x + b y > c``; return the corners left.

    Rows of `cell`: x, y, number of the dot beyond the side that starts at the corner; then three
    rows of scratch, and how far each corner lies beyond the line.
    """
    n_out = 0
    for k in range(m):
        s = a * cell[0, k] + b * cell[1, k] - c
        cell[6, k] = s
        if s > 0.0:
            n_out += 1
    if n_out == 0 or n_out == m or m + 2 > cell.shape[1]:
        return m
    n = 0
    for k in range(m):
        j = k + 1 if k + 1 < m else 0
        s = cell[6, k]
        t = cell[6, j]
        if s <= 0.0:
            cell[3, n] = cell[0, k]
            cell[4, n] = cell[1, k]
            cell[5, n] = cell[2, k]
            n += 1
        if (s <= 0.0) != (t <= 0.0):
            f = s / (s - t)
            cell[3, n] = cell[0, k] + f * (cell[0, j] - cell[0, k])
            cell[4, n] = cell[1, k] + f * (cell[1, j] - cell[1, k])
            cell[5, n] = number if s <= 0.0 else cell[2, k]
            n += 1
    for k in range(n):
        cell[0, k] = cell[3, k]
        cell[1, k] = cell[4, k]
        cell[2, k] = cell[5, k]
    return n


@inline
def _reach2(cell: Array, m: int) -> float:
    best = 0.0
    for k in range(m):
        best = max(best, cell[0, k] * cell[0, k] + cell[1, k] * cell[1, k])
    return best


@inline
def _cell_of(cell: Array, near: Array, xy: Array, i: int, cell_start: Array, frame: Array) -> int:
    """Cut the cell of dot i out of its box, ring after ring of the grid; return its corners."""
    side = frame[2]
    nx = int(frame[3])
    ny = int(frame[4])
    x = xy[i, 0]
    y = xy[i, 1]
    ix = min(max(int(x / side), 0), nx - 1)
    iy = min(max(int(y / side), 0), ny - 1)
    half = frame[5]
    x0 = max(-x, -half)
    y0 = max(-y, -half)
    x1 = min(frame[0] - x, half)
    y1 = min(frame[1] - y, half)
    cell[0, 0], cell[1, 0] = x0, y0
    cell[0, 1], cell[1, 1] = x1, y0
    cell[0, 2], cell[1, 2] = x1, y1
    cell[0, 3], cell[1, 3] = x0, y1
    for k in range(4):
        cell[2, k] = -1.0
    m = 4
    reach2 = _reach2(cell, m)
    around = 0
    for row in range(max(iy - 1, 0), min(iy + 1, ny - 1) + 1):
        k = row * nx
        around += cell_start[k + min(ix + 1, nx - 1) + 1] - cell_start[k + max(ix - 1, 0)]
    near2 = _NEAR * 9.0 * side * side / around  # a disc of about eleven dots
    from2 = 0.0
    ring = 1
    while True:
        count = 0
        for row in range(max(iy - ring, 0), min(iy + ring, ny - 1) + 1):
            whole = ring == 1 or row == iy - ring or row == iy + ring
            step = 1 if whole else 2 * ring
            for col in range(ix - ring, ix + ring + 1, step):
                if col < 0 or col >= nx:
                    continue
                k = row * nx + col
                for j in range(cell_start[k], cell_start[k + 1]):
                    a = xy[j, 0] - x
                    b = xy[j, 1] - y
                    d2 = a * a + b * b
                    if d2 <= from2 or d2 > near2 or d2 >= 4.0 * reach2:
                        continue
                    if count == len(near):  # a crowd: no need to sort it
                        m = _cut(cell, m, a, b, 0.5 * d2, float(j))
                        reach2 = _reach2(cell, m)
                        continue
                    at = count
                    while at > 0 and near[at - 1, 0] > d2:
                        near[at, 0] = near[at - 1, 0]
                        near[at, 1] = near[at - 1, 1]
                        at -= 1
                    near[at, 0] = d2
                    near[at, 1] = j
                    count += 1
        for k in range(count):
            d2 = near[k, 0]
            if d2 >= 4.0 * reach2:
                break
            j = int(near[k, 1])
            m = _cut(cell, m, xy[j, 0] - x, xy[j, 1] - y, 0.5 * d2, float(j))
            reach2 = _reach2(cell, m)
        if near2 < np.inf:  # once more through the first rings, for the dots farther off
            from2 = near2
            near2 = np.inf
            continue
        from2 = 0.0
        seen = np.inf
        if ix - ring > 0:
            seen = min(seen, x - (ix - ring) * side)
        if ix + ring < nx - 1:
            seen = min(seen, (ix + ring + 1) * side - x)
        if iy - ring > 0:
            seen = min(seen, y - (iy - ring) * side)
        if iy + ring < ny - 1:
            seen = min(seen, (iy + ring + 1) * side - y)
        if 4.0 * reach2 <= seen * seen:
            return m
        ring += 1


@kernel
def build_cells(
    start: int,
    stop: int,
    xy: Array,
    cell_start: Array,
    frame: Array,
    sums: Array,
    corners: Array,
    beyond: Array,
    n_corners: Array,
    asked: Array,
) -> None:
    """Build the cells of dots ``start..stop`` and integrate the darkness over them.

    Parameters
    ----------
    xy : (n, 2) float64
        Sorted by grid cell.
    frame : (6,) float64
        Width and height of the page, side of a grid cell, columns and rows of the grid, and half
        the side of the box that bounds a cell.
    sums : (h, w + 1, 2) float64
        From `sum_darkness`.
    corners : (n, `MAX_CORNERS`, 2) float32
        Of the cells, relative to the dot.
    beyond : (n, `MAX_CORNERS`) int32
        The dot beyond the side after each corner, or -1.
    n_corners : (n,) uint8
        0 for a cell with too many.
    asked : (n,) float64
        Ink that the cell asks for.
    """
    cell = np.empty((7, _ROOM))
    near = np.empty((_ROOM, 2))
    for i in range(start, stop):
        x = xy[i, 0]
        y = xy[i, 1]
        m = _cell_of(cell, near, xy, i, cell_start, frame)
        total = 0.0
        for k in range(m):
            j = k + 1 if k + 1 < m else 0
            total += _ink_beside(
                sums, x + cell[0, k], y + cell[1, k], x + cell[0, j], y + cell[1, j]
            )
        asked[i] = max(total, 0.0)
        n_corners[i] = m if 0 < m <= MAX_CORNERS else 0
        for k in range(n_corners[i]):
            corners[i, k, 0] = cell[0, k]
            corners[i, k, 1] = cell[1, k]
            beyond[i, k] = int(cell[2, k])
