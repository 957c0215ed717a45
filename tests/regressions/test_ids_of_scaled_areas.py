"""An area that got more dots wrote over dots of other areas: its new ids were theirs."""

import numpy as np

from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.stippling.scale import Scaling
from stippler.stippling.scale_areas import scale_areas


def test_dots_of_other_areas_stay_whatever_their_ids_are():
    drawing = Drawing.blank(Page(60, 40))
    at = np.random.default_rng(4).random((1200, 2)) * (60, 40)
    order = np.lexsort((at[:, 0] > 20,))  # the left ones have the lower ids
    drawing.dots = Dots.round(at[order], 0.2)
    document = Document(drawing)
    left = Path.polyline([(5, 5), (20, 5), (20, 35), (5, 35)], closed=True)
    edit_areas(document, "Draw area", lambda m: edits.add(m, left))
    area = max(document.drawing.areas)
    others = document.dots.id[document.dots.area != area].copy()
    assert document.dots.id[document.dots.area == area].max() < others.max()
    before = document.dots.take(document.rows(others))
    n_before = len(document.dots) - len(others)
    scale_areas(document, [area], Scaling(n_dots=3 * n_before))
    rows = document.rows(others)
    assert (rows >= 0).all()
    for name in Dots.__slots__:
        assert np.array_equal(getattr(document.dots, name)[rows], getattr(before, name)), name
    assert abs(len(document.dots) - len(others) - 3 * n_before) <= 3
    assert len(np.unique(document.dots.id)) == len(document.dots)
