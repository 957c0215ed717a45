"""A drawing becomes its scaled self in one step, and undo brings all of it back to the bit."""

import numpy as np
import pytest
import shapely

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.planar.path import Path
from stippler.editor.scaling import become
from stippler.stippling.scale import Scaling, scaled_drawing


def document_of(n=1500):
    drawing = Drawing.blank(Page(60.0, 40.0))
    drawing.areas[4] = Area("wing", shapely.box(0, 0, 25, 40))
    rng = np.random.default_rng(3)
    dots = Dots.round(rng.random((n, 2)) * (60, 40), rng.uniform(0.1, 0.2, n))
    dots.area[:] = np.where(dots.position_mm[:, 0] < 25, 4, 0)
    dots.constraint[:20] = FIXED
    drawing.lines = {2: Line("axis", Path.polyline([(30, 20), (50, 20)]), meeting="adhere")}
    dots.constraint[20:30], dots.curve[20:30] = ON_CURVE, 2
    dots.parameter[20:30] = np.arange(10) * 2.0 + 1
    dots.position_mm[20:30] = drawing.lines[2].at(dots.parameter[20:30])
    dots.area[20:30] = 0
    drawing.dots = dots
    return Document(drawing)


def state(document):
    dots, drawing = document.dots.by_id(), document.drawing
    arrays = [getattr(dots, name).tobytes() for name in dots.__slots__]
    return arrays, drawing.page, dict(drawing.areas), dict(drawing.lines), dict(drawing.borders)


@pytest.mark.parametrize(
    "values", [Scaling(0.5, None, 0.1), Scaling(2.0, 4000), Scaling(1.0, 300)], ids=str
)
def test_undo_brings_all_back(values):
    document = document_of()
    before, ink = state(document), float((document.dots.radius_mm.astype(float) ** 2).sum())
    scaled = scaled_drawing(document.drawing.snapshot(), values)
    become(document, scaled, "Scale")
    after, dots, f = state(document), document.dots, values.factor
    assert document.drawing.page.width_mm == 60 * f
    assert float((dots.radius_mm.astype(float) ** 2).sum()) == pytest.approx(ink * f * f, rel=2e-3)
    if values.least_radius_mm:
        free = ~dots.fixed
        assert dots.radius_mm[free].min() >= values.least_radius_mm - 1e-6
    if values.n_dots:
        assert abs(len(dots) - values.n_dots) <= 30
    held = dots.constraint == ON_CURVE
    line = document.drawing.lines[2]
    assert held.sum() == 10
    assert np.allclose(dots.position_mm[held], line.at(dots.parameter[held]), atol=1e-3)
    assert (dots.constraint == FIXED).sum() == 20
    inside = dots.position_mm[:, 0] < 25 * f
    assert np.array_equal(dots.area == 4, inside)
    document.undo()
    assert state(document) == before
    document.redo()
    assert state(document) == after
