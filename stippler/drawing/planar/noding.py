"""Splitting segments where they meet, on the grid, so that afterwards they only share ends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.errors import GeometryError

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

_MOST_ROUNDS = 40
_MOST_SAME = 2
"""How often the same segments may come out of splitting: then no end comes."""

_ROOM = 256


def contacts(xy: Ints, is_new: Bools) -> tuple[Ints, Ints]:
    """Return which segments have to be split, and where; see `find_contacts`."""
    from stippler.kernels.planar.contacts import find_contacts

    order = np.argsort(np.minimum(xy[:, 0], xy[:, 2]), kind="stable")
    room = _ROOM + len(xy) // 4
    while True:
        which, at = np.empty(room, np.int64), np.empty((room, 2), np.int64)
        n = int(find_contacts(xy, order, is_new, which, at))
        if n <= room:
            return which[:n], at[:n]
        room = n


def pairs_beside(xy: Ints) -> int:
    """Return how many pairs of segments lie beside each other in x: what `contacts` looks at."""
    low, high = np.minimum(xy[:, 0], xy[:, 2]), np.maximum(xy[:, 0], xy[:, 2])
    low.sort()
    return int(np.searchsorted(low, high, "right").sum()) - len(xy) * (len(xy) + 1) // 2


def one_way(xy: Ints) -> Ints:
    """Return segments that all run from the lower of their ends, in an order of points."""
    swap = (xy[:, 0] > xy[:, 2]) | ((xy[:, 0] == xy[:, 2]) & (xy[:, 1] > xy[:, 3]))
    return np.where(swap[:, None], xy[:, [2, 3, 0, 1]], xy)


def node_segments(xy: Ints, is_new: Bools) -> tuple[Ints, Ints, Bools]:
    """Split segments until none meets another but at shared ends.

    Parameters
    ----------
    xy : (m, 4) int64
    is_new : (m,) bool
        Pairs of which neither is new are taken to keep clear of each other.

    Returns
    -------
    xy : (n, 4) int64
        Pieces, those of a segment one after the other and in its direction.
    parent : (n,) int64
        The segment each is a piece of.
    is_moved : (n,) bool
        Whether it is new or was split.

    Raises
    ------
    GeometryError
        If no end is found: borders too crowded for the grid.
    """
    parent = np.arange(len(xy))
    moved = is_new.copy()
    fresh = is_new
    known: list[bytes] = []
    for k in range(_MOST_ROUNDS):
        which, at = contacts(xy, fresh)
        if not len(which):
            return xy, parent, moved
        if k > 1:  # many more rounds would come: look whether they lead anywhere
            known.append(np.unique(one_way(xy), axis=0).tobytes())
            if known.count(known[-1]) == _MOST_SAME:
                break
        xy, split_of = _split(xy, which, at)
        was_split = np.zeros(len(parent), np.bool_)
        was_split[which] = True
        parent, fresh = parent[split_of], was_split[split_of]
        moved = moved[split_of] | fresh
    raise GeometryError("lie too close together here", "borders", "draw with more room")


def _split(xy: Ints, which: Ints, at: Ints) -> tuple[Ints, Ints]:
    """Split segments at points, in the order of the points along them."""
    m = len(xy)
    owner = np.concatenate([np.arange(m), which])
    ends = np.concatenate([xy[:, 2:], at])
    away = (ends - xy[owner, :2]).astype(np.float64)
    direction = (xy[owner, 2:] - xy[owner, :2]).astype(np.float64)
    share = (away * direction).sum(axis=1)
    share[:m] = np.inf
    order = np.lexsort((ends[:, 0], ends[:, 1], share, owner))  # a point met twice is one
    owner, ends = owner[order], ends[order]
    first = np.r_[True, owner[1:] != owner[:-1]]
    starts = np.empty_like(ends)
    starts[1:] = ends[:-1]
    starts[first] = xy[owner[first], :2]
    real = (starts != ends).any(axis=1)
    return np.hstack([starts, ends])[real], owner[real]
