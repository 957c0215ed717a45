"""New dots, stippled, processed and filled, line up on lines that they adhere to."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import FREE, NO_CURVE, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.planar.moves import smooth_path
from stippler.drawing.planar.path import Path
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.jobs.processing import process_now
from stippler.jobs.stippling import fill
from stippler.kernels.machine.pool import set_threads
from stippler.stippling.fill import Filling

SIZE = (60.0, 40.0)
CURVE = smooth_path(Path.polyline([(6, 8), (25, 25), (40, 12), (53, 22)]))


def adhering(path=CURVE, **values):
    return Line("line", path, (0.0, 0.0), **({"meeting": "adhere", "reach_mm": 1.5} | values))


def drawing_of(*lines, dark=0.4, style=None):
    drawing = Drawing.blank(Page(*SIZE), style or Style(n_dots=1500, iterations=8))
    drawing.reference = Reference(np.full((400, 600), dark, np.float32), SIZE[0])
    drawing.lines = dict(enumerate(lines))
    drawing.dots = Dots.round([(1.0, 1.0)], 0.1)  # or the first ones would be no step
    return drawing


def state(document):
    dots = document.dots.by_id()
    names = ("position_mm", "radius_mm", "constraint", "curve", "parameter", "area", "id")
    return [getattr(dots, name).tobytes() for name in names]


def gaps(document, k=0):
    dots, line = document.dots, document.drawing.lines[k]
    on = (dots.constraint == ON_CURVE) & (dots.curve == k)
    assert np.allclose(line.at(dots.parameter[on]), dots.position_mm[on], atol=1e-9)
    return np.diff(np.sort(dots.parameter[on]))


def test_processed_dots_line_up_and_it_is_one_step():
    document = Document(drawing_of(adhering()))
    before = state(document)
    process_now(document, [0])
    found = gaps(document)
    assert found.mean() == pytest.approx(1.0746 * np.sqrt(2400 / 1500), rel=0.12)
    assert np.ptp(found) < 0.01 * found.mean()
    assert len(document.dots) == 1500
    from scipy.spatial import KDTree

    at, on = document.dots.position_mm, document.dots.constraint == ON_CURVE
    nearest = KDTree(at).query(at, k=2)[0][:, 1]
    assert nearest[on].min() > 0.45 * np.median(nearest)  # the others have made room
    assert len(document.history.steps) == 1
    after = state(document)
    document.undo()
    assert state(document) == before
    document.redo()
    assert state(document) == after


def test_their_sizes_are_solved_where_they_lie():
    """Tone is that of a drawing without the line, within what dots of this number can draw."""
    from stippler.kernels.tone.union_share import shares_of_union

    inked = []
    for lines in ((), (adhering(),)):
        document = Document(drawing_of(*lines))
        process_now(document, [0])
        dots = document.dots
        of = np.column_stack((dots.position_mm, dots.radius_mm)).astype(np.float32)
        inked.append(float((np.pi * shares_of_union(of) * np.square(dots.radius_mm)).sum()))
    assert inked[1] == pytest.approx(inked[0], rel=0.01)


def test_processing_anew_keeps_those_that_a_line_holds_and_adds_no_more_than_fit():
    document = Document(drawing_of(adhering()))
    process_now(document, [0])
    first = len(gaps(document))
    held = document.dots.id[document.dots.constraint == ON_CURVE].copy()
    places = document.dots.position_mm[document.rows(held)].copy()
    process_now(document, [0])
    rows = document.rows(held)
    assert (rows >= 0).all()
    assert np.array_equal(document.dots.position_mm[rows], places)
    assert len(gaps(document)) <= first + 3


def test_an_area_lays_dots_on_its_part_of_a_line():
    drawing = drawing_of(adhering(Path.polyline([(-5, 20), (65, 20)])))
    drawing.areas = {**drawing.areas, 1: Area("round", shapely.Point(30, 20).buffer(11.3))}
    document = Document(drawing)
    process_now(document, [1])
    dots = document.dots
    on = dots.constraint == ON_CURVE
    assert on.sum() > 10
    assert (np.hypot(*(dots.position_mm[1:] - (30, 20)).T) <= 11.3 + 1e-6).all()
    assert (dots.area[1:] == 1).all()
    found = gaps(document)
    assert np.ptp(found) < 0.01 * found.mean()
    process_now(document, [0])
    dots = document.dots
    assert (dots.area[dots.constraint == ON_CURVE] == 0).sum() > 10


@pytest.mark.parametrize("arrangement", ["random", "hexagonal"])
def test_filled_dots_line_up_beside_those_that_are_there(arrangement):
    drawing = drawing_of(adhering())
    drawing.dots = Dots.round(np.random.default_rng(1).random((200, 2)) * SIZE, 0.1)
    document = Document(drawing)
    values = Filling(n_dots=900, arrangement=arrangement)
    *_, last = fill([shapely.box(0, 0, *SIZE)], values, document.drawing.snapshot())
    n = len(last.points_mm)
    assert last.held is not None
    on = last.held.curve != NO_CURVE
    assert on.sum() > 20
    line = document.drawing.lines[0]
    assert np.allclose(line.at(last.held.along_mm[on]), last.points_mm[on], atol=1e-9)
    *_, plain = fill([shapely.box(0, 0, *SIZE)], values)
    assert len(plain.points_mm) == n
    far = shapely.distance(shapely.linestrings(CURVE.points_mm), shapely.points(plain.points_mm))
    away = far > 12.0
    assert np.array_equal(plain.points_mm[away], last.points_mm[away])  # far from it none moves


def test_hidden_lines_and_those_that_are_ignored_take_none():
    for line in (adhering(hidden=True), adhering(meeting="ignore"), adhering(reach_mm=0.0)):
        document = Document(drawing_of(line))
        process_now(document, [0])
        assert (document.dots.constraint == FREE).all()


def test_any_number_of_threads_lays_the_same():
    made = []
    try:
        for n in (1, 3):
            set_threads(n)
            document = Document(drawing_of(adhering(), style=Style(n_dots=3000, iterations=3)))
            process_now(document, [0])
            made.append(state(document))
    finally:
        set_threads(0)
    assert made[0] == made[1]


def test_a_drawing_whose_lines_take_no_dots_is_drawn_as_without_them():
    plain, lined = Document(drawing_of()), Document(drawing_of(adhering(meeting="ignore")))
    for document in (plain, lined):
        process_now(document, [0])
    assert state(plain) == state(lined)
    far = replace(adhering(), path=Path.polyline([(-30, -30), (-20, -30)]))
    away = Document(drawing_of(far))
    process_now(away, [0])
    assert state(away) == state(plain)
