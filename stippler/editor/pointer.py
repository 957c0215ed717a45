"""The pointer over the canvas: the state that takes its events, and what comes of them."""

from __future__ import annotations

from dataclasses import replace

from stippler.camera import Point
from stippler.editor.events import (
    Event,
    FocusLost,
    Gone,
    KeyDown,
    KeyUp,
    Moved,
    Pressed,
    Released,
    Scrolled,
)
from stippler.editor.pointer_states import Change, Idle, Pan, State, Turn, Zoom, held
from stippler.editor.view import View

_Placed = Moved | Pressed | Released | Scrolled


class Pointer:
    """Brings events to the state in canvas coordinates, and its changes to the view.

    Attributes
    ----------
    state : State
    at_px : (x, y) or None
        On the canvas; None while the pointer is elsewhere.
    """

    def __init__(self, view: View) -> None:
        self._view = view
        self.origin_px: Point = (0.0, 0.0)
        self.state: State = Idle()
        self.at_px: Point | None = None

    def place(self, origin_px: Point) -> None:
        """Say where in the window the canvas begins."""
        self.origin_px = origin_px

    def take(self, event: Event, *, elsewhere: bool) -> None:
        """Take an event; `elsewhere` is whether a panel has the pointer.

        What a state has taken hold of it keeps until it lets go, over panels too.
        """
        match event:
            case Moved() | Pressed() | Released() | Scrolled():
                local = self.local(event)
                self.at_px = None if elsewhere else (local.x_px, local.y_px)
                if not elsewhere or held(self.state) or isinstance(event, Moved):
                    self._pass(local)
            case Gone():
                self.at_px = None
            case KeyDown() | KeyUp() | FocusLost():
                self._pass(event)

    @property
    def at_mm(self) -> Point | None:
        """On the page; None while the pointer is elsewhere."""
        return self._view.at(*self.at_px) if self.at_px is not None else None

    def _pass(self, event: Event) -> None:
        self.state, changes = self.state.take(event)
        for change in changes:
            self._apply(change)

    def _apply(self, change: Change) -> None:
        match change:
            case Pan(dx, dy):
                self._view.pan((dx, dy))
            case Zoom(factor, x, y):
                self._view.zoom(factor, (x, y))
            case Turn(from_px, to_px):
                self._view.drag_round(from_px, to_px)

    def local(self, event: _Placed) -> _Placed:
        """Return an event in the canvas's coordinates."""
        x, y = self.origin_px
        return replace(event, x_px=event.x_px - x, y_px=event.y_px - y)
