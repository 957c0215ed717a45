"""What is found of an export beside the window, part by part, and not twice."""

from dataclasses import replace

import numpy as np
import pytest

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor.export_choices import Choices
from stippler.jobs import export_look
from stippler.jobs.export_look import Asked, Look, Sight, look


def asked(path="a.svg", sight=None, **changes) -> Asked:
    rng = np.random.default_rng(1)
    drawing = Drawing.blank(Page(60, 40))
    drawing.dots = Dots.round(rng.uniform((1, 1), (59, 39), (500, 2)), 0.4)
    choices = Choices(path)
    form = choices.form
    return replace(
        Asked(drawing, 1, form, choices.values(), choices.process(), sight or Sight(300, 200)),
        **changes,
    )


def last(what, known=None):
    *_, found = look(what, known or Look(), lambda: False)
    return found


@pytest.mark.parametrize("path", ["a.svg", "a.tif", "a.csv", "a.gcode"])
def test_everything_is_found(path):
    what = asked(path, wants_course=path == "a.gcode", wants_moments=path == "a.gcode")
    found = last(what)
    assert found.picture.shape == (found.window.rows, found.window.columns)
    assert 5 < 255 - found.picture.mean() < 100
    assert found.estimate.n_bytes > 100
    assert found.findings is not None
    assert (found.course is not None) == (path == "a.gcode")
    assert (found.moments is not None) == (path == "a.gcode")
    if found.moments is not None:
        assert found.moments.drawn_s.shape == found.picture.shape


def test_the_picture_comes_first():
    first = next(look(asked(), Look(), lambda: False))
    assert first.picture is not None
    assert first.estimate is None


def test_what_is_known_is_not_sought_again(monkeypatch):
    known = last(asked())
    monkeypatch.setattr(export_look, "_sheet", None)
    nearer = last(asked(sight=Sight(300, 200, 40.0, (10.0, 10.0))), known)
    assert nearer.sheet is known.sheet
    assert nearer.estimate is known.estimate
    assert nearer.findings is known.findings
    assert nearer.window.width_mm == pytest.approx(300 / 40)


def test_another_drawing_and_other_values_are_looked_at_anew():
    known = last(asked())
    fresh = asked(state=2)
    fresh.drawing.dots = fresh.drawing.dots.take(slice(0, 20))
    found = last(fresh, known)
    assert found.estimate.n_bytes < known.estimate.n_bytes
    assert found.sheet is not known.sheet
    wide = asked()
    wide = replace(wide, values={**wide.values, "print_width": 30.0})
    assert last(wide, known).sheet.width_mm == 30


def test_what_nobody_waits_for_is_given_up():
    assert list(look(asked(), Look(), lambda: True)) == []


@pytest.mark.parametrize("px_per_mm", [None, 3.0, 50.0])
@pytest.mark.parametrize("middle", [None, (0.0, 0.0), (59.0, 20.0), (500.0, 500.0)])
def test_a_window_lies_within_the_sheet(px_per_mm, middle):
    sight = Sight(333, 222, px_per_mm, middle)
    window = sight.window(60, 40)
    if window is None:
        assert middle == (500.0, 500.0)
        return
    assert window.left >= 0
    assert window.top >= 0
    half = 0.5 / sight.scale(60, 40)
    assert window.left + window.width_mm <= 60 + half + 1e-9
    assert window.top + window.height_mm <= 40 + half + 1e-9
    assert window.columns / window.width_mm == pytest.approx(sight.scale(60, 40))
