"""The polygons that an area consists of, traced along its arcs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import Polygon

from stippler.drawing.planar.path import UNIT_MM
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.drawing.planar.planar_map import Arc

HalfEdge = tuple[int, bool]
"""An arc and whether it is run forwards; what it belongs to lies on its left."""

Node = tuple[int, int]


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """One polygon of an area, in mm, and the half-edges of its outer ring and its holes."""

    polygon: Polygon
    rings: tuple[tuple[HalfEdge, ...], ...]

    @property
    def half_edges(self) -> list[HalfEdge]:
        """Those of all rings."""
        return [h for ring in self.rings for h in ring]


def parts_of(area: int, arcs: Mapping[int, Arc]) -> list[Part]:
    """Trace an area's polygons.

    Raises
    ------
    GeometryError
        If its arcs do not close.
    """
    shells: list[tuple[float, NDArray[np.float64], tuple[HalfEdge, ...]]] = []
    holes: list[tuple[NDArray[np.float64], tuple[HalfEdge, ...]]] = []
    for ring in _rings(area, arcs):
        at = np.concatenate([_run(arcs, h)[:-1] for h in ring])
        at = np.vstack([at, at[:1]])
        size = _signed_area(at)
        if size > 0:
            shells.append((size, at * UNIT_MM, tuple(ring)))
        elif size < 0:  # a line out and back encloses nothing
            holes.append((at * UNIT_MM, tuple(ring)))
    shells.sort(key=lambda shell: shell[0])
    owned = _owners(shells, holes)
    return [
        Part(
            Polygon(at, [holes[k][0] for k in owned[i]]),
            (ring, *(holes[k][1] for k in owned[i])),
        )
        for i, (_, at, ring) in enumerate(shells)
    ]


def _owners(
    shells: list[tuple[float, NDArray[np.float64], tuple[HalfEdge, ...]]],
    holes: list[tuple[NDArray[np.float64], tuple[HalfEdge, ...]]],
) -> list[list[int]]:
    """Return which holes lie in each shell: each in the smallest that holds it."""
    owned: list[list[int]] = [[] for _ in shells]
    if len(shells) == 1:
        return [list(range(len(holes)))]
    if holes and not shells:
        raise GeometryError("has holes and no outline", "area")
    if not holes:
        return owned
    polygons = shapely.polygons([shapely.linearrings(at) for _, at, _ in shells])
    inner = shapely.polygons([shapely.linearrings(at) for at, _ in holes])
    tree = shapely.STRtree(polygons)
    hole, shell = tree.query(inner, predicate="covered_by")
    sizes = shapely.area(inner) * (1.0 + 1e-11)  # a line's loop is hole and outline at once
    larger = shapely.area(polygons)[shell] > sizes[hole]
    hole, shell = hole[larger], shell[larger]
    for k in range(len(holes)):
        holding = shell[hole == k]
        if not len(holding):
            raise GeometryError("has a hole outside of its outline", "area")
        owned[int(holding.min())].append(k)
    return owned


def _run(arcs: Mapping[int, Arc], h: HalfEdge) -> NDArray[np.int64]:
    at = arcs[h[0]].path.vertices
    return at if h[1] else at[::-1]


def _signed_area(at: NDArray[np.int64]) -> float:
    x, y = (at - at[0]).T.astype(np.float64)
    return 0.5 * float(np.dot(x[:-1], y[1:]) - np.dot(x[1:], y[:-1]))


def _rings(area: int, arcs: Mapping[int, Arc]) -> list[list[HalfEdge]]:
    """Walk around the area's faces; rings that touch themselves are taken apart."""
    leaving: dict[Node, list[HalfEdge]] = {}
    half_edges: list[HalfEdge] = []
    for k, arc in arcs.items():
        if arc.left == area:
            half_edges.append((k, True))
            leaving.setdefault(arc.start, []).append((k, True))
        if arc.right == area:
            half_edges.append((k, False))
            leaving.setdefault(arc.end, []).append((k, False))
    used: set[HalfEdge] = set()
    rings: list[list[HalfEdge]] = []
    for first in half_edges:
        if first in used:
            continue
        walk = [first]
        used.add(first)
        while (h := _next(walk[-1], leaving, arcs)) != first:
            if h is None or h in used:
                raise GeometryError("has a border that does not close", "area")
            used.add(h)
            walk.append(h)
        rings += _simple(walk, arcs)
    return rings


def _tip(arcs: Mapping[int, Arc], h: HalfEdge) -> Node:
    return arcs[h[0]].end if h[1] else arcs[h[0]].start


def _next(
    h: HalfEdge, leaving: Mapping[Node, list[HalfEdge]], arcs: Mapping[int, Arc]
) -> HalfEdge | None:
    """Return the half-edge that goes on around the same face: the first clockwise from back."""
    node = _tip(arcs, h)
    there = leaving.get(node, [])
    if len(there) < 2:
        return there[0] if there else None
    back = _direction(arcs, (h[0], not h[1]))
    return max(there, key=lambda g: _turn_key(back, _direction(arcs, g)))


def _direction(arcs: Mapping[int, Arc], h: HalfEdge) -> tuple[int, int]:
    at = arcs[h[0]].path.vertices
    (x0, y0), (x1, y1) = (at[0], at[1]) if h[1] else (at[-1], at[-2])
    return int(x1 - x0), int(y1 - y0)


class _turn_key:  # noqa: N801 - a key for sorting
    """Orders directions by their angle from `back`, counter-clockwise, exactly; back itself first.

    The largest is the first one clockwise from back.
    """

    __slots__ = ("back", "half", "to")

    def __init__(self, back: tuple[int, int], to: tuple[int, int]) -> None:
        self.back, self.to = back, to
        c = back[0] * to[1] - back[1] * to[0]
        d = back[0] * to[0] + back[1] * to[1]
        self.half = (1 if c > 0 else 3) if c else (0 if d > 0 else 2)

    def __lt__(self, other: _turn_key) -> bool:
        if self.half != other.half:
            return self.half < other.half
        return self.to[0] * other.to[1] - self.to[1] * other.to[0] > 0


def _simple(walk: list[HalfEdge], arcs: Mapping[int, Arc]) -> list[list[HalfEdge]]:
    """Take a closed walk apart where it comes to a node again."""
    rings: list[list[HalfEdge]] = []
    path: list[HalfEdge] = []
    begun: dict[Node, int] = {}
    for h in walk:
        start = _tip(arcs, (h[0], not h[1]))
        if start in begun:
            k = begun[start]
            rings.append(path[k:])
            for g in path[k:]:
                begun.pop(_tip(arcs, (g[0], not g[1])), None)
            path = path[:k]
        begun[start] = len(path)
        path.append(h)
    return [ring for ring in [*rings, path] if ring]


def sectors(nodes: set[Node], arcs: Mapping[int, Arc]) -> bool:
    """Return whether at each node the area left of each arc is the one right of the next."""
    leaving: dict[Node, list[HalfEdge]] = {node: [] for node in nodes}
    for k, arc in arcs.items():
        if arc.start in leaving:
            leaving[arc.start].append((k, True))
        if arc.end in leaving:
            leaving[arc.end].append((k, False))
    for there in leaving.values():
        first = _direction(arcs, there[0])
        there.sort(key=lambda h: _turn_key(first, _direction(arcs, h)))
        for h, g in zip(there, there[1:] + there[:1], strict=True):
            left = arcs[h[0]].left if h[1] else arcs[h[0]].right
            right = arcs[g[0]].right if g[1] else arcs[g[0]].left
            if left != right:
                return False
    return True
