"""Dots that change hands when borders move: those in the strip that a border swept, no others."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.planar.path import UNIT_MM, Points
from stippler.drawing.planar.planar_map import Arc, AreaIndex, PlanarMap, Segments

Ints = NDArray[np.int64]


def dots_in_strip(
    before: PlanarMap, after: PlanarMap, position_mm: Points, area: Ints | NDArray[np.int32]
) -> tuple[NDArray[np.intp], Ints]:
    """Return which dots lie in another area after an edit, and in which.

    Parameters
    ----------
    before, after : PlanarMap
        `after` comes from `before` by edits.
    position_mm : (n, 2) float64
    area : (n,) int
        Where the dots lie before.

    Returns
    -------
    which : (k,) intp
        In order.
    area : (k,) int64

    Notes
    -----
    Only segments that changed are looked at: where a ray to a point crosses them, what they say
    now less what they said before is what changes.
    """
    changed = jumps_of(after.changes(before))
    if not len(changed.xy):
        return np.empty(0, np.intp), np.empty(0, np.int64)
    ends = changed.xy.reshape(-1, 2)
    (x0, y0), (x1, y1) = ends.min(axis=0) * UNIT_MM, ends.max(axis=0) * UNIT_MM
    x, y = position_mm[:, 0], position_mm[:, 1]
    near = np.flatnonzero((x >= x0) & (x <= x1))
    near = near[(y[near] >= y0) & (y[near] <= y1)]
    jump = AreaIndex(changed, 0).area_at(position_mm[near])
    moved = jump != 0
    which = near[moved]
    return which, area[which] + jump[moved]


def jumps_of(pairs: Mapping[int, tuple[Arc | None, Arc | None]]) -> Segments:
    """Return the segments that changed: new ones, and old ones with their sides exchanged.

    What cancels out is left out.
    """
    old = Segments.of([a for a, _ in pairs.values() if a is not None])
    new = Segments.of([a for _, a in pairs.values() if a is not None])
    xy = np.concatenate([new.xy, old.xy])
    left = np.concatenate([new.left, old.right])
    right = np.concatenate([new.right, old.left])
    back = (xy[:, 0] > xy[:, 2]) | ((xy[:, 0] == xy[:, 2]) & (xy[:, 1] > xy[:, 3]))
    xy = np.where(back[:, None], xy[:, [2, 3, 0, 1]], xy)
    jump = np.where(back, right - left, left - right)
    order = np.lexsort(xy.T)
    xy, jump = xy[order], jump[order]
    first = np.flatnonzero(np.r_[True, (xy[1:] != xy[:-1]).any(axis=1)][: len(xy)])
    total = np.add.reduceat(jump, first) if len(first) else jump
    kept = first[total != 0]
    return Segments(
        np.ascontiguousarray(xy[kept]), total[total != 0], np.zeros(len(kept), np.int64)
    )
