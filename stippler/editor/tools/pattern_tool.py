"""The pattern tool: moves, turns, scales, shears and bends the pattern of an area."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.one_step import as_one_step
from stippler.drawing.parameter import Parameter, by_default
from stippler.editor.events import LEFT, Event, Pressed
from stippler.editor.messages import WARNING
from stippler.editor.tools import bending
from stippler.editor.tools.drag import Drag
from stippler.editor.tools.tool import (
    NOTHING,
    RESTING,
    Desk,
    Overlay,
    Point,
    Sight,
    Tool,
    ToolState,
)
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.drawing.deformation import Deformation
    from stippler.drawing.document import Document
    from stippler.drawing.pattern import Pattern

_NEAR_PX = 9.0
_KIND = "pattern"


def area_of(chosen: list[int]) -> int:
    """Return the area whose pattern is at hand: the first chosen one, or the page."""
    return chosen[0] if chosen else 0


def box_of(document: Document, area: int) -> bending.Box:
    """Return the box about what an area owns."""
    return document.partition.part_of(area).bounds  # type: ignore[no-any-return]


class PatternTool(Tool):
    """Bends the pattern of the chosen area, or of the page."""

    shows_areas = True

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return (
            by_default("how", "By", bending.MOVE, "What is taken hold of.", options=bending.WAYS),
            by_default("dots", "Take dots along", True, "Dots follow while it is dragged."),
        )

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Take hold of the pattern."""
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        area = area_of(desk.areas.alive(desk.document))
        found = laid_on(desk.document, area)
        if found is None:
            desk.say("lay a pattern over the area first: choose one in the panel", WARNING)
            return RESTING
        k, pattern = found
        at, box, way = desk.at(event), box_of(desk.document, area), self.value("how")
        near = [
            (math.dist(at, place), grip)
            for grip, place in bending.grips(pattern.deformation, box, way, desk.mm(1.0))
        ]
        distance, grip = min(near, default=(math.inf, ("all", 0)))
        is_near = distance <= desk.mm(_NEAR_PX)
        if way == bending.PINS:
            return self._pin(desk, k, pattern, at, grip if is_near else None)
        if not is_near:
            if way in (bending.CAGE, bending.PERSPECTIVE):
                return RESTING
            grip = ("all", 0)
        return Bending(k, pattern, box, way, grip, at, takes_dots=self.value("dots"))

    def _pin(
        self, desk: Desk, k: int, pattern: Pattern, at: Point, grip: bending.Grip | None
    ) -> ToolState:
        """Take hold of a pin, set one, or take one away."""
        bent = pattern.deformation
        box = box_of(desk.document, pattern.area)
        if grip is not None and desk.mods.alt:
            pins = tuple(pin for i, pin in enumerate(bent.pins_mm) if i != grip[1])
            _set(desk.document, k, replace(pattern, deformation=replace(bent, pins_mm=pins)),
                 "Remove pin")  # fmt: skip
            return RESTING
        if grip is None:
            unpinned = replace(bent, matrix=(1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0), cage=None)
            came = unpinned.inverse_of([at])[0]
            if not np.isfinite(came).all():
                return RESTING
            pin = ((float(came[0]), float(came[1])), at)
            bent = replace(bent, pins_mm=(*bent.pins_mm, pin))
            grip = ("pin", len(bent.pins_mm) - 1)
        state = Bending(k, pattern, box, bending.PINS, grip, at, takes_dots=self.value("dots"))
        state.first = bent
        state.show(bent, desk)
        return state

    def overlay(self, sight: Sight) -> Overlay:
        """Return the handles of the pattern."""
        if sight.document is None or sight.is_held:
            return NOTHING
        area = area_of(sight.areas.alive(sight.document))
        found = laid_on(sight.document, area)
        if found is None:
            return NOTHING
        box = box_of(sight.document, area)
        return bending.overlay(found[1].deformation, box, self.value("how"), sight.mm)


def laid_on(document: Document, area: int) -> tuple[int, Pattern] | None:
    """Return the pattern of an area with its id."""
    from stippler.stippling.part_of_area import pattern_of

    return pattern_of(document.drawing, area)


def _set(document: Document, k: int, pattern: Pattern, label: str) -> None:
    as_one_step(document, label, lambda document: document.set(_KIND, k, pattern))


@dataclass(slots=True)
class Bending(Drag):
    """A grip of the pattern follows the pointer; the pattern and its dots are there meanwhile."""

    k: int
    pattern: Pattern
    box: bending.Box
    way: str
    grip: bending.Grip
    start: Point
    takes_dots: bool = True
    first: Deformation | None = None
    now: Deformation | None = None
    dots: Taken | None = None

    def _follow(self, at: Point, desk: Desk) -> None:
        from stippler.drawing.deformation import before_fold

        first = self.first or self.pattern.deformation
        try:
            wanted = bending.moved(
                first, self.box, self.way, self.grip, self.start, at, exact=desk.mods.shift
            )
            if self.grip[0] in ("point", "pin"):
                reach = (0.0, 0.0, float(self.pattern.columns), float(self.pattern.rows))
                wanted = before_fold(first, wanted, reach)
            self.show(wanted, desk)
        except GeometryError:
            return  # it stays as it was before

    def show(self, wanted: Deformation, desk: Desk) -> None:
        """Bend the pattern so, and its dots."""
        pattern = replace(self.pattern, deformation=wanted)
        pattern.rings_mm()  # refused beyond the horizon
        if not desk.document.in_stroke:
            desk.document.begin("Bend pattern")
            if self.takes_dots:
                old = self.pattern.deformation
                self.dots = Taken.of(desk.document, self.pattern.area, old)
        desk.document.set(_KIND, self.k, pattern)
        if self.dots is not None:
            self.dots.put(desk.document, wanted)
        self.now = wanted

    def _let_go(self, desk: Desk) -> ToolState:
        if desk.document.in_stroke:
            desk.document.commit()
        return RESTING

    @property
    def overlay(self) -> Overlay:
        """The handles as they are now."""
        bent = self.now or self.pattern.deformation
        if self.way in (bending.CAGE, bending.PINS):
            return bending.overlay(bent, self.box, self.way, 1.0, self.grip)
        return NOTHING

    def cancel(self, desk: Desk) -> None:
        """Put it back."""
        if desk.document.in_stroke:
            desk.document.cancel()


@dataclass(slots=True)
class Taken:
    """Free dots of an area, and from where its deformation has them."""

    ids: NDArray[np.int64]
    area: int
    from_: NDArray[np.float64]

    @classmethod
    def of(cls, document: Document, area: int, bent: Deformation) -> Taken | None:
        """Take the free dots of an area; None where there are none."""
        dots = document.dots
        rows = np.flatnonzero((dots.area == area) & ~dots.fixed)
        came = bent.inverse_of(dots.position_mm[rows])
        known = np.isfinite(came).all(axis=1)
        if not known.any():
            return None
        return cls(dots.id[rows[known]].copy(), area, came[known])

    def put(self, document: Document, bent: Deformation) -> None:
        """Bring them to where a deformation has them.

        Those that would leave their area stay, and those that would come too near to a line.
        """
        at = bent.apply(self.from_)
        inside = document.partition.area_at(at) == self.area
        if (lines := document.meetings) is not None:
            inside &= lines.are_off(at)
        rows = document.rows(self.ids)
        document.change("position_mm", rows[inside], at[inside])
