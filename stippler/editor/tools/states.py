"""The states of a tool: resting, stroking, sizing the tip, outlining and carrying a selection.

A state takes an event and a `Desk` and returns the state that comes next. Changes of the drawing
are made within a stroke of its document, so every state but `Rest` can be cancelled without trace.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

from stippler.brushes.brush import LARGEST_MM, SMALLEST_MM, Brush
from stippler.brushes.stroke_path import PointerSample
from stippler.editor.events import (
    LEFT,
    Event,
    FocusLost,
    KeyDown,
    Mods,
    Moved,
    Pressed,
    Released,
    Scrolled,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from stippler.brushes.stroke import Stroke
    from stippler.drawing.document import Document

Point = tuple[float, float]

RESIZE_A_NOTCH = 1.1
_STILL_PX = 4.0  # a press that moves less is a click
_DOUBLE_S = 0.35
_LINE_RADII_PER_S = 20.0
_STALL_S = 0.1  # a timed brush is given a frame sooner than this, unless the machine stalls


class Selection(Protocol):
    """The chosen dots."""

    ids: NDArray[np.int64]

    def choose(self, ids: NDArray[np.int64], mods: Mods) -> None:
        """Choose dots; Shift adds them, Alt takes them away."""
        ...


@dataclass(slots=True)
class Desk:
    """What a state works with; made anew for each event.

    Attributes
    ----------
    page : callable
        From pixels of the canvas to mm on the page.
    pressure : callable
        From a point and a time to what stands in for a pen's pressure.
    heading_rad : float
        Direction in which the pointer came; NaN if it is not known.
    """

    document: Document
    brush: Brush
    selection: Selection
    page: Callable[[float, float], Point]
    px_per_mm: float
    pressure: Callable[[Point, float], float]
    next_seed: Callable[[], int]
    set_brush: Callable[[Brush], None]
    last_end: PointerSample | None
    heading_rad: float

    def sample(self, event: Moved | Pressed | Released) -> PointerSample:
        """Return where on the page an event was."""
        at = self.page(event.x_px, event.y_px)
        return PointerSample(*at, pressure=self.pressure(at, event.t_s), t=event.t_s)

    def stroke(self, first: PointerSample) -> Stroke:
        """Begin a stroke."""
        from stippler.brushes.stroke import Stroke

        return Stroke(self.document, self.brush, first, self.next_seed(), self.heading_rad)


class ToolState(Protocol):
    """One way of taking input."""

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Take an event; return the state that comes next."""
        ...

    def cancel(self, desk: Desk) -> None:
        """Take back what this state has begun."""
        ...


@dataclass(slots=True)
class Rest:
    """No button is held.

    Attributes
    ----------
    ended : PointerSample or None
        Where the stroke that has just ended did.
    """

    ended: PointerSample | None = None

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Begin a stroke, a selection, or sizing; resize by the wheel."""
        match event:
            case Pressed(button=button) if button == LEFT:
                return _begun(event, desk)
            case Scrolled(mods=mods) if mods.ctrl or mods.alt:
                desk.set_brush(desk.brush.resized(RESIZE_A_NOTCH**event.dy))
        return Rest()

    def cancel(self, desk: Desk) -> None:
        """Nothing has begun."""


def _begun(event: Pressed, desk: Desk) -> ToolState:
    if desk.brush.about.rhythm == "select":
        return _begun_selection(event, desk)
    if event.mods.shift:
        return Sizing(event.x_px, event.y_px, desk.brush.radius_mm)
    return Stroking(desk.stroke(desk.sample(event)), event.t_s)


def _begun_selection(event: Pressed, desk: Desk) -> ToolState:
    at = desk.page(event.x_px, event.y_px)
    plain = not (event.mods.shift or event.mods.alt)
    if plain and _on_selected(at, desk):
        desk.document.begin("Move selection")
        return Carrying(at)
    how = desk.brush.value("how")
    if how == "area":
        from stippler.brushes.selection import in_area

        desk.selection.choose(in_area(desk.document, at), event.mods)
        return Rest()
    if how == "polygon":
        return Cornering([at], event.mods, at, event.t_s)
    return Outlining(how, [at], event.mods, (event.x_px, event.y_px))


def _on_selected(at: Point, desk: Desk) -> bool:
    """Return whether the dot under the pointer, or as good as, is a chosen one."""
    row = desk.document.nearest(*at, 8.0 / desk.px_per_mm)
    if row is None:
        return False
    return bool((desk.selection.ids == desk.document.dots.id[row]).any())


@dataclass(slots=True)
class Stroking:
    """The brush is down.

    Attributes
    ----------
    seen_s : float
        The time of the last event or frame.
    lost_s : float
        How long the machine has stalled since the press: a timed brush does not make up for that.
    """

    stroke: Stroke
    seen_s: float
    lost_s: float = 0.0

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer until the button comes up, or Escape takes it all back."""
        match event:
            case Moved():
                self.stroke.follow(self._sample(event, desk))
            case Released(button=button) if button == LEFT:
                sample = self._sample(event, desk)
                self.stroke.commit(sample)
                return Rest(sample)
            case FocusLost():
                self.stroke.commit(self.stroke.end)
                return Rest(self.stroke.end)
            case KeyDown(key="escape"):
                self.stroke.cancel()
                return Rest()
        return self

    def rest(self, t_s: float) -> None:
        """Let time go on."""
        self.stroke.rest(self._at(t_s))

    def _sample(self, event: Moved | Released, desk: Desk) -> PointerSample:
        return replace(desk.sample(event), t=self._at(event.t_s))

    def _at(self, t_s: float) -> float:
        """Return how far the stroke's own time has come, which stands still in a stall."""
        self.lost_s += max(t_s - self.seen_s - _STALL_S, 0.0)
        self.seen_s = max(t_s, self.seen_s)
        return t_s - self.lost_s

    def cancel(self, desk: Desk) -> None:
        """Take the stroke back."""
        self.stroke.cancel()


@dataclass(slots=True)
class Sizing:
    """Shift is held and so is the button: dragging right enlarges the tip, left reduces it.

    A click draws a straight line from where the last stroke ended.
    """

    x_px: float
    y_px: float
    radius_mm: float
    is_dragged: bool = False

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer."""
        match event:
            case Moved():
                dx = event.x_px - self.x_px
                if self.is_dragged or math.hypot(dx, event.y_px - self.y_px) > _STILL_PX:
                    self.is_dragged = True
                    wanted = self.radius_mm + dx / desk.px_per_mm
                    radius = min(max(wanted, SMALLEST_MM), LARGEST_MM)
                    desk.set_brush(replace(desk.brush, radius_mm=radius))
            case Released(button=button) if button == LEFT:
                return Rest() if self.is_dragged else _line(event, desk)
            case KeyDown(key="escape"):
                self.cancel(desk)
                return Rest()
            case FocusLost():
                return Rest()
        return self

    def cancel(self, desk: Desk) -> None:
        """Give the tip its old size."""
        desk.set_brush(replace(desk.brush, radius_mm=self.radius_mm))


def _line(event: Released, desk: Desk) -> ToolState:
    end = desk.sample(event)
    if desk.last_end is None:
        desk.stroke(end).commit(end)
        return Rest(end)
    first = replace(desk.last_end, pressure=1.0, t=0.0)
    way = math.hypot(end.x - first.x, end.y - first.y)
    last = replace(end, pressure=1.0, t=way / (_LINE_RADII_PER_S * desk.brush.radius_mm))
    desk.stroke(first).commit(last)
    return Rest(end)


@dataclass(slots=True)
class Outlining:
    """A rectangle or a lasso is dragged; the rectangle is upright on the screen."""

    how: str
    points: list[Point]
    mods: Mods
    start_px: Point

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer; choose when the button comes up."""
        match event:
            case Moved() | Released():
                self._follow(event, desk)
                if isinstance(event, Released) and event.button == LEFT:
                    self._choose(desk)
                    return Rest()
            case KeyDown(key="escape") | FocusLost():
                return Rest()
        return self

    def _follow(self, event: Moved | Released, desk: Desk) -> None:
        (x0, y0), (x1, y1) = self.start_px, (event.x_px, event.y_px)
        if self.how == "rectangle":
            self.points = [desk.page(*at) for at in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
        elif (at := desk.page(x1, y1)) != self.points[-1]:
            self.points.append(at)

    def _choose(self, desk: Desk) -> None:
        from stippler.brushes.selection import in_outline

        desk.selection.choose(in_outline(desk.document, self.points), self.mods)

    @property
    def outline(self) -> list[Point]:
        """What is to be shown, in mm."""
        return self.points

    def cancel(self, desk: Desk) -> None:
        """Nothing has been chosen."""


@dataclass(slots=True)
class Cornering:
    """A polygon's corners are clicked, until Enter or a double click closes it."""

    points: list[Point]
    mods: Mods
    at: Point
    clicked_s: float

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Add a corner; choose when it is closed."""
        match event:
            case Moved():
                self.at = desk.page(event.x_px, event.y_px)
            case Pressed(button=button) if button == LEFT:
                at = desk.page(event.x_px, event.y_px)
                near = math.dist(at, self.points[-1]) * desk.px_per_mm < _STILL_PX
                if near and event.t_s - self.clicked_s < _DOUBLE_S:
                    return self._closed(desk)
                self.points.append(at)
                self.clicked_s = event.t_s
            case KeyDown(key="enter"):
                return self._closed(desk)
            case KeyDown(key="escape"):
                return Rest()
        return self

    def _closed(self, desk: Desk) -> ToolState:
        from stippler.brushes.selection import in_outline

        desk.selection.choose(in_outline(desk.document, self.points), self.mods)
        return Rest()

    @property
    def outline(self) -> list[Point]:
        """What is to be shown, in mm."""
        return [*self.points, self.at]

    def cancel(self, desk: Desk) -> None:
        """Nothing has been chosen."""


@dataclass(slots=True)
class Carrying:
    """The chosen dots follow the pointer."""

    at: Point

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Move them by each step of the pointer."""
        from stippler.brushes.selection import move

        match event:
            case Moved() | Released():
                to = desk.page(event.x_px, event.y_px)
                move(desk.document, desk.selection.ids, (to[0] - self.at[0], to[1] - self.at[1]))
                self.at = to
                if isinstance(event, Released) and event.button == LEFT:
                    desk.document.commit()
                    return Rest()
            case KeyDown(key="escape"):
                self.cancel(desk)
                return Rest()
            case FocusLost():
                desk.document.commit()
                return Rest()
        return self

    def cancel(self, desk: Desk) -> None:
        """Put them back."""
        if desk.document.in_stroke:
            desk.document.cancel()
