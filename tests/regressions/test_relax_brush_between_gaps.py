"""The relaxation brush looks around in a box that only grows.

Between two gaps it grew towards one, forgot it for the other, and went on so for ever.
"""

import numpy as np
import pytest

from stippler.brushes import evening_out
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page


@pytest.mark.parametrize("seed", range(12))
def test_it_comes_to_an_end(seed, monkeypatch) -> None:
    rng = np.random.default_rng(seed)
    drawing = Drawing.blank(Page(200.0, 150.0))
    fine = rng.random((3000, 2)) * (14, 14) + (93, 68)
    below, above = ((np.abs(fine - at) < 2.2).all(axis=1) for at in ((100, 71), (101, 79)))
    fine, few = fine[~(below | above)], rng.random((40, 2)) * (200, 150)
    drawing.dots = Dots.round(np.concatenate([fine, few]), 0.05)
    document, looks = Document(drawing), []
    box_around = evening_out.box_around

    def counted(*args):
        looks.append(args)
        assert len(looks) < 30
        return box_around(*args)

    monkeypatch.setattr(evening_out, "box_around", counted)
    for y in (73.5, 75.0, 76.5):
        looks.clear()
        at = document.dots.position_mm
        rows = np.flatnonzero(np.hypot(*(at - (100.0, y)).T) < 1.5)
        moved = evening_out.evened_out(document, rows, by_tone=False).moved_mm
        assert np.isfinite(moved).all()
