"""Relaxing a page with an area upon it moved dots of the page into the area."""

import numpy as np
from shapely.geometry import box

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.style import Style
from stippler.jobs.stippling import relax_drawing


def test_dots_stay_in_what_is_their_areas() -> None:
    drawing = Drawing.blank(Page(40, 30))
    drawing.areas[1] = Area("ear", box(10, 8, 28, 20))
    document = Document(drawing)
    document.begin("Fill")
    document.insert(Dots.round(np.random.default_rng(2).random((900, 2)) * (40, 30), 0.2))
    document.commit()
    area = drawing.dots.area.copy()
    assert 100 < area.sum() < 800
    *_, last = relax_drawing(drawing.snapshot(), Style(weighted=False), 12)
    assert np.array_equal(document.partition.area_at(last.moved_mm), area)
    assert not np.array_equal(last.moved_mm, drawing.dots.position_mm)
