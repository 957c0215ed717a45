"""An area whose pattern misses it is left out and named; all others are relaxed, filled, scaled.

One such area had made *Relax all*, *Fill* and scaling refuse the whole drawing.
"""

import numpy as np
import pytest
import shapely

from stippler.drawing.area import Area
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.pattern import Pattern
from stippler.drawing.style import Style
from stippler.errors import GeometryError
from stippler.jobs.stippling import relax_drawing
from stippler.stippling.patterns import builtin
from stippler.stippling.scale import Scaling, scaled_drawing


@pytest.fixture
def drawing() -> Drawing:
    drawing = Drawing.blank(Page(60.0, 30.0))
    drawing.areas[1] = Area("left", shapely.box(0, 0, 30, 30))
    drawing.areas[2] = Area("right", shapely.box(30, 0, 60, 30))
    drawing.patterns[1] = Pattern.over(2, builtin("hexagons"), (100, 100, 120, 120), 12.0)
    at = np.random.default_rng(3).random((600, 2)) * (60, 30)
    drawing.dots = Dots.round(at, 0.1)
    drawing.dots.area[:] = np.where(at[:, 0] < 30.0, 1, 2)
    return drawing


def test_relax_all_leaves_it_out_and_names_it(drawing) -> None:
    works = list(relax_drawing(drawing, Style(weighted=False), 5))
    assert [note for work in works for note in work.notes] == [
        "area 'right' was left out: pattern: does not meet its area; move it over the area"
    ]
    moved = works[-1].moved_mm
    left = drawing.dots.area == 1
    assert (moved[left] != drawing.dots.position_mm[left]).any(axis=1).mean() > 0.9
    assert np.array_equal(moved[~left], drawing.dots.position_mm[~left])


def test_alone_it_is_refused(drawing) -> None:
    with pytest.raises(GeometryError, match="does not meet its area"):
        list(relax_drawing(drawing, Style(weighted=False), 5, [2]))


def test_the_drawing_is_scaled_with_it(drawing) -> None:
    half = scaled_drawing(drawing, Scaling(n_dots=300))
    assert abs(len(half.dots) - 300) < 6
    assert (half.dots.area == 2).sum() > 100
