"""A grid of linked lists of dots: one dot moves, comes or goes in constant time.

`head` holds the first row of each cell, `links` (rows, 3) the next and previous row and the cell,
-1 where there is none. `frame` is ``x0, y0, 1 / side, columns, rows, slack`` of the grid; dots
outside it are kept in its border cells. A dot may have moved by up to `slack` since it was put into
its cell: queries look that much further, and go by where dots are.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel

F8 = NDArray[np.float64]
I4 = NDArray[np.int32]
I8 = NDArray[np.int64]


@inline
def _cell_of(v: float, v0: float, inverse: float, n: float) -> int:
    return int(min(max((v - v0) * inverse, 0.0), n - 1.0))


@inline
def _link(row: int, xy: F8, frame: F8, head: I4, links: I4) -> None:
    cell = _cell_of(xy[row, 1], frame[1], frame[2], frame[4]) * int(frame[3]) + _cell_of(
        xy[row, 0], frame[0], frame[2], frame[3]
    )
    first = head[cell]
    links[row, 0], links[row, 1], links[row, 2] = first, -1, cell
    if first >= 0:
        links[first, 1] = row
    head[cell] = row


@inline
def _unlink(row: int, head: I4, links: I4) -> None:
    after, before, cell = links[row, 0], links[row, 1], links[row, 2]
    if before >= 0:
        links[before, 0] = after
    else:
        head[cell] = after
    if after >= 0:
        links[after, 1] = before
    links[row, 2] = -1


@kernel
def link_all(xy: F8, frame: F8, head: I4, links: I4) -> None:
    """Fill empty lists with all dots."""
    for row in range(len(xy)):
        _link(row, xy, frame, head, links)


@kernel
def relink(rows: I8, xy: F8, frame: F8, head: I4, links: I4) -> None:
    """Bring rows up to date: moved, new, or gone (at or beyond the number of dots)."""
    for row in rows:
        if links[row, 2] >= 0:
            _unlink(row, head, links)
        if row < len(xy):
            _link(row, xy, frame, head, links)


@kernel
def rows_in_box(
    x0: float, y0: float, x1: float, y1: float, xy: F8, frame: F8, head: I4, links: I4, out: I8
) -> int:
    """Write the rows of the dots in a closed box; return how many, also where `out` is full."""
    n, slack = 0, frame[5]
    i0 = _cell_of(x0 - slack, frame[0], frame[2], frame[3])
    i1 = _cell_of(x1 + slack, frame[0], frame[2], frame[3])
    j0 = _cell_of(y0 - slack, frame[1], frame[2], frame[4])
    j1 = _cell_of(y1 + slack, frame[1], frame[2], frame[4])
    for j in range(j0, j1 + 1):
        for cell in range(j * int(frame[3]) + i0, j * int(frame[3]) + i1 + 1):
            row = head[cell]
            while row >= 0:
                if x0 <= xy[row, 0] <= x1 and y0 <= xy[row, 1] <= y1:
                    if n < len(out):
                        out[n] = row
                    n += 1
                row = links[row, 0]
    return n


@kernel
def nearest_row(x: float, y: float, reach: float, xy: F8, frame: F8, head: I4, links: I4) -> int:
    """Return the row of the nearest dot within a reach, the lowest of equals; -1 if none."""
    best, best_d2 = -1, reach * reach
    far = reach + frame[5]
    i0 = _cell_of(x - far, frame[0], frame[2], frame[3])
    i1 = _cell_of(x + far, frame[0], frame[2], frame[3])
    j0 = _cell_of(y - far, frame[1], frame[2], frame[4])
    j1 = _cell_of(y + far, frame[1], frame[2], frame[4])
    for j in range(j0, j1 + 1):
        for i in range(i0, i1 + 1):
            row = head[j * int(frame[3]) + i]
            while row >= 0:
                d2 = (xy[row, 0] - x) ** 2 + (xy[row, 1] - y) ** 2
                if d2 < best_d2 or (d2 == best_d2 and (best < 0 or row < best)):
                    best, best_d2 = row, d2
                row = links[row, 0]
    return best


@kernel
def keep_apart(
    points: F8, distance: float, xy: F8, frame: F8, head: I4, links: I4, kept: NDArray[np.bool_]
) -> None:
    """Mark the points that stay clear of all dots and of the points marked before them."""
    d2 = distance * distance
    for k in range(len(points)):
        x, y = points[k, 0], points[k, 1]
        row = nearest_row(x, y, distance * (1.0 - 1e-12), xy, frame, head, links)
        kept[k] = row < 0
        for m in range(k):
            if kept[m] and (points[m, 0] - x) ** 2 + (points[m, 1] - y) ** 2 < d2:
                kept[k] = False
                break


@inline
def _nearest_d2_in_ring(
    row: int, ring: int, ix: int, iy: int, best: float, xy: F8, frame: F8, head: I4, links: I4
) -> float:
    """Return the squared distance to the nearest other dot in the cells at distance `ring`."""
    x, y = xy[row, 0], xy[row, 1]
    columns, rows = int(frame[3]), int(frame[4])
    for j in range(max(iy - ring, 0), min(iy + ring, rows - 1) + 1):
        step = 1 if j == iy - ring or j == iy + ring else max(2 * ring, 1)
        for i in range(ix - ring, ix + ring + 1, step):
            if 0 <= i < columns:
                other = head[j * columns + i]
                while other >= 0:
                    if other != row:
                        best = min(best, (xy[other, 0] - x) ** 2 + (xy[other, 1] - y) ** 2)
                    other = links[other, 0]
    return best


@kernel
def nearest_distances(
    rows: I8, reach: float, xy: F8, frame: F8, head: I4, links: I4, out: F8
) -> None:
    """Write the distance of each row's dot to the nearest other; `reach` where none is nearer."""
    side = 1.0 / frame[2]
    most = int(max(frame[3], frame[4]))
    for k in range(len(rows)):
        x, y = xy[rows[k], 0], xy[rows[k], 1]
        ix = _cell_of(x, frame[0], frame[2], frame[3])
        iy = _cell_of(y, frame[1], frame[2], frame[4])
        to_wall = min(
            min(x - frame[0] - ix * side, (ix + 1) * side + frame[0] - x),
            min(y - frame[1] - iy * side, (iy + 1) * side + frame[1] - y),
        )
        best = reach * reach
        for ring in range(most + 1):
            best = _nearest_d2_in_ring(rows[k], ring, ix, iy, best, xy, frame, head, links)
            seen = to_wall + ring * side - frame[5]
            if seen > 0.0 and best <= seen * seen:
                break
        out[k] = math.sqrt(best)
