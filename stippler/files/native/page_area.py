"""The page's own area, put back into drawings that were saved without it."""

from __future__ import annotations

from collections.abc import Mapping

import shapely
from shapely.geometry import MultiPolygon, Polygon, box

from stippler.drawing.area import PAGE_AREA, Area
from stippler.drawing.page import Page
from stippler.drawing.planar.slivers import LEAST_WIDTH_MM
from stippler.errors import GeometryError


def with_page_area(areas: Mapping[int, Area], page: Page) -> dict[int, Area]:
    """Return areas with the page's own among them: it owns what no other does.

    Earlier files lack it where areas covered the whole page. As in drawings of today, it then has
    the style of the lowest of them.

    Raises
    ------
    GeometryError
        If the others' outlines are none.
    """
    if PAGE_AREA in areas or not areas:
        return dict(areas)
    whole = box(0.0, 0.0, page.width_mm, page.height_mm)
    try:
        shapes = shapely.make_valid([area.outline_mm for area in areas.values()])
        rest = whole.difference(shapely.union_all(shapes))
    except shapely.errors.GEOSException as error:
        raise GeometryError(str(error)[:120], "outline of an area") from None
    if not isinstance(rest, Polygon | MultiPolygon) or _is_sliver(rest):
        rest = MultiPolygon()
    return {PAGE_AREA: Area("page", rest, areas[min(areas)].style), **areas}


def _is_sliver(outline: Polygon | MultiPolygon) -> bool:
    return bool(outline.area <= LEAST_WIDTH_MM * outline.length)
