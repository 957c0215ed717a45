"""Which of many outlines a point lies in: the edges near it are asked, in a grid.

`edges` (k, 4) hold the ends of each edge, the lower one first; `frame` is ``x0, y0, side`` of the
square cells, `columns` by `rows`. A cell's items stand from ``start[cell]`` to ``start[cell + 1]``,
those of the uppermost outline first; each is the outline's rank, whether the outline holds the
cell's lower corner, and the number of one of its edges in the cell, or -1 where it has none there.

A point is inside if a way from the cell's corner, up the cell's side and then across, crosses the
outline an even number of times, or an odd one where the corner is outside. Points count as shifted
by less than anything to the right, and by less than that upwards, so no way leads through a corner;
a point on an edge is inside all the same.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel

F8 = NDArray[np.float64]
I4 = NDArray[np.int32]
I8 = NDArray[np.int64]


TINY = 1e-100
"""Lengths below this count as 0: products of two of them would, and edges lose their slope."""


@inline
def _is_beyond(x: float, y: float, k: int, edges: F8) -> bool:
    """Whether a point lies right of an edge, or above one that is level.

    Two products are compared, and not subtracted: that would be one rounding short of exact zeros.
    """
    ax, ay, bx, by = edges[k]
    if ay == by:
        return bool(y >= ay)
    return bool((bx - ax) * (y - ay) <= (x - ax) * (by - ay))


@inline
def _is_on(x: float, y: float, k: int, edges: F8) -> bool:
    ax, ay, bx, by = edges[k]
    inside = min(ax, bx) <= x <= max(ax, bx) and ay <= y <= by
    return bool(inside and (bx - ax) * (y - ay) == (x - ax) * (by - ay))


@kernel
def locate(
    points: F8, frame: F8, columns: int, rows: int, start: I8, rank: I4, holds: I4, edge: I4,
    edges: F8, out: I4,
) -> None:  # fmt: skip
    """Write the rank of the uppermost outline that holds each point, -1 where none does."""
    x0, y0, side = frame
    for i in range(len(points)):
        x = 0.0 if abs(points[i, 0]) < TINY else points[i, 0]
        y = 0.0 if abs(points[i, 1]) < TINY else points[i, 1]
        out[i] = -1
        if not (x0 <= x <= x0 + side * columns and y0 <= y <= y0 + side * rows):
            continue
        cx, cy = min(int((x - x0) / side), columns - 1), min(int((y - y0) / side), rows - 1)
        left, low = x0 + cx * side, y0 + cy * side
        cell = cy * columns + cx
        k = start[cell]
        while k < start[cell + 1] and out[i] < 0:
            mine, inside, on = rank[k], holds[k] != 0, False
            while k < start[cell + 1] and rank[k] == mine:
                e = edge[k]
                k += 1
                if e < 0:
                    continue
                beyond = _is_beyond(left, y, e, edges)
                if (edges[e, 0] <= left) != (edges[e, 2] <= left):
                    inside ^= beyond != _is_beyond(left, low, e, edges)
                if (edges[e, 1] <= y) != (edges[e, 3] <= y):
                    inside ^= beyond != _is_beyond(x, y, e, edges)
                on = on or _is_on(x, y, e, edges)
            if inside or on:
                out[i] = mine


@inline
def _first_beyond(y: float, k: int, x0: float, side: float, columns: int, edges: F8) -> int:
    """Find the first corner of a row of the grid that lies right of an edge that crosses it."""
    ax, ay = edges[k, 0], edges[k, 1]
    x = ax + (y - ay) / (edges[k, 3] - ay) * (edges[k, 2] - ax)
    i = int(min(max((x - x0) / side, 0.0), columns))
    while i > 0 and _is_beyond(x0 + (i - 1) * side, y, k, edges):
        i -= 1
    while i < columns and not _is_beyond(x0 + i * side, y, k, edges):
        i += 1
    return i


@kernel
def fill_corners(
    edges: F8, first: int, last: int, frame: F8, columns: int, rows: int, inside: I4
) -> None:
    """Write which cells' lower corners one outline holds; `inside` (rows, columns) is 0 before."""
    x0, y0, side = frame
    for k in range(first, last):
        j = int(max((edges[k, 1] - y0) / side - 1.0, 0.0))
        while j < rows and y0 + j * side < edges[k, 3]:
            y = y0 + j * side
            if (edges[k, 1] <= y) != (edges[k, 3] <= y):
                i = _first_beyond(y, k, x0, side, columns, edges)
                if i < columns:
                    inside[j, i] ^= 1
            j += 1
    for j in range(rows):
        for i in range(1, columns):
            inside[j, i] ^= inside[j, i - 1]


@kernel
def list_cells(
    edges: F8, first: int, last: int, frame: F8, columns: int, rows: int, cell: I8, edge: I4
) -> int:
    """List the cells that the edges of one outline may touch; return how many pairs there are."""
    x0, y0, side = frame
    n = 0
    for k in range(first, last):
        ax, ay, bx, by = edges[k]
        j0 = max(int((ay - y0) / side - 1e-6), 0)
        j1 = min(int((by - y0) / side + 1e-6), rows - 1)
        for j in range(j0, j1 + 1):
            low, high = max(y0 + (j - 1e-6) * side, ay), min(y0 + (j + 1 + 1e-6) * side, by)
            xa, xb = ax, bx
            if by > ay:
                xa = ax + (low - ay) / (by - ay) * (bx - ax)
                xb = ax + (high - ay) / (by - ay) * (bx - ax)
            i0 = max(int((min(xa, xb) - x0) / side - 1e-6), 0)
            i1 = min(int((max(xa, xb) - x0) / side + 1e-6), columns - 1)
            for i in range(i0, i1 + 1):
                if n < len(cell):
                    cell[n], edge[n] = j * columns + i, k
                n += 1
    return n
