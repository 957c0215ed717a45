"""What pieces of borders are to dots, said by hand with the tool Nodes."""

import pytest

from stippler.drawing.planar.policies import said
from stippler.editor.events import Mods
from stippler.editor.tools.border_pieces import chosen_pieces, pieces_text, set_policy
from tests.editor.area_hands import AreaHands, box

SHIFT = Mods(shift=True)


@pytest.fixture
def hands(tmp_path):
    """Two areas that share the border x = 50, from y = 10 to 60."""
    hands = AreaHands(tmp_path, tool="nodes")
    hands.add(box(10, 10, 50, 60), box(50, 10, 90, 60))
    return hands


def say(hands, policy):
    desk = hands.toolbox.desk(hands.document, lambda x, y: (x, y), 10.0)
    set_policy(desk, hands.tool.held, policy)
    hands.tool.update(hands.document)


def spoken(hands):
    """Return what pieces say, by the middle of each."""
    found = {}
    for arc in hands.map.arcs.values():
        at = arc.path.points_mm
        for policy, a, b in zip(said(arc), at[:-1], at[1:], strict=True):
            if policy:
                found[tuple(((a + b) / 2).tolist())] = policy
    return found


def test_the_pressed_piece_alone_gets_a_policy(hands):
    hands.click((50, 35))
    assert hands.tool.n_chosen == 2
    say(hands, "through")
    assert spoken(hands) == {(50.0, 35.0): "through"}
    assert hands.labels[-1] == "Border: through"
    assert hands.tool.chosen_text == "2 nodes chosen. Border of 1 piece: through"
    hands.click((10, 35))
    say(hands, "wall")
    assert spoken(hands) == {(50.0, 35.0): "through", (10.0, 35.0): "wall"}
    n = len(hands.labels)
    say(hands, "wall")
    assert len(hands.labels) == n
    hands.document.undo()
    assert spoken(hands) == {(50.0, 35.0): "through"}
    hands.click((50, 35))
    say(hands, "")
    assert spoken(hands) == {}


def test_pieces_between_chosen_nodes(hands):
    hands.click((10, 10))
    hands.click((10, 60), SHIFT)
    hands.click((50, 60), SHIFT)
    say(hands, "bleed")
    assert spoken(hands) == {(10.0, 35.0): "bleed", (30.0, 60.0): "bleed"}
    assert pieces_text(hands.document, hands.tool.held) == "Border of 2 pieces: bleed"
    hands.click((30, 60))
    say(hands, "wall")
    hands.click((10, 10))
    hands.click((10, 60), SHIFT)
    hands.click((50, 60), SHIFT)
    assert pieces_text(hands.document, hands.tool.held) == "Border of 2 pieces: several"


def test_two_pieces_with_the_same_ends_are_told_apart(hands):
    hands.add(box(60, 65, 80, 75))
    hands.tool.update(hands.document)
    lens = hands.map
    hands.double_click((70, 75))
    hands.click((70, 75))
    assert sum(map(len, chosen_pieces(hands.tool.held).values())) == 0
    hands.click((75, 75))
    assert sum(map(len, chosen_pieces(hands.tool.held).values())) == 1
    assert hands.map is not lens


def test_without_a_piece_it_says_what_to_do(hands):
    hands.click((50, 10))
    say(hands, "wall")
    assert spoken(hands) == {}
    assert "press a piece" in hands.said[-1][1]
