"""Draws areas: by corners and handles, or freehand."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stippler.drawing.parameter import Parameter, by_default
from stippler.editor.events import LEFT, Event, Pressed
from stippler.editor.messages import INFO
from stippler.editor.tools.outline_states import Cornering, Lassoing
from stippler.editor.tools.tool import Desk, Tool, ToolState
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.drawing.planar.edits import Outcome
    from stippler.drawing.planar.path import Path
    from stippler.drawing.planar.planar_map import PlanarMap

NEW, ADD, TAKE, CUT_OUT = "new area", "add", "take away", "cut out"
OTHERS = {"gives way": "takes", "stays": "is-cut", "forbids it": "refused"}
"""What lies where a new area is drawn, as the panel says it and as `planar.edits` does."""

DOES = by_default(
    "does",
    "Makes",
    NEW,
    "A new area; or adds to the chosen one, takes away from the chosen ones, or cuts a "
    "part out of it that is an area of its own then.",
    options=(NEW, ADD, TAKE, CUT_OUT),
)
OTHERS_THERE = by_default(
    "others",
    "Others",
    "gives way",
    "What an area that lies there does: it gives way, it stays as it is, or it forbids "
    "the new one. Locked areas always stay.",
    options=tuple(OTHERS),
    only=("does", (NEW, ADD)),
)
SHAPE = by_default(
    "shape",
    "Draw",
    "corners",
    "Click corners, or drag to pull a curve's handles out; Enter, a double click or the first "
    "corner closes. Or drag a lasso.",
    options=("corners", "lasso"),
)
FOLLOW = by_default(
    "follow",
    "Along borders",
    True,
    "Two corners set on borders are joined along them; Shift turns it over. Alt keeps corners off "
    "borders.",
    only=("shape", ("corners",)),
)
SMOOTHING = by_default(
    "smoothing",
    "Smoothing",
    2.0,
    "How far, on the screen, the curves may leave what was drawn; 0 keeps every point.",
    0.0,
    20.0,
    "px",
    only=("shape", ("lasso",)),
)


class AreaTool(Tool):
    """Draws an outline, and makes an area of it or changes those that are chosen."""

    commands = (
        "area.unite", "area.remove", "area.smooth", "area.simplify", "area.lock", "area.hide",
    )  # fmt: skip
    shows_areas = True
    closed = True

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return (
            DOES,
            OTHERS_THERE,
            SHAPE,
            FOLLOW,
            SMOOTHING,
        )

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Set the first corner, or begin a lasso."""
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        if self.value("does") in (ADD, TAKE) and not desk.areas.drawn(desk.document):
            raise GeometryError("none is chosen", "areas", "choose one in the list, or with Nodes")
        if self.value("shape") == "lasso":
            return Lassoing.begun(self, event, desk)
        return Cornering.begun(self, event, desk)

    def follows_borders(self, desk: Desk) -> bool:
        """Return whether corners on borders are joined along them now."""
        return bool(self.value("follow")) != desk.mods.shift

    def smoothing_mm(self, desk: Desk) -> float:
        """Return how far a lasso's curves may leave it."""
        return desk.mm(float(self.value("smoothing")))

    def make(self, desk: Desk, path: Path) -> None:
        """Make an area, or change the chosen ones."""
        does = self.value("does")
        outcome = make_area(desk, [path], does, OTHERS[self.value("others")])
        if outcome.made:
            desk.areas.choose(outcome.made)


def make_area(
    desk: Desk, paths: list[Path], does: str, others: str, rule: str = "non-zero"
) -> Outcome:
    """Do one of the things that can be done with an outline, as one step; tell its notes."""
    from stippler.drawing.area_edits import edit_areas, held_areas
    from stippler.drawing.planar import edits

    document = desk.document
    held = held_areas(document.drawing)
    chosen = [k for k in desk.areas.drawn(document) if k not in held]

    def edit(areas: PlanarMap) -> Outcome:
        if does == ADD:
            return edits.extend(areas, paths, _one(chosen), others, held, rule)
        if does == TAKE:
            _one(chosen)
            return edits.subtract(areas, paths, chosen, rule=rule)
        if does == CUT_OUT:
            from_one = chosen[0] if chosen else _under(areas, paths)
            return edits.cut(areas, paths, from_one, rule)
        return edits.add(areas, paths, others, locked=held, rule=rule)

    labels = {NEW: "Draw area", ADD: "Add to area", TAKE: "Take from area", CUT_OUT: "Cut out"}
    outcome = edit_areas(document, labels[does], edit)
    for note in outcome.notes:
        desk.say(note, INFO)
    return outcome


def _one(chosen: list[int]) -> int:
    if not chosen:
        raise GeometryError("none is chosen that is not locked", "areas", "choose another")
    return chosen[0]


def _under(areas: PlanarMap, paths: list[Path]) -> int:
    import shapely

    point = shapely.Polygon(paths[0].points_mm).buffer(0.0).representative_point()
    return int(areas.area_at([(point.x, point.y)])[0])
