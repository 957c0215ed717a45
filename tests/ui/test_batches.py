"""Batches of events: parted where one event changes what the next is for; a press has an owner."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from stippler.editor.batches import PointerOwner, parts_of
from stippler.editor.events import (
    LEFT,
    RIGHT,
    CloseAsked,
    FocusLost,
    KeyDown,
    KeyUp,
    Mods,
    Moved,
    Pressed,
    Released,
    Scrolled,
    Typed,
)

EVENTS = st.sampled_from(
    [
        Moved(1, 2),
        Pressed(LEFT, 1, 2),
        Released(LEFT, 1, 2),
        Pressed(RIGHT, 1, 2),
        Released(RIGHT, 1, 2),
        Scrolled(0, 1, 1, 2),
        KeyDown("a"),
        KeyDown("a", Mods(ctrl=True)),
        KeyUp("a"),
        KeyDown("enter"),
        Typed("a"),
        FocusLost(),
        CloseAsked(),
    ]
)


@given(st.lists(EVENTS, max_size=30))
def test_parts_are_the_events_in_order(events) -> None:
    parts = parts_of(events)
    assert [event for part in parts for event in part] == events
    assert all(parts)


@given(st.lists(EVENTS, max_size=30))
def test_nothing_follows_a_press_or_a_chord_within_a_part(events) -> None:
    for part in parts_of(events):
        for event in part[:-1]:
            assert not isinstance(event, Pressed | Released | FocusLost | CloseAsked)
            assert event not in (KeyDown("enter"), KeyDown("a", Mods(ctrl=True)))


def test_moves_and_words_stay_together() -> None:
    moves = [Moved(k, 0) for k in range(50)]
    assert parts_of(moves) == [moves]
    word = [e for sign in "dots" for e in (KeyDown(sign), Typed(sign), KeyUp(sign))]
    assert parts_of(word) == [word]
    assert len(parts_of([Scrolled(0, 1, 5, 5), Moved(9, 9)])) == 2  # the wheel is for the old place


def test_the_owner_of_a_press_keeps_the_pointer_until_its_release() -> None:
    owner = PointerOwner()
    assert not owner.is_panel(Pressed(LEFT, 0, 0), over_panel=False)
    assert not owner.is_panel(Moved(0, 0), over_panel=True)
    assert not owner.is_panel(Pressed(RIGHT, 0, 0), over_panel=True)
    assert not owner.is_panel(Released(RIGHT, 0, 0), over_panel=True)
    assert not owner.is_panel(Released(LEFT, 0, 0), over_panel=True)
    assert owner.is_panel(Moved(0, 0), over_panel=True)
    assert owner.is_panel(Pressed(LEFT, 0, 0), over_panel=True)
    assert owner.is_panel(Released(LEFT, 0, 0), over_panel=False)
    assert not owner.is_panel(Moved(0, 0), over_panel=False)
    owner.is_panel(Pressed(LEFT, 0, 0), over_panel=True)
    owner.is_panel(FocusLost(), over_panel=False)
    assert not owner.is_panel(Moved(0, 0), over_panel=False)
