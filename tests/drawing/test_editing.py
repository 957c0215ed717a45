"""Strokes, undo, redo, runs and late results, in any order."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from shapely.geometry import Polygon

from stippler.drawing.area import Area
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.editing import Editing

NAMES = [f.name for f in fields(Dots)]
SHARES = st.lists(st.floats(0, 0.999), min_size=1, max_size=6)
PLACES = st.lists(st.tuples(st.floats(-1, 21), st.floats(-1, 11)), min_size=1, max_size=6)


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in NAMES)


def some_dots(n=40, seed=3):
    rng = np.random.default_rng(seed)
    dots = Dots.round(rng.uniform(0, 1, (n, 2)) * (20, 10), rng.uniform(0.1, 0.3, n))
    dots.fixed[:] = rng.uniform(size=n) < 0.2
    return dots


def some_drawing(n=40):
    drawing = Drawing.blank(Page(20, 10))
    drawing.dots = some_dots(n)
    return drawing


class EditingMachine(RuleBasedStateMachine):
    """Every state a step of the history leads to is kept as a copy and compared to the bit."""

    def __init__(self):
        super().__init__()
        self.start = some_dots()
        drawing = some_drawing()
        self.editing = Editing(drawing, budget_bytes=2000)  # so that steps lie on disk, too
        self.states = [self.start.copy()]  # without runs: what undo and redo lead to
        self.at = 0
        self.before = None
        self.moved_by_run = False
        self.shown = {}

    def teardown(self):
        self.editing.history.close()

    def rows(self, shares):
        n = len(self.editing.dots)
        return np.unique((np.array(shares) * n).astype(np.int64)) if n else np.empty(0, np.int64)

    def ensure_stroke(self):
        if not self.editing.in_stroke:
            self.before = self.editing.dots.copy()
            self.editing.begin("stroke")

    @rule(shares=SHARES, dx=st.floats(-3, 3), dy=st.floats(-3, 3))
    def move(self, shares, dx, dy):
        self.ensure_stroke()
        rows = self.rows(shares)
        fixed = self.editing.dots.position_mm[self.editing.dots.fixed].copy()
        self.editing.move(rows, self.editing.dots.position_mm[rows] + (dx, dy))
        assert np.array_equal(fixed, self.editing.dots.position_mm[self.editing.dots.fixed])

    @rule(shares=SHARES, radius=st.floats(0.0625, 1, width=32), fixed=st.booleans())
    def change(self, shares, radius, fixed):
        self.ensure_stroke()
        rows = self.rows(shares)
        self.editing.change("radius_mm", rows, np.full(len(rows), radius, np.float32))
        self.editing.change("fixed", rows, np.full(len(rows), fixed))

    @rule(places=PLACES)
    def insert(self, places):
        self.ensure_stroke()
        self.editing.insert(Dots.round(places, 0.2))

    @rule(shares=SHARES)
    def remove(self, shares):
        self.ensure_stroke()
        self.editing.remove(self.rows(shares))

    @precondition(lambda self: self.editing.in_stroke)
    @rule()
    def commit(self):
        edit = self.editing.commit()
        if edit.is_empty:
            return
        del self.states[self.at + 1 :]
        self.states.append(self.editing.dots.copy())
        self.at += 1

    @precondition(lambda self: self.editing.in_stroke and not self.editing.in_run)
    @rule()
    def cancel(self):
        self.editing.cancel()
        assert same(self.editing.dots, self.before)

    @precondition(lambda self: not self.editing.in_stroke and not self.editing.in_run)
    @rule()
    def undo(self):
        assert self.editing.undo() == (self.at > 0)
        self.at = max(self.at - 1, 0)
        assert same(self.editing.dots, self.states[self.at])

    @precondition(lambda self: not self.editing.in_stroke and not self.editing.in_run)
    @rule()
    def redo(self):
        assert self.editing.redo() == (self.at + 1 < len(self.states))
        self.at = min(self.at + 1, len(self.states) - 1)
        assert same(self.editing.dots, self.states[self.at])

    @precondition(lambda self: not self.editing.in_stroke and not self.editing.in_run)
    @rule(seed=st.integers(0, 9), strokes=st.integers(0, 2))
    def run(self, seed, strokes):
        """A run with strokes in its midst; all of it undone and done again."""
        editing, rng = self.editing, np.random.default_rng(seed)
        if not len(editing.dots):
            return
        start = editing.dots.copy()
        frozen = editing.begin_run("relax")
        for k in range(strokes + 1):
            result = rng.uniform(0, 1, (len(frozen), 2)) * (20, 10)
            editing.merge(result)
            if k < strokes:
                editing.begin("within the run")
                rows = self.rows(rng.uniform(0, 0.999, 5))
                editing.move(rows, editing.dots.position_mm[rows] + 0.5)
                hand = editing.dots.id[rows], editing.dots.position_mm[rows].copy()
                if k:
                    editing.remove(self.rows(rng.uniform(0, 0.999, 3)))
                editing.insert(Dots.round([(1, 1)], 0.1))
                editing.merge(rng.uniform(0, 1, (len(frozen), 2)) * (20, 10))
                there = editing.rows(hand[0])
                kept = there >= 0
                assert np.array_equal(editing.dots.position_mm[there[kept]], hand[1][kept])
                editing.commit()
        editing.end_run()
        end = editing.dots.copy()
        n_done = editing.history.n_done
        while editing.history.n_done > self.at:
            editing.undo()
        assert same(editing.dots, start)
        del self.states[self.at + 1 :]
        while editing.redo():
            self.states.append(editing.dots.copy())
            self.at += 1
        assert editing.history.n_done == n_done == self.at
        assert same(editing.dots, end)

    @invariant()
    def whole(self):
        editing = self.editing
        dots = editing.dots
        assert len(np.unique(dots.id)) == len(dots)
        assert np.array_equal(editing.rows(dots.id), np.arange(len(dots)))
        assert (dots.position_mm >= 0).all()
        assert (dots.position_mm <= (20, 10)).all()
        box = (3.0, 2.0, 11.0, 7.5)
        x, y = dots.position_mm.T
        inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
        assert np.array_equal(editing.in_box(box), np.flatnonzero(inside))

    @invariant()
    def changes_are_told(self):
        """What the GPU was told adds up to what there is."""
        changed = self.editing.take_changed()
        rows, dots = changed.rows, self.editing.dots
        if changed.places and "id" in self.shown and len(dots) == len(self.shown["id"]):
            self.shown["position_mm"] = dots.position_mm.copy()
        if rows is None or len(dots) != len(self.shown.get("id", ())):
            self.shown = {name: getattr(dots, name).copy() for name in NAMES}
            return
        for name in NAMES:
            self.shown[name][rows] = getattr(dots, name)[rows]
            assert np.array_equal(self.shown[name], getattr(dots, name))


TestEditing = EditingMachine.TestCase
TestEditing.settings = settings(max_examples=60, stateful_step_count=30)


def test_a_stroke_is_one_step_whatever_it_did():
    editing = Editing(some_drawing())
    editing.begin("much")
    for k in range(50):
        editing.move(np.arange(10), editing.dots.position_mm[:10] + 0.01 * k)
    editing.remove(np.array([3, 4]))
    edit = editing.commit()
    assert len(editing.history.steps) == 1
    assert len(edit.changes["position_mm"].ids) <= 10
    editing.undo()
    assert same(editing.dots, some_dots())


def test_dots_that_came_and_went_within_a_stroke_leave_no_trace():
    editing = Editing(some_drawing())
    editing.begin("nothing")
    rows = editing.insert(Dots.round([(1, 1), (2, 2)], 0.2))
    editing.remove(rows)
    assert editing.commit().is_empty
    assert not editing.history.steps


def test_old_steps_lie_on_disk_and_come_back(tmp_path):
    editing = Editing(some_drawing(), budget_bytes=1)
    states = [editing.dots.copy()]
    for k in range(6):
        editing.begin("move")
        editing.move(np.arange(20), editing.dots.position_mm[:20] + 0.1 * k + 0.1)
        editing.commit()
        states.append(editing.dots.copy())
    on_disk = [step.path for step in editing.history.steps if step.path]
    assert len(on_disk) == 5
    for state in reversed(states[:-1]):
        editing.undo()
        assert same(editing.dots, state)
    for state in states[1:]:
        editing.redo()
        assert same(editing.dots, state)
    folder = next(step.path for step in editing.history.steps if step.path).parent
    editing.history.close()
    assert not folder.exists()


def test_undoing_an_open_run_ends_it():
    editing = Editing(some_drawing())
    start = editing.dots.copy()
    editing.begin_run("relax")
    editing.merge(np.full((40, 2), 5.0))
    assert not same(editing.dots, start)
    assert editing.undo()
    assert not editing.in_run
    assert same(editing.dots, start)
    assert editing.merge(np.full((40, 2), 6.0)) == 0


def test_a_run_keeps_going_below_strokes_that_were_undone():
    editing = Editing(some_drawing())
    editing.begin_run("relax")
    editing.begin("stroke")
    free = np.flatnonzero(~editing.dots.fixed)[:3]
    editing.move(free, editing.dots.position_mm[free] * 0.5)
    painted = editing.dots.position_mm[free].copy()
    editing.commit()
    assert editing.undo()
    assert editing.in_run
    assert editing.merge(np.full((40, 2), 5.0)) > 0
    assert editing.redo()
    assert np.array_equal(editing.dots.position_mm[free], painted)


def test_dots_do_not_leave_an_area_with_a_hole():
    drawing = Drawing.blank(Page(10, 10))
    ring = Polygon([(0, 0), (10, 0), (10, 10), (0, 10)], [[(4, 4), (6, 4), (6, 6), (4, 6)]])
    drawing.areas = [Area("ring", ring)]
    drawing.dots = Dots.round([(3, 5), (9, 9)], 0.2)
    editing = Editing(drawing)
    editing.begin("push")
    editing.move(np.array([0, 1]), np.array([(5.0, 5.0), (12.0, 9.0)]))
    (x, y), other = editing.dots.position_mm
    assert 3 < x <= 4
    assert y == 5
    assert 9 < other[0] <= 10
    assert len(editing.insert(Dots.round([(5, 5), (1, 1), (-1, 3)], 0.2))) == 1


def test_strokes_have_to_begin_and_end():
    editing = Editing(some_drawing())
    with pytest.raises(ValueError, match="no stroke"):
        editing.change("radius_mm", np.array([0]), np.array([1.0], np.float32))
    editing.begin("one")
    with pytest.raises(ValueError, match="has begun"):
        editing.begin("two")
    with pytest.raises(ValueError, match="has begun"):
        editing.undo()


@pytest.mark.parametrize("n_results", [0, 1, 3, 30])
def test_nearest_and_apart_agree_with_brute_force(n_results):
    """After small moves of all dots, too, which the index only takes note of."""
    editing = Editing(some_drawing(400))
    rng = np.random.default_rng(5)
    editing.begin_run("relax")
    for _ in range(n_results):
        moved = editing.dots.position_mm + rng.uniform(-0.1, 0.1, (400, 2))
        editing.merge(np.clip(moved, 0, (20, 10)))
    box = (3.0, 2.0, 11.0, 7.5)
    x, y = editing.dots.position_mm.T
    inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
    assert np.array_equal(editing.in_box(box), np.flatnonzero(inside))
    points = rng.uniform(-1, 21, (200, 2)) * (1, 0.5)
    position = editing.dots.position_mm
    distance = np.hypot(*(points[:, None] - position[None]).transpose(2, 0, 1))
    for k, (x, y) in enumerate(points):
        near = editing.nearest(x, y, 0.8)
        least = int(distance[k].argmin())
        assert near == (least if distance[k, least] <= 0.8 else None)
    kept = []
    for p, d in zip(points, distance, strict=True):
        before = points[: len(kept)][np.array(kept, np.bool_)]
        kept.append(d.min() >= 0.5 and all(np.hypot(*(p - q)) >= 0.5 for q in before))
    assert np.array_equal(editing.apart(points, 0.5), kept)
    between = np.hypot(*(position[:, None] - position[None]).transpose(2, 0, 1))
    np.fill_diagonal(between, np.inf)
    told = editing.nearest_distances(np.arange(400), 3.0)
    assert np.allclose(told, np.minimum(between.min(axis=1), 3.0), rtol=1e-12)
