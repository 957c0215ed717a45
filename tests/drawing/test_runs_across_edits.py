"""A run that stays open while a person edits, undoes and redoes, in any order."""

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from tests.conftest import EXAMPLES
from tests.drawing.test_editing import SHARES, same, some_drawing


class OpenRun(RuleBasedStateMachine):
    """What a person has done meanwhile is never moved by a result, and everything can be undone."""

    def __init__(self):
        super().__init__()
        self.document = Document(some_drawing())
        self.start = self.document.dots.copy()
        self.frozen = None
        self.by_hand = {}  # places that a person has given since the run began, by id
        self.n_merged = 0

    def teardown(self):
        self.document.end_run()
        n_steps = self.document.history.n_done
        end = self.document.dots.copy()
        while self.document.undo():
            pass
        assert same(self.document.dots, self.start)
        for _ in range(n_steps):
            assert self.document.redo()
        assert same(self.document.dots, end)
        self.document.history.close()

    def rows(self, shares):
        n = len(self.document.dots)
        return np.unique((np.array(shares) * n).astype(np.int64)) if n else np.empty(0, np.int64)

    @precondition(lambda self: self.frozen is None and len(self.document.dots))
    @rule()
    def begin(self):
        self.frozen, self.by_hand = self.document.begin_run("Relax"), {}
        assert self.document.in_run

    @precondition(lambda self: self.frozen is not None)
    @rule(seed=st.integers(0, 9))
    def merge(self, seed):
        result = np.random.default_rng(seed).uniform(0, 1, (len(self.frozen), 2)) * (20, 10)
        before = self.document.dots.copy()
        n_moved = self.document.merge(result)
        after = self.document.dots
        assert np.array_equal(before.id, after.id)
        held = before.constraint != 0
        assert np.array_equal(before.position_mm[held], after.position_mm[held])
        new = ~np.isin(after.id, self.frozen.id)
        assert np.array_equal(before.position_mm[new], after.position_mm[new])
        moved = (before.position_mm != after.position_mm).any(axis=1)
        assert moved.sum() <= n_moved <= len(self.frozen)
        self.n_merged += int(moved.sum())

    @precondition(lambda self: self.frozen is not None)
    @rule()
    def end(self):
        self.document.end_run()
        assert not self.document.in_run
        self.frozen = None

    @rule(shares=SHARES, by=st.floats(-2, 2))
    def stroke(self, shares, by):
        document = self.document
        document.begin("Move")
        rows = self.rows(shares)
        document.move(rows, document.dots.position_mm[rows] + by)
        held = document.dots.constraint[rows] != 0
        for row in rows[~held]:
            self.by_hand[int(document.dots.id[row])] = document.dots.position_mm[row].copy()
        document.commit()

    @rule(x=st.floats(0, 20), y=st.floats(0, 10))
    def add(self, x, y):
        self.document.begin("Add")
        self.document.insert(Dots.round([(x, y)], 0.1))
        self.document.commit()

    @rule(shares=SHARES)
    def remove(self, shares):
        self.document.begin("Remove")
        self.document.remove(self.rows(shares))
        self.document.commit()

    @rule()
    def undo(self):
        self.document.undo()
        self.frozen = self.frozen if self.document.in_run else None
        self.by_hand = {}  # what is undone is the run's again

    @rule()
    def redo(self):
        self.document.redo()
        self.by_hand = {}

    @invariant()
    def hands_are_obeyed(self):
        dots = self.document.dots
        place = dict(zip(dots.id.tolist(), dots.position_mm, strict=True))
        for i, at in self.by_hand.items():
            if self.frozen is not None and i in place:
                assert np.array_equal(place[i], at)


TestOpenRun = OpenRun.TestCase
TestOpenRun.settings = settings(max_examples=40 * EXAMPLES, stateful_step_count=25, deadline=None)
