"""Parts areas along a line."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from stippler.drawing.parameter import Parameter, by_default
from stippler.editor.events import LEFT, Event, Pressed
from stippler.editor.tools.area_tool import SMOOTHING
from stippler.editor.tools.outline_states import Cornering, Lassoing
from stippler.editor.tools.tool import Desk, Tool, ToolState
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.drawing.planar.edits import Outcome
    from stippler.drawing.planar.path import Path
    from stippler.drawing.planar.planar_map import PlanarMap

_BEYOND_PX = 3.0  # ends that snap to a border go on as far as this, so that they cross it


class KnifeTool(Tool):
    """Draws a line from border to border; what it parts are areas of their own then."""

    commands = ("area.unite", "area.remove")
    shows_areas = True
    closed = False

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        shape = by_default(
            "shape",
            "Draw",
            "freehand",
            "Drag the line; or click its corners, Enter or a double click ends it.",
            options=("freehand", "corners"),
        )
        return (shape, replace(SMOOTHING, only=("shape", ("freehand",))))

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Begin the line."""
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        if self.value("shape") == "corners":
            return Cornering.begun(self, event, desk)
        return Lassoing.begun(self, event, desk)

    def follows_borders(self, desk: Desk) -> bool:
        """Return False: a line along a border would part nothing."""
        return False

    def smoothing_mm(self, desk: Desk) -> float:
        """Return how far the line's curves may leave it."""
        return desk.mm(float(self.value("smoothing")))

    def make(self, desk: Desk, path: Path) -> None:
        """Part the areas."""
        from stippler.drawing.area_edits import edit_areas, held_areas

        document = desk.document
        held = held_areas(document.drawing)
        wanted = [k for k in desk.areas.drawn(document) if k not in held]
        line = longer(path, desk.mm(_BEYOND_PX))

        def edit(areas: PlanarMap) -> Outcome:
            crossed = wanted or [k for k in crossed_by(areas, line) if k not in held]
            return split_all(areas, line, crossed)

        outcome = edit_areas(document, "Split area", edit)
        desk.areas.choose((*wanted, *outcome.made))


def longer(path: Path, by_mm: float) -> Path:
    """Return an open path that goes on straight at both ends."""
    import numpy as np

    from stippler.drawing.planar.path import path_of_cubics, pieces_of

    pieces = pieces_of(path)
    if not pieces:
        return path
    at = path.points_mm
    first, last = at[0] - at[1], at[-1] - at[-2]
    before = at[0] + by_mm * first / np.hypot(*first)
    after = at[-1] + by_mm * last / np.hypot(*last)
    return path_of_cubics([np.array([before, at[0]]), *pieces, np.array([at[-1], after])])


def crossed_by(areas: PlanarMap, line: Path) -> list[int]:
    """Return the areas that a line runs through."""
    import shapely

    if len(line) < 2:  # the points of a click lie in one place of the grid
        return []
    drawn = shapely.linestrings(line.points_mm)
    return [k for k in areas.areas if shapely.intersection(drawn, areas.outline(k)).length > 0.0]


def split_all(before: PlanarMap, line: Path, chosen: list[int]) -> Outcome:
    """Split areas along one line; at least one of them has to be parted."""
    from stippler.drawing.planar.edits import Outcome, split

    after, made = before, list[int]()
    refused: GeometryError | None = None
    for k in chosen:
        try:
            outcome = split(after, line, k)
        except GeometryError as error:
            refused = error
            continue
        after = outcome.map
        made += outcome.made
    if not made:
        raise refused or GeometryError("crosses no area", "the line", "draw it across one")
    return Outcome(after, tuple(made))
