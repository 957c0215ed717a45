"""The warp tool: one cage bends chosen dots, areas with dots and lines, or all there is."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.parameter import Parameter, by_default
from stippler.editor.events import LEFT, Event, Pressed
from stippler.editor.line_edits import clear_zones, lines_of, meet, set_line
from stippler.editor.messages import WARNING
from stippler.editor.tools import bending
from stippler.editor.tools.drag import Drag
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
    from stippler.drawing.bend_areas import ShownBorders
    from stippler.drawing.deformation import Deformation
    from stippler.drawing.document import Document
    from stippler.drawing.line import Line

CHOSEN, AREAS, ALL = "selection", "areas", "all"
_NEAR_PX = 9.0
_SUFFERED = 0.1  # of a dot's room, by which it has to have changed
_MOST_RELAXED = 20_000
_TURNS = 3
_APART_PX = 3.0  # points of borders, while they are dragged


@dataclass(slots=True)
class Target:
    """What is bent together.

    Attributes
    ----------
    ids : (n,) int64
        Of free dots.
    lines, areas : tuple of int
    """

    box: bending.Box
    ids: NDArray[np.int64]
    lines: tuple[int, ...]
    areas: tuple[int, ...]


def target_of(what: str, document: Document, sight: Desk | Sight) -> Target | None:
    """Return what is to be bent; None where nothing is chosen."""
    dots, page = document.dots, document.drawing.page
    every = lines_of(document)
    if what == CHOSEN:
        rows = document.rows(sight.selection.ids)
        rows, chosen = rows[rows >= 0], tuple(sight.lines.alive(document))
        places = [dots.position_mm[rows], *(every[k].path.points_mm for k in chosen)]
        areas: tuple[int, ...] = ()
    else:
        is_all = what == ALL
        areas = tuple(document.drawing.areas if is_all else sight.areas.alive(document))
        if not areas:
            return None
        parts = [document.partition.part_of(k).bounds for k in areas]
        bounds = np.array(parts).reshape(-1, 2, 2)
        places = [bounds.reshape(-1, 2)]
        rows = np.flatnonzero(np.isin(dots.area, areas))
        low, high = bounds.min(axis=(0, 1)), bounds.max(axis=(0, 1))
        chosen = tuple(
            k for k, line in every.items()
            if ((line.path.points_mm >= low) & (line.path.points_mm <= high)).all()
        )  # fmt: skip
    at = np.concatenate(places)
    if not len(at) or np.ptp(at, axis=0).min() <= 1e-6:
        return None
    low = np.maximum(at.min(axis=0), 0.0)
    high = np.minimum(at.max(axis=0), (page.width_mm, page.height_mm))
    rows = rows[~dots.fixed[rows]]
    box = (float(low[0]), float(low[1]), float(high[0]), float(high[1]))
    unlocked = tuple(k for k in chosen if not every[k].locked)
    return Target(box, dots.id[rows].copy(), unlocked, areas)


class WarpTool(Tool):
    """Bends what is chosen."""

    shows_areas = True

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return (
            by_default("what", "What", CHOSEN, "What is bent together.",
                      options=(CHOSEN, AREAS, ALL)),
            by_default("how", "By", bending.CAGE, "What is taken hold of.",
                      options=(bending.CAGE, bending.MOVE, bending.PERSPECTIVE)),
            by_default("points", "Cage points", 4.0, "Each way.", 4, 12,
                      only=("how", (bending.CAGE,))),
            by_default("sizes", "Keep the tone", True, "Dots grow where they are drawn apart."),
            by_default("relaxes", "Relax after", True, "Where spacing has suffered."),
        )  # fmt: skip

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Take hold of the cage."""
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        target = target_of(self.value("what"), desk.document, desk)
        if target is None:
            desk.say("nothing is chosen to be bent", WARNING)
            return RESTING
        at = desk.at(event)
        rest, way = self.rest(target.box), self.value("how")
        near = [
            (math.dist(at, place), grip)
            for grip, place in bending.grips(rest, target.box, way, desk.mm(1.0))
        ]
        distance, grip = min(near, default=(math.inf, ("all", 0)))
        if distance > desk.mm(_NEAR_PX):
            if way != bending.MOVE:
                return RESTING
            grip = ("all", 0)
        return Warping(self, target, rest, way, grip, at)

    def rest(self, box: bending.Box) -> Deformation:
        """Return a cage over a box that bends nothing yet."""
        from stippler.drawing.deformation import Cage, Deformation

        n = round(self.value("points"))
        return Deformation(cage=Cage.over(box, n, n) if self.value("how") == bending.CAGE else None)

    def overlay(self, sight: Sight) -> Overlay:
        """Return the cage."""
        if sight.document is None or sight.is_held:
            return NOTHING
        target = target_of(self.value("what"), sight.document, sight)
        if target is None:
            return NOTHING
        return bending.overlay(self.rest(target.box), target.box, self.value("how"), sight.mm)


@dataclass(slots=True)
class Warping(Drag):
    """A point of the cage follows the pointer, and dots, lines and what is shown of borders."""

    tool: WarpTool
    target: Target
    first: Deformation
    way: str
    grip: bending.Grip
    start: Point
    now: Deformation | None = None
    places: NDArray[np.float64] = field(default_factory=lambda: np.empty((0, 2)))
    radii: NDArray[np.float32] = field(default_factory=lambda: np.empty(0, np.float32))
    rows: NDArray[np.int64] = field(default_factory=lambda: np.empty(0, np.int64))
    lines: dict[int, Line] = field(default_factory=dict)
    borders: ShownBorders | None = None
    shown: tuple[Path, ...] = ()

    def _follow(self, at: Point, desk: Desk) -> None:
        from stippler.drawing.deformation import before_fold

        box = self.target.box
        try:
            wanted = bending.moved(
                self.first, box, self.way, self.grip, self.start, at, exact=desk.mods.shift
            )
            if wanted.cage is not None:
                wanted = before_fold(self.first, wanted, box)
            self._show(wanted, desk)
        except GeometryError:
            return  # it stays as it was before

    def _show(self, wanted: Deformation, desk: Desk) -> None:
        document = desk.document
        if not document.in_stroke:
            self._take_up(desk)
        for k, line in self.lines.items():
            set_line(document, k, line.deformed(wanted))
        at = wanted.apply(self.places)
        page = document.drawing.page
        inside = _on_page(at, page.width_mm, page.height_mm)
        rows, at = (self.rows, at) if inside.all() else (self.rows[inside], at[inside])
        document.change("position_mm", rows, at)
        if self.borders is not None:
            self.shown = tuple(Path(points.tolist()) for points in self.borders.bent(wanted))
        self.now = wanted

    def _take_up(self, desk: Desk) -> None:
        """Begin the stroke, and keep what is to be bent as it was."""
        document = desk.document
        document.begin("Warp")
        self.rows = document.rows(self.target.ids)
        self.places = document.dots.position_mm[self.rows].copy()
        self.radii = document.dots.radius_mm[self.rows].copy()
        self.lines = {k: lines_of(document)[k] for k in self.target.lines}
        if self.target.areas and len(document.drawing.areas) > 1:
            from stippler.drawing.area_edits import current_map
            from stippler.drawing.bend_areas import ShownBorders

            borders = current_map(document)
            self.borders = ShownBorders.of(borders, self.target.areas, desk.mm(_APART_PX))

    def _let_go(self, desk: Desk) -> ToolState:
        document = desk.document
        if not document.in_stroke or self.now is None:
            return RESTING
        from stippler.drawing.bend_areas import bend_borders, clear_grown_over

        try:
            if self.target.areas:
                bend_borders(document, self.target.areas, self.now)
                clear_grown_over(document, self.target.areas, self.target.ids)
                _bend_patterns(document, self.target, self.now)
        except GeometryError as error:
            desk.say(str(error), WARNING)
            self.cancel(desk)
            return RESTING
        self._keep_tone(document, self.now)
        for k in self.lines:
            meet(document, k, desk.say)
        clear_zones(document, document.rows(self.target.ids), desk.say)
        document.commit()
        return RESTING

    def _keep_tone(self, document: Document, bent: Deformation) -> None:
        """Give dots their areas and sizes anew, and relax those whose room has changed."""
        rows = document.rows(self.target.ids)
        document.own_by_place(rows)
        room = stretch(bent, self.places)
        if self.tool.value("sizes"):
            sizes = (self.radii * np.sqrt(np.clip(room, 0.04, 25.0))).astype(np.float32)
            document.change("radius_mm", rows, sizes)
        suffered = np.abs(np.log(np.maximum(room, 1e-6))) > _SUFFERED
        if self.tool.value("relaxes") and 0 < suffered.sum() <= _MOST_RELAXED:
            from stippler.brushes.selection import relax

            for _ in range(_TURNS):
                relax(document, self.target.ids[suffered])

    @property
    def overlay(self) -> Overlay:
        """The cage as it is now, and the borders in place of those of the drawing."""
        bent = self.now or self.first
        cage = NOTHING
        if self.way == bending.CAGE:
            cage = bending.overlay(bent, self.target.box, self.way, 1.0, self.grip)
        if not self.shown:
            return cage
        return Overlay((*self.shown, *cage.paths), cage.handles, has_borders=True)

    def cancel(self, desk: Desk) -> None:
        """Put it back."""
        if desk.document.in_stroke:
            desk.document.cancel()


def _on_page(at: NDArray[np.float64], width: float, height: float) -> NDArray[np.bool_]:
    x, y = at.T
    return np.asarray((x >= 0.0) & (x <= width) & (y >= 0.0) & (y <= height))


def stretch(bent: Deformation, at: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return by how much a deformation enlarges areas at places."""
    step = 1e-3
    here = bent.apply(at)
    right = (bent.apply(np.add(at, (step, 0.0))) - here) / step
    down = (bent.apply(np.add(at, (0.0, step))) - here) / step
    return np.asarray(np.abs(right[:, 0] * down[:, 1] - right[:, 1] * down[:, 0]))


def _bend_patterns(document: Document, target: Target, bent: Deformation) -> None:
    """Bend the patterns of the areas, too."""
    patterns = document.drawing.patterns
    for k, pattern in [(k, p) for k, p in patterns.items() if p.area in target.areas]:  # type: ignore[attr-defined]
        whole = pattern.deformation.followed_by(bent, target.box)  # type: ignore[attr-defined]
        document.set("pattern", k, replace(pattern, deformation=whole))  # type: ignore[type-var]
