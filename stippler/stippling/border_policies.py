"""What the borders of a drawing's areas are to dots: pieces say it themselves, or else their areas.

*Through* holds between two areas where a piece of the border between them says so, or where both
say so and share a style. All else between two areas is a wall to each, or bleeds.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias
from weakref import WeakKeyDictionary

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiLineString, MultiPolygon

from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Outline, Partition
from stippler.drawing.planar.planar_map import Arc
from stippler.drawing.style import AUTOMATIC, BLEED, THROUGH
from stippler.stippling.halftone_area import edges_of
from stippler.stippling.part_of_area import pattern_of

Edges = NDArray[np.float64]
Pieces: TypeAlias = tuple[tuple[str, MultiLineString], ...]
"""Pieces of borders, and what they are to dots."""

ON_LINE_MM = 1e-6
"""A segment whose middle is nearer to a piece of a border lies on it."""

SLIT_MM = 1e-5
"""Half the width of a wall within areas that are drawn as one elsewhere."""


@dataclass(frozen=True, slots=True, eq=False)
class Shared:
    """The border between two areas of which each may see others.

    Attributes
    ----------
    through : MultiLineString, mm
        Where they see each other.
    walls : MultiLineString, mm
        Where they do not.
    bleeding : MultiLineString, mm
        What of that bleeds to one of them, or both.
    """

    through: MultiLineString
    walls: MultiLineString
    bleeding: MultiLineString

    @property
    def closed(self) -> MultiLineString:
        """Walls that bleed to neither."""
        return merged(edges_in(shapely.difference(self.walls, self.bleeding)))


class BorderPolicies:
    """The borders of a drawing as dots meet them.

    Parameters
    ----------
    drawing : Drawing
    partition : Partition
        Its own.
    """

    def __init__(self, drawing: Drawing, partition: Partition) -> None:
        self.drawing, self.partition = drawing, partition
        self._pieces = pieces_of(drawing)
        self._between: dict[tuple[int, int], Shared | None] = {}

    @cached_property
    def seeing(self) -> list[int]:
        """Areas that may see others through their borders, by their numbers."""
        lines = [line for policy, line in self._pieces if policy == THROUGH]
        areas = self.drawing.areas
        found = {k for k in areas if self.drawing.border_of(k) == THROUGH}
        if lines:
            tree = shapely.STRtree(lines)
            for k in areas:
                part = self.partition.part_of(k)
                if len(tree.query(part, predicate="dwithin", distance=ON_LINE_MM)):
                    found.add(k)
        return sorted(k for k in found if pattern_of(self.drawing, k) is None)

    def own_of(self, areas: Sequence[int]) -> Pieces:
        """Return pieces along some areas that are something else than the first area says."""
        first = self.drawing.border_of(areas[0])
        found = list(self._pieces)
        for k in areas[1:]:
            border = self.drawing.border_of(k)
            if _alone(border) != _alone(first):
                edges = edges_of(self.partition.part_of(k))
                found.insert(0, (border, merged(edges[policies_at(edges, self._pieces) == ""])))
        around = shapely.union_all([self.partition.part_of(k) for k in areas])
        return tuple(
            (policy, line) for policy, line in found
            if shapely.dwithin(around, line, ON_LINE_MM)
        )  # fmt: skip

    def between(self, a: int, b: int) -> Shared | None:
        """Return the border between two areas that may see others, if they have one."""
        key = (min(a, b), max(a, b))
        if key not in self._between:
            self._between[key] = self._shared(*key) if {a, b} <= set(self.seeing) else None
        return self._between[key]

    def _shared(self, a: int, b: int) -> Shared | None:
        drawing, part_of = self.drawing, self.partition.part_of
        edges = edges_in(shapely.intersection(part_of(a), part_of(b)))
        policies = policies_at(edges, self._pieces)
        alike = drawing.areas[a].style == drawing.areas[b].style
        both = drawing.border_of(a) == drawing.border_of(b) == THROUGH
        is_through = policies == THROUGH
        if alike and both:
            is_through |= policies == ""
        if not len(edges):
            return None
        bleeds = policies == BLEED
        if BLEED in (drawing.border_of(a), drawing.border_of(b)):
            bleeds |= policies == ""
        return Shared(*(merged(edges[some]) for some in (is_through, ~is_through, bleeds)))

    def pairs(self, areas: Collection[int]) -> Iterable[tuple[int, int, Shared]]:
        """Yield which of some areas see each other, and the border between them."""
        for a, b, shared in self._borders(areas):
            if not shared.through.is_empty:
                yield a, b, shared

    def _borders(self, areas: Collection[int]) -> Iterable[tuple[int, int, Shared]]:
        """Yield which of some areas that may see others meet, and the border between them."""
        if len(areas) > 1:
            mine = set(areas)
            yield from (one for one in self._all_borders if {one[0], one[1]} <= mine)

    @cached_property
    def _all_borders(self) -> list[tuple[int, int, Shared]]:
        found = list[tuple[int, int, Shared]]()
        if not self.may_see_through:
            return found
        seeing = self.seeing
        parts = [self.partition.part_of(k) for k in seeing]
        first, second = shapely.STRtree(parts).query(parts, predicate="intersects")
        for i, j in sorted(zip(first.tolist(), second.tolist(), strict=True)):
            if i < j and (shared := self.between(seeing[i], seeing[j])) is not None:
                found.append((seeing[i], seeing[j], shared))
        return found

    @cached_property
    def _all_pairs(self) -> list[tuple[int, int, Shared]]:
        return list(self.pairs(self.seeing))

    def seen_from(self, areas: Sequence[int]) -> dict[int, tuple[Shared, ...]]:
        """Return which areas are seen from some, through which of their borders."""
        mine = set(areas)
        around: dict[int, tuple[Shared, ...]] = {}
        if mine & set(self.seeing):
            for a, b, shared in self._all_pairs:
                if (a in mine) != (b in mine):
                    other = b if a in mine else a
                    around[other] = (*around.get(other, ()), shared)
        return around

    @property
    def may_see_through(self) -> bool:
        """Whether there are areas of which one may see another."""
        return len(self.seeing) > 1

    def joined(self, areas: Sequence[int], *, drawn: bool = True) -> list[tuple[int, ...]]:
        """Return which of some areas are drawn as one, each group where its first area is.

        Those of one style that see each other through some of the border between them. Where a
        border between two bleeds the dots of each run on under those of the other, which is no
        one outline: those are not `drawn` together.
        """
        style = {k: self.drawing.areas[k].style for k in areas if k in self.drawing.areas}
        apart = set[tuple[int, int]]()
        if drawn:
            apart = {(a, b) for a, b, one in self._borders(areas) if not one.bleeding.is_empty}
        return self.linked(areas, lambda a, b: style[a] == style[b], apart)

    def linked(
        self,
        areas: Sequence[int],
        count: Callable[[int, int], bool] = lambda a, b: True,
        apart: Collection[tuple[int, int]] = (),
    ) -> list[tuple[int, ...]]:
        """Return which of some areas see each other, as far as that is to count.

        Of pairs that are to be `apart` no group has both.
        """
        group = {k: k for k in areas}
        for a, b, _ in self.pairs(areas):
            old, new = group[b], group[a]
            meet = {old, new}
            if old == new or not count(a, b) or any({group[i], group[j]} == meet for i, j in apart):
                continue
            group = {j: new if g == old else g for j, g in group.items()}
        found: dict[int, list[int]] = {}
        for k in areas:
            found.setdefault(group[k], []).append(k)
        return [tuple(ids) for ids in found.values()]

    def part_of_all(self, areas: Sequence[int]) -> Outline:
        """Return what several areas own together, parted by the walls that are between them."""
        part = part_of_all(self.partition, areas)
        if len(areas) == 1:
            return part
        walls = [shared.walls for _, _, shared in self._borders(areas)]
        return with_slits(part, walls)


_known: WeakKeyDictionary[Document, tuple[object, BorderPolicies]] = WeakKeyDictionary()


def policies_of(document: Document) -> BorderPolicies:
    """Return what a document's borders are to dots; the same until areas, styles or borders change.

    Brushes ask with each stamp: what is the same object is found equal at once.
    """
    drawing = document.drawing
    tables = drawing.areas, drawing.borders, drawing.styles, drawing.patterns
    known = _known.get(document)
    if known is None or known[0] != tables:
        made = BorderPolicies(drawing, document.partition)
        known = tuple([dict(table) for table in tables]), made
        _known[document] = known
    return known[1]


def pieces_of(drawing: Drawing) -> Pieces:
    """Return all pieces of borders that say themselves what they are to dots."""
    found: dict[str, list[Edges]] = {}
    for arc in drawing.borders.values():
        if not (isinstance(arc, Arc) and arc.policies):
            continue
        at = arc.path.points_mm
        for first, last, policy in arc.policies:
            edges = np.hstack([at[first:last], at[first + 1 : last + 1]])
            found.setdefault(policy, []).append(edges)
    return tuple((policy, merged(np.concatenate(edges))) for policy, edges in found.items())


def part_of_all(partition: Partition, areas: Sequence[int]) -> Outline:
    """Return what several areas own together."""
    if len(areas) == 1:
        return partition.part_of(areas[0])
    return polygons_in(shapely.union_all([partition.part_of(k) for k in areas]))


def with_slits(part: Outline, walls: Sequence[MultiLineString]) -> Outline:
    """Return an outline in which no dot sees across some lines."""
    walls = [wall for wall in walls if not wall.is_empty]
    if not walls:
        return part
    slits = shapely.buffer(
        shapely.union_all(walls), SLIT_MM, cap_style="flat", join_style="mitre", mitre_limit=2.0
    )
    return polygons_in(shapely.difference(part, slits))


def policies_at(edges: Edges, pieces: Pieces) -> NDArray[np.object_]:
    """Return what pieces say of edges (m, 4) that lie on them; else an empty text."""
    found = np.full(len(edges), "", object)
    middle = shapely.points((edges[:, :2] + edges[:, 2:]) / 2.0) if len(edges) else []
    for policy, line in pieces:
        shapely.prepare(line)
        found[shapely.dwithin(middle, line, ON_LINE_MM)] = policy
    return found


def _alone(border: str) -> str:
    """Return what a border is where nobody is seen through it."""
    return AUTOMATIC if border == THROUGH else border


def edges_in(lines: shapely.Geometry) -> Edges:
    """Return the segments (m, 4) of the lines in a geometry."""
    parts = shapely.get_parts(shapely.get_parts(lines))
    parts = parts[shapely.get_type_id(parts) == 1]
    corners = [shapely.get_coordinates(one) for one in parts]
    if not corners:
        return np.empty((0, 4))
    return np.concatenate([np.hstack((c[:-1], c[1:])) for c in corners])


def merged(edges: Edges) -> MultiLineString:
    """Return edges (m, 4) joined end to end."""
    if not len(edges):
        return MultiLineString()
    lines = shapely.multilinestrings(shapely.linestrings(edges.reshape(-1, 2, 2)))
    found: MultiLineString = shapely.multilinestrings(shapely.get_parts(shapely.line_merge(lines)))
    return found


def polygons_in(shape: shapely.Geometry) -> Outline:
    """Return the polygons of a shape as one."""
    parts = shapely.get_parts(shape)
    parts = parts[shapely.get_type_id(parts) == 3]
    return parts[0] if len(parts) == 1 else MultiPolygon(parts.tolist())
