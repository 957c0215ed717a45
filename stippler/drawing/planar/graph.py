"""Edges that meet only in nodes, and what their sides face."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from stippler.errors import GeometryError

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

UNKNOWN = -2
_SHIFT = 30


def number_nodes(ends: Ints) -> tuple[Ints, Ints]:
    """Return the distinct points of (k, 2), and the number of each point given."""
    key = ((ends[:, 0] + (1 << (_SHIFT - 1))) << _SHIFT) + ends[:, 1] + (1 << (_SHIFT - 1))
    _, first, number = np.unique(key, return_index=True, return_inverse=True)
    return ends[first], number.reshape(-1)


@dataclass(frozen=True, slots=True, eq=False)
class Graph:
    """Distinct edges between distinct nodes.

    Attributes
    ----------
    nodes : (n, 2) int64
    a, b : (m,) int64
        Ends of each edge, as in the segment it was first given as.
    piece : (m,) int64
        That segment.
    left, right : (m,) int64
        Areas beside it before the edit; `UNKNOWN` where no old border lies.
    net : (m,) int64
        Winding of the outline left of it, less that right of it.
    is_line : (m,) bool
        Whether the outline or line runs along it.
    """

    nodes: Ints
    a: Ints
    b: Ints
    piece: Ints
    left: Ints
    right: Ints
    net: Ints
    is_line: Bools

    @classmethod
    def of(cls, xy: Ints, left: Ints, right: Ints, net: Ints, is_line: Bools) -> Self:
        """Lay segments that coincide onto each other; what cancels out is no border any more."""
        nodes, number = number_nodes(xy.reshape(-1, 2))
        a, b = number.reshape(-1, 2).T
        low, high = np.minimum(a, b), np.maximum(a, b)
        _, first, edge = np.unique(low * len(nodes) + high, return_index=True, return_inverse=True)
        edge = edge.reshape(-1)
        flipped = a != a[first][edge]
        sums = np.zeros(len(first), np.int64)
        np.add.at(sums, edge, np.where(flipped, -net, net))
        lines = np.zeros(len(first), np.bool_)
        np.logical_or.at(lines, edge, is_line)
        beside = _cancelled(edge, len(first), left, right, flipped)
        return cls(nodes, a[first], b[first], first, *beside, sums, lines)

    def around(self) -> tuple[Ints, Ints]:
        """Return the half-edges that leave each node, in order: where each begins, and they."""
        from stippler.kernels.planar.faces import sort_around

        ends = np.concatenate([self.a, self.b])
        start = np.r_[0, np.cumsum(np.bincount(ends, minlength=len(self.nodes)))]
        around = np.full(len(ends), -1, np.int64)
        sort_around(self.nodes, self.a, self.b, start, around)
        return start, around

    def segments(self) -> Ints:
        """Return (m, 4) coordinates of the edges."""
        return np.hstack([self.nodes[self.a], self.nodes[self.b]])


def _cancelled(edge: Ints, n: int, left: Ints, right: Ints, flipped: Bools) -> tuple[Ints, Ints]:
    """Return what lies beside each edge when areas between borders that coincide are gone."""
    lefts, rights = np.where(flipped, right, left), np.where(flipped, left, right)
    known = np.flatnonzero(left != UNKNOWN)
    out_left, out_right = np.full(n, UNKNOWN), np.full(n, UNKNOWN)
    out_left[edge[known]], out_right[edge[known]] = lefts[known], rights[known]
    count = np.bincount(edge[known], minlength=n)
    for e in np.flatnonzero(count > 1).tolist():
        mine = known[edge[known] == e]
        l_rest, r_rest = lefts[mine].tolist(), rights[mine].tolist()
        for area in list(l_rest):
            if area in r_rest:
                l_rest.remove(area)
                r_rest.remove(area)
        if len(l_rest) > 1:
            raise GeometryError("would lie across each other", "borders")
        out_left[e] = l_rest[0] if l_rest else UNKNOWN
        out_right[e] = r_rest[0] if r_rest else UNKNOWN
    return out_left, out_right
