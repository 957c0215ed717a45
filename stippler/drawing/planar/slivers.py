"""Pieces too thin to hold a dot go to the neighbour they share most border with."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from stippler.drawing.planar.assemble import Edges, arcs_of_edges, curves_of, replaced
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import OUTSIDE, Arc, PlanarMap, Segments
from stippler.drawing.planar.rings import HalfEdge, Part

LEAST_AREA_MM2 = 1e-4
LEAST_WIDTH_MM = 0.002

_MOST_ROUNDS = 12


def is_sliver(part: Part) -> bool:
    """Return whether a polygon is too small or thin to be a place."""
    area, length = part.polygon.area, part.polygon.length
    return bool(area < LEAST_AREA_MM2 or 2.0 * area < LEAST_WIDTH_MM * length)


def without_slivers(after: PlanarMap, areas: Iterable[int]) -> PlanarMap:
    """Give the slivers of some areas, and those that this makes, to neighbours."""
    todo = set(areas) - {OUTSIDE}
    for _ in range(_MOST_ROUNDS):
        given: dict[HalfEdge, int] = {}
        for area in sorted(todo):
            for part in after.parts(area):
                if is_sliver(part) and not any(h in given for h in _twins(part)):
                    to = _neighbour(after, part, area)
                    if to != area:
                        given.update(dict.fromkeys(part.half_edges, to))
        if not given:
            return after
        after = give(after, given)
        todo |= set(given.values())
    return after


def _twins(part: Part) -> list[HalfEdge]:
    """Return the half-edges across the border: a part and its neighbour never change in one go."""
    return [(k, not forward) for k, forward in part.half_edges]


def _neighbour(after: PlanarMap, part: Part, area: int) -> int:
    length: dict[int, float] = {}
    for k, forward in part.half_edges:
        arc = after.arcs[k]
        beyond = arc.right if forward else arc.left
        run = float(np.hypot(*np.diff(arc.path.vertices, axis=0).T.astype(np.float64)).sum())
        if beyond not in (OUTSIDE, area):
            length[beyond] = length.get(beyond, 0.0) + run
    return max(length, key=lambda k: (length[k], -k)) if length else area


def give(before: PlanarMap, given: dict[HalfEdge, int], next_area: int | None = None) -> PlanarMap:
    """Return the map in which the faces at some half-edges' left belong to other areas."""
    sides = {k: [a.left, a.right] for k, a in before.arcs.items()}
    for (k, forward), area in given.items():
        sides[k][0 if forward else 1] = area
    return with_sides(before, {k: (x, y) for k, (x, y) in sides.items()}, next_area)


def with_sides(
    before: PlanarMap, sides: dict[int, tuple[int, int]], next_area: int | None = None
) -> PlanarMap:
    """Return the map with other areas beside its arcs; arcs between one area and itself are gone.

    Arcs that then run on into each other become one.
    """
    changed = {k for k, s in sides.items() if s != (before.arcs[k].left, before.arcs[k].right)}
    gone = {k for k, (left, right) in sides.items() if left == right}
    ends = {e for k in gone for e in (before.arcs[k].start, before.arcs[k].end)}
    taken = [
        k
        for k, a in before.arcs.items()
        if k in changed or k in gone or a.start in ends or a.end in ends
    ]
    made = [
        Arc(before.arcs[k].path, *sides.get(k, (before.arcs[k].left, before.arcs[k].right)))
        for k in taken
        if k not in gone
    ]
    chosen = set(taken)
    fixed = {e for k, a in before.arcs.items() if k not in chosen for e in (a.start, a.end)}
    return replaced(before, taken, arcs_of_edges(_edges_of(made), fixed), next_area)


def _edges_of(arcs: list[Arc]) -> Edges:

    all_of = Segments.of(arcs)
    paths: list[Path] = [a.path for a in arcs]
    curve, t0, t1, cubics = curves_of(paths, len(all_of.xy))
    return Edges(all_of.xy, all_of.left, all_of.right, curve, t0, t1, cubics)
