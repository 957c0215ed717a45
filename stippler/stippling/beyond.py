"""What an area's dots see beyond its border: the neighbours' dots, where that is through.

These stand still. They shape cells and spacing on both sides of the line, so that an area that is
made or moved by itself goes on where its neighbour ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, MultiLineString, Polygon

from stippler.drawing.partition import Outline
from stippler.drawing.style import BLEED
from stippler.stippling.border_policies import (
    BorderPolicies,
    edges_in,
    merged,
    policies_at,
    polygons_in,
    with_slits,
)
from stippler.stippling.borders import strips_beyond

Floats = NDArray[np.float64]

_FEWEST = 0.25  # of the dots that a strip would have: with fewer nothing is there to be seen


@dataclass(frozen=True, slots=True, eq=False)
class Seen:
    """A neighbour that is seen through a border.

    Attributes
    ----------
    line : MultiLineString, mm
        Where it is seen.
    walls : MultiLineString, mm
        Where it is not.
    part : polygon, mm
        What it owns.
    """

    line: MultiLineString
    walls: MultiLineString
    part: Outline


Neighbours: TypeAlias = Sequence[Seen]


@dataclass(frozen=True, slots=True, eq=False)
class Beyond:
    """What is seen of the neighbours from an area.

    Attributes
    ----------
    strips : list of Polygon, mm
        Beyond the lines, a few spacings wide.
    rows : (k,) int
        Which of the neighbours' dots lie in them.
    walls : list of MultiLineString, mm
    cut : tuple of LineString, mm
        Lines beyond which there is hardly a dot: new ones are laid out there, too, and cut off.
    empty : list of Polygon, mm
        The strips beyond those.
    """

    strips: list[Polygon]
    rows: NDArray[np.intp]
    walls: list[MultiLineString]
    cut: tuple[LineString, ...]
    empty: list[Polygon]

    @classmethod
    def of(
        cls, seen: Neighbours, outline: Outline, position_mm: Floats, width_mm: float, fewest: float
    ) -> Beyond:
        """Look as far as a width beyond an outline.

        Parameters
        ----------
        position_mm : (m, 2) float64
            Of the dots around.
        fewest : float
            Dots per mm2; where there are fewer than a quarter of that, there are none to be seen.
        """
        strips, walls, empty = list[Polygon](), list[MultiLineString](), list[Polygon]()
        cut, rows = list[LineString](), [np.empty(0, np.intp)]
        for one in seen:
            mine = _strips_of(one, outline, width_mm)
            found = np.flatnonzero(_in_any(mine, position_mm))
            area = sum(strip.area for strip in mine)
            if len(found) < max(_FEWEST * fewest * area, 1.0):
                empty += mine
                cut += one.line.geoms
            else:
                strips += mine
                rows.append(found)
            walls.append(one.walls)
        return cls(strips, np.unique(np.concatenate(rows)), walls, tuple(cut), empty)

    def joined_to(self, outline: Outline) -> Outline:
        """Return an outline with all strips, parted by the walls there are."""
        strips = [*self.strips, *self.empty]
        if not strips:
            return outline
        return with_slits(polygons_in(shapely.union_all([outline, *strips])), self.walls)

    def seen_with(self, outline: Outline) -> Outline:
        """Return an outline with those strips in which there are dots."""
        return replace(self, empty=[]).joined_to(outline)

    def hold(self, position_mm: Floats) -> NDArray[np.bool_]:
        """Tell which places lie in the strips."""
        return _in_any(self.strips, position_mm)


NOTHING = Beyond([], np.empty(0, np.intp), [], (), [])


def seen_of(
    policies: BorderPolicies, areas: Sequence[int], *, bleeds: bool = True
) -> tuple[Seen, ...]:
    """Return what some areas see of others; walls that bleed are such to who does not bleed."""
    return tuple(
        Seen(
            border.through, border.closed if bleeds else border.walls, policies.partition.part_of(k)
        )
        for k, borders in policies.seen_from(areas).items()
        for border in borders
    )


def bled_onto(policies: BorderPolicies, areas: Sequence[int]) -> tuple[Seen, ...]:
    """Return over which pieces of their border some areas bleed onto others."""
    border, pieces = policies.drawing.border_of(areas[0]), policies.own_of(areas)
    if border != BLEED and all(policy != BLEED for policy, _ in pieces):
        return ()
    part, found = policies.part_of_all(areas), list[Seen]()
    for k in policies.drawing.areas:
        other = policies.partition.part_of(k)
        if k in areas or not shapely.intersects(part, other):
            continue
        edges = edges_in(shapely.intersection(part, other))
        said = policies_at(edges, pieces)
        bleeds = (said == BLEED) | ((said == "") & (border == BLEED))
        if bleeds.any():
            found.append(Seen(merged(edges[bleeds]), MultiLineString(), other))
    return tuple(found)


def _strips_of(one: Seen, outline: Outline, width_mm: float) -> list[Polygon]:
    """Return what of a neighbour lies so near beyond the line that it is seen through."""
    found: list[Polygon] = []
    for line in one.line.geoms:
        for strip in strips_beyond(line, outline, width_mm):
            parts = shapely.get_parts(shapely.intersection(strip, one.part))
            met = shapely.length(shapely.intersection(parts, line))
            found += [p for p, n in zip(parts, met, strict=True) if isinstance(p, Polygon) and n]
    return found


def _in_any(polygons: Sequence[Polygon], position_mm: Floats) -> NDArray[np.bool_]:
    inside = np.zeros(len(position_mm), np.bool_)
    for polygon in polygons:
        shapely.prepare(polygon)
        inside |= shapely.intersects_xy(polygon, position_mm[:, 0], position_mm[:, 1])
    return inside
