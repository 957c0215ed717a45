"""A brush beside holes that touch each other or the border used to stop: its box cut them wrong."""

import numpy as np
import pytest
import shapely
from shapely.geometry import Polygon, box

from stippler.brushes.local_cells import cells_of
from stippler.drawing.area import PAGE_AREA, Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.page import Page

HOLES = [[(20, 40), (50, 40), (50, 70), (20, 70)], [(50, 10), (80, 10), (80, 40), (50, 40)]]
TOUCHING = Polygon([(0, 0), (100, 0), (100, 80), (0, 80)], HOLES)


@pytest.mark.parametrize("outline", [TOUCHING, TOUCHING.difference(box(0, 70, 20, 78))])
def test_cells_anywhere(outline):
    drawing = Drawing.blank(Page(100.0, 80.0))
    drawing.areas[PAGE_AREA] = Area("page", outline)
    xy = np.random.default_rng(0).random((1500, 2)) * [100, 80]
    xy = xy[shapely.contains_xy(outline, *xy.T)]
    drawing.dots = Dots.round(xy, 0.3)
    document, n_places = Document(drawing), 0
    for x in range(2, 100, 8):
        for y in range(2, 80, 8):
            rows = np.flatnonzero(np.hypot(*(xy - (x, y)).T) < 6.0)
            if len(rows):
                n_places += 1
                assert (cells_of(document, rows).area_mm2 > 0.0).all()
    assert n_places > 80
