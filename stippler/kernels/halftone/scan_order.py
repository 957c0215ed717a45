"""Which cells a halftone fills, and in what order."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import kernel

Array = NDArray[Any]

FRONT_STEP = 16
"""Rows between those for which an undulating front is given."""

_FAR = 65_000


@kernel
def outside_polygon(edges: Array, charge: Array) -> None:
    """Set the charge of cells whose centre lies outside a polygon to exactly 0.

    `edges` (m, 4) are x0, y0, x1, y1 of all rings, in cells; inside is where a ray to the left
    crosses an odd number of them.
    """
    h, w = charge.shape
    m = len(edges)
    first = np.zeros(h + 2, np.int64)  # edges by the row they begin in
    row_of = np.empty(m, np.int64)
    for e in range(m):
        row_of[e] = min(max(int(np.ceil(min(edges[e, 1], edges[e, 3]) - 0.5)), 0), h)
        first[row_of[e] + 1] += 1
    for y in range(1, h + 2):
        first[y] += first[y - 1]
    at = first.copy()
    sorted_edges = np.empty(m, np.int64)
    for e in range(m):
        sorted_edges[at[row_of[e]]] = e
        at[row_of[e]] += 1
    active = np.empty(m, np.int64)
    crossings = np.empty(m)
    n_active = 0
    for y in range(h):
        for k in range(first[y], first[y + 1]):
            active[n_active] = sorted_edges[k]
            n_active += 1
        middle = y + 0.5
        n = 0
        kept = 0
        for k in range(n_active):
            e = active[k]
            ay = edges[e, 1]
            by = edges[e, 3]
            if max(ay, by) <= middle:
                continue
            active[kept] = e
            kept += 1
            x = edges[e, 0] + (middle - ay) / (by - ay) * (edges[e, 2] - edges[e, 0])
            i = n
            while i > 0 and crossings[i - 1] > x:
                crossings[i] = crossings[i - 1]
                i -= 1
            crossings[i] = x
            n += 1
        n_active = kept
        x = 0
        for k in range(n + 1):
            end = w
            if k < n:
                end = min(max(int(np.ceil(crossings[k] - 0.5)), 0), w)
            if k % 2 == 0:
                for column in range(x, end):
                    charge[y, column] = 0.0
            x = max(x, end)


@kernel
def chamfer(charge: Array, distance: Array) -> None:
    """Write each cell's distance to the nearest one without charge or off the field, in thirds.

    Steps of 3 to the side and 4 across the corner (Borgefors 1986).
    """
    h, w = charge.shape
    for turn in range(2):
        back = -1 if turn == 0 else 1
        for a in range(h):
            y = a if turn == 0 else h - 1 - a
            for b in range(w):
                x = b if turn == 0 else w - 1 - b
                if not charge[y, x] > 0.0:
                    distance[y, x] = 0
                    continue
                best = _FAR if turn == 0 else int(distance[y, x])
                side = int(distance[y, x + back]) if 0 <= x + back < w else 0
                best = min(best, side + 3)
                for s in range(-1, 2):
                    inside = 0 <= y + back < h and 0 <= x + s < w
                    across = int(distance[y + back, x + s]) if inside else 0
                    best = min(best, across + (3 if s == 0 else 4))
                distance[y, x] = best


@kernel
def order_by_distance(distance: Array, order: Array) -> None:
    """List the flat indices of cells with a distance above 0 by distance, then in raster order."""
    h, w = distance.shape
    first = np.zeros(_FAR + 8, np.int64)
    for y in range(h):
        for x in range(w):
            if distance[y, x] > 0:
                first[distance[y, x] + 1] += 1
    for k in range(1, len(first)):
        first[k] += first[k - 1]
    for y in range(h):
        for x in range(w):
            d = distance[y, x]
            if d > 0:
                order[first[d]] = y * w + x
                first[d] += 1


@kernel
def along_front(
    charge: Array, lag: Array, next_row: Array, due: Array, at: Array, stop: int, order: Array
) -> int:
    """List the flat indices of cells with charge as an undulating front comes down over them.

    Parameters
    ----------
    charge : (h, w) float32
    lag : (h // FRONT_STEP + 2, w) float32
        The front reaches a cell at the level of its row plus this, which is given for every so
        many rows.
    next_row : (w,) int32
        First row of each column that is not listed yet, from 0; updated.
    due : (w,) float32
        Level at which the front reaches it, from `lag[0]`; updated.
    at : (2,) int64
        Level and column to go on from; updated.
    stop : int
        Level before which to stop.
    order : (m,) int32
        Filled from its beginning.

    Returns
    -------
    int
        How many are listed; m if there may be more before `stop`.
    """
    h, w = charge.shape
    step = np.uint32(FRONT_STEP)
    n = 0
    x = int(at[1])
    for level in range(at[0], stop):
        while x < w:
            while due[x] <= level:
                y = np.uint32(next_row[x])
                if charge[y, x] > 0.0:
                    if n == len(order):
                        at[0] = level
                        at[1] = x
                        return n
                    order[n] = y * w + x
                    n += 1
                y += np.uint32(1)
                next_row[x] = y
                if y == h:
                    due[x] = np.inf
                    break
                j = y // step
                part = np.float32(y - j * step) * np.float32(1.0 / FRONT_STEP)
                due[x] = np.float32(y) + lag[j, x] + part * (lag[j + 1, x] - lag[j, x])
            x += 1
        x = 0
    at[0] = stop
    at[1] = 0
    return n
