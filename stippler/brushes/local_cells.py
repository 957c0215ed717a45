"""Voronoi cells of some dots of a large drawing, at a cost that depends on those dots alone."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.document import Document
from stippler.drawing.reference import Reference
from stippler.drawing.store import Rows
from stippler.stippling.density import DensityField
from stippler.stippling.relax_local import LocalRelaxation

Floats = NDArray[np.float64]
Box = tuple[float, float, float, float]

MARGIN_SPACINGS = 4.0
"""How far around the dots their neighbours are taken in, in mean spacings."""


def centroids_of(document: Document, rows: Rows, reference: Reference | None = None) -> Floats:
    """Return the centroids of the dots' cells among all dots around; weighted by a reference.

    Dots whose cell is not known, as beyond their area's border, keep their place.
    """
    out = np.array(document.dots.position_mm[rows])
    for engine, mine, which in _engines(document, rows, reference):
        out[which] = engine.relax(mine)
    return out


def areas_of(document: Document, rows: Rows) -> Floats:
    """Return the areas of the dots' cells among all dots around, mm²; 0 where it is not known."""
    out = np.zeros(len(rows))
    for engine, mine, which in _engines(document, rows, None):
        out[which] = engine.cell_areas(mine)
    return out


def _engines(
    document: Document, rows: Rows, reference: Reference | None
) -> Iterator[tuple[LocalRelaxation, NDArray[np.intp], NDArray[np.intp]]]:
    """Yield for each area an engine of the dots around, those asked for in it, and in `rows`."""
    if not len(rows):
        return
    around = _box_around(document, document.dots.position_mm[rows])
    near = document.in_box(around)
    near_area = document.dots.area[near]
    for k in np.flatnonzero(np.bincount(document.dots.area[rows])):
        own = near if len(document.drawing.areas) == 1 else near[near_area == k]
        polygon = _part_of_area(document, int(k), around)
        if not isinstance(polygon, tuple):
            xy = document.dots.position_mm[own]
            own = own[shapely.intersects_xy(polygon, xy[:, 0], xy[:, 1])]
        at = np.searchsorted(own, rows)
        found = own[np.minimum(at, len(own) - 1)] == rows if len(own) else at < 0
        if found.any():
            outline = shapely.box(*polygon) if isinstance(polygon, tuple) else polygon
            density = _density(reference, around)
            engine = LocalRelaxation(document.dots.position_mm[own], outline, density=density)
            yield engine, at[found], np.flatnonzero(found)


def _part_of_area(
    document: Document, k: int, around: Box
) -> Box | shapely.Polygon | shapely.MultiPolygon:
    """Return the part of an area in a box: a box again where the area is one."""
    box = document.partition.box_of(k)
    if box is not None:
        return (
            max(box[0], around[0]),
            max(box[1], around[1]),
            min(box[2], around[2]),
            min(box[3], around[3]),
        )
    part = shapely.clip_by_rect(document.drawing.areas[k].outline_mm, *around)
    if part.geom_type == "GeometryCollection":  # a corner or an edge that only touches the box
        part = shapely.MultiPolygon([p for p in part.geoms if p.geom_type == "Polygon"])
    return part


def _box_around(document: Document, position_mm: Floats) -> Box:
    (x0, y0), (x1, y1) = position_mm.min(axis=0), position_mm.max(axis=0)
    page = document.drawing.page
    whole = math.sqrt(page.width_mm * page.height_mm / len(document.dots))
    size = max((x1 - x0) * (y1 - y0), 0.0)
    spacing = math.sqrt(size / len(position_mm)) if len(position_mm) > 8 else whole
    margin = MARGIN_SPACINGS * max(spacing, 1e-6 * page.width_mm)
    return float(x0 - margin), float(y0 - margin), float(x1 + margin), float(y1 + margin)


def _density(reference: Reference | None, box: Box) -> DensityField | None:
    """Cut the weight out of the reference: its square, since dots settle at the weight's root."""
    if reference is None:
        return None
    h, w = reference.darkness.shape
    side = reference.pixel_mm
    i0, j0 = (min(max(math.floor(v / side), 0), n - 1) for v, n in ((box[0], w), (box[1], h)))
    i1, j1 = (min(max(math.ceil(v / side), 1), n) for v, n in ((box[2], w), (box[3], h)))
    part = reference.darkness[j0 : max(j1, j0 + 1), i0 : max(i1, i0 + 1)]
    return DensityField(np.square(part), side, (i0 * side, j0 * side))
