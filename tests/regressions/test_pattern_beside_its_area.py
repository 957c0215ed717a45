"""An area whose pattern misses it is left out and named; all others are relaxed, made, scaled.

One such area had made *Relax all*, *Fill*, *Process* and scaling refuse the whole drawing.
"""

import numpy as np
import pytest
import shapely

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.pattern import Pattern
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import GeometryError
from stippler.jobs.processing import process_now
from stippler.jobs.stippling import relax_drawing
from stippler.stippling.patterns import builtin
from stippler.stippling.scale import Scaling, patterns_aside, scaled_drawing


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


@pytest.fixture
def pictured(drawing) -> Drawing:
    grey = np.full((60, 120), 0.3, np.float32)
    drawing.reference = Reference(grey, 60.0)
    drawing.styles[0] = Style(n_dots=400, iterations=4)
    return drawing


def test_processing_leaves_it_out_and_names_it(pictured) -> None:
    document = Document(pictured)
    there = document.dots.id[document.dots.area == 2]
    before = document.dots.position_mm[document.rows(there)]
    notes = process_now(document, [1, 2])
    assert notes[0] == (
        "area 'right' was left out: pattern: does not meet its area; move it over the area"
    )
    assert [step.label for step in document.history.steps] == ["Process left"]
    assert np.array_equal(np.sort(document.dots.id[document.dots.area == 2]), np.sort(there))
    assert np.array_equal(document.dots.position_mm[document.rows(there)], before)


def test_processing_it_alone_is_refused_and_changes_nothing(pictured) -> None:
    document = Document(pictured)
    with pytest.raises(GeometryError, match="does not meet its area"):
        process_now(document, [2])
    assert not document.history.steps


def test_an_area_under_others_is_left_out_too(pictured) -> None:
    pictured.areas[3] = Area("over left", shapely.box(0, 0, 30, 30))
    pictured.dots.area[pictured.dots.area == 1] = 3
    document = Document(pictured)
    notes = process_now(document, [1, 3])
    assert notes[0].startswith("area 'left' was left out: area 1: lies under others")
    assert [step.label for step in document.history.steps] == ["Process over left"]


def test_all_left_out_are_told_of_at_once(pictured) -> None:
    pictured.patterns[2] = Pattern.over(1, builtin("hexagons"), (100, 100, 120, 120), 12.0)
    with pytest.raises(GeometryError, match="the areas: can hold no dots"):
        process_now(Document(pictured), [1, 2])


def test_scaling_tells_of_it_and_goes_on_even_where_all_are_missed(drawing) -> None:
    drawing.patterns[2] = Pattern.over(1, builtin("hexagons"), (100, 100, 120, 120), 12.0)
    told = patterns_aside(drawing)
    assert [text.partition(":")[0] for text in told] == [
        "area 'left' is scaled as if it had no pattern",
        "area 'right' is scaled as if it had no pattern",
    ]
    assert abs(len(scaled_drawing(drawing, Scaling(n_dots=300)).dots) - 300) < 6


def test_the_drawing_is_scaled_with_it(drawing) -> None:
    half = scaled_drawing(drawing, Scaling(n_dots=300))
    assert abs(len(half.dots) - 300) < 6
    assert (half.dots.area == 2).sum() > 100
