"""Dots that lie too close to one another for how close their neighbours lie."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel

Array = NDArray[Any]

_NEIGHBOURS = 7
_AROUND = 2  # grid cells to each side that most dots can be judged by
_LOOKED_AT = 64  # dots in them that are counted at most
_SURELY = 1.0 + 1e-12  # what rounding may be off


@inline
def _look(
    xy: Array, i: int, cell_start: Array, frame: Array, distance2: Array, nearest: int
) -> int:
    """Fill `distance2` with the squared distances to the nearest dots; return the nearest one."""
    side = frame[2]
    nx = int(frame[3])
    ny = int(frame[4])
    x = xy[i, 0]
    y = xy[i, 1]
    ix = min(max(int(x / side), 0), nx - 1)
    iy = min(max(int(y / side), 0), ny - 1)
    last = len(distance2) - 1
    distance2[:] = np.inf
    ring = 0
    while ring <= max(nx, ny):
        seen = max(ring - 1.0, 0.0) * side  # a dot in this ring is at least so far
        if seen * seen > distance2[last]:
            break
        for row in range(max(iy - ring, 0), min(iy + ring, ny - 1) + 1):
            whole = row == iy - ring or row == iy + ring
            step = 1 if whole else max(2 * ring, 1)
            for col in range(ix - ring, ix + ring + 1, step):
                if col < 0 or col >= nx:
                    continue
                k = row * nx + col
                for j in range(cell_start[k], cell_start[k + 1]):
                    d2 = (xy[j, 0] - x) ** 2 + (xy[j, 1] - y) ** 2
                    if d2 >= distance2[last] or j == i:
                        continue
                    at = last
                    while at > 0 and distance2[at - 1] > d2:
                        distance2[at] = distance2[at - 1]
                        at -= 1
                    distance2[at] = d2
                    if at == 0:
                        nearest = j
        ring += 1
    return nearest


@inline
def _lack_around(
    xy: Array, i: int, cell_start: Array, frame: Array, share: float, enough: float,
    nearest: Array, seen: Array, distance2: Array,
) -> float:  # fmt: skip
    """Return what `find_close` does by the grid cells around a dot alone; -1 if they do not tell.

    `nearest` gets the nearest; `seen` and `distance2` are scratch.
    """
    side = frame[2]
    nx = int(frame[3])
    ny = int(frame[4])
    x = xy[i, 0]
    y = xy[i, 1]
    ix = min(max(int(x / side), 0), nx - 1)
    iy = min(max(int(y / side), 0), ny - 1)
    first = max(ix - _AROUND, 0)
    last = min(ix + _AROUND, nx - 1)
    nearest2 = np.inf
    n = 0
    for row in range(max(iy - _AROUND, 0), min(iy + _AROUND, ny - 1) + 1):
        for j in range(cell_start[row * nx + first], cell_start[row * nx + last + 1]):
            d2 = (xy[j, 0] - x) ** 2 + (xy[j, 1] - y) ** 2
            if j == i:
                continue
            if n == len(seen):
                return -1.0
            seen[n] = d2
            n += 1
            if d2 < nearest2:
                nearest2 = d2
                nearest[i] = j
    known = _AROUND * side  # no dot beyond these cells is nearer
    known2 = known * known
    if n < _NEIGHBOURS or nearest2 > known2:
        return -1.0
    if nearest2 >= enough * enough * _SURELY:
        return 0.0
    reach2 = nearest2 / (share * share) / _SURELY
    within = 0
    for k in range(n):
        within += seen[k] <= reach2
    if within >= _NEIGHBOURS:
        return 0.0  # the seventh is no farther than the nearest is by `share`
    distance2[:] = np.inf
    last = _NEIGHBOURS - 1
    for k in range(n):
        d2 = seen[k]
        if d2 < distance2[last]:
            at = last
            while at > 0 and distance2[at - 1] > d2:
                distance2[at] = distance2[at - 1]
                at -= 1
            distance2[at] = d2
    if distance2[last] > known2:
        return -1.0
    wanted = min(share * math.sqrt(distance2[last]), enough)
    return max(wanted - math.sqrt(nearest2), 0.0)


@kernel
def find_close(
    start: int,
    stop: int,
    xy: Array,
    cell_start: Array,
    frame: Array,
    share: float,
    enough: Array,
    awake: Array,
    nearest: Array,
    lack: Array,
) -> None:
    """Find each dot's nearest, and how far that is short of a share of the way to the seventh.

    Or of `enough` (n,), where that is less: on a thin line the seventh is far away.

    Parameters
    ----------
    xy : (n, 2) float64
        Sorted by grid cell.
    cell_start : (columns * rows + 1,) int32
        Where the dots of each grid cell begin.
    frame : (5,) float64
        Width and height of the page, side of a grid cell, columns and rows of the grid.
    share : float
    awake : (n,) bool
        Only these are looked at; of the others `lack` is set to 0 and `nearest` is left.
    nearest : (n,) int32
    lack : (n,) float64
        0 for a dot that is far enough, or has fewer neighbours than seven.
    """
    distance2 = np.empty(_NEIGHBOURS)
    seen = np.empty(_LOOKED_AT)
    for i in range(start, stop):
        lack[i] = 0.0
        if not awake[i]:
            continue
        found = _lack_around(xy, i, cell_start, frame, share, enough[i], nearest, seen, distance2)
        if found >= 0.0:
            lack[i] = found
            continue
        j = _look(xy, i, cell_start, frame, distance2, -1)
        nearest[i] = j
        seventh2 = distance2[_NEIGHBOURS - 1]
        if seventh2 < np.inf:
            wanted = min(share * math.sqrt(seventh2), enough[i])
            lack[i] = max(wanted - math.sqrt(distance2[0]), 0.0)


@kernel
def push_apart(
    xy: Array,
    nearest: Array,
    lack: Array,
    darkness: Array,
    rim: Array,
    moves: Array,
    rows: Array,
    awake: Array,
) -> int:
    """Move each dot that is too close, and its nearest, half of what lacks; return how many.

    A dot nearer to the page's edge than `rim` (n,) only slides along it, and none moves onto
    white. `moves` (n, 2), all 0 before and after, and `rows` (n,) int32 are scratch; `awake` gets
    the dots that moved.
    """
    h, w = darkness.shape
    n = 0
    n_rows = 0
    awake[:] = False
    for i in range(len(xy)):
        if lack[i] == 0.0:
            continue
        n += 1
        j = nearest[i]
        dx = xy[i, 0] - xy[j, 0]
        dy = xy[i, 1] - xy[j, 1]
        d = math.hypot(dx, dy)
        if d == 0.0:
            dx, d = 1.0 if i < j else -1.0, 1.0
        half = 0.5 * lack[i] / d
        if nearest[j] == i and lack[j] > 0.0:
            half *= 0.5  # the other one does as much
        dx *= half
        dy *= half
        moves[i, 0] += dx
        moves[i, 1] += dy
        moves[j, 0] -= dx
        moves[j, 1] -= dy
        for k in range(2):
            row = i if k == 0 else j
            if not awake[row]:
                awake[row] = True
                rows[n_rows] = row
                n_rows += 1
    for k in range(n_rows):
        i = rows[k]
        moved_x, moved_y = moves[i, 0], moves[i, 1]
        moves[i, 0] = moves[i, 1] = 0.0
        awake[i] = moved_x != 0.0 or moved_y != 0.0
        if not awake[i]:
            continue
        x = xy[i, 0]
        y = xy[i, 1]
        if rim[i] < x < w - rim[i]:
            x = min(max(x + moved_x, 1e-9 * w), (1.0 - 1e-9) * w)
        if rim[i] < y < h - rim[i]:
            y = min(max(y + moved_y, 1e-9 * h), (1.0 - 1e-9) * h)
        if darkness[min(max(int(y), 0), h - 1), min(max(int(x), 0), w - 1)] > 0.0:
            xy[i, 0] = x
            xy[i, 1] = y
    return n
