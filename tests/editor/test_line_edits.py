"""Lines in a document: what adheres goes along, distances are kept, undo is exact."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, FREE, NO_CURVE, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.planar.moves import smooth_path
from stippler.drawing.planar.path import Path
from stippler.editor.line_edits import add_line, meet, rows_on, set_line, spread_held
from stippler.editor.tools.line_choice import ChosenLines, away_mm, line_at


def document_of(n=800, seed=1):
    drawing = Drawing.blank(Page(60.0, 40.0))
    drawing.dots = Dots.round(np.random.default_rng(seed).random((n, 2)) * (60, 40), 0.1)
    return Document(drawing)


def curve(**options):
    path = smooth_path(Path.polyline([(10, 10), (25, 25), (40, 12), (52, 30)]))
    return Line("", path, **options)


def state(document):
    dots = document.dots.by_id()
    fields = (dots.position_mm, dots.constraint, dots.curve, dots.parameter, dots.area)
    return [f.tobytes() for f in fields], dict(document.drawing.lines)


def drawn(document, line):
    document.begin("Draw")
    k = add_line(document, line)
    meet(document, k)
    document.commit()
    return k


def test_dots_within_reach_are_held_evenly_and_go_along():
    document = document_of()
    before = state(document)
    k = drawn(document, curve(meeting="adhere", reach_mm=2.0))
    rows = rows_on(document, k)
    assert len(rows) > 20
    line = document.drawing.lines[k]
    assert line.name == "line 0"
    dots = document.dots
    assert np.allclose(dots.position_mm[rows], line.at(dots.parameter[rows]))
    gaps = np.diff(np.sort(dots.parameter[rows]))
    assert np.ptp(gaps) < 0.01 * gaps.mean()
    held, all_ = dots.id[rows].copy(), len(dots)
    document.begin("Move")
    moved = Line(line.name, Path.polyline([(5, 5), (55, 5)]), meeting="adhere", reach_mm=2.0)
    set_line(document, k, moved)
    document.commit()
    assert np.array_equal(np.sort(document.dots.id[rows_on(document, k)]), np.sort(held))
    assert np.allclose(document.dots.position_mm[rows_on(document, k), 1], 5)
    document.begin("Delete")
    set_line(document, k, None)
    document.commit()
    assert len(document.dots) == all_
    assert (document.dots.constraint == FREE).all()
    assert (document.dots.curve == NO_CURVE).all()
    while document.undo():
        pass
    assert state(document) == before
    while document.redo():
        pass
    assert not document.drawing.lines


@given(st.integers(0, 9999), st.floats(0.0, 1.0), st.floats(0.1, 1.0))
@settings(max_examples=15, deadline=None)
def test_distances_are_kept(seed, width, distance):
    document = document_of(400, seed)
    before = state(document)
    document.drawing.dots.constraint[::7] = FIXED
    line = curve(meeting="distance", width_mm=(width, width), distance_mm=distance)
    k = drawn(document, line)
    dots, axis = document.dots, shapely.linestrings(line.path.points_mm)
    away = shapely.distance(axis, shapely.points(dots.position_mm))
    free = dots.constraint == FREE
    assert (away[free] >= width / 2 + distance - 1e-6).all()
    old = np.frombuffer(before[0][0]).reshape(-1, 2)
    fixed = dots.by_id().constraint == FIXED
    assert np.array_equal(dots.by_id().position_mm[fixed], old[fixed])
    document.undo()
    assert state(document)[0][0] == before[0][0]
    assert k not in document.drawing.lines


def test_dots_that_find_no_place_between_lines_are_taken_away_and_that_is_said():
    document = document_of(1500)
    before, said = state(document), []
    document.begin("Lines")
    for y in (18.0, 18.9, 19.8):
        between = Line(f"at {y}", Path.polyline([(-5, y), (65, y)]), (0.0, 0.0),
                       meeting="distance", distance_mm=0.6)  # fmt: skip
        meet(document, add_line(document, between), lambda text, _: said.append(text))
    document.commit()
    y = document.dots.position_mm[:, 1]
    assert (np.abs(y[:, None] - (18.0, 18.9, 19.8)).min(axis=1) >= 0.6 - 1e-6).all()
    n_gone = 1500 - len(document.dots)
    assert sum(int(text.split()[0]) for text in said) == n_gone
    near = np.frombuffer(before[0][0]).reshape(-1, 2)[:, 1]
    assert 0 < n_gone <= ((near > 17.3) & (near < 20.5)).sum()
    document.undo()
    assert state(document) == before


def test_a_line_takes_no_more_dots_than_fit_on_it():
    document = document_of(6000)
    k = drawn(document, curve(meeting="adhere", reach_mm=4.0))
    fits = document.drawing.lines[k].length_mm / (1.0746 * np.sqrt(60 * 40 / 6000))
    assert len(rows_on(document, k)) == pytest.approx(fits, rel=0.12)


def test_a_hidden_line_moves_no_dot():
    document = document_of(800)
    before = state(document)[0]
    drawn(document, curve(meeting="distance", distance_mm=0.6, hidden=True))
    assert state(document)[0] == before


def test_a_line_that_leaves_the_page_leaves_its_dots_there():
    document = document_of()
    k = drawn(document, curve(meeting="adhere", reach_mm=2.0))
    document.begin("Move")
    set_line(document, k, Line("far", Path.polyline([(-50, 20), (50, 20)]), meeting="adhere"))
    document.commit()
    at = document.dots.position_mm
    assert ((at >= 0) & (at <= (60, 40))).all()


def test_dots_are_spread_on_all_lines_by_the_tone():
    document = document_of(0)
    document.begin("Rows")
    k = add_line(document, Line("a", Path.polyline([(10, 20), (50, 20)])))
    rows = document.insert(Dots.round([(10 + s, 20) for s in (1, 2, 3, 30)], 0.1))
    document.change("constraint", rows, np.full(4, ON_CURVE, np.int8))
    document.change("curve", rows, np.full(4, k, np.int32))
    document.change("parameter", rows, np.array([1.0, 2.0, 3.0, 30.0]))
    document.commit()
    document.begin("Spread")
    assert spread_held(document) == 4
    document.commit()
    assert np.allclose(document.dots.parameter, [5, 15, 25, 35])
    document.begin("Spread")
    assert spread_held(document) == 0
    assert document.commit().is_empty


def test_lines_are_found_under_the_pointer():
    document = document_of(0)
    document.begin("Lines")
    a = add_line(document, Line("a", Path.polyline([(10, 10), (50, 10)]), (4.0, 0.0)))
    b = add_line(document, Line("b", Path.polyline([(10, 30), (50, 30)]), hidden=True))
    document.commit()
    assert away_mm(document.drawing.lines[a], (30, 15)) == pytest.approx(4.0)
    assert line_at(document, (12, 11.5), 0.1) == a
    assert line_at(document, (48, 11.5), 0.1) is None
    assert line_at(document, (30, 30), 5.0) is None  # hidden
    chosen = ChosenLines()
    chosen.choose(a)
    chosen.choose(99)
    assert chosen.alive(document) == []
    assert b != a
