"""Brushes and lines: no dot comes nearer to a line than it may; new dots line up on others."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.brushes import selection
from stippler.brushes.brush import Brush
from stippler.brushes.kinds import KINDS
from stippler.brushes.motion import moved
from stippler.brushes.stroke import Stroke
from stippler.brushes.stroke_path import PointerSample
from stippler.drawing.document import Document
from stippler.drawing.dots import FREE, NO_CURVE, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.planar.moves import smooth_path
from stippler.drawing.planar.path import Path
from stippler.drawing.reference import Reference

SIZE = (40.0, 30.0)
CURVE = smooth_path(Path.polyline([(5, 8), (16, 20), (26, 9), (36, 22)]))
WIDTH, DISTANCE = 0.5, 0.6
KEPT = WIDTH / 2 + DISTANCE


def keeping_off(path=CURVE, **values):
    return Line("off", path, (WIDTH, WIDTH), meeting="distance", distance_mm=DISTANCE, **values)


def adhering(path=CURVE, **values):
    return Line("on", path, (0.0, 0.0), meeting="adhere", **({"reach_mm": 1.5} | values))


def document_of(*lines, n=1500, seed=1):
    """Return a document whose dots lie off all zones."""
    drawing = Drawing.blank(Page(*SIZE))
    at = np.random.default_rng(seed).random((n, 2)) * SIZE
    far = [shapely.distance(axis_of(one), shapely.points(at)) for one in lines]
    drawing.dots = Dots.round(at[np.min(far, axis=0) > KEPT + 0.01], 0.12)
    drawing.lines = dict(enumerate(lines))
    ramp = np.linspace(0.1, 0.9, 400, dtype=np.float32) * np.ones((300, 1), np.float32)
    drawing.reference = Reference(ramp, SIZE[0])
    return Document(drawing)


def axis_of(line):
    return shapely.linestrings(line.path.points_mm)


def nearest(document, line, rows=slice(None)):
    return shapely.distance(axis_of(line), shapely.points(document.dots.position_mm[rows]))


def stroke(document, kind, seed=0, points=None, **values):
    """Press, go across the line and back along it, and let go."""
    brush = Brush(kind, kind, 4.0, values=values)
    rng = np.random.default_rng(seed)
    points = np.asarray(rng.random((6, 2)) * SIZE if points is None else points, np.float64)
    share = np.linspace(0.0, len(points) - 1, 6 * len(points) - 5)
    x, y = (np.interp(share, np.arange(len(points)), points[:, k]) for k in (0, 1))
    steps = [PointerSample(*at, t=0.02 * k) for k, at in enumerate(zip(x, y, strict=True))]
    one = Stroke(document, brush, steps[0], seed)
    for step in steps[1:]:
        one.follow(step)
    one.commit(steps[-1])


def state(document):
    dots = document.dots.by_id()
    names = ("position_mm", "constraint", "curve", "parameter", "radius_mm", "id")
    return [getattr(dots, name).tobytes() for name in names]


@pytest.mark.parametrize("kind", [kind.name for kind in KINDS])
@pytest.mark.parametrize("seed", [0, 1, 2])
def test_no_brush_brings_a_dot_into_the_zone_of_a_line(kind, seed):
    line = keeping_off()
    document = document_of(line, seed=seed)
    before = state(document)
    stroke(document, kind, seed)
    assert nearest(document, line).min() >= KEPT - 1e-6
    assert ((document.dots.position_mm >= 0) & (document.dots.position_mm <= SIZE)).all()
    document.undo()
    assert state(document) == before


def test_dots_that_are_pushed_slide_along_the_zone_and_do_not_cross_it():
    straight = keeping_off(Path.polyline([(20, -5), (20, 35)]))
    document = document_of(straight)
    left = document.dots.id[document.dots.position_mm[:, 0] < 20].copy()
    for _ in range(3):
        stroke(document, "push", points=[(8, 15), (19, 16), (30, 17)])
    at = document.dots.position_mm[document.rows(left)]
    assert (at[:, 0] <= 20 - KEPT + 1e-6).all()
    assert np.isclose(at[:, 0], 20 - KEPT, atol=1e-6).sum() > 5  # they stand along its edge


def test_a_dot_that_is_dragged_hops_over_a_line():
    straight = keeping_off(Path.polyline([(20, -5), (20, 35)]))
    document = document_of(straight, n=0)
    document.begin("Add")
    document.insert(Dots.round([(10.0, 15.0)], 0.1))
    document.commit()
    stroke(document, "drag", points=[(10, 15), (19.8, 15)])
    assert document.dots.position_mm[0, 0] == pytest.approx(20 - KEPT, abs=1e-6)
    stroke(document, "drag", points=[(20 - KEPT, 15), (20.2, 15)])
    assert document.dots.position_mm[0, 0] == pytest.approx(20 + KEPT, abs=1e-6)


def test_a_dot_is_added_on_the_edge_and_none_is_sprayed_into_a_zone():
    straight = keeping_off(Path.polyline([(20, -5), (20, 35)]))
    document = document_of(straight, n=0)
    stroke(document, "add", points=[(20.3, 15), (20.3, 15)])
    assert document.dots.position_mm[0] == pytest.approx((20 + KEPT, 15), abs=1e-6)
    stroke(document, "spray", points=[(20, 15)] * 8, apart_mm=0.0)
    assert len(document.dots) > 50
    edge = np.abs(nearest(document, straight) - KEPT) < 1e-3
    assert edge.sum() < 5  # they are left out, not gathered on its edge


@pytest.mark.parametrize("act", ["move", "duplicate", "shake", "relax"])
def test_what_is_done_to_a_selection_keeps_off_lines(act):
    line = keeping_off()
    document = document_of(line)
    ids = document.dots.id[:500].copy()
    document.begin(act)
    if act == "move":
        moved(document, document.rows(ids), (0.7, 0.9))
    elif act == "duplicate":
        selection.duplicate(document, ids)
    elif act == "shake":
        selection.shake(document, ids, np.random.default_rng(1))
    else:
        selection.relax(document, ids)
    document.commit()
    assert nearest(document, line).min() >= KEPT - 1e-6


def test_a_hidden_line_keeps_no_dot_off_and_holds_none():
    document = document_of(keeping_off(hidden=True), adhering(hidden=True), n=0)
    stroke(document, "spray", points=[(16, 20)] * 8, apart_mm=0.0)
    assert nearest(document, keeping_off()).min() < KEPT
    assert (document.dots.constraint == FREE).all()


@given(st.integers(0, 9999), st.floats(0.0, 0.8))
@settings(max_examples=15, deadline=None)
def test_sprayed_dots_within_reach_lie_on_the_line(seed, apart):
    line = adhering()
    document = document_of(line, n=0)
    before = state(document)
    stroke(document, "spray", seed, points=[(12, 15), (16, 20), (22, 14)], apart_mm=apart)
    dots = document.dots
    on = dots.constraint == ON_CURVE
    assert on.sum() > 3
    assert (dots.curve[on] == 0).all()
    assert (dots.curve[~on] == NO_CURVE).all()
    assert np.allclose(line.at(dots.parameter[on]), dots.position_mm[on], atol=1e-9)
    s = np.sort(dots.parameter[on])
    assert np.diff(s).min() >= min(max(apart, 0.4) * 0.5, 0.2)  # none upon another
    assert len(document.history.steps) == 1
    document.undo()
    assert state(document) == before
    document.redo()
    assert (document.dots.constraint == ON_CURVE).sum() == on.sum()


def test_an_added_dot_within_reach_lies_on_the_line_unless_one_is_there():
    straight = adhering(Path.polyline([(20, -5), (20, 35)]))
    document = document_of(straight, n=0)
    stroke(document, "add", points=[(21, 15), (21, 15)])
    assert document.dots.position_mm[0] == pytest.approx((20, 15))
    assert document.dots.constraint[0] == ON_CURVE
    stroke(document, "add", points=[(21, 15.1), (21, 15.1)])
    assert document.dots.position_mm[1] == pytest.approx((21, 15.1))
    assert document.dots.constraint[1] == FREE


def test_a_line_that_is_changed_or_goes_is_met_as_it_is():
    line = adhering()
    document = document_of(line, n=0)
    stroke(document, "spray", points=[(16, 20)] * 4)
    n = int((document.dots.constraint == ON_CURVE).sum())
    assert n > 0
    document.begin("Delete")
    document.set("line", 0, None)
    document.commit()
    n_before = len(document.dots)
    stroke(document, "spray", points=[(16, 20)] * 12, apart_mm=0.0)
    assert (document.dots.constraint[n_before:] == FREE).all()
    document.undo()
    document.undo()
    stroke(document, "spray", points=[(26, 9)] * 6)
    assert (document.dots.constraint == ON_CURVE).sum() > n
