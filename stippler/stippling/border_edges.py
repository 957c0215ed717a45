"""The borders of compartments as directed edges, inside on the left (y up).

Straight runs of edges are one edge each. Where holes touch each other or the outer border, edges
are linked so that walking along them never crosses over: each edge is followed by the one that
bounds the same corner of the inside.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

Floats = NDArray[np.float64]
Rows = NDArray[np.int32]

_STRAIGHT = 8 * 2.0**-53
"""A corner nearer than this share of all coordinates to the line past it is none."""


@dataclass(frozen=True, slots=True, eq=False)
class BorderEdges:
    """Edges of all compartments, those of one together.

    Attributes
    ----------
    edge : (e, 4) float64
        From where to where.
    next_edge, compartment : (e,) int32
    """

    edge: Floats
    next_edge: Rows
    compartment: Rows

    @classmethod
    def of(cls, polygons: list[Polygon]) -> BorderEdges:
        """Take the rings of valid polygons apart."""
        xy, ring, owner = _corners_of(np.array(polygons, object))
        following = _following(ring)
        keep = ~_is_straight(xy, following)
        keep |= (np.bincount(ring, keep) < 3)[ring]  # as thin as rounding
        xy, ring = xy[keep], ring[keep]
        following = _following(ring)
        edge, compartment = np.hstack([xy, xy[following]]), owner[ring].astype(np.int32)
        with_holes = np.flatnonzero([len(p.interiors) > 0 for p in polygons])
        if len(with_holes):
            touching = _touching_rings(polygons, with_holes)
            if touching:
                edge, following, compartment = _split(edge, following, compartment, touching)
                _link_by_corner(edge, following, compartment)
        return cls(np.ascontiguousarray(edge), following.astype(np.int32), compartment)


def _corners_of(polygons: NDArray[np.object_]) -> tuple[Floats, NDArray[np.intp], NDArray[np.intp]]:
    """Return corners, each once, inside on the left; their ring; and the polygon of each ring."""
    rings, owner = shapely.get_rings(polygons, return_index=True)
    xy, ring = shapely.get_coordinates(rings, return_index=True)
    is_new = np.ones(len(xy), np.bool_)
    is_new[1:] = (xy[1:] != xy[:-1]).any(axis=1) | (ring[1:] != ring[:-1])
    is_new[np.flatnonzero(np.append(ring[1:] != ring[:-1], True))] = False  # the first once more
    xy, ring = xy[is_new], ring[is_new]
    is_hole = np.ones(len(rings), np.bool_)
    is_hole[np.flatnonzero(np.diff(owner, prepend=-1))] = False
    turned = np.flatnonzero(shapely.is_ccw(rings) == is_hole)
    if len(turned):
        count = np.bincount(ring, minlength=len(rings))
        first = np.cumsum(count) - count
        at = np.arange(len(xy))
        back = np.isin(ring, turned)
        at[back] = (2 * first + count - 1)[ring[back]] - at[back]
        xy = xy[at]
    return xy, ring, owner


def _following(ring: NDArray[np.intp]) -> NDArray[np.intp]:
    """Return for each corner the number of the next one of its ring."""
    out = np.arange(1, len(ring) + 1)
    starts = np.flatnonzero(np.diff(ring, prepend=-1))
    out[np.append(starts[1:], len(ring)) - 1] = starts
    return out


def _is_straight(xy: Floats, following: NDArray[np.intp]) -> NDArray[np.bool_]:
    """Tell which corners lie on the straight way from the one before to the one after."""
    before = np.empty_like(following)
    before[following] = np.arange(len(xy))
    du, dv = xy - xy[before], xy[following] - xy
    length = np.hypot(*du.T) + np.hypot(*dv.T)
    scale = np.abs(xy).max(initial=0.0)
    cross = np.abs(du[:, 0] * dv[:, 1] - du[:, 1] * dv[:, 0])
    straight: NDArray[np.bool_] = cross <= _STRAIGHT * scale * length
    straight &= (du * dv).sum(axis=1) > 0.0
    return straight


def _touching_rings(polygons: list[Polygon], with_holes: NDArray[np.intp]) -> dict[int, Floats]:
    """Return by polygon the places where two of its rings touch."""
    found = {}
    for c in with_holes:
        rings = shapely.get_rings(polygons[c])
        a, b = shapely.STRtree(rings).query(rings, predicate="intersects")
        a, b = a[a < b], b[a < b]
        if len(a):
            at = shapely.get_coordinates(shapely.intersection(rings[a], rings[b]))
            found[int(c)] = np.unique(at, axis=0)
    return found


def _split(
    edge: Floats, following: NDArray[np.intp], compartment: Rows, touching: dict[int, Floats]
) -> tuple[Floats, NDArray[np.intp], Rows]:
    """Make corners of the places where rings touch."""
    edges, links, owners = list(edge), list(following), list(compartment)
    for c, places in touching.items():
        mine = [int(e) for e in np.flatnonzero(compartment == c)]
        for x, y in places:
            here = shapely.points(x, y)
            lines = shapely.linestrings([edges[e].reshape(2, 2) for e in mine])
            for e in np.array(mine)[shapely.distance(lines, here) <= 1e-12 * shapely.length(lines)]:
                x0, y0, x1, y1 = edges[e]
                if (x0, y0) != (x, y) != (x1, y1):
                    edges[e] = np.array([x0, y0, x, y])
                    edges.append(np.array([x, y, x1, y1]))
                    links.append(links[e])
                    owners.append(c)
                    links[e] = len(edges) - 1
                    mine.append(len(edges) - 1)
    order = np.argsort(np.array(owners), kind="stable")
    place = np.empty(len(order), np.intp)
    place[order] = np.arange(len(order))
    return (
        np.array(edges)[order],
        place[np.array(links)[order]],
        np.array(owners, np.int32)[order],
    )


def _link_by_corner(edge: Floats, following: NDArray[np.intp], compartment: Rows) -> None:
    """Let each edge that ends where several begin be followed by the next one clockwise."""
    order = np.lexsort((edge[:, 1], edge[:, 0], compartment))
    starts = np.column_stack([compartment, edge[:, :2]])[order]
    group = np.cumsum(np.append(False, (starts[1:] != starts[:-1]).any(axis=1)))
    before = np.empty_like(following)
    before[following] = np.arange(len(edge))
    crowded = np.flatnonzero(np.bincount(group) > 1)
    for g in crowded:
        leaving = order[group == g]
        arriving = before[leaving]
        out = np.arctan2(*(edge[leaving, 2:] - edge[leaving, :2]).T[::-1])
        for e in arriving:
            back = np.arctan2(*(edge[e, :2] - edge[e, 2:])[::-1])
            following[e] = leaving[np.argmin((back - out) % (2 * np.pi))]
