"""Areas in a document: one step each, exact undo, dots in the right hands."""

import numpy as np
import pytest
import shapely

from benchmarks.random_areas import EDITS
from stippler.drawing import records
from stippler.drawing.area_edits import edit_areas, map_of
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.pattern import Pattern
from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.path import Path
from stippler.errors import GeometryError
from stippler.stippling.patterns import builtin


def box(x0, y0, x1, y1):
    return Path.polyline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], closed=True)


@pytest.fixture
def document():
    drawing = Drawing.blank(Page(100, 80))
    at = np.random.default_rng(0).random((3000, 2)) * (100, 80)
    drawing.dots = Dots.round(at, 0.2)
    return Document(drawing)


def state(document):
    d = document.drawing
    return (dict(d.areas), dict(d.borders), d.dots.area.copy(), d.dots.position_mm.copy())


def same(a, b):
    return a[:2] == b[:2] and all(np.array_equal(x, y) for x, y in zip(a[2:], b[2:], strict=True))


def test_dots_belong_to_new_areas_and_return(document):
    start = state(document)
    outcome = edit_areas(document, "Draw area", lambda m: edits.add(m, box(10, 10, 50, 60)))
    assert outcome.made == (1,)
    x, y = document.dots.position_mm.T
    inside = (x > 10) & (x < 50) & (y > 10) & (y < 60)
    assert np.array_equal(document.dots.area == 1, inside)
    assert shapely.equals(document.drawing.areas[1].outline_mm, shapely.box(10, 10, 50, 60))
    document.undo()
    assert same(state(document), start)
    document.redo()
    assert np.array_equal(document.dots.area == 1, inside)


def test_a_refused_edit_changes_nothing(document):
    edit_areas(document, "Draw area", lambda m: edits.add(m, box(10, 10, 50, 60)))
    before = state(document)
    with pytest.raises(GeometryError):
        edit_areas(document, "Draw", lambda m: edits.add(m, box(20, 20, 90, 70), edits.REFUSED))
    assert same(state(document), before)


def test_random_edits_undo_to_the_start(document):
    rng = np.random.default_rng(7)
    states = [state(document)]
    for name in rng.choice(list(EDITS), 60):
        try:
            edit_areas(document, str(name), lambda m, name=name: EDITS[str(name)](m, rng))
        except GeometryError:
            continue
        now = state(document)
        if not same(now, states[-1]):
            states.append(now)
    owner = map_of(document.drawing).area_at(document.dots.position_mm)
    assert np.array_equal(owner, document.dots.area)
    assert set(document.drawing.areas) == set(map_of(document.drawing).areas) | {0}
    assert len(states) > 20
    for expected in states[-2::-1]:
        assert document.undo()
        assert same(state(document), expected)


def test_areas_lines_and_patterns_survive_the_file(document, tmp_path):
    from stippler.files.native.drawing_file import open_drawing, save_drawing

    edit_areas(document, "Draw area", lambda m: edits.add(m, box(10, 10, 50, 60)))
    edit_areas(document, "Bend", lambda m: edits.Outcome(moves.smooth(m, m.arcs_of(1)).map))
    document.begin("Line and pattern")
    document.add(records.LINE, Line("one", box(1, 1, 5, 5), (0.3, 0.1)))
    document.add(records.PATTERN, Pattern.over(1, builtin("bricks"), (10, 10, 50, 60), 20))
    document.commit()
    file = tmp_path / "a.stipple"
    save_drawing(document.drawing, file)
    again = open_drawing(file, lambda *given: None)[0]
    for kind in (records.AREA, records.BORDER, records.LINE, records.PATTERN):
        assert again.table(kind) == document.drawing.table(kind)
