"""Strokes of every brush, undos, redos, runs, cancels and late results, in any order."""

from dataclasses import fields

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule
from shapely.geometry import Polygon

from stippler.brushes import selection
from stippler.brushes.brush import Brush
from stippler.brushes.kinds import KINDS
from stippler.brushes.stroke import Stroke
from stippler.brushes.stroke_path import PointerSample
from stippler.brushes.tip import Tip
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference

NAMES = [f.name for f in fields(Dots)]
SIZE = (20.0, 12.0)
RING = Polygon([(9, 2), (17, 3), (15, 10), (10, 9)], [[(12, 5), (14, 5), (13, 7)]])
TIPS = (Tip(), Tip("square", 1.0), Tip("polygon", corners=((-1, -1), (1, -0.5), (0, 1))))


def variants():
    """Every type of brush that paints, with each of its options."""
    for kind in KINDS:
        if kind.rhythm == "select":
            continue
        yield kind.name, {}
        for p in kind.parameters:
            for option in p.values or ((True,) if isinstance(p.default, bool) else ()):
                yield kind.name, {p.name: option}


TOOLES = st.sampled_from(list(variants()))
AT = st.tuples(st.floats(-1, 21), st.floats(-1, 13))
PATHS = st.lists(AT, min_size=1, max_size=4)


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in NAMES)


def some_drawing():
    rng = np.random.default_rng(7)
    drawing = Drawing.blank(Page(*SIZE))
    drawing.areas[1] = Area("ring", RING)
    ramp = np.tile(np.linspace(0, 1, 40, dtype=np.float32), (24, 1))
    drawing.reference = Reference(ramp, SIZE[0])
    drawing.dots = Dots.round(rng.uniform((0, 0), SIZE, (70, 2)), rng.uniform(0.1, 0.3, 70))
    drawing.dots.constraint[:] = rng.uniform(size=70) < 0.15
    return drawing


def without_stroke(before, painted, middle):
    """Return the dots as they are without a stroke during which a result came.

    Those that the stroke had touched are as before it; the others as the result left them.
    """
    wanted = before.copy()
    for row, i in enumerate(before.id):
        now = np.flatnonzero(painted.id == i)
        if len(now) and all(
            np.array_equal(getattr(before, name)[row], getattr(painted, name)[now[0]])
            for name in NAMES
        ):
            at = np.flatnonzero(middle.id == i)[0]
            for name in NAMES:
                getattr(wanted, name)[row] = getattr(middle, name)[at]
    return wanted


class PaintingMachine(RuleBasedStateMachine):
    """Nothing a person did is overwritten, and undoing everything gives the start to the bit."""

    def __init__(self):
        super().__init__()
        drawing = some_drawing()
        self.document = Document(drawing, budget_bytes=4000)
        at = self.document.partition.area_at(drawing.dots.position_mm)
        self.document.begin("areas")
        self.document.change("area", np.arange(len(at)), at.astype(np.int32))
        self.document.commit()
        self.document.history.close()
        self.start = self.document.dots.copy()
        self.n_strokes = 0
        self.run_size = 0
        self.by_hand = set()  # ids a person has changed since the run began

    def teardown(self):
        document = self.document
        document.end_run()
        end, n_done = document.dots.copy(), document.history.n_done
        while document.undo():
            pass
        assert same(document.dots, self.start)
        while document.history.n_done < n_done:
            document.redo()
        assert same(document.dots, end)
        document.history.close()

    def places_of_fixed(self):
        dots = self.document.dots
        return dict(
            zip(dots.id[dots.fixed].tolist(), dots.position_mm[dots.fixed].tolist(), strict=True)
        )

    def places(self, ids):
        rows = self.document.rows(np.array(sorted(ids), np.int64))
        return self.document.dots.position_mm[rows[rows >= 0]].copy()

    def check_fixed(self, before):
        """Fixed dots are where they were, or gone."""
        dots = self.document.dots
        now = dict(zip(dots.id.tolist(), dots.position_mm.tolist(), strict=True))
        assert all(now.get(k, place) == place for k, place in before.items())

    def note_hand(self, before):
        """Remember the ids of the dots that a stroke has changed or added."""
        after = self.document.dots
        rows = self.document.rows(before.id)
        there = rows >= 0
        differs = np.zeros(len(there), np.bool_)
        for name in NAMES:
            changed = getattr(before, name)[there] != getattr(after, name)[rows[there]]
            differs[there] |= changed.any(axis=1) if changed.ndim == 2 else changed
        self.by_hand |= set(before.id[differs].tolist())
        self.by_hand |= set(np.setdiff1d(after.id, before.id).tolist())

    @rule(
        which=TOOLES,
        tip=st.sampled_from(TIPS),
        path=PATHS,
        radius=st.floats(0.5, 6),
        ends=st.sampled_from(["commit", "commit", "cancel"]),
        late=st.booleans(),
    )
    def stroke(self, which, tip, path, radius, ends, late):
        kind, values = which
        before, fixed = self.document.dots.copy(), self.places_of_fixed()
        self.n_strokes += 1
        brush = Brush(kind, kind, radius, tip, values=values)
        stroke = Stroke(self.document, brush, PointerSample(*path[0]), self.n_strokes)
        for k, at in enumerate(path[1:]):
            stroke.follow(PointerSample(*at, t=0.1 * (k + 1)))
        earlier, middle, wanted = set(self.by_hand), before, before
        if late and self.run_size > 0:
            self.note_hand(before)  # what the hand did so far, or it could not be told afterwards
            places, painted = self.places(self.by_hand), self.document.dots.copy()
            self.merge(self.n_strokes)
            assert np.array_equal(self.places(self.by_hand), places)
            middle = self.document.dots.copy()
            wanted = without_stroke(before, painted, middle)
        if ends == "cancel":
            stroke.cancel()
            self.by_hand = earlier
        else:
            stroke.commit(PointerSample(*path[-1], t=0.1 * len(path) + 0.2))
            self.note_hand(middle)
        if kind not in ("fix", "unfix"):
            self.check_fixed(fixed)
        if ends == "cancel":
            assert same(self.document.dots, wanted)

    @rule(corners=st.tuples(AT, AT), what=st.integers(0, 5))
    def work_on_a_selection(self, corners, what):
        document, before, fixed = self.document, self.document.dots.copy(), self.places_of_fixed()
        (ax, ay), (bx, by) = corners
        ids = selection.in_outline(document, [(ax, ay), (bx, ay), (bx, by), (ax, by)])
        document.begin("selection")
        if what == 0:
            selection.move(document, ids, (1.5, -0.5))
        elif what == 1:
            selection.delete(document, ids[::2])
        elif what == 2:
            selection.duplicate(document, ids[:5])
        elif what == 3:
            selection.relax(document, ids)
        elif what == 4:
            selection.shake(document, ids, np.random.default_rng(self.n_strokes))
        else:
            selection.resize(document, ids, 20.0)
        document.commit()
        self.check_fixed(fixed)
        self.note_hand(before)

    @precondition(lambda self: len(self.document.dots))
    @rule()
    def begin_a_run(self):
        self.run_size = len(self.document.begin_run("relax"))
        self.by_hand = set()

    def merge(self, seed):
        """Let a worker's result come in: places in the dots' own areas, as a worker's are."""
        run, rng = self.document._run, np.random.default_rng(seed)
        if run is None:
            return
        aim = run.position_mm + rng.normal(0, 1.0, run.position_mm.shape)
        rows = self.document.rows(run.ids)
        area = np.where(rows >= 0, self.document.dots.area[rows], 0).astype(np.int32)
        self.document.merge(self.document.partition.confine(run.position_mm, aim, area))
        self.document.merge_radii(rng.uniform(0.1, 0.4, len(run.ids)).astype(np.float32))

    @precondition(lambda self: self.run_size)
    @rule(seed=st.integers(0, 99))
    def a_late_result(self, seed):
        """One that comes after the run was ended or undone, too."""
        fixed, mine = self.places_of_fixed(), self.places(self.by_hand)
        if self.document.in_run:
            self.merge(seed)
        else:
            before = self.document.dots.copy()
            assert self.document.merge(np.zeros((self.run_size, 2))) == 0
            assert same(self.document.dots, before)
        self.check_fixed(fixed)
        assert np.array_equal(self.places(self.by_hand), mine)

    @rule(n=st.integers(0, 20), area=st.integers(0, 1), ends=st.booleans(), seed=st.integers(0, 9))
    def process_an_area(self, n, area, ends, seed):
        """A draft in place of an area's dots, which is kept or dropped."""
        document = self.document
        if area not in document.drawing.areas:
            return
        document.end_run()
        before, fixed = document.dots.copy(), self.places_of_fixed()
        others = before.take(before.area != area)
        document.begin_draft("Process", area, document.drawing.style_of(area), keeps_fixed=True)
        at = np.random.default_rng(seed).uniform((0, 0), SIZE, (200, 2))
        at = at[document.partition.area_at(at) == area][:n]
        document.draft(at[: n // 2], np.full(len(at[: n // 2]), 0.2, np.float32))
        document.draft(at, np.full(len(at), 0.2, np.float32))
        if ends:
            document.end_draft()
            rows = document.rows(others.id)
            assert same(document.dots.take(rows), others)
        else:
            document.drop_draft()
            assert same(document.dots, before)
        self.check_fixed(fixed)
        self.note_hand(before)

    @rule()
    def end_the_run(self):
        self.document.end_run()

    @rule()
    def undo(self):
        before = self.document.dots.copy()
        self.document.undo()
        self.note_hand(before)

    @rule()
    def redo(self):
        before = self.document.dots.copy()
        self.document.redo()
        self.note_hand(before)

    @invariant()
    def whole(self):
        document, dots = self.document, self.document.dots
        assert len(np.unique(dots.id)) == len(dots)
        assert np.array_equal(document.rows(dots.id), np.arange(len(dots)))
        assert np.array_equal(document.partition.area_at(dots.position_mm), dots.area)
        assert (dots.radius_mm > 0).all()
        view = (3.0, 2.0, 13.0, 8.5)
        x, y = dots.position_mm.T
        inside = (x >= view[0]) & (x <= view[2]) & (y >= view[1]) & (y <= view[3])
        assert np.array_equal(document.in_box(view), np.flatnonzero(inside))


TestPainting = PaintingMachine.TestCase
TestPainting.settings = settings(max_examples=60, stateful_step_count=25, deadline=None)
