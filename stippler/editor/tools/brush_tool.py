"""Brushes as tools: strokes, sizing the tip, straight lines; one tool for each type."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from stippler.brushes.brush import LARGEST_MM, SMALLEST_MM, Brush
from stippler.brushes.kinds import Kind, Value
from stippler.brushes.stroke_path import PointerSample
from stippler.drawing.parameter import Parameter
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
from stippler.editor.messages import WARNING
from stippler.editor.tools.brush_shelf import BrushShelf
from stippler.editor.tools.tool import (
    NOTHING,
    RESTING,
    Desk,
    Overlay,
    Point,
    Sight,
    Tip,
    Tool,
    ToolState,
)

if TYPE_CHECKING:
    from stippler.brushes.stroke import Stroke
    from stippler.drawing.preview import Preview
    from stippler.drawing.reference import Reference

LIGHT_PRESSURE = 0.3
RESIZE_A_NOTCH = 1.1
_STILL_PX = 4.0  # a press that moves less is a click
_LINE_RADII_PER_S = 20.0
_FAST_RADII_PER_S = 30.0  # a stroke this fast has the least pressure
_CALM_S = 0.08  # over which the speed is averaged
_STALL_S = 0.1  # a timed brush is given a frame sooner than this, unless the machine stalls


class BrushTool(Tool):
    """The brushes of one type; the one in use does the work.

    Attributes
    ----------
    kind : Kind
    brush : Brush
    last_end : PointerSample or None
        Where the last stroke ended.
    """

    def __init__(self, kind: Kind, shelf: BrushShelf) -> None:
        super().__init__()
        self.kind, self._shelf = kind, shelf
        self.name, self.label, self.key, self.tip = kind.name, kind.label, kind.key, kind.tip
        self.last_end: PointerSample | None = None
        self._speed: tuple[Point, float, float] | None = None  # where, when, mm/s

    @property
    def brush(self) -> Brush:
        """The brush in use."""
        return self._shelf.used(self.kind.name)

    @brush.setter
    def brush(self, brush: Brush) -> None:
        self._shelf.set(brush)

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return self.kind.parameters

    def value(self, name: str) -> Value:
        """Return a parameter's value."""
        value: Value = self.brush.value(name)
        return value

    def set(self, name: str, value: Value) -> None:
        """Set a parameter."""
        self.brush = self.brush.with_value(name, value)

    def resize(self, factor: float) -> bool:
        """Enlarge or reduce the tip."""
        self.brush = self.brush.resized(factor)
        return True

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Begin a stroke or sizing; resize by the wheel."""
        match event:
            case Pressed(button=button) if button == LEFT:
                self._speed = None
                if event.mods.shift:
                    return Sizing(self, event.x_px, event.y_px, self.brush.radius_mm)
                return Stroking(self, self.stroke(desk, self.sample(event, desk)), event.t_s)
            case Scrolled(mods=mods) if mods.ctrl or mods.alt:
                self.resize(RESIZE_A_NOTCH**event.dy)
                return RESTING
        return None

    def overlay(self, sight: Sight) -> Overlay:
        """Return the outline of the tip."""
        at_mm = sight.at_mm
        return Overlay(tip=Tip(self.brush, at_mm)) if at_mm is not None else NOTHING

    def preview(
        self, at_mm: Point, mods: Mods, heading_rad: float, reference: Reference | None
    ) -> Preview | None:
        """Return what a press would do to the dots under the tip, where that can be shown."""
        if not self.kind.previews:
            return None
        from stippler.brushes.shape import preview_of

        light = self.brush.pressure == "key" and mods.alt
        strength = LIGHT_PRESSURE if light else 1.0
        return preview_of(self.in_hand(mods), at_mm, heading_rad, strength, reference)

    def forget(self) -> None:
        """Know of no stroke before."""
        self.last_end = self._speed = None

    # --- strokes ----------------------------------------------------------------------------

    def in_hand(self, mods: Mods) -> Brush:
        """Return the brush as it works while keys are held: Ctrl inverts it, where it can."""
        return (self.brush.inverted if mods.ctrl else None) or self.brush

    def stroke(self, desk: Desk, first: PointerSample) -> Stroke:
        """Begin a stroke."""
        from stippler.brushes.stroke import Stroke

        brush = self.in_hand(desk.mods)
        return Stroke(desk.document, brush, first, desk.next_seed(), desk.heading_rad)

    def sample(self, event: Moved | Pressed | Released, desk: Desk) -> PointerSample:
        """Return where on the page an event was."""
        at = desk.at(event)
        return PointerSample(*at, pressure=self.pressure(at, event.t_s, desk.mods), t=event.t_s)

    def pressure(self, at: Point, t_s: float, mods: Mods) -> float:
        """Return what stands in for a pen's pressure: 1 is full."""
        brush = self.brush
        if brush.pressure == "key":
            return LIGHT_PRESSURE if mods.alt else 1.0
        if brush.pressure != "speed":
            return 1.0
        speed = 0.0
        if self._speed is not None:
            (x, y), t, before = self._speed
            dt = t_s - t
            share = 1.0 - math.exp(-dt / _CALM_S) if dt > 0.0 else 0.0
            now = math.hypot(at[0] - x, at[1] - y) / dt if dt > 0.0 else before
            speed = before + share * (now - before)
        self._speed = (at, t_s, speed)
        fast = _FAST_RADII_PER_S * brush.radius_mm
        return 1.0 - (1.0 - LIGHT_PRESSURE) * min(speed / fast, 1.0)

    def line_to(self, event: Released, desk: Desk) -> None:
        """Draw a straight line from where the last stroke ended."""
        end = self.sample(event, desk)
        if self.last_end is None:
            self.stroke(desk, end).commit(end)
        else:
            first = replace(self.last_end, pressure=1.0, t=0.0)
            way = math.hypot(end.x - first.x, end.y - first.y)
            t = way / (_LINE_RADII_PER_S * self.brush.radius_mm)
            self.stroke(desk, first).commit(replace(end, pressure=1.0, t=t))
        self.last_end = end


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

    tool: BrushTool
    stroke: Stroke
    seen_s: float
    lost_s: float = 0.0
    overlay: Overlay = NOTHING

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer until the button comes up, or Escape takes it all back."""
        match event:
            case Moved():
                self.stroke.follow(self._sample(event, desk))
            case Released(button=button) if button == LEFT:
                return self._ended(self._sample(event, desk), desk)
            case FocusLost():
                return self._ended(self.stroke.end, desk)
            case KeyDown(key="escape"):
                self.stroke.cancel()
                return RESTING
        return self

    def _ended(self, sample: PointerSample, desk: Desk) -> ToolState:
        edit = self.stroke.commit(sample)
        self.tool.last_end = sample
        brush = self.tool.in_hand(desk.mods)
        about = brush.about
        if edit.is_empty and about.nothing:
            values = {p.name: brush.value(p.name) for p in about.parameters}
            desk.say(about.nothing.format(**values), WARNING)
        return RESTING

    @property
    def is_timed(self) -> bool:
        """Whether it goes on while the pointer rests."""
        return self.stroke.is_timed

    def rest(self, t_s: float) -> None:
        """Let time go on."""
        self.stroke.rest(self._at(t_s))

    def _sample(self, event: Moved | Released, desk: Desk) -> PointerSample:
        return replace(self.tool.sample(event, desk), t=self._at(event.t_s))

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

    tool: BrushTool
    x_px: float
    y_px: float
    radius_mm: float
    is_dragged: bool = False
    overlay: Overlay = NOTHING

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer."""
        match event:
            case Moved():
                dx = event.x_px - self.x_px
                if self.is_dragged or math.hypot(dx, event.y_px - self.y_px) > _STILL_PX:
                    self.is_dragged = True
                    self._size(self.radius_mm + desk.mm(dx))
            case Released(button=button) if button == LEFT:
                if not self.is_dragged:
                    self.tool.line_to(event, desk)
                return RESTING
            case KeyDown(key="escape"):
                self.cancel(desk)
                return RESTING
            case FocusLost():
                return RESTING
        return self

    def _size(self, radius_mm: float) -> None:
        radius = min(max(radius_mm, SMALLEST_MM), LARGEST_MM)
        self.tool.brush = replace(self.tool.brush, radius_mm=radius)

    def cancel(self, desk: Desk) -> None:
        """Give the tip its old size."""
        self._size(self.radius_mm)
