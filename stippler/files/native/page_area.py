"""The page's own area, put back into drawings that were saved without it."""

from __future__ import annotations

from collections.abc import Mapping

import shapely
from shapely.geometry import MultiPolygon, Polygon, box

from stippler.drawing.area import PAGE_AREA, Area
from stippler.drawing.page import Page
from stippler.drawing.planar.slivers import LEAST_WIDTH_MM


def with_page_area(areas: Mapping[int, Area], page: Page) -> dict[int, Area]:
    """Return areas with the page's own among them: it owns what no other does.

    Earlier files lack it where areas covered the whole page. As in drawings of today, it then has
    the style of the lowest of them.
    """
    if PAGE_AREA in areas or not areas:
        return dict(areas)
    taken = shapely.union_all([area.outline_mm for area in areas.values()])
    rest = box(0.0, 0.0, page.width_mm, page.height_mm).difference(taken)
    if not isinstance(rest, Polygon | MultiPolygon) or _is_sliver(rest):
        rest = MultiPolygon()
    return {PAGE_AREA: Area("page", rest, areas[min(areas)].style), **areas}


def _is_sliver(outline: Polygon | MultiPolygon) -> bool:
    return bool(outline.area <= LEAST_WIDTH_MM * outline.length)
