"""Which area owns which part of the page, and moves that do not leave it."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import compress
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

Points = NDArray[np.float64]
Box = tuple[float, float, float, float]
Outline: TypeAlias = Polygon | MultiPolygon

NOWHERE = -1
_HALVINGS = 4


class Partition:
    """The only answer to what part of the page is an area's.

    Parameters
    ----------
    outlines : mapping of area id to polygon
        From the lowest to the uppermost: where two overlap the upper one owns what both have. Only
        outlines count here, and not where they come from.
    """

    def __init__(self, outlines: Mapping[int, Outline]) -> None:
        from stippler.drawing.outline_grid import OutlineGrid

        self._outlines = dict(outlines)
        self._boxes = {k: _as_box(outline) for k, outline in self._outlines.items()}
        ids = [k for k, outline in self._outlines.items() if not outline.is_empty]
        self._lowest = ids.pop(0) if ids and self._boxes[ids[0]] is not None else None
        self._upper = np.array(ids[::-1], np.int32)
        self._grid = OutlineGrid([self._outlines[k] for k in ids[::-1]]) if ids else None
        self._parts: dict[int, Outline] = {}

    def box_of(self, k: int) -> Box | None:
        """Return the box x0, y0, x1, y1 that an area owns; None where that is something else."""
        alone = self._grid is None or self._lowest is None
        return self._boxes[k] if alone or k != self._lowest else None

    def part_of(self, k: int) -> Outline:
        """Return what an area owns: its outline without those above it; may be empty."""
        if k not in self._parts:
            mine, above = self._outlines[k], [o for i, o in self._outlines.items() if i > k]
            near = list(compress(above, shapely.intersects(above, mine)))
            part = shapely.difference(mine, shapely.union_all(near)) if near else mine
            self._parts[k] = _polygons_in(part)
        return self._parts[k]

    def area_at(self, points: Points) -> NDArray[np.int32]:
        """Return the area of each point; `NOWHERE` off the page."""
        found = np.full(len(points), NOWHERE, np.int32)
        if self._lowest is not None:
            found[self._in_box(self._lowest, points)] = self._lowest
        if self._grid is not None:
            rank = self._grid.find(points)
            found[rank >= 0] = self._upper[rank[rank >= 0]]
        return found

    def confine(self, old: Points, new: Points, area: NDArray[np.int32]) -> Points:
        """Return moves cut short so that they end in the dots' areas.

        A move that would end outside is halved until it does not, and else not made. Where dots
        lie outside their area already they stay.
        """
        outside = ~self._own(new, area)
        if not outside.any():
            return new
        out = new.copy()
        which = np.flatnonzero(outside)
        share = 1.0
        for _ in range(_HALVINGS):
            share *= 0.5
            tried = old[which] + share * (new[which] - old[which])
            fine = self._own(tried, area[which])
            out[which[fine]] = tried[fine]
            which = which[~fine]
            if not len(which):
                return out
        out[which] = old[which]
        return out

    def _own(self, points: Points, area: NDArray[np.int32]) -> NDArray[np.bool_]:
        """Return whether points lie in the areas given."""
        if self._grid is None and self._lowest is not None:
            return np.asarray(self._in_box(self._lowest, points) & (area == self._lowest))
        return np.asarray(self.area_at(points) == area)

    def _in_box(self, k: int, points: Points) -> NDArray[np.bool_]:
        x0, y0, x1, y1 = self._boxes[k] or (0.0, 0.0, -1.0, -1.0)
        x, y = points[:, 0], points[:, 1]
        return np.asarray((x >= x0) & (x <= x1) & (y >= y0) & (y <= y1))


def _as_box(outline: Outline) -> Box | None:
    if len(shapely.get_coordinates(outline)) > 8:
        return None
    bounds: Box = outline.bounds
    return bounds if outline.equals(shapely.box(*bounds)) else None


def _polygons_in(part: shapely.Geometry) -> Outline:
    """Return what of a geometry has an extent."""
    if isinstance(part, Polygon | MultiPolygon):
        return part
    polygons = [p for p in shapely.get_parts(part) if isinstance(p, Polygon)]
    return MultiPolygon(polygons)
