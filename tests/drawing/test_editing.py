"""Strokes, undo, redo, runs and late results, in any order."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from shapely.geometry import Polygon

from stippler.drawing.adjustment import Adjustment
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.edit import Edit
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from tests.conftest import EXAMPLES

NAMES = [f.name for f in fields(Dots)]
SHARES = st.lists(st.floats(0, 0.999), min_size=1, max_size=6)
PLACES = st.lists(st.tuples(st.floats(-1, 21), st.floats(-1, 11)), min_size=1, max_size=6)


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in NAMES)


def some_dots(n=40, seed=3):
    rng = np.random.default_rng(seed)
    dots = Dots.round(rng.uniform(0, 1, (n, 2)) * (20, 10), rng.uniform(0.1, 0.3, n))
    dots.constraint[:] = rng.uniform(size=n) < 0.2
    return dots


def some_drawing(n=40):
    drawing = Drawing.blank(Page(20, 10))
    drawing.dots = some_dots(n)
    drawing.reference = Reference(np.linspace(0, 1, 200, dtype=np.float32).reshape(10, 20), 20.0)
    return drawing


def values(drawing):
    """All that is no dot: values are frozen, so holding them is a copy."""
    tables = {kind: dict(drawing.table(kind)) for kind in ("area", "style", "line", "pattern")}
    return tables | {"page": drawing.page, "reference": drawing.reference}


def whole(drawing):
    return drawing.dots.copy(), values(drawing)


def alike(a, b):
    return same(a[0], b[0]) and a[1] == b[1]


class EditingMachine(RuleBasedStateMachine):
    """Every state a step of the history leads to is kept as a copy and compared to the bit."""

    def __init__(self):
        super().__init__()
        self.start = some_dots()
        drawing = some_drawing()
        self.document = Document(drawing, budget_bytes=2000)  # so that steps lie on disk, too
        self.states = [whole(drawing)]  # without runs: what undo and redo lead to
        self.entries = []
        self.document.follow(lambda entry: self.entries.append((entry, entry.edit)))
        self.most_id = {}
        self.at = 0
        self.before = None
        self.shown, self.cursor = {}, 0
        self.merged = False  # whether a result came since the changes were looked at

    def teardown(self):
        self.document.history.close()

    def rows(self, shares):
        n = len(self.document.dots)
        return np.unique((np.array(shares) * n).astype(np.int64)) if n else np.empty(0, np.int64)

    def ensure_stroke(self):
        if not self.document.in_stroke:
            self.before = whole(self.document.drawing)
            self.document.begin("stroke")

    @rule(dots=st.integers(1, 9), name=st.sampled_from("abc"))
    def value(self, dots, name):
        self.ensure_stroke()
        document, drawing = self.document, self.document.drawing
        i = document.add("style", Style(n_dots=dots, name=name))
        assert i > self.most_id.get("style", 0)
        self.most_id["style"] = i
        x = float(dots)
        area = Area(name, Polygon([(x, 1), (x + 6, 2), (x + 5, 9)]), style=i)
        document.set("area", document.add("area", area), None if dots == 1 else area)
        document.set("reference", 0, drawing.reference.adjusted(Adjustment(contrast=dots / 10)))
        document.own_by_place(np.arange(len(document.dots)))

    @rule(which=st.integers(1, 20))
    def drop(self, which):
        self.ensure_stroke()
        rows = np.flatnonzero(self.document.dots.area == which)
        self.document.change("area", rows, np.zeros(len(rows), np.int32))
        self.document.set("area", which, None)

    @rule(shares=SHARES, dx=st.floats(-3, 3), dy=st.floats(-3, 3))
    def move(self, shares, dx, dy):
        self.ensure_stroke()
        rows = self.rows(shares)
        fixed = self.document.dots.position_mm[self.document.dots.fixed].copy()
        self.document.move(rows, self.document.dots.position_mm[rows] + (dx, dy))
        assert np.array_equal(fixed, self.document.dots.position_mm[self.document.dots.fixed])

    @rule(shares=SHARES, radius=st.floats(0.0625, 1, width=32), fixed=st.booleans())
    def change(self, shares, radius, fixed):
        self.ensure_stroke()
        rows = self.rows(shares)
        self.document.change("radius_mm", rows, np.full(len(rows), radius, np.float32))
        self.document.change("constraint", rows, np.full(len(rows), fixed, np.int8))

    @rule(places=PLACES)
    def insert(self, places):
        self.ensure_stroke()
        self.document.insert(Dots.round(places, 0.2))

    @rule(shares=SHARES)
    def remove(self, shares):
        self.ensure_stroke()
        self.document.remove(self.rows(shares))

    @precondition(lambda self: self.document.in_stroke)
    @rule()
    def commit(self):
        edit = self.document.commit()
        if edit.is_empty:
            assert alike(whole(self.document.drawing), self.before)
            return
        del self.states[self.at + 1 :]
        self.states.append(whole(self.document.drawing))
        self.at += 1

    @precondition(lambda self: self.document.in_stroke)
    @rule()
    def cancel(self):
        self.document.cancel()
        assert alike(whole(self.document.drawing), self.before)

    @precondition(lambda self: not self.document.in_stroke)
    @rule()
    def undo(self):
        assert self.document.undo() == (self.at > 0)
        self.at = max(self.at - 1, 0)
        assert alike(whole(self.document.drawing), self.states[self.at])

    @precondition(lambda self: not self.document.in_stroke)
    @rule()
    def redo(self):
        assert self.document.redo() == (self.at + 1 < len(self.states))
        self.at = min(self.at + 1, len(self.states) - 1)
        assert alike(whole(self.document.drawing), self.states[self.at])

    @precondition(lambda self: not self.document.in_stroke)
    @rule(seed=st.integers(0, 9), sizes=st.lists(st.integers(0, 9), max_size=4))
    def make(self, seed, sizes):
        """A draft: it stands among the dots as it grows, and is one step."""
        document, rng = self.document, np.random.default_rng(seed)
        others = document.dots.id[document.dots.area != 0].copy()
        document.begin_draft("Stipple", 0, Style(n_dots=seed + 1, pen="quill"))
        self.merged = True
        n = 0
        for n in sizes:
            document.draft(rng.uniform(0, 1, (n, 2)) * (20, 10), np.full(n, 0.2, np.float32))
            assert len(document.dots) == len(others) + n
            with pytest.raises(ValueError, match="being made"):
                document.begin("stroke")
        document.draft(rng.uniform(0, 1, (n, 2)) * (20, 10), np.full(n, 0.3, np.float32))
        edit = document.end_draft()
        assert set(others) <= set(document.dots.id)
        if edit.is_empty:
            return
        if len(self.states) == 1 and not document.history.steps:
            self.states[0] = whole(document.drawing)  # it began so
            return
        del self.states[self.at + 1 :]
        self.states.append(whole(document.drawing))
        self.at += 1

    @precondition(lambda self: not self.document.in_stroke)
    @rule(which=st.data())
    def squash(self, which):
        """Steps joined are one edit that leads to the same, and comes back; through arrays, too."""
        steps = self.document.history.steps[: self.at]
        edits = [step.edit for step in steps if step.edit is not None]
        if len(edits) < 2 or any(step.edit is None for step in steps[-len(edits) :]):
            return
        first = self.at - len(edits)
        cut = which.draw(st.integers(1, len(edits) - 1))
        left, right = joined(edits[:cut]), joined(edits[cut:])
        drawing = at_state(self.states[first])
        other = Document(drawing)
        edit = left.then(right)
        pictures = {p.digest: p for p in edit.pictures.values()}
        other._apply(Edit.from_arrays(dict(edit.arrays()), pictures))
        assert alike(whole(drawing), self.states[self.at])
        other._apply(edit.inverse())
        assert alike(whole(drawing), self.states[first])
        assert edit.then(edit.inverse()).is_empty

    @precondition(lambda self: not self.document.in_stroke)
    @rule()
    def recover(self):
        """What was told, done again from the start, makes the same drawing with its history."""
        drawing = some_drawing()
        other = Document(drawing)
        for entry, _ in self.entries:
            other.replay(entry)
        assert alike(whole(drawing), whole(self.document.drawing))
        mine, others = self.document.history, other.history
        assert [s.label for s in mine.steps] == [s.label for s in others.steps]
        assert mine.n_done == others.n_done
        while other.undo():
            pass
        assert alike(whole(drawing), self.states[0])

    @precondition(lambda self: not self.document.in_stroke)
    @rule(seed=st.integers(0, 9), strokes=st.integers(0, 2))
    def run(self, seed, strokes):
        """A run with strokes in its midst; all of it undone and done again."""
        document, rng = self.document, np.random.default_rng(seed)
        if not len(document.dots):
            return
        start = document.dots.copy()
        frozen = document.begin_run("relax")
        for k in range(strokes + 1):
            result = rng.uniform(0, 1, (len(frozen), 2)) * (20, 10)
            document.merge(result)
            self.merged = True
            if k < strokes:
                document.begin("within the run")
                rows = self.rows(rng.uniform(0, 0.999, 5))
                document.move(rows, document.dots.position_mm[rows] + 0.5)
                hand = document.dots.id[rows], document.dots.position_mm[rows].copy()
                if k:
                    document.remove(self.rows(rng.uniform(0, 0.999, 3)))
                document.insert(Dots.round([(1, 1)], 0.1))
                document.merge(rng.uniform(0, 1, (len(frozen), 2)) * (20, 10))
                there = document.rows(hand[0])
                kept = there >= 0
                assert np.array_equal(document.dots.position_mm[there[kept]], hand[1][kept])
                document.commit()
            document.tell_run()
        document.end_run()
        end = document.dots.copy()
        n_done = document.history.n_done
        while document.history.n_done > self.at:
            document.undo()
        assert same(document.dots, start)
        del self.states[self.at + 1 :]
        while document.redo():
            self.states.append(whole(document.drawing))
            self.at += 1
        assert document.history.n_done == n_done == self.at
        assert same(document.dots, end)

    @invariant()
    def whole(self):
        document = self.document
        dots = document.dots
        assert len(np.unique(dots.id)) == len(dots)
        assert np.array_equal(document.rows(dots.id), np.arange(len(dots)))
        assert (dots.position_mm >= 0).all()
        assert (dots.position_mm <= (20, 10)).all()
        box = (3.0, 2.0, 11.0, 7.5)
        x, y = dots.position_mm.T
        inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
        assert np.array_equal(document.in_box(box), np.flatnonzero(inside))

    @invariant()
    def changes_are_told(self):
        """What the GPU was told adds up to what there is."""
        changed = self.document.changes.since(self.cursor)
        self.cursor = changed.cursor
        assert changed.places <= self.merged
        self.merged = False
        rows, dots = changed.rows, self.document.dots
        if changed.places and "id" in self.shown and len(dots) == len(self.shown["id"]):
            self.shown["position_mm"] = dots.position_mm.copy()
        if rows is None or len(dots) != len(self.shown.get("id", ())):
            self.shown = {name: getattr(dots, name).copy() for name in NAMES}
            return
        for name in NAMES:
            self.shown[name][rows] = getattr(dots, name)[rows]
            assert np.array_equal(self.shown[name], getattr(dots, name))


def joined(edits):
    whole = edits[0]
    for edit in edits[1:]:
        whole = whole.then(edit)
    return whole


def at_state(state):
    drawing = some_drawing()
    drawing.dots = state[0].copy()
    for kind, table in state[1].items():
        if isinstance(table, dict):
            drawing.table(kind).clear()
            drawing.table(kind).update(table)
        else:
            drawing.put(kind, 0, table)
    return drawing


TestEditing = EditingMachine.TestCase
TestEditing.settings = settings(max_examples=60 * EXAMPLES, stateful_step_count=30)


def test_a_stroke_is_one_step_whatever_it_did():
    document = Document(some_drawing())
    document.begin("much")
    for k in range(50):
        document.move(np.arange(10), document.dots.position_mm[:10] + 0.01 * k)
    document.remove(np.array([3, 4]))
    edit = document.commit()
    assert len(document.history.steps) == 1
    assert len(edit.dots.changes["position_mm"].ids) <= 10
    document.undo()
    assert same(document.dots, some_dots())


def test_dots_that_came_and_went_within_a_stroke_leave_no_trace():
    document = Document(some_drawing())
    document.begin("nothing")
    rows = document.insert(Dots.round([(1, 1), (2, 2)], 0.2))
    document.remove(rows)
    assert document.commit().is_empty
    assert not document.history.steps


def test_old_steps_lie_on_disk_and_come_back(tmp_path):
    document = Document(some_drawing(), budget_bytes=1)
    states = [document.dots.copy()]
    for k in range(6):
        document.begin("move")
        document.move(np.arange(20), document.dots.position_mm[:20] + 0.1 * k + 0.1)
        document.commit()
        states.append(document.dots.copy())
    on_disk = [step.path for step in document.history.steps if step.path]
    assert len(on_disk) == 5
    for state in reversed(states[:-1]):
        document.undo()
        assert same(document.dots, state)
    for state in states[1:]:
        document.redo()
        assert same(document.dots, state)
    folder = next(step.path for step in document.history.steps if step.path).parent
    document.history.close()
    assert not folder.exists()


def test_undoing_an_open_run_ends_it():
    document = Document(some_drawing())
    start = document.dots.copy()
    document.begin_run("relax")
    document.merge(np.full((40, 2), 5.0))
    assert not same(document.dots, start)
    assert document.undo()
    assert not document.in_run
    assert same(document.dots, start)
    assert document.merge(np.full((40, 2), 6.0)) == 0


def test_a_run_keeps_going_below_strokes_that_were_undone():
    document = Document(some_drawing())
    document.begin_run("relax")
    document.begin("stroke")
    free = np.flatnonzero(~document.dots.fixed)[:3]
    document.move(free, document.dots.position_mm[free] * 0.5)
    painted = document.dots.position_mm[free].copy()
    document.commit()
    assert document.undo()
    assert document.in_run
    assert document.merge(np.full((40, 2), 5.0)) > 0
    assert document.redo()
    assert np.array_equal(document.dots.position_mm[free], painted)


def test_dots_do_not_leave_an_area_with_a_hole():
    drawing = Drawing.blank(Page(10, 10))
    ring = Polygon([(0, 0), (10, 0), (10, 10), (0, 10)], [[(4, 4), (6, 4), (6, 6), (4, 6)]])
    drawing.areas = {0: Area("ring", ring)}
    drawing.dots = Dots.round([(3, 5), (9, 9)], 0.2)
    document = Document(drawing)
    document.begin("push")
    document.move(np.array([0, 1]), np.array([(5.0, 5.0), (12.0, 9.0)]))
    (x, y), other = document.dots.position_mm
    assert 3 < x <= 4
    assert y == 5
    assert 9 < other[0] <= 10
    assert len(document.insert(Dots.round([(5, 5), (1, 1), (-1, 3)], 0.2))) == 1


def test_strokes_have_to_begin_and_end():
    document = Document(some_drawing())
    with pytest.raises(ValueError, match="no stroke"):
        document.change("radius_mm", np.array([0]), np.array([1.0], np.float32))
    document.begin("one")
    with pytest.raises(ValueError, match="has begun"):
        document.begin("two")
    with pytest.raises(ValueError, match="has begun"):
        document.undo()


@pytest.mark.parametrize("n_results", [0, 1, 3, 30])
def test_nearest_and_apart_agree_with_brute_force(n_results):
    """After small moves of all dots, too, which the index only takes note of."""
    document = Document(some_drawing(400))
    rng = np.random.default_rng(5)
    document.begin_run("relax")
    for _ in range(n_results):
        moved = document.dots.position_mm + rng.uniform(-0.1, 0.1, (400, 2))
        document.merge(np.clip(moved, 0, (20, 10)))
    box = (3.0, 2.0, 11.0, 7.5)
    x, y = document.dots.position_mm.T
    inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
    assert np.array_equal(document.in_box(box), np.flatnonzero(inside))
    points = rng.uniform(-1, 21, (200, 2)) * (1, 0.5)
    position = document.dots.position_mm
    distance = np.hypot(*(points[:, None] - position[None]).transpose(2, 0, 1))
    for k, (x, y) in enumerate(points):
        near = document.nearest(x, y, 0.8)
        least = int(distance[k].argmin())
        assert near == (least if distance[k, least] <= 0.8 else None)
    kept = []
    for p, d in zip(points, distance, strict=True):
        before = points[: len(kept)][np.array(kept, np.bool_)]
        kept.append(d.min() >= 0.5 and all(np.hypot(*(p - q)) >= 0.5 for q in before))
    assert np.array_equal(document.apart(points, 0.5), kept)
    between = np.hypot(*(position[:, None] - position[None]).transpose(2, 0, 1))
    np.fill_diagonal(between, np.inf)
    told = document.nearest_distances(np.arange(400), 3.0)
    assert np.allclose(told, np.minimum(between.min(axis=1), 3.0), rtol=1e-12)
