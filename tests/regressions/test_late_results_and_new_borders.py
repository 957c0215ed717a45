"""A run that began before an area was drawn put dots into it that were another's."""

import numpy as np

from stippler.drawing.area_edits import edit_areas, map_of
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path


def test_results_from_before_a_border_do_not_cross_it() -> None:
    drawing = Drawing.blank(Page(100, 80))
    drawing.dots = Dots.round(np.random.default_rng(0).random((400, 2)) * (100, 80), 0.2)
    document = Document(drawing)
    dots = document.begin_run("Relax")
    corners = [(30, 20), (70, 20), (70, 60), (30, 60)]
    edit_areas(document, "Draw area", lambda m: edits.add(m, Path.polyline(corners, closed=True)))
    towards = dots.position_mm + 0.4 * ((50.0, 40.0) - dots.position_mm)
    document.merge(towards)
    document.end_run()
    owner = map_of(document.drawing).area_at(document.dots.position_mm)
    assert np.array_equal(owner, document.dots.area)
    assert (document.dots.position_mm == towards).all(axis=1).sum() > 100
