"""Tools driven by scripted events and a clock that is set: no window, no GL, no sleep."""

from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, precondition, rule

from stippler.brushes import effects
from stippler.brushes.kinds import KINDS
from stippler.brushes.presets import load_brushes
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.editor.events import (
    FocusLost,
    KeyDown,
    KeyUp,
    Mods,
    Moved,
    Pressed,
    Released,
    Scrolled,
)
from stippler.editor.tools.toolbox import Toolbox

NAMES = [f.name for f in fields(Dots)]
PX_PER_MM = 10.0
SHIFT, ALT, CTRL = Mods(shift=True), Mods(alt=True), Mods(ctrl=True)


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in NAMES)


def make_editing(n=200):
    rng = np.random.default_rng(4)
    drawing = Drawing.blank(Page(40, 30))
    drawing.dots = Dots.round(rng.uniform(0, 1, (n, 2)) * (40, 30), 0.2)
    drawing.dots.constraint[::9] = FIXED
    return Document(drawing)


class Hands:
    """A toolbox, a drawing, and events in mm."""

    def __init__(self, path, n=200):
        self.said = []
        self.box = Toolbox(path, lambda text, level: self.said.append((level, text)))
        self.document = make_editing(n)
        self.t = 0.0

    def take(self, event):
        return self.box.take(
            event, self.document, lambda x, y: (x / PX_PER_MM, y / PX_PER_MM), PX_PER_MM
        )

    def at(self, kind, place, mods=Mods(), button="left"):  # noqa: B008 - frozen
        self.t += 0.01
        x, y = place[0] * PX_PER_MM, place[1] * PX_PER_MM
        if kind is Moved:
            return self.take(Moved(x, y, self.t, mods))
        return self.take(kind(button, x, y, self.t, mods))

    def drag(self, *places, mods=Mods()):  # noqa: B008 - frozen
        self.at(Pressed, places[0], mods)
        for place in places:
            self.at(Moved, place)
        self.at(Released, places[-1])

    def key(self, name):
        self.t += 0.01
        return self.take(KeyDown(name, t_s=self.t))

    def use(self, kind, **changes):
        self.box.choose(kind)
        values = changes.pop("values", None)
        if self.box.brush is None:
            for name, value in (values or {}).items():
                self.box.tool.set(name, value)
            return
        brush = replace(self.box.brush, **changes)
        self.box.set_brush(replace(brush, values=values) if values else brush)

    @property
    def labels(self):
        return [step.label for step in self.document.history.steps]


@pytest.fixture
def hands(tmp_path):
    return Hands(tmp_path / "brushes.json")


def test_without_a_brush_nothing_is_taken(hands):
    start = hands.document.dots.copy()
    hands.drag((5, 5), (20, 20))
    assert not hands.at(Pressed, (5, 5))
    assert same(start, hands.document.dots)


@pytest.mark.parametrize("kind", [kind.name for kind in KINDS])
def test_a_stroke_is_a_step_and_escape_takes_it_back(hands, kind):
    hands.use(kind, radius_mm=5.0)
    start = hands.document.dots.copy()
    if kind == "unfix":
        assert hands.document.dots.fixed.any()
    assert hands.at(Pressed, (10, 10))
    for x in range(11, 30):
        hands.at(Moved, (x, 12))
    hands.box.rest(hands.t + 0.3)
    assert not same(start, hands.document.dots)
    assert hands.key("escape")
    assert same(start, hands.document.dots)
    assert not hands.labels
    hands.drag((10, 10), (20, 12), (29, 12))
    assert hands.labels == [hands.box.brush.name]
    hands.document.undo()
    assert same(start, hands.document.dots)


def test_timed_brushes_go_on_while_the_pointer_rests(hands):
    hands.use("spray", values={"per_s": 100.0, "apart_mm": 0.0})
    n = len(hands.document.dots)
    hands.at(Pressed, (20, 15))
    assert hands.box.is_timed
    t = hands.t
    for k in range(100):
        hands.box.rest(t + (k + 1) / 100)
    hands.t += 1.0
    hands.at(Released, (20, 15))
    assert not hands.box.is_timed
    assert 95 <= len(hands.document.dots) - n <= 105


@pytest.mark.parametrize("kind", ["spray", "thin"])
def test_a_timed_brush_does_not_make_up_for_a_stall(hands, kind):
    """Thin took 305 dots in one frame once the machine came back after a minute."""
    hands.use(kind, values={"per_s": 200.0})
    hands.at(Pressed, (20, 15))
    n, t = len(hands.document.dots), hands.t
    hands.box.rest(t + 0.05)
    before = abs(len(hands.document.dots) - n)
    hands.box.rest(t + 60.0)
    at_once = abs(len(hands.document.dots) - n) - before
    assert before > 0
    assert at_once <= 21  # a tenth of a second's


def test_losing_the_window_ends_the_stroke_and_keeps_it(hands):
    hands.use("erase")
    hands.at(Pressed, (20, 15))
    hands.take(FocusLost())
    assert hands.labels == ["Erase"]
    assert not hands.box.is_busy


@pytest.mark.parametrize("kind", ["erase", "spray", "push"])
def test_taking_another_tool_ends_the_stroke_in_progress_and_keeps_it(hands, kind):
    """It stayed open: "a stroke has begun already" was all that any edit did from then on."""
    hands.use(kind)
    hands.at(Pressed, (20, 15))
    hands.at(Moved, (23, 17))
    hands.at(Moved, (26, 21))
    assert hands.document.in_stroke
    hands.box.choose("select")
    assert not hands.box.is_busy
    assert not hands.document.in_stroke
    assert len(hands.document.history.steps) == 1
    hands.use("erase")
    hands.drag((20, 15), (22, 15))
    assert hands.labels[-1] == "Erase"


def test_the_tip_is_sized_by_keys_wheel_and_shift(hands):
    hands.use("erase", radius_mm=4.0)
    hands.box.resize(1.5)
    assert hands.box.brush.radius_mm == pytest.approx(6.0)
    assert hands.take(Scrolled(0, 2, 0, 0, mods=CTRL))
    assert hands.box.brush.radius_mm == pytest.approx(6.0 * 1.21)
    assert not hands.take(Scrolled(0, 2, 0, 0))  # that zooms
    hands.drag((10, 10), (12, 10), (15, 10), mods=SHIFT)
    assert hands.box.brush.radius_mm == pytest.approx(6.0 * 1.21 + 5.0)
    before = hands.box.brush.radius_mm
    hands.at(Pressed, (10, 10), SHIFT)
    hands.at(Moved, (30, 10))
    hands.key("escape")
    assert hands.box.brush.radius_mm == before
    assert not hands.labels


def test_a_click_with_shift_draws_a_straight_line(hands):
    hands.use("erase", radius_mm=1.0)
    hands.drag((5, 15), (5, 15))
    hands.at(Pressed, (35, 15), SHIFT)
    hands.at(Released, (35, 15))
    x, y = hands.document.dots.position_mm.T
    assert not ((x > 5) & (x < 35) & (np.abs(y - 15) < 0.4)).any()
    assert hands.labels == ["Erase"] * len(hands.labels)


def test_a_failing_brush_takes_its_stroke_back_and_rests(hands, monkeypatch):
    hands.use("push")
    start = hands.document.dots.copy()
    hands.at(Pressed, (20, 15))
    hands.at(Moved, (25, 15))
    assert not same(start, hands.document.dots)

    def broken(touch):
        raise RuntimeError("broken")

    monkeypatch.setitem(effects.EFFECTS, "push", broken)
    with pytest.raises(RuntimeError):
        hands.at(Moved, (30, 15))
    assert same(start, hands.document.dots)
    assert not hands.box.is_busy
    assert not hands.document.in_stroke


def inside(hands, test):
    x, y = hands.document.dots.position_mm.T
    return set(hands.document.dots.id[test(x, y)])


def test_selecting_by_rectangle_lasso_polygon_and_area(hands):
    box = inside(hands, lambda x, y: (x > 5) & (x < 20) & (y > 5) & (y < 25))
    hands.use("select", values={"how": "rectangle"})
    hands.drag((20, 25), (5, 5))
    assert set(hands.box.selection.ids) == box
    hands.use("select", values={"how": "lasso"})
    hands.at(Pressed, (5, 5), SHIFT)  # with Shift, or a chosen dot would be carried
    for place in ((20, 5), (20, 25), (5, 25), (5, 5)):
        hands.at(Moved, place)
    assert len(hands.box.state.overlay.paths[0].points_mm) > 3
    hands.at(Released, (5, 5))
    assert set(hands.box.selection.ids) == box
    hands.box.selection.choose(np.empty(0, np.int64), Mods())
    hands.use("select", values={"how": "polygon"})
    for place in ((5, 5), (20, 5), (20, 25), (5, 25)):
        hands.at(Pressed, place)
        hands.at(Released, place)
        hands.t += 1.0
    hands.key("enter")
    assert set(hands.box.selection.ids) == box
    hands.box.selection.choose(np.empty(0, np.int64), Mods())
    hands.use("select", values={"how": "area"})
    hands.at(Pressed, (0.01, 0.01))
    assert len(hands.box.selection.ids) == 200
    assert not hands.labels


def test_shift_adds_to_the_selection_and_alt_takes_away(hands):
    hands.use("select")
    hands.drag((5, 5), (20, 25))
    first = set(hands.box.selection.ids)
    hands.drag((15, 5), (35, 25), mods=SHIFT)
    both = set(hands.box.selection.ids)
    second = inside(hands, lambda x, y: (x >= 15) & (x <= 35) & (y >= 5) & (y <= 25))
    assert both == first | second
    hands.drag((5, 5), (20, 25), mods=ALT)
    assert set(hands.box.selection.ids) == both - first


def test_a_selection_is_carried_by_one_of_its_dots(hands):
    hands.use("select")
    hands.drag((10, 8), (20, 18))
    ids = hands.box.selection.ids
    rows = hands.document.rows(ids)
    before = hands.document.dots.position_mm[rows].copy()
    fixed = hands.document.dots.fixed[rows]
    grip = tuple(before[0])
    hands.drag(grip, (grip[0] + 3, grip[1] + 2))
    moved = hands.document.dots.position_mm[rows] - before
    assert np.allclose(moved[~fixed], (3, 2))
    assert not moved[fixed].any()
    assert hands.labels == ["Move selection"]
    start = hands.document.dots.copy()
    free = hands.document.dots.position_mm[rows][~fixed][0]
    hands.at(Pressed, free)
    hands.at(Moved, free + 5)
    hands.key("escape")
    assert same(start, hands.document.dots)


def test_brushes_are_copied_kept_and_deleted(hands, tmp_path):
    hands.use("jitter", radius_mm=7.5)
    hands.box.shelf.copy("jitter")
    assert hands.box.brush.name == "Jitter 2"
    hands.box.set_brush(hands.box.brush.with_value("amount", 77.0))
    hands.box.save()
    again, problem = load_brushes(tmp_path / "brushes.json")
    assert not problem
    assert [b.value("amount") for b in again if b.kind == "jitter"] == [20.0, 77.0]
    hands.box.choose("jitter")
    assert hands.box.brush.name == "Jitter"  # the next of its type
    hands.box.shelf.delete("jitter")
    assert hands.box.brush.name == "Jitter 2"
    hands.box.shelf.delete("jitter")  # the last of a type stays
    assert hands.box.brush.name == "Jitter 2"


def test_pressure_comes_from_a_key_or_from_speed(hands):
    hands.use("size", pressure="key", values={"how": "enlarge", "amount": 50.0})

    def growth():
        before = hands.document.dots.radius_mm.copy()
        hands.drag((20, 15), (20, 15))
        grown = (hands.document.dots.radius_mm / before).max()
        hands.document.undo()
        return grown

    full = growth()
    hands.take(KeyDown("left_alt"))
    light = growth()
    hands.take(KeyUp("left_alt"))
    assert growth() == full > light > 1
    hands.use("push", pressure="speed", radius_mm=3.0)
    hands.at(Pressed, (5, 15))
    slow = hands.box.tool.pressure((5.1, 15), hands.t + 1.0, Mods())
    fast = hands.box.tool.pressure((35.0, 15), hands.t + 1.05, Mods())
    assert slow > 0.95
    assert fast < 0.5
    hands.key("escape")


def test_spray_says_why_it_adds_nothing(hands):
    hands.use("spray", values={"per_s": 300.0, "apart_mm": 5.0})
    hands.drag((20, 15), (20, 15))
    assert not hands.labels
    ((level, text),) = hands.said
    assert "5 mm" in text
    assert level == "warning"


class ToolMachine(RuleBasedStateMachine):
    """Any events in any order, with late results in their midst."""

    def __init__(self):
        super().__init__()
        from pathlib import Path

        self.hands = Hands(Path("none.json"), 60)
        self.start = self.hands.document.dots.copy()
        self.fixed = {}
        self.frozen = None

    def teardown(self):
        hands = self.hands
        if hands.box.is_busy:
            hands.key("escape")
            hands.key("escape")
        hands.document.end_run()
        while hands.document.undo():
            pass
        assert same(hands.document.dots, self.start)
        hands.document.history.close()

    @rule(k=st.integers(0, len(KINDS)))
    def choose(self, k):
        if not self.hands.box.is_busy:
            self.hands.box.choose(self.hands.box.cards[k].name)

    @rule(
        kind=st.sampled_from([Pressed, Moved, Moved, Released]),
        place=st.tuples(st.floats(-3, 43), st.floats(-3, 33)),
        mods=st.sampled_from([Mods(), Mods(), SHIFT, ALT]),
    )
    def point(self, kind, place, mods):
        self.hands.at(kind, place, mods)

    @rule(key=st.sampled_from(["escape", "enter"]))
    def key(self, key):
        self.hands.key(key)

    @rule()
    def lose_focus(self):
        self.hands.take(FocusLost())

    @rule(dt=st.floats(0, 0.5))
    def wait(self, dt):
        self.hands.t += dt
        self.hands.box.rest(self.hands.t)

    @precondition(lambda self: not self.hands.document.in_stroke)
    @rule()
    def undo(self):
        self.hands.document.undo()
        self.frozen = self.frozen if self.hands.document.in_run else None

    @precondition(lambda self: not self.hands.document.in_stroke)
    @rule()
    def redo(self):
        self.hands.document.redo()

    @precondition(lambda self: not self.hands.document.in_stroke)
    @rule()
    def begin_run(self):
        self.frozen = self.hands.document.begin_run("relax")

    @precondition(lambda self: self.frozen is not None)
    @rule(seed=st.integers(0, 99))
    def result(self, seed):
        rng = np.random.default_rng(seed)
        self.hands.document.merge(rng.uniform(0, 1, (len(self.frozen), 2)) * (40, 30))

    @invariant()
    def rules_hold(self):
        dots = self.hands.document.dots
        assert len(np.unique(dots.id)) == len(dots)
        assert np.array_equal(self.hands.document.rows(dots.id), np.arange(len(dots)))
        assert (self.hands.document.partition.area_at(dots.position_mm) == dots.area).all()
        now = dict(zip(dots.id[dots.fixed].tolist(), dots.position_mm[dots.fixed], strict=True))
        for key in now.keys() & self.fixed.keys():
            assert np.array_equal(now[key], self.fixed[key])
        self.fixed = {key: place.copy() for key, place in now.items()}


TestTools = ToolMachine.TestCase
TestTools.settings = settings(max_examples=40, stateful_step_count=40)
