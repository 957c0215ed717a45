"""What the pointer does on the canvas, as small states that take events and return changes.

A state never touches the view or the drawing: it says what should change, and which state comes
next. Tools have states of their own (`editor/tools`); `editor/hands.py` says who gets an event.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from stippler.editor.events import (
    LEFT,
    MIDDLE,
    Event,
    FocusLost,
    KeyDown,
    KeyUp,
    Moved,
    Pressed,
    Released,
    Scrolled,
)

ZOOM_A_NOTCH = 1.2


@dataclass(frozen=True, slots=True)
class Pan:
    """Move the page on the screen."""

    dx_px: float
    dy_px: float


@dataclass(frozen=True, slots=True)
class Zoom:
    """Scale the page about a pixel."""

    factor: float
    x_px: float
    y_px: float


@dataclass(frozen=True, slots=True)
class Turn:
    """Turn the page about the middle of the canvas, as a drag from one pixel to another does."""

    from_px: tuple[float, float]
    to_px: tuple[float, float]


Change = Pan | Zoom | Turn


class State(Protocol):
    """One way of taking input."""

    @property
    def cursor(self) -> str:
        """Name of the pointer's shape: "arrow", "hand", "turn"."""
        ...

    def take(self, event: Event) -> tuple[State, list[Change]]:
        """Take an event; return the state that comes next, and what should change."""
        ...


@dataclass(frozen=True, slots=True)
class Idle:
    """Nothing is held."""

    cursor: str = "arrow"

    def take(self, event: Event) -> tuple[State, list[Change]]:
        """Begin to pan or to turn, or zoom."""
        match event:
            case Pressed(button=button) if button == MIDDLE:
                return _taken_hold(event, self), []
            case KeyDown(key="space"):
                return Hand(), []
            case Scrolled():
                return self, _zoomed(event)
        return self, []


@dataclass(frozen=True, slots=True)
class Hand:
    """The space bar is held: a press takes hold of the page."""

    cursor: str = "hand"

    def take(self, event: Event) -> tuple[State, list[Change]]:
        """Take hold of the page, zoom, or go back when space comes up."""
        match event:
            case Pressed(button=button) if button in (LEFT, MIDDLE):
                return _taken_hold(event, self), []
            case KeyUp(key="space") | FocusLost():
                return Idle(), []
            case Scrolled():
                return self, _zoomed(event)
        return self, []


@dataclass(frozen=True, slots=True)
class Panning:
    """The page follows the pointer until the button comes up."""

    button: str
    x_px: float
    y_px: float
    back: State
    cursor: str = "hand"

    def take(self, event: Event) -> tuple[State, list[Change]]:
        """Follow the pointer; space coming up meanwhile is remembered."""
        match event:
            case Moved():
                pan = Pan(event.x_px - self.x_px, event.y_px - self.y_px)
                return Panning(self.button, event.x_px, event.y_px, self.back), [pan]
            case Released(button=button) if button == self.button:
                return self.back, []
            case KeyUp(key="space"):
                return Panning(self.button, self.x_px, self.y_px, Idle()), []
            case KeyDown(key="space"):
                return Panning(self.button, self.x_px, self.y_px, Hand()), []
            case FocusLost():
                return Idle(), []
            case Scrolled():
                return self, _zoomed(event)
        return self, []


@dataclass(frozen=True, slots=True)
class Turning:
    """The page turns with the pointer until the button comes up."""

    button: str
    at_px: tuple[float, float]
    back: State
    cursor: str = "turn"

    def take(self, event: Event) -> tuple[State, list[Change]]:
        """Follow the pointer; space coming up meanwhile is remembered."""
        match event:
            case Moved():
                to = (event.x_px, event.y_px)
                return Turning(self.button, to, self.back), [Turn(self.at_px, to)]
            case Released(button=button) if button == self.button:
                return self.back, []
            case KeyUp(key="space"):
                return Turning(self.button, self.at_px, Idle()), []
            case KeyDown(key="space"):
                return Turning(self.button, self.at_px, Hand()), []
            case FocusLost():
                return Idle(), []
            case Scrolled():
                return self, _zoomed(event)
        return self, []


def _taken_hold(event: Pressed, back: State) -> State:
    """Return the state that holds the page: Shift turns it."""
    if event.mods.shift:
        return Turning(event.button, (event.x_px, event.y_px), back)
    return Panning(event.button, event.x_px, event.y_px, back)


def _zoomed(event: Scrolled) -> list[Change]:
    if not event.dy:
        return []
    return [Zoom(ZOOM_A_NOTCH**event.dy, event.x_px, event.y_px)]


def held(state: State) -> bool:
    """Return whether a state holds the pointer, so that it gets events over panels too."""
    return not isinstance(state, Idle | Hand)
