"""What dots under a brush see through the borders of their area."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import shapely
from shapely.geometry import MultiLineString, Polygon

from stippler.drawing.document import Document
from stippler.stippling.border_policies import policies_of, polygons_in, with_slits

Box = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Sight:
    """Parts of other areas that are seen from one in a box.

    Attributes
    ----------
    areas : tuple of int
    parts : tuple of polygon
    walls : tuple of MultiLineString
    """

    areas: tuple[int, ...]
    parts: tuple[shapely.Geometry, ...]
    walls: tuple[MultiLineString, ...]

    def joined_to(self, outlines: Sequence[Polygon]) -> list[Polygon]:
        """Return the outlines of an area in the box with what is seen; walls are slits in them."""
        whole = polygons_in(shapely.union_all([*outlines, *self.parts]))
        return [p for p in shapely.get_parts(with_slits(whole, self.walls)) if p.area > 0.0]


def seen_around(document: Document, area: int, around: Box) -> Sight | None:
    """Return what is seen from an area in a box; None where that is nothing but itself."""
    policies = policies_of(document)
    if not policies.may_see_through:
        return None
    window = shapely.box(*around)
    areas, parts, walls = list[int](), list[shapely.Geometry](), list[MultiLineString]()
    for k, borders in policies.seen_from((area,)).items():
        near = [b for b in borders if shapely.intersects(b.through, window)]
        if near:
            areas.append(k)
            parts.append(shapely.clip_by_rect(policies.partition.part_of(k), *around))
            walls += [b.walls for b in near]
    return Sight(tuple(areas), tuple(parts), tuple(walls)) if areas else None
