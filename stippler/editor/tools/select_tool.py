"""The selection: dots chosen by an outline or an area, and taken hold of."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stippler.drawing.parameter import Parameter, by_default
from stippler.editor.events import (
    LEFT,
    Event,
    FocusLost,
    KeyDown,
    Mods,
    Moved,
    Pressed,
    Released,
)
from stippler.editor.tools import selection_grips
from stippler.editor.tools.tool import (
    NOTHING,
    RESTING,
    Desk,
    Overlay,
    Path,
    Point,
    Sight,
    Tool,
    ToolState,
)

_STILL_PX = 4.0  # a press that moves less is a click
_DOUBLE_S = 0.35


class SelectTool(Tool):
    """Chooses dots, and moves the chosen ones."""

    commands = (
        "selection.invert", "selection.grow", "selection.copy", "selection.paste",
        "selection.delete", "selection.duplicate", "selection.fix", "selection.free",
        "selection.relax", "selection.jitter", "selection.enlarge", "selection.reduce",
    )  # fmt: skip

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return (
            by_default(
                "how",
                "Outline",
                "rectangle",
                "Drag a rectangle or a lasso, click a polygon's corners (Enter or a double click "
                "closes it), or click into an area.",
                options=("rectangle", "lasso", "polygon", "area"),
            ),
        )

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Begin to carry the chosen dots, or to choose others."""
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        at = desk.at(event)
        plain = not (event.mods.shift or event.mods.alt)
        if plain and (grip := selection_grips.taken(event, desk)) is not None:
            return grip
        how = self.value("how")
        if how == "area":
            from stippler.brushes.selection import in_area

            desk.selection.choose(in_area(desk.document, at), event.mods)
            return RESTING
        if how == "polygon":
            return Cornering([at], event.mods, at, event.t_s)
        return Outlining(how, [at], event.mods, (event.x_px, event.y_px))

    def overlay(self, sight: Sight) -> Overlay:
        """Return the outline of the chosen dots, with handles."""
        return NOTHING if sight.is_held else selection_grips.overlay(sight)


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
                    _choose(desk, self.points, self.mods)
                    return RESTING
            case KeyDown(key="escape") | FocusLost():
                return RESTING
        return self

    def _follow(self, event: Moved | Released, desk: Desk) -> None:
        (x0, y0), (x1, y1) = self.start_px, (event.x_px, event.y_px)
        if self.how == "rectangle":
            self.points = [desk.page(*at) for at in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
        elif (at := desk.page(x1, y1)) != self.points[-1]:
            self.points.append(at)

    @property
    def overlay(self) -> Overlay:
        """The outline."""
        return Overlay((Path(tuple(self.points), closed=True),))

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
                self.at = desk.at(event)
            case Pressed(button=button) if button == LEFT:
                at = desk.at(event)
                near = math.dist(at, self.points[-1]) * desk.px_per_mm < _STILL_PX
                if near and event.t_s - self.clicked_s < _DOUBLE_S:
                    return self._closed(desk)
                self.points.append(at)
                self.clicked_s = event.t_s
            case KeyDown(key="enter"):
                return self._closed(desk)
            case KeyDown(key="escape"):
                return RESTING
        return self

    def _closed(self, desk: Desk) -> ToolState:
        _choose(desk, self.points, self.mods)
        return RESTING

    @property
    def overlay(self) -> Overlay:
        """The outline, to where the pointer is."""
        return Overlay((Path((*self.points, self.at), closed=True),))

    def cancel(self, desk: Desk) -> None:
        """Nothing has been chosen."""


def _choose(desk: Desk, points: list[Point], mods: Mods) -> None:
    from stippler.brushes.selection import in_outline

    desk.selection.choose(in_outline(desk.document, points), mods)
