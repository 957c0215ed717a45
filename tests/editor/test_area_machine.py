"""Random drawing, cutting, dragging and painting, with runs between: nothing is ever by halves."""

import tempfile
from pathlib import Path as FilePath

import numpy as np
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, precondition, rule

from stippler.drawing.area_edits import edit_areas
from stippler.drawing.planar import edits
from stippler.errors import StipplerError
from tests.conftest import EXAMPLES
from tests.editor.area_hands import AreaHands, same, state

places = st.tuples(st.integers(-4, 104), st.integers(-4, 84))
inside = st.tuples(st.integers(2, 98), st.integers(2, 78))


class AreaMachine(RuleBasedStateMachine):
    """A person who draws areas and paints on them, a worker whose results come late."""

    @initialize()
    def begin(self):
        self.folder = tempfile.TemporaryDirectory()
        self.hands = AreaHands(FilePath(self.folder.name), n_dots=300)
        self.start = state(self.hands.document)
        self.result = None

    def teardown(self):
        if not hasattr(self, "hands"):
            return
        document = self.hands.document
        if document.in_run:
            document.end_run()
        while document.undo():
            pass
        assert same(state(document), self.start)
        while document.redo():
            pass
        self.hands.check()
        self.folder.cleanup()

    def act(self, act):
        """Do something by hand; areas it does not border on stay to the bit."""
        hands, before = self.hands, self.hands.map
        outlines = dict(hands.document.drawing.areas)
        try:
            act()
        except StipplerError:
            hands.toolbox.drop(hands.document)
        if hands.toolbox.is_busy:
            hands.key("escape")
        hands.check()
        touched = edits.touched(before, hands.map)
        for k, area in outlines.items():
            if k not in touched:
                assert hands.document.drawing.areas[k] is area

    @rule(corners=st.lists(places, min_size=3, max_size=6), does=st.integers(0, 3))
    def draw(self, corners, does):
        hands = self.hands
        hands.toolbox.choose("area")
        hands.tool.set("does", ("new area", "new area", "cut out", "take away")[does])
        hands.tool.set("shape", "corners")

        def act():
            for place in corners:
                hands.move(place)
                hands.click(place)
            hands.key("enter")

        self.act(act)

    @rule(middle=inside, size=st.integers(4, 30))
    def lasso(self, middle, size):
        hands = self.hands
        hands.toolbox.choose("area")
        hands.tool.set("does", "new area")
        hands.tool.set("shape", "lasso")
        t = np.linspace(0, 6.2, 30)
        ring = np.column_stack([middle[0] + size * np.cos(t), middle[1] + size * np.sin(3 * t)])
        self.act(lambda: hands.drag(*map(tuple, ring)))

    @rule(a=places, b=places)
    def cut(self, a, b):
        self.hands.toolbox.choose("knife")
        self.act(lambda: self.hands.drag(a, b))

    @rule(at=inside)
    def fill(self, at):
        self.hands.toolbox.choose("bucket")
        self.act(lambda: self.hands.click(at))

    @rule(k=st.integers(0, 500), to=inside, double=st.booleans())
    def drag_node(self, k, to, double):
        hands = self.hands
        hands.toolbox.choose("nodes")
        hands.tool.update(hands.document)
        nodes = [
            held.index.place_mm((i, v))
            for held in hands.tool.held
            for i, path in held.index.paths.items()
            for v in path.nodes()
        ]
        if not nodes:
            return
        at = nodes[k % len(nodes)]
        near = (at[0] + 0.05 * (to[0] - at[0]), at[1] + 0.05 * (to[1] - at[1]))
        self.act(lambda: hands.drag(at, near, to))
        if double:
            desk = hands.toolbox.desk(hands.document, lambda x, y: (x, y), 10.0)
            self.act(lambda: hands.tool.bend(desk, smooth=True))
            self.act(lambda: hands.key("delete"))

    @rule(k=st.integers(0, 50), remove=st.booleans())
    def unite_or_remove(self, k, remove):
        areas = [i for i in self.hands.map.areas if i]
        if not areas:
            return
        one = areas[k % len(areas)]

        def edit(m):
            near = m.neighbours(one)
            return edits.remove(m, one) if remove or not near else edits.unite(m, [near[0], one])

        self.act(lambda: edit_areas(self.hands.document, "Unite", edit))

    @rule(a=inside, b=inside, brush=st.sampled_from(["spray", "relax", "jitter", "erase", "push"]))
    def paint(self, a, b, brush):
        self.hands.toolbox.choose(brush)
        self.act(lambda: self.hands.drag(a, b))

    @precondition(lambda self: self.result is None)
    @rule()
    def begin_run(self):
        document = self.hands.document
        dots = document.begin_run("Run")
        by = np.random.default_rng(len(self.hands.labels)).normal(0, 8, (len(dots), 2))
        moved = dots.position_mm + by
        self.result = document.partition.confine(dots.position_mm, moved, dots.area)

    @precondition(lambda self: self.result is not None)
    @rule()
    def late_result(self):
        """A worker's result for the dots and areas as they were."""
        document, places = self.hands.document, self.result
        if document.in_run and len(places):
            document.merge(places)
            document.end_run()
            self.hands.check()
        self.result = None

    @rule()
    def undo(self):
        self.hands.document.undo()
        self.hands.check()

    @rule()
    def redo(self):
        self.hands.document.redo()
        self.hands.check()


TestAreaMachine = AreaMachine.TestCase
TestAreaMachine.settings = settings(
    max_examples=5 * EXAMPLES, stateful_step_count=14, deadline=None
)
