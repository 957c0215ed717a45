"""How much of each dot is ink that no other dot lays: its share of the union of all dots.

The union of discs is the disjoint union of what each disc keeps inside its power cell (the points
of the plane whose power to it is least), so shares add up to the area of the union.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import bare_kernel, inline, inner, kernel
from stippler.kernels.machine.pool import parallel_for

_N_RAYS = 32
_MANY = 0.25  # segments that cut off more than this may overlap one another: count by rays

_RAYS = np.column_stack(
    [
        np.cos(np.arange(_N_RAYS) * 2 * np.pi / _N_RAYS),
        np.sin(np.arange(_N_RAYS) * 2 * np.pi / _N_RAYS),
    ]
)


_RANGE = 4.0
"""Largest over smallest radius of the discs that share a grid."""


class Grids(NamedTuple):
    """Discs by size and place: one grid for each class of sizes.

    Attributes
    ----------
    real : (m, 4) float64
        Side of a cell, x and y of the corner, the largest radius in it.
    whole : (m, 3) int64
        Columns, rows, and where the grid's cells begin in `first`.
    first : (cells + m,) int64
        The first disc of each cell, and the end of the last one.
    """

    real: NDArray[np.float64]
    whole: NDArray[np.int64]
    first: NDArray[np.int64]


@bare_kernel
def _sort_into_cells(discs, which, grids, k, start, order, out):
    """Sort the discs of class k by the cell they lie in; they follow those of classes before."""
    n_x, n_y, base = grids.whole[k, 0], grids.whole[k, 1], grids.whole[k, 2]
    n_cells = n_x * n_y
    first = grids.first[base : base + n_cells + 1]
    first[:] = 0
    for i in which:
        first[_cell(discs[i, 0], discs[i, 1], grids, k) + 1] += 1
    first[0] = start
    for c in range(n_cells):
        first[c + 1] += first[c]
    for m in range(len(which) - 1, -1, -1):
        i = which[m]
        c = _cell(discs[i, 0], discs[i, 1], grids, k)
        first[c + 1] -= 1
        at = first[c + 1]
        order[at] = i
        out[at, 0], out[at, 1], out[at, 2] = discs[i, 0], discs[i, 1], discs[i, 2]
    for c in range(n_cells):
        first[c] = first[c + 1]
    first[n_cells] = start + len(which)


@inline
def _cell(x, y, grids, k):
    side, n_x = grids.real[k, 0], grids.whole[k, 0]
    i = min(max(int((x - grids.real[k, 1]) / side), 0), n_x - 1)
    j = min(max(int((y - grids.real[k, 2]) / side), 0), grids.whole[k, 1] - 1)
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


@inline
def reached(x, y, r, grids, k):
    """Return columns and rows, first to last, whose discs may meet one of radius r at (x, y)."""
    side = grids.real[k, 0]
    n_x, n_y = grids.whole[k, 0], grids.whole[k, 1]
    span = math.ceil((r + grids.real[k, 3]) / side)
    cx = min(max(int((x - grids.real[k, 1]) / side), 0), n_x - 1)
    cy = min(max(int((y - grids.real[k, 2]) / side), 0), n_y - 1)
    x0, x1 = max(cx - span, 0), min(cx + span, n_x - 1)
    y0, y1 = max(cy - span, 0), min(cy + span, n_y - 1)
    return x0, x1, y0, y1


@kernel
def _shares(start, stop, discs, grids, order, out):
    rays = np.empty((2, _N_RAYS), np.float32)
    for i in range(start, stop):
        if not discs[i, 2] > 0.0:  # of a hidden area: there is nothing to share
            out[order[i]] = 1.0
            continue
        lost = _lost_to_neighbours(i, discs, grids, order)
        out[order[i]] = 1.0 - lost if lost <= _MANY else _kept(i, discs, grids, order, rays)


@inline
def _lost_to_neighbours(i, discs, grids, order):
    """Return the sum of what each neighbour takes of a disc."""
    x, y, r = discs[i, 0], discs[i, 1], discs[i, 2]
    first, lost = grids.first, 0.0
    for k in range(len(grids.real)):
        n_x, base = grids.whole[k, 0], grids.whole[k, 2]
        x0, x1, y0, y1 = reached(x, y, r, grids, k)
        for row in range(base + y0 * n_x, base + y1 * n_x + 1, n_x):
            for j in range(first[row + x0], first[row + x1 + 1]):
                dx, dy, s = discs[j, 0] - x, discs[j, 1] - y, discs[j, 2]
                d2 = dx * dx + dy * dy
                if d2 < (r + s) * (r + s) and j != i:
                    lost += _lost(d2, r, s, order[j] < order[i])
    return lost


@inner
def _kept(i, discs, grids, order, rays):
    """Return the share of a disc that its neighbours leave together, by rays from its centre."""
    x, y, r = discs[i, 0], discs[i, 1], discs[i, 2]
    rays[0, :] = 0.0
    rays[1, :] = r
    first, kept = grids.first, 0.0
    for k in range(len(grids.real)):
        n_x, base = grids.whole[k, 0], grids.whole[k, 2]
        x0, x1, y0, y1 = reached(x, y, r, grids, k)
        for row in range(base + y0 * n_x, base + y1 * n_x + 1, n_x):
            for j in range(first[row + x0], first[row + x1 + 1]):
                dx, dy, s = discs[j, 0] - x, discs[j, 1] - y, discs[j, 2]
                d2 = dx * dx + dy * dy
                if d2 < (r + s) * (r + s) and j != i:
                    _clip_rays(rays, dx, dy, d2, r, s, order[j] < order[i])
    for m in range(_N_RAYS):
        kept += max(rays[1, m] ** 2 - rays[0, m] ** 2, 0.0)
    return kept / (_N_RAYS * r * r)


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
    order, by_cell = np.empty(n, np.int64), np.empty((n, 3), np.float32)
    grids = sort_discs(discs, order, by_cell)
    parallel_for(_shares, n, by_cell, grids, order, out, grain=2048)
    return out


def sort_discs(
    discs: NDArray[np.float32], order: NDArray[np.int64], by_cell: NDArray[np.float32]
) -> Grids:
    """Sort discs into a grid for each class of sizes, the largest first.

    One grid for all would have cells as large as the largest disc, and all others in a few of them.
    """
    x, y, radius = np.ascontiguousarray(discs[:, :3].T)
    largest = float(radius.max())
    members = [np.arange(len(discs))]
    if float(radius.min()) * _RANGE < largest:
        size = np.log(np.maximum(radius, 1e-9 * largest) / largest) // -math.log(_RANGE)
        members = [np.flatnonzero(size == k) for k in np.unique(size)]
    low = np.array([x.min(), y.min()], np.float64)
    extent = np.array([x.max(), y.max()], np.float64) - low
    grids = _empty_grids([float(radius[which].max()) for which in members], members, low, extent)
    start = 0
    for k, which in enumerate(members):
        _sort_into_cells(discs, which, grids, k, start, order, by_cell)
        start += len(which)
    return grids


def _empty_grids(
    largest: list[float],
    members: list[NDArray[np.intp]],
    low: NDArray[np.float64],
    extent: NDArray[np.float64],
) -> Grids:
    """Lay out grids whose cells are no smaller than their discs, with about a disc to a cell."""
    m = len(members)
    real, whole, base = np.empty((m, 4)), np.empty((m, 3), np.int64), 0
    for k, which in enumerate(members):
        side = 2.0 * largest[k]
        side = max(side, math.sqrt(float(np.prod(np.maximum(extent, side))) / len(which)))
        n_x, n_y = (int(s) + 1 for s in extent / side)
        real[k], whole[k] = (side, *low, largest[k]), (n_x, n_y, base)
        base += n_x * n_y + 1
    return Grids(real, whole, np.empty(base, np.int64))
