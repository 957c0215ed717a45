"""How much of each dot is ink that no other dot lays: its share of the union of all dots.

The union of discs is the disjoint union of what each disc keeps inside its power cell (the points
of the plane whose power to it is least), so shares add up to the area of the union.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.machine.pool import parallel_for

_N_RAYS = 32
_MANY = 0.25  # segments that cut off more than this may overlap one another: count by rays

_RAYS = np.column_stack(
    [
        np.cos(np.arange(_N_RAYS) * 2 * np.pi / _N_RAYS),
        np.sin(np.arange(_N_RAYS) * 2 * np.pi / _N_RAYS),
    ]
)


@kernel
def _sort_into_cells(discs, side, x0, y0, n_x, n_y, first, order, out):
    """Sort discs by the cell of a grid they lie in; `first` gets n_x n_y + 1 entries."""
    n = discs.shape[0]
    first[:] = 0
    for i in range(n):
        first[_cell(discs[i, 0], discs[i, 1], side, x0, y0, n_x, n_y) + 1] += 1
    for c in range(n_x * n_y):
        first[c + 1] += first[c]
    for i in range(n - 1, -1, -1):
        c = _cell(discs[i, 0], discs[i, 1], side, x0, y0, n_x, n_y)
        first[c + 1] -= 1
        at = first[c + 1]
        order[at] = i
        out[at, 0], out[at, 1], out[at, 2] = discs[i, 0], discs[i, 1], discs[i, 2]
    for c in range(n_x * n_y):
        first[c] = first[c + 1]
    first[n_x * n_y] = n


@inline
def _cell(x, y, side, x0, y0, n_x, n_y):
    i = min(max(int((x - x0) / side), 0), n_x - 1)
    j = min(max(int((y - y0) / side), 0), n_y - 1)
    return j * n_x + i


@inline
def _segment(h, r):
    """Return the share of a disc beyond a line at distance h from its centre."""
    c = h / r
    if c >= 1.0:
        return 0.0
    if c <= -1.0:
        return 1.0
    return (math.acos(c) - c * math.sqrt(1.0 - c * c)) / math.pi


@kernel
def _shares(start, stop, discs, side, x0, y0, n_x, n_y, first, order, out):
    rays = np.empty((2, _N_RAYS), np.float32)
    for i in range(start, stop):
        x, y, r = discs[i, 0], discs[i, 1], discs[i, 2]
        cx = min(max(int((x - x0) / side), 0), n_x - 1)
        cy = min(max(int((y - y0) / side), 0), n_y - 1)
        lost = 0.0
        for gy in range(max(cy - 1, 0), min(cy + 2, n_y)):
            a, b = first[gy * n_x + max(cx - 1, 0)], first[gy * n_x + min(cx + 1, n_x - 1) + 1]
            for j in range(a, b):
                dx, dy, s = discs[j, 0] - x, discs[j, 1] - y, discs[j, 2]
                d2 = dx * dx + dy * dy
                if d2 < (r + s) * (r + s) and j != i:
                    lost += _lost(d2, r, s, order[j] < order[i])
        if lost > _MANY:
            rays[0, :] = 0.0
            rays[1, :] = r
            for gy in range(max(cy - 1, 0), min(cy + 2, n_y)):
                a, b = first[gy * n_x + max(cx - 1, 0)], first[gy * n_x + min(cx + 1, n_x - 1) + 1]
                for j in range(a, b):
                    dx, dy, s = discs[j, 0] - x, discs[j, 1] - y, discs[j, 2]
                    d2 = dx * dx + dy * dy
                    if d2 < (r + s) * (r + s) and j != i:
                        _clip_rays(rays, dx, dy, d2, r, s, order[j] < order[i])
            kept = 0.0
            for m in range(_N_RAYS):
                kept += max(rays[1, m] ** 2 - rays[0, m] ** 2, 0.0)
            out[order[i]] = kept / (_N_RAYS * r * r)
        else:
            out[order[i]] = 1.0 - lost


@inline
def _lost(d2, r, s, is_first):
    """Return the share of a disc of radius r nearer to one of radius s, in terms of power."""
    if d2 < 1e-9 * r * r:  # one on another: the larger keeps all, of equals the first
        return 1.0 if s > r or (s == r and is_first) else 0.0
    d = math.sqrt(d2)
    return _segment((d2 + r * r - s * s) / (2.0 * d), r)


@inline
def _clip_rays(rays, dx, dy, d2, r, s, is_first):
    """Keep of each ray from the centre, from entry to exit, what a neighbour leaves."""
    if d2 < 1e-9 * r * r:
        if s > r or (s == r and is_first):
            rays[1, :] = 0.0
        return
    d = math.sqrt(d2)
    h = (d2 + r * r - s * s) / (2.0 * d)
    for m in range(_N_RAYS):
        c = (_RAYS[m, 0] * dx + _RAYS[m, 1] * dy) / d
        if c > 1e-9:
            rays[1, m] = min(rays[1, m], max(h / c, 0.0))
        elif c < -1e-9:
            rays[0, m] = max(rays[0, m], h / c)
        elif h < 0.0:
            rays[1, m] = 0.0


def shares_of_union(discs: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return for each disc the share of its area that counts in the union of all.

    Parameters
    ----------
    discs : (n, 3 or more) float32
        x, y and radius; what follows is not read.

    Returns
    -------
    (n,) float32
        0 to 1; ``pi * sum(share * radius**2)`` is the area of the union, to about 0.5 % where
        many discs lie on one another and exactly where few do.
    """
    n = len(discs)
    out = np.ones(n, np.float32)
    if n < 2:
        return out
    low, high = discs[:, :2].min(axis=0).astype(float), discs[:, :2].max(axis=0).astype(float)
    side = 2.0 * float(discs[:, 2].max())
    side = max(side, math.sqrt(float(np.prod(np.maximum(high - low, side))) / n))
    n_x, n_y = (int(s) + 1 for s in (high - low) / side)
    first = np.empty(n_x * n_y + 1, np.int64)
    order = np.empty(n, np.int64)
    by_cell = np.empty((n, 3), np.float32)
    grid = (side, float(low[0]), float(low[1]), n_x, n_y)
    _sort_into_cells(discs, *grid, first, order, by_cell)
    parallel_for(_shares, n, by_cell, *grid, first, order, out, grain=2048)
    return out
