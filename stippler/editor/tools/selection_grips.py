"""The chosen dots taken hold of: dragged, scaled by a corner, turned by the handle above."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from stippler.editor.events import LEFT, Event, FocusLost, KeyDown, Moved, Pressed, Released
from stippler.editor.tools.tool import (
    NOTHING,
    RESTING,
    Desk,
    Grip,
    Handle,
    Overlay,
    Path,
    Point,
    Sight,
    ToolState,
)

if TYPE_CHECKING:
    from stippler.brushes.motion import Held, Motion

_NEAR_PX = 8.0
_OUT_PX = 10.0  # corners stand so far out
_TURN_PX = 30.0  # and the handle that turns above them
_STILL_PX = 3.0
_SNAP_RAD = math.radians(15.0)
_LEAST_SCALE = 0.02


def overlay(sight: Sight) -> Overlay:
    """Return the outline of the chosen dots with its handles."""
    if sight.document is None or not len(sight.selection.ids):
        return NOTHING
    hull = sight.selection.hull(sight.document)
    if not hull:
        return NOTHING
    places = _handles(sight.selection.box(sight.document), sight.mm)
    handles = tuple(Handle(at, grip) for at, grip, _ in places)
    return Overlay((Path(hull, closed=True, dashed=True),), handles)


def _handles(box: tuple[Point, Point] | None, mm: float) -> list[tuple[Point, Grip, Point]]:
    """Return where the handles of a box are, what they do, and about which point."""
    if box is None:
        return []
    (x0, y0), (x1, y1) = box
    out, middle = _OUT_PX * mm, ((x0 + x1) / 2, (y0 + y1) / 2)
    found: list[tuple[Point, Grip, Point]] = [
        ((x + i * out, y + j * out), "scale", (x0 + x1 - x, y0 + y1 - y))
        for x, i in ((x0, -1), (x1, 1))
        for y, j in ((y0, -1), (y1, 1))
    ]
    return [*found, ((middle[0], y0 - _TURN_PX * mm), "turn", middle)]


def taken(event: Pressed, desk: Desk) -> ToolState | None:
    """Return what a press takes hold of: a handle, or the chosen dots; None is neither."""
    if not len(desk.selection.ids):
        return None
    at = desk.at(event)
    for place, grip, about in _handles(desk.selection.box(desk.document), desk.mm(1.0)):
        if math.dist(at, place) <= desk.mm(_NEAR_PX):
            return Gripping(grip, at, about, (event.x_px, event.y_px))
    if desk.selection.holds(desk.document, at, desk.mm(_NEAR_PX)):
        return Gripping("node", at, at, (event.x_px, event.y_px))
    return None


@dataclass(slots=True)
class Gripping:
    """The chosen dots follow the pointer: "node" drags, "scale" and "turn" about a point.

    Shift turns by steps; Alt scales the places alone, not the dots. A press that does not move
    lets go of the selection.
    """

    grip: Grip
    start: Point
    about: Point
    start_px: Point
    held: Held | None = None
    hull: tuple[Point, ...] = ()
    motion: Motion | None = None

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer until the button comes up, or Escape puts all back."""
        match event:
            case Moved() | Released():
                away = math.hypot(event.x_px - self.start_px[0], event.y_px - self.start_px[1])
                if self.held is not None or away > _STILL_PX:
                    self._follow(event, desk)
                if isinstance(event, Released) and event.button == LEFT:
                    return self._let_go(desk)
            case KeyDown(key="escape"):
                self.cancel(desk)
                return RESTING
            case FocusLost():
                return self._let_go(desk)
        return self

    def _let_go(self, desk: Desk) -> ToolState:
        if self.held is not None:
            desk.document.commit()
        elif self.grip == "node":
            desk.selection.choose(desk.selection.ids[:0])
        return RESTING

    def _follow(self, event: Moved | Released, desk: Desk) -> None:
        from stippler.brushes.motion import Held

        if self.held is None:
            self.hull = desk.selection.hull(desk.document)
            label = {"scale": "Scale selection", "turn": "Turn selection"}
            desk.document.begin(label.get(self.grip, "Move selection"))
            self.held = Held(desk.document, desk.selection.ids)
        self.motion = self.held.put(self._wanted(desk.at(event), desk))

    def _wanted(self, at: Point, desk: Desk) -> Motion:
        from stippler.brushes.motion import Motion

        (x0, y0), (ax, ay) = self.start, self.about
        if self.grip == "turn":
            turn = math.atan2(at[1] - ay, at[0] - ax) - math.atan2(y0 - ay, x0 - ax)
            turn = math.remainder(turn, math.tau)
            if desk.mods.shift:
                turn = round(turn / _SNAP_RAD) * _SNAP_RAD
            return Motion(turn_rad=turn, about_mm=self.about)
        if self.grip == "scale":
            dx, dy = x0 - ax, y0 - ay
            share = ((at[0] - ax) * dx + (at[1] - ay) * dy) / max(dx * dx + dy * dy, 1e-12)
            scale = max(share, _LEAST_SCALE)
            return Motion(scale=scale, about_mm=self.about, sizes=not desk.mods.alt)
        return Motion((at[0] - x0, at[1] - y0))

    @property
    def overlay(self) -> Overlay:
        """The outline where it has come to."""
        if self.motion is None or not self.hull:
            return NOTHING
        import numpy as np

        points = self.motion.of(np.array(self.hull))
        corners = tuple((float(x), float(y)) for x, y in points)
        return Overlay((Path(corners, closed=True, dashed=True),))

    def cancel(self, desk: Desk) -> None:
        """Put them back."""
        if desk.document.in_stroke:
            desk.document.cancel()
