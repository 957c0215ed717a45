"""What happened between two frames, parted so that each event is judged when it happened.

A press may open what the next press is for, and a key may close it. So a batch of events is taken
in parts, with a frame of the panels after each: what a part has changed is there for the next.
"""

from __future__ import annotations

from collections.abc import Iterable

from stippler.editor.events import (
    CloseAsked,
    Dropped,
    Event,
    FocusLost,
    KeyDown,
    Moved,
    Pressed,
    Released,
    Scrolled,
)
from stippler.editor.keymap import is_modifier


def parts_of(events: Iterable[Event]) -> list[list[Event]]:
    """Return the events in parts, each of which may be taken within one frame."""
    parts: list[list[Event]] = []
    is_closed = True
    for event in events:
        turned = parts and isinstance(event, Moved) and isinstance(parts[-1][-1], Scrolled)
        if is_closed or turned:
            parts.append([])
        parts[-1].append(event)
        is_closed = _closes(event)
    return parts


def _closes(event: Event) -> bool:
    """Return whether later events may be for something that this one brings about."""
    if isinstance(event, KeyDown):
        types = len(event.key) == 1 and not (event.mods.ctrl or event.mods.alt)
        return not types and not is_modifier(event.key)
    return isinstance(event, Pressed | Released | Dropped | CloseAsked | FocusLost)


class PointerOwner:
    """Who has the pointer: panels or the canvas; the owner of a press keeps it until its release.

    Another button pressed meanwhile is the same owner's.
    """

    def __init__(self) -> None:
        self._held: set[str] = set()
        self._is_panel = False

    def is_panel(self, event: Event, *, over_panel: bool) -> bool:
        """Return whether an event is a panel's, given what lies under it."""
        match event:
            case Pressed(button=button):
                if not self._held:
                    self._is_panel = over_panel
                self._held.add(button)
            case Released(button=button) if button in self._held:
                self._held.discard(button)
            case FocusLost():
                self._held.clear()
                return over_panel
            case _ if not self._held:
                return over_panel
        return self._is_panel
