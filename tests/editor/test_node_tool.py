"""Nodes and handles by hand: what meets there follows, one step each, nothing by halves."""

import numpy as np
import pytest

from stippler.drawing.planar.nodes import handles_at, is_smooth
from stippler.editor.events import Mods
from stippler.editor.tools.node_source import BorderNodes
from tests.editor.area_hands import AreaHands, box, same, state

SHIFT, ALT = Mods(shift=True), Mods(alt=True)


@pytest.fixture
def hands(tmp_path):
    """Two areas that share the border x = 50, from y = 10 to 60."""
    hands = AreaHands(tmp_path, tool="nodes")
    hands.add(box(10, 10, 50, 60), box(50, 10, 90, 60))
    return hands


def test_a_shared_corner_takes_both_neighbours_along(hands):
    hands.drag((50, 10), (55, 15), (60, 20), mods=ALT)
    hands.check()
    assert hands.size(1) == pytest.approx(2050)
    for k in (1, 2):
        corners = np.array(hands.document.drawing.areas[k].outline_mm.exterior.coords)
        assert (corners == (60, 20)).all(axis=1).any()
    assert hands.labels[-1] == "Move border"


def test_a_dragged_segment_takes_both_neighbours_along(hands):
    hands.drag((50, 35), (54, 35), (56, 37))
    hands.check()
    assert hands.size(1) == pytest.approx(2000 + 6 * 50, rel=1e-3)
    assert hands.size(2) == pytest.approx(2000 - 6 * 50, rel=1e-3)


def test_several_nodes_take_all_neighbours_along(hands):
    hands.click((50, 10))
    hands.click((50, 60), SHIFT)
    assert hands.tool.n_chosen == 2
    hands.drag((50, 60), (45, 60))
    hands.check()
    assert hands.size(1) == pytest.approx(35 * 50)
    assert hands.size(2) == pytest.approx(45 * 50)
    assert hands.tool.n_chosen == 2


def test_escape_leaves_no_trace(hands):
    before, n = state(hands.document), len(hands.labels)
    hands.press((50, 10))
    hands.move((70, 30))
    hands.key("escape")
    hands.release((70, 30))
    assert same(state(hands.document), before)
    assert len(hands.labels) == n


def test_what_is_refused_is_said_and_changes_nothing(hands):
    before = state(hands.document)
    hands.drag((50, 10), (30, 70), (95, 75), mods=ALT)
    assert same(state(hands.document), before)
    assert "would lie across another" in hands.said[-1][1]


def test_a_box_chooses_and_arrows_nudge(hands):
    hands.drag((40, 5), (60, 70))
    assert hands.tool.n_chosen == 2
    for _ in range(5):
        assert hands.key("right", SHIFT)
    hands.check()
    assert hands.size(1) == pytest.approx(45 * 50)
    assert hands.key("escape")
    assert not hands.tool.n_chosen
    assert not hands.key("right")


def test_a_node_is_added_smoothed_bent_and_removed(hands):
    start = state(hands.document)
    hands.double_click((50, 35))
    assert hands.tool.n_chosen == 1
    hands.drag((50, 35), (58, 35), mods=ALT)
    hands.check()
    assert hands.size(1) == pytest.approx(2000 + 0.5 * 8 * 50)
    desk = hands.toolbox.desk(hands.document, lambda x, y: (x, y), 10.0)
    hands.tool.bend(desk, smooth=True)
    hands.check()
    held = next(h for h in hands.tool.held if isinstance(h.source, BorderNodes))
    ((k, i),) = held.nodes
    assert is_smooth(held.index.paths[k], i)
    handle = handles_at(held.index.paths[k], i)["out"]
    hands.drag(handle, (handle[0] + 4, handle[1]))
    hands.check()
    ((k, i),) = held.nodes
    assert is_smooth(held.index.paths[k], i)
    handle = handles_at(held.index.paths[k], i)["out"]
    hands.drag(handle, (handle[0] - 6, handle[1]), mods=ALT)
    ((k, i),) = held.nodes
    assert not is_smooth(held.index.paths[k], i)
    hands.tool.bend(desk, smooth=False)
    ((k, i),) = held.nodes
    assert not handles_at(held.index.paths[k], i)
    assert hands.key("delete")
    hands.check()
    assert 2000 < hands.size(1) < 2150  # the tangents of the outer ends are kept
    while hands.document.history.n_done > 2:
        hands.document.undo()
    assert same(state(hands.document), start)


def test_a_node_where_borders_meet_cannot_be_removed(hands):
    hands.click((50, 10))
    hands.key("delete")
    assert "where borders meet" in hands.said[-1][1]
    hands.check()


def test_a_locked_area_keeps_its_border(hands):
    from stippler.drawing import records

    document = hands.document
    document.begin("Lock")
    document.set(
        records.AREA,
        1,
        document.drawing.areas[1].__class__.from_json(
            {**document.drawing.areas[1].to_json(), "locked": True}
        ),
    )
    document.commit()
    before = state(document)
    hands.drag((50, 35), (56, 35))
    assert "is locked" in hands.said[-1][1]
    assert same(state(document), before)
    hands.drag((90, 35), (80, 35))
    hands.check()
    assert hands.size(2) == pytest.approx(30 * 50)


def test_a_click_beside_chooses_the_area(hands):
    hands.click((30, 30))
    assert hands.toolbox.areas.ids == (1,)
    hands.click((70, 30), SHIFT)
    assert hands.toolbox.areas.ids == (1, 2)
    hands.click((5, 5))
    assert hands.toolbox.areas.ids == (0,)
