"""Voronoi cells of some dots of a large drawing, at a cost that depends on those dots alone."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.brushes.local_sight import seen_around
from stippler.drawing.area import PAGE_AREA
from stippler.drawing.document import Document
from stippler.drawing.reference import Reference
from stippler.drawing.store import Rows
from stippler.stippling.density import DensityField
from stippler.stippling.relax_local import LocalRelaxation
from stippler.stippling.style_tone import curves_of

Floats = NDArray[np.float64]
Box = tuple[float, float, float, float]

MARGIN_SPACINGS = 4.0
"""How far around the dots their neighbours are taken in, in mean spacings."""


@dataclass(frozen=True, slots=True, eq=False)
class LocalCells:
    """What is known of some dots' cells.

    Attributes
    ----------
    moved_mm : (k, 2) float64
        Where a step of relaxation takes the dots.
    area_mm2 : (k,) float64
    reach_mm : (k,) float64
        Distance of the farthest corner.
    """

    moved_mm: Floats
    area_mm2: Floats
    reach_mm: Floats


def centroids_of(document: Document, rows: Rows, reference: Reference | None = None) -> Floats:
    """Return the centroids of the dots' cells among all dots; weighted by a reference.

    Dots whose cell is not known, as beyond their area's border, keep their place. Where walls are
    in the way it is where relaxation takes the dot; dots at one place are parted.
    """
    return cells_of(document, rows, reference).moved_mm


def areas_of(document: Document, rows: Rows) -> Floats:
    """Return the areas of the dots' cells among all dots, mm²; 0 where it is not known."""
    return cells_of(document, rows).area_mm2


def cells_of(document: Document, rows: Rows, reference: Reference | None = None) -> LocalCells:
    """Compute the cells of some dots, as they are among all dots of the drawing.

    Dots around are taken in as far as `MARGIN_SPACINGS`, and farther for cells that reach so far
    that a dot beyond might cut them.
    """
    found = LocalCells(
        np.array(document.dots.position_mm[rows]), np.zeros(len(rows)), np.zeros(len(rows))
    )
    left, around = np.arange(len(rows)), None
    while len(left):
        at = document.dots.position_mm[rows[left]]
        around = box_around(document, at, around)
        density = None if reference is None else density_in(reference, around)
        for place in places_of(document, rows[left], around):
            where = left[place.which]
            engine = LocalRelaxation(
                document.dots.position_mm[place.rows], place.outlines,
                density=density, movable=place.movable,
            )  # fmt: skip
            found.moved_mm[where], found.area_mm2[where], found.reach_mm[where] = engine.look(
                place.mine
            )
        reach = found.reach_mm[left]
        lacking = lacks(document, at, reach, around)
        around = wider(at[lacking], reach[lacking])
        left = left[lacking]
    return found


def wider(at: Floats, reach_mm: Floats) -> Box | None:
    """Return a box around cells that reach so far, in which nothing that cuts them is left out."""
    if not len(at):
        return None
    margin = 2.1 * reach_mm[:, None]
    low, high = (at - margin).min(axis=0), (at + margin).max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def lacks(document: Document, at: Floats, reach_mm: Floats, around: Box) -> NDArray[np.bool_]:
    """Tell which cells might be cut by a dot beyond a box, or lean out of it."""
    page = document.drawing.page
    room = np.full(len(at), np.inf)
    for axis, size in enumerate((page.width_mm, page.height_mm)):
        if around[axis] > 0.0:
            room = np.minimum(room, at[:, axis] - around[axis])
        if around[axis + 2] < size:
            room = np.minimum(room, around[axis + 2] - at[:, axis])
    found: NDArray[np.bool_] = 2.0 * reach_mm > room
    return found


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """The part of an area in which the cells of some of its dots lie.

    Attributes
    ----------
    area : int
    outlines : list of Polygon
    rows : (n,) int64
        Of the dots in it, sorted.
    mine, which : (k,) int64
        Those asked for: where they are in `rows`, and in the list that was asked for.
    """

    area: int
    outlines: list[shapely.Polygon]
    rows: Rows
    mine: NDArray[np.intp]
    which: NDArray[np.intp]

    @property
    def movable(self) -> NDArray[np.bool_]:
        """Tell which of its dots are asked for."""
        movable = np.zeros(len(self.rows), np.bool_)
        movable[self.mine] = True
        return movable


def places_of(document: Document, rows: Rows, around: Box) -> Iterator[Place]:
    """Yield for each area the part of it in a box that holds some dots, if it knows any of them."""
    near = document.in_box(around)
    near_area = document.dots.area[near]
    for k in np.flatnonzero(np.bincount(document.dots.area[rows])):
        own = near if len(document.drawing.areas) == 1 else near[near_area == k]
        outlines, is_box = _part_of_area(document, int(k), around)
        asked = rows
        if seen := seen_around(document, int(k), around):
            own = near[np.isin(near_area, [int(k), *seen.areas])]
            outlines, is_box = seen.joined_to(outlines), False
            asked = np.where(document.dots.area[rows] == k, rows, -1)
        if not is_box:
            xy = document.dots.position_mm[own]
            inside = [shapely.intersects_xy(outline, xy[:, 0], xy[:, 1]) for outline in outlines]
            own = own[np.logical_or.reduce([np.zeros(len(own), np.bool_), *inside])]
        at = np.searchsorted(own, asked)
        found = own[np.minimum(at, len(own) - 1)] == asked if len(own) else at < 0
        if found.any():
            yield Place(int(k), outlines, own, at[found], np.flatnonzero(found))


def _part_of_area(document: Document, k: int, around: Box) -> tuple[list[shapely.Polygon], bool]:
    """Return the compartments of an area in a box, and whether it is one box.

    What the box cuts apart is joined by a frame around it: the parts are one compartment, and
    their dots see each other. Cells that reach the frame are not known yet.
    """
    areas = document.drawing.areas
    box = document.partition.box_of(k)
    if box is not None and len(areas) == 1:
        return [_overlap(box, around)], True
    window = shapely.box(*around)
    outline: shapely.Geometry = areas[k].outline_mm
    above = []
    if k == PAGE_AREA:
        above = [areas[i].outline_mm for i in areas if i != k]
        above = [other for other in above if other.intersects(window)]
    if box is not None and not above:
        return [_overlap(box, around)], True
    if above:
        outline = outline.difference(shapely.unary_union(above))
    out = []
    for polygon in _polygons(outline):
        part = shapely.clip_by_rect(polygon, *around)
        if not part.is_valid:  # it does not know of holes that touch
            part = shapely.intersection(polygon, window)
        parts = _polygons(part)
        if len(parts) > 1:
            width = 0.1 * max(around[2] - around[0], around[3] - around[1])
            parts.append(window.buffer(width, join_style="mitre").difference(window))
            parts = _polygons(shapely.unary_union(parts))
        out += parts
    return out, False


def _overlap(a: Box, b: Box) -> shapely.Polygon:
    return shapely.box(max(a[0], b[0]), max(a[1], b[1]), min(a[2], b[2]), min(a[3], b[3]))


def _polygons(geometry: shapely.Geometry) -> list[shapely.Polygon]:
    """Return the polygons of a shape, without the corners and lines it may have as well."""
    return [p for p in shapely.get_parts(geometry) if p.geom_type == "Polygon" and p.area > 0.0]


def box_around(document: Document, position_mm: Floats, least: Box | None) -> Box:
    """Return a box around dots with a margin; one that holds `least` if that is given."""
    x, y = position_mm.T
    x0, y0, x1, y1 = float(x.min()), float(y.min()), float(x.max()), float(y.max())
    page = document.drawing.page
    whole = math.sqrt(page.width_mm * page.height_mm / len(document.dots))
    spacing = whole
    if len(position_mm) > 8:
        size, longest = (x1 - x0) * (y1 - y0), max(x1 - x0, y1 - y0)
        spacing = max(math.sqrt(size / len(position_mm)), longest / len(position_mm))
    margin = MARGIN_SPACINGS * max(spacing, 1e-6 * page.width_mm)
    box = (x0 - margin, y0 - margin, x1 + margin, y1 + margin)
    if least is None:
        return box
    return (
        min(box[0], least[0]), min(box[1], least[1]), max(box[2], least[2]), max(box[3], least[3])
    )  # fmt: skip


def tone_in(document: Document, area: int, box: Box) -> DensityField | None:
    """Cut the darkness that an area's dots are to show out of the picture, if there is one."""
    reference = document.drawing.reference
    if reference is None:
        return None
    seen = darkness_in(reference, box)
    for curve in curves_of(document.drawing.style_of(area)):
        seen = replace(seen, values=curve(seen.values))
    return seen


def density_in(reference: Reference, box: Box) -> DensityField:
    """Cut the weight out of the reference: its square, since dots settle at the weight's root."""
    field = darkness_in(reference, box)
    return DensityField(np.square(field.values), field.pixel_mm, field.origin_mm)


def darkness_in(reference: Reference, box: Box) -> DensityField:
    """Cut the part in a box out of the reference."""
    h, w = reference.source.levels.shape
    side = reference.pixel_mm
    i0, j0 = (min(max(math.floor(v / side), 0), n - 1) for v, n in ((box[0], w), (box[1], h)))
    i1, j1 = (min(max(math.ceil(v / side), 1), n) for v, n in ((box[2], w), (box[3], h)))
    rows, columns = slice(j0, max(j1, j0 + 1)), slice(i0, max(i1, i0 + 1))
    part = reference.levels.darkness(rows, columns)
    return DensityField(part, side, (i0 * side, j0 * side))
