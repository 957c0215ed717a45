"""Drawing outlines and lines by hand: corners that are clicked, and a line that is dragged."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Protocol

from stippler.drawing.planar.path import Path as Curves
from stippler.editor.events import LEFT, Event, FocusLost, KeyDown, Moved, Pressed, Released
from stippler.editor.messages import WARNING
from stippler.editor.tools.outline_draft import (
    Corner,
    freehand,
    path_of,
    points_of,
    snapped,
    traced,
)
from stippler.editor.tools.tool import (
    RESTING,
    Desk,
    Handle,
    Overlay,
    Path,
    Point,
    ToolState,
)
from stippler.errors import GeometryError

_CLOSE_PX = 8.0
_PULL_PX = 4.0
_STEP_PX = 1.5
_DOUBLE_S, _DOUBLE_PX = 0.35, 4.0


class OutlineTaker(Protocol):
    """A tool that makes something of a path."""

    closed: bool

    def follows_borders(self, desk: Desk) -> bool:
        """Return whether corners on borders are joined along them now."""
        ...

    def smoothing_mm(self, desk: Desk) -> float:
        """Return how far a freehand line's curves may leave it."""
        ...

    def make(self, desk: Desk, path: Curves) -> None:
        """Make something of what was drawn; raises `GeometryError` where that is refused."""
        ...


@dataclass(slots=True)
class Cornering:
    """Corners are clicked, with handles where the press is dragged, until Enter or a double click.

    A click on the first corner closes, Backspace takes the last one back, Esc all of them.
    """

    tool: OutlineTaker
    corners: list[Corner]
    hover: Corner
    pressed_px: Point | None
    clicked: tuple[float, Point]

    @classmethod
    def begun(cls, tool: OutlineTaker, event: Pressed, desk: Desk) -> Cornering:
        """Set the first corner."""
        at, snap = snapped(desk, desk.at(event))
        first = Corner(at, snap=snap)
        px = (event.x_px, event.y_px)
        return cls(tool, [first], first, px, (event.t_s, px))

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Add corners; make something when it is closed."""
        match event:
            case Moved():
                self._move(event, desk)
            case Pressed(button=button) if button == LEFT:
                return self._press(event, desk)
            case Released(button=button) if button == LEFT:
                self.pressed_px = None
            case KeyDown(key="enter" | "kp_enter"):
                return self._closed(desk)
            case KeyDown(key="backspace" | "delete"):
                self.corners.pop()
                return self if self.corners else RESTING
            case KeyDown(key="escape"):
                return RESTING
        return self

    def _move(self, event: Moved, desk: Desk) -> None:
        at = desk.at(event)
        if self.pressed_px is not None:
            away = math.dist((event.x_px, event.y_px), self.pressed_px)
            if away > _PULL_PX or self.corners[-1].handle is not None:
                self.corners[-1] = replace(self.corners[-1], handle=at)
            self.hover = Corner(at)
            return
        self.hover = self._corner(at, desk)

    def _corner(self, at: Point, desk: Desk) -> Corner:
        place, snap = snapped(desk, at)
        corner = Corner(place, snap=snap)
        if self.tool.follows_borders(desk):
            corner = traced(desk, self.corners[-1], corner)
        return corner

    def _press(self, event: Pressed, desk: Desk) -> ToolState:
        at, px = desk.at(event), (event.x_px, event.y_px)
        t_s, last_px = self.clicked
        self.clicked = (event.t_s, px)
        if event.t_s - t_s < _DOUBLE_S and math.dist(px, last_px) < _DOUBLE_PX:
            return self._closed(desk)
        first = self.corners[0].at
        if self.tool.closed and len(self.corners) > 2 and math.dist(at, first) < desk.mm(_CLOSE_PX):
            return self._closed(desk)
        self.corners.append(self._corner(at, desk))
        self.hover = self.corners[-1]
        self.pressed_px = px
        return self

    def _closed(self, desk: Desk) -> ToolState:
        """Make something; what is refused is said, and can be drawn on."""
        corners = self.corners
        if self.tool.closed and self.tool.follows_borders(desk) and len(corners) > 1:
            last = traced(desk, corners[-1], replace(corners[0], via=(), is_traced=False))
            if last.is_traced:
                corners = [*corners, last]
        try:
            self.tool.make(desk, path_of(corners, closed=self.tool.closed))
        except GeometryError as error:
            desk.say(f"{error}; Backspace takes a corner back, Esc all", WARNING)
            return self
        return RESTING

    @property
    def overlay(self) -> Overlay:
        """The outline, to where the pointer is."""
        corners = [*self.corners, self.hover] if self.pressed_px is None else self.corners
        line = points_of(corners)
        paths = [Path(line)]
        if self.tool.closed and len(line) > 2:
            paths.append(Path((line[-1], line[0]), dashed=True))
        handles = [Handle(c.at, "node") for c in self.corners]
        for c in self.corners[-1:]:
            if c.handle is not None and c.handle_in is not None:
                paths.append(Path((c.handle_in, c.handle)))
                handles += [Handle(c.handle, "control"), Handle(c.handle_in, "control")]
        if self.hover.snap is not None and self.pressed_px is None:
            handles.append(Handle(self.hover.at, "node", chosen=True))
        return Overlay(tuple(paths), tuple(handles))

    def cancel(self, desk: Desk) -> None:
        """Nothing has been made."""


@dataclass(slots=True)
class Lassoing:
    """A line is dragged freehand; its ends snap to borders."""

    tool: OutlineTaker
    points: list[Point] = field(default_factory=list)

    @classmethod
    def begun(cls, tool: OutlineTaker, event: Pressed, desk: Desk) -> Lassoing:
        """Begin where the pointer is, or on a border near it."""
        return cls(tool, [snapped(desk, desk.at(event))[0]])

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer; make something when the button comes up."""
        match event:
            case Moved():
                at = desk.at(event)
                if math.dist(at, self.points[-1]) >= desk.mm(_STEP_PX):
                    self.points.append(at)
            case Released(button=button) if button == LEFT:
                if not self.tool.closed:
                    self.points.append(snapped(desk, desk.at(event))[0])
                if len(self.points) > 1:
                    path = freehand(
                        self.points, self.tool.smoothing_mm(desk), closed=self.tool.closed
                    )
                    self.tool.make(desk, path)
                return RESTING
            case KeyDown(key="escape") | FocusLost():
                return RESTING
        return self

    @property
    def overlay(self) -> Overlay:
        """The line so far."""
        return Overlay((Path(tuple(self.points), closed=self.tool.closed),))

    def cancel(self, desk: Desk) -> None:
        """Nothing has been made."""
