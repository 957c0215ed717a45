"""Grows an outline from a scribble inside, and one outside, by the picture's tones."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from stippler.drawing.parameter import Parameter
from stippler.editor.events import LEFT, Event, FocusLost, KeyDown, Moved, Pressed, Released
from stippler.editor.messages import INFO, WARNING
from stippler.editor.tools.area_tool import DOES, OTHERS, OTHERS_THERE, make_area
from stippler.editor.tools.picture_source import PictureSource, lines_of
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
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.analysis.region_outlines import RegionOutlines
    from stippler.drawing.planar.path import Path as Curves
    from stippler.drawing.reference import Reference

_STEP_PX = 3.0


@dataclass(slots=True)
class Scribble:
    """A line that says what is inside, or what is not."""

    points: list[Point]
    is_outside: bool
    parts: set[int]


class GrowTool(Tool):
    """Scribble within a thing of the picture; its outline is found."""

    commands = ("area.grown", "area.unite", "area.remove")
    shows_areas = True

    def __init__(self) -> None:
        super().__init__()
        self.source = PictureSource()
        self.scribbles: list[Scribble] = []
        self._lines: tuple[Path, ...] = ()
        self._of: Reference | None = None

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return (DOES, OTHERS_THERE)

    @property
    def chosen_text(self) -> str:
        """Say what is missing."""
        return "Enter makes an area" if self._lines else "Nothing scribbled yet"

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Begin a scribble, or take a key."""
        if isinstance(event, KeyDown):
            return self._key(event, desk)
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        reference = desk.document.drawing.reference
        if self.source.parts(reference) is None:
            desk.say("the picture is being read; once more in a moment", INFO)
            return RESTING
        if self._of is not reference:
            self.drop()
            self._of = reference
        scribble = Scribble([desk.at(event)], desk.mods.alt, set())
        self.scribbles.append(scribble)
        self.update()
        return Scribbling(self, scribble)

    def wants(self, event: KeyDown, desk: Desk) -> bool:
        """Take Enter, Backspace and Escape while anything is scribbled."""
        return bool(self.scribbles) and event.key in ("enter", "kp_enter", "backspace", "escape")

    def _key(self, event: KeyDown, desk: Desk) -> ToolState | None:
        if not self.wants(event, desk):
            return None
        if event.key == "escape":
            self.drop()
        elif event.key == "backspace":
            self.scribbles.pop()
            self.update()
        else:
            self.make(desk)
        return RESTING

    def make(self, desk: Desk) -> None:
        """Make an area of what has grown; what is refused is said."""
        if not self._lines or desk.document.drawing.reference is not self._of:
            desk.say("scribble within a thing of the picture first", WARNING)
            return
        does, others = str(self.value("does")), OTHERS[str(self.value("others"))]
        try:
            outcome = make_area(desk, self.rings(), does, others, "even-odd")
        except GeometryError as error:
            desk.say(str(error), WARNING)
            return
        if outcome.made:
            desk.areas.choose(outcome.made)
        self.drop()

    def rings(self) -> list[Curves]:
        """Return the outline of what has grown, as curves."""
        return self._outlines(curved=True).rings(1)

    def _outlines(self, *, curved: bool) -> RegionOutlines:
        from stippler.analysis.region_outlines import outlines_of

        parts = self.source.parts(self._of)
        assert parts is not None
        assert self._of is not None
        inside = set[int]().union(*(s.parts for s in self.scribbles if not s.is_outside))
        outside = set[int]().union(*(s.parts for s in self.scribbles if s.is_outside))
        grown = parts.grown(inside, outside).astype("int32")
        return outlines_of(grown[parts.labels], self.source.pixel_mm(self._of), curved=curved)

    def update(self) -> None:
        """Find the outline anew."""
        assert self._of is not None
        for scribble in self.scribbles:
            scribble.parts = self.source.under(self._of, scribble.points)
        has_seed = any(s.parts for s in self.scribbles if not s.is_outside)
        self._lines = lines_of(self._outlines(curved=False)) if has_seed else ()

    def drop(self) -> None:
        """Forget all scribbles."""
        self.scribbles, self._lines = [], ()

    def overlay(self, sight: Sight) -> Overlay:
        """Return the outline and the scribbles; those outside are dashed."""
        document = sight.document
        if document is None or document.drawing.reference is not self._of or not self.scribbles:
            return NOTHING
        drawn = (Path(tuple(s.points), dashed=s.is_outside) for s in self.scribbles)
        return Overlay((*self._lines, *drawn))

    def put_away(self) -> None:
        """Forget all scribbles."""
        self.drop()

    def forget(self) -> None:
        """Forget all scribbles."""
        self.drop()
        self._of = None


@dataclass(slots=True)
class Scribbling:
    """A scribble is drawn; the outline follows at once."""

    tool: GrowTool
    scribble: Scribble
    overlay: Overlay = NOTHING

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer until the button comes up."""
        match event:
            case Moved():
                at = desk.at(event)
                if math.dist(at, self.scribble.points[-1]) > desk.mm(_STEP_PX):
                    self.scribble.points.append(at)
                    self.tool.update()
            case Released(button=button) if button == LEFT:
                return RESTING
            case KeyDown(key="escape") | FocusLost():
                self.cancel(desk)
                return RESTING
        return self

    def cancel(self, desk: Desk) -> None:
        """Take the scribble back."""
        if self.scribble in self.tool.scribbles:
            self.tool.scribbles.remove(self.scribble)
            self.tool.update()
