"""Locked areas resist brushes, runs and deletion; hidden ones leave files; both survive saving."""

from dataclasses import fields, replace

import numpy as np
import pytest

from stippler.drawing import records
from stippler.drawing.dots import Dots
from stippler.drawing.visible import hidden_areas, shown, sized_zero
from tests.editor.area_hands import AreaHands, box

NAMES = [f.name for f in fields(Dots)]


@pytest.fixture
def hands(tmp_path):
    hands = AreaHands(tmp_path)
    hands.add(box(10, 10, 50, 60), box(50, 10, 90, 60))
    return hands


def mark(hands, k, **flags):
    document = hands.document
    document.begin("Mark")
    document.set(records.AREA, k, replace(document.drawing.areas[k], **flags))
    document.commit()


def of(document, k):
    dots = document.dots
    dots = dots.take(np.flatnonzero(dots.area == k))
    return dots.take(np.argsort(dots.id))


@pytest.mark.parametrize(
    "brush", ["spray", "erase", "relax", "jitter", "size", "shape", "push", "fix"]
)
def test_brushes_leave_a_locked_area_alone(hands, brush):
    mark(hands, 1, locked=True)
    before, beside = of(hands.document, 1), of(hands.document, 2)
    hands.toolbox.choose(brush)
    hands.toolbox.set_brush(replace(hands.toolbox.brush, radius_mm=15.0))
    hands.drag((35, 30), (48, 32), (52, 35), (60, 36))
    after = of(hands.document, 1)
    assert all(np.array_equal(getattr(before, n), getattr(after, n)) for n in NAMES)
    after = of(hands.document, 2)
    assert len(after) != len(beside) or any(
        not np.array_equal(getattr(beside, n), getattr(after, n)) for n in NAMES
    )


def test_a_run_leaves_a_locked_area_alone(hands):
    mark(hands, 1, locked=True)
    document = hands.document
    before = of(document, 1).position_mm
    dots = document.begin_run("Relax")
    document.merge(dots.position_mm + 0.01)
    document.merge_radii(dots.radius_mm * np.float32(2.0))
    document.end_run()
    assert np.array_equal(of(document, 1).position_mm, before)
    assert (of(document, 1).radius_mm == np.float32(0.2)).all()
    assert (of(document, 2).radius_mm == np.float32(0.4)).all()


def test_hidden_dots_have_no_size_on_screen_and_are_not_in_files(hands, tmp_path):
    from stippler.export import save
    from stippler.files.native.drawing_file import open_drawing

    mark(hands, 1, hidden=True)
    drawing = hands.document.drawing
    n = int((drawing.dots.area == 1).sum())
    assert n > 100
    sized = sized_zero(drawing.dots, hidden_areas(drawing))
    assert np.array_equal(sized.radius_mm == 0, drawing.dots.area == 1)
    assert len(shown(drawing).dots) == len(drawing.dots) - n
    save(drawing, tmp_path / "a.csv")
    assert len((tmp_path / "a.csv").read_text().splitlines()) == 1 + len(drawing.dots) - n
    save(drawing, tmp_path / "a.stipple")
    again = open_drawing(tmp_path / "a.stipple", lambda *given: None)[0]
    assert len(again.dots) == len(drawing.dots)
    assert again.areas == drawing.areas
    assert again.borders == drawing.borders
    assert again.areas[1].hidden
    assert hidden_areas(drawing, solo=1) == {0, 2}
    assert shown(drawing) is not drawing
    mark(hands, 1, hidden=False)
    assert shown(drawing) is drawing
