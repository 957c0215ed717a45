"""Filling a page that has no picture."""

from __future__ import annotations

import numpy as np
import pytest
from shapely.geometry import box

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import ParameterError
from stippler.jobs.stippling import fill
from stippler.stippling.fill import Filling


def added(document: Document, filling: Filling, area: int) -> int:
    *_, made = fill([document.drawing.outlines()[area]], filling)
    document.begin("Fill")
    rows = document.insert(Dots.round(made.points_mm, filling.radius_mm))
    document.commit()
    return len(rows)


@pytest.mark.parametrize("arrangement", ["hexagonal", "random"])
def test_an_area_is_filled_in_one_step(arrangement) -> None:
    drawing = Drawing.blank(Page(60.0, 40.0))
    drawing.areas[1] = Area("corner", box(0, 0, 20, 10))
    document = Document(drawing)
    filling = Filling(200, arrangement, 0.25, seed=3)
    first, second = (added(document, filling, area) for area in (0, 1))
    dots = document.dots
    assert len(dots) == first + second
    assert abs(first - 200) <= 8
    assert (dots.position_mm[dots.area == 1] <= [20, 10]).all()
    assert (dots.radius_mm == np.float32(0.25)).all()
    assert len(set(dots.id)) == len(dots)
    document.undo()
    assert len(document.dots) == first


@pytest.mark.parametrize(
    "wrong", [{"n_dots": 0}, {"n_dots": 10**9}, {"radius_mm": 0.0}, {"seed": -1}]
)
def test_fillings_that_make_no_sense(wrong) -> None:
    with pytest.raises(ParameterError, match=r"^(dots|arrangement|radius|seed): "):
        Filling(**wrong)
