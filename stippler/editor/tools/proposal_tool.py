"""Proposes areas from the picture; regions are merged and split by clicks and strokes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from stippler.brushes.kinds import Value
from stippler.drawing.parameter import Parameter, by_default
from stippler.editor.events import LEFT, Event, FocusLost, KeyDown, Moved, Pressed, Released
from stippler.editor.messages import INFO, WARNING
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
    import numpy as np
    from numpy.typing import NDArray

    from stippler.drawing.reference import Reference

_STEP_PX = 3.0
_KEPT = 50


class ProposalTool(Tool):
    """Shows regions of the picture as outlines of areas to be."""

    commands = ("area.proposed", "area.unite", "area.remove")
    shows_areas = True

    def __init__(self) -> None:
        super().__init__()
        self.source = PictureSource()
        self._of: Reference | None = None
        self._states: list[NDArray[np.int32]] = []
        self._lines: tuple[Path, ...] = ()
        self._is_taken = False  # then nothing is proposed until it is asked for

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return (
            by_default(
                "regions", "Regions", 24.0, "About how many; changing it begins anew.", 2.0, 300.0
            ),
        )

    def set(self, name: str, value: Value) -> None:
        """Set a parameter; another number of regions begins anew."""
        super().set(name, round(float(value)) if name == "regions" else value)
        self.put_away()

    @property
    def chosen_text(self) -> str:
        """Say how many regions there are."""
        if self._states:
            return f"{self.n_regions} regions"
        return "Click for proposals" if self._is_taken else "Point at the picture for proposals"

    @property
    def n_regions(self) -> int:
        """How many regions are proposed."""
        import numpy as np

        return len(np.unique(self._states[-1])) if self._states else 0

    # --- input --------------------------------------------------------------------------------

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Begin a stroke, or take a key."""
        if isinstance(event, KeyDown):
            return self._key(event, desk)
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        if not self._is_ready(desk.document.drawing.reference):
            desk.say("the picture is being read; once more in a moment", INFO)
            return RESTING
        return Stroking(self, [desk.at(event)], desk.mods.alt)

    def wants(self, event: KeyDown, desk: Desk) -> bool:
        """Take Enter, and Backspace while there is a change to take back."""
        if event.key == "backspace":
            return len(self._states) > 1
        return event.key in ("enter", "kp_enter") and bool(self._states)

    def _key(self, event: KeyDown, desk: Desk) -> ToolState | None:
        if not self.wants(event, desk):
            return None
        if event.key == "backspace":
            self._states.pop()
            self._show()
        else:
            self.make(desk)
        return RESTING

    def stroke(self, line: list[Point], *, is_click: bool, parts_off: bool) -> None:
        """Merge what a stroke crosses; part what is clicked, or covered with Alt."""
        parts = self.source.parts(self._of)
        if parts is None or self._of is None or not self._states:
            return
        under, now = self.source.under(self._of, line), self._states[-1]
        if not under:
            return
        if parts_off:
            then = parts.parted(now, under)
        elif is_click:
            then = parts.split(now, next(iter(under)))
        else:
            then = parts.merged(now, under)
        self._states = [*self._states[-_KEPT:], then]
        self._show()

    def make(self, desk: Desk) -> None:
        """Make areas of all regions but the one that holds most of the picture's rim."""
        import numpy as np

        from stippler.analysis.region_outlines import outlines_of

        parts = self.source.parts(self._of) if self._of is not None else None
        if parts is None or self._of is None or not self._states:
            desk.say("nothing is proposed yet", WARNING)
            return
        labels = self._states[-1][parts.labels]
        outlines = outlines_of(labels, self.source.pixel_mm(self._of), curved=True)
        rim = np.concatenate([labels[0], labels[-1], labels[:, 0], labels[:, -1]])
        ground = int(np.bincount(rim).argmax())
        found = [outlines.rings(int(k)) for k in np.unique(labels) if k != ground]
        if self.source.accept is None:
            raise GeometryError("cannot be made here", "areas")
        self.source.accept("Propose areas", found)
        self.put_away()
        self._is_taken = True

    # --- what is proposed ---------------------------------------------------------------------

    def _is_ready(self, reference: Reference | None) -> bool:
        parts = self.source.parts(reference)
        if parts is None:
            return False
        if reference is not self._of or not self._states:
            self._of = reference
            self._is_taken = False
            self._states = [parts.regions(round(float(self.value("regions"))))]
            self._show()
        return True

    def _show(self) -> None:
        from stippler.analysis.region_outlines import outlines_of

        parts = self.source.parts(self._of)
        assert parts is not None
        assert self._of is not None
        labels = self._states[-1][parts.labels]
        self._lines = lines_of(outlines_of(labels, self.source.pixel_mm(self._of)))

    def overlay(self, sight: Sight) -> Overlay:
        """Return the borders between regions."""
        document = sight.document
        reference = document.drawing.reference if document is not None else None
        if reference is None or (not self._states and (sight.at_mm is None or self._is_taken)):
            return NOTHING
        return Overlay(self._lines) if self._is_ready(reference) else NOTHING

    def put_away(self) -> None:
        """Propose nothing."""
        self._states, self._lines, self._is_taken = [], (), False

    def forget(self) -> None:
        """Know no picture."""
        self.put_away()
        self._of = None


@dataclass(slots=True)
class Stroking:
    """A stroke across regions."""

    tool: ProposalTool
    points: list[Point] = field(default_factory=list)
    parts_off: bool = False

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer; merge or part when the button comes up."""
        match event:
            case Moved():
                at = desk.at(event)
                if math.dist(at, self.points[-1]) > desk.mm(_STEP_PX):
                    self.points.append(at)
            case Released(button=button) if button == LEFT:
                click = len(self.points) == 1
                self.tool.stroke(self.points, is_click=click, parts_off=self.parts_off)
                return RESTING
            case KeyDown(key="escape") | FocusLost():
                return RESTING
        return self

    @property
    def overlay(self) -> Overlay:
        """The stroke."""
        return Overlay((Path(tuple(self.points), dashed=self.parts_off),))

    def cancel(self, desk: Desk) -> None:
        """Nothing has been changed."""
