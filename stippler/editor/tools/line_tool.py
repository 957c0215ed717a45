"""The line tool: curves by a pen, freehand lines, and moving lines whole."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stippler.drawing.one_step import as_one_step
from stippler.drawing.parameter import Parameter, by_default
from stippler.editor.events import LEFT, Event, KeyDown, Pressed
from stippler.editor.line_edits import lines_of, set_line
from stippler.editor.tools.line_choice import line_at
from stippler.editor.tools.line_states import NEAR_PX, Freehand, Moving, Node, Penning
from stippler.editor.tools.tool import (
    NOTHING,
    RESTING,
    Desk,
    Overlay,
    Path,
    Sight,
    Tool,
    ToolState,
)

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.line import Line
    from stippler.drawing.planar.path import Path as LinePath

_MOST_OUTLINE = 400  # points of a chosen line that are drawn over the page

PEN, FREEHAND, MOVE = "pen", "freehand", "move"


class LineTool(Tool):
    """Draws lines, and moves them."""

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        drawing = ("how", (PEN, FREEHAND))
        return (
            by_default("how", "How", PEN, "Draw or move lines.", options=(PEN, FREEHAND, MOVE)),
            by_default("start_mm", "Width", 0.3, "Where it begins.", 0.0, 10.0, "mm", only=drawing),
            by_default("end_mm", "At its end", 0.3, "Another width tapers the line.", 0.0, 10.0,
                      "mm", only=drawing),
            by_default("printed", "In ink", True, "Else it is a guide that only dots see.",
                      only=drawing),
            by_default("meeting", "Dots", "ignore",
                      "Ignore the line, keep a distance from its edge, or adhere: those within "
                      "reach line up on it.", options=("ignore", "distance", "adhere"),
                      only=drawing),
            by_default("distance_mm", "Distance", 0.3, "Of dots from its edge.", 0.0, 10.0, "mm",
                      only=("meeting", ("distance",))),
            by_default("reach_mm", "Reach", 1.0, "From how far dots line up.", 0.0, 10.0, "mm",
                      only=("meeting", ("adhere",))),
        )  # fmt: skip

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Begin a line, or take hold of one."""
        if isinstance(event, KeyDown) and self.wants(event, desk):
            return self._deleted(desk)
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        at, how = desk.at(event), self.value("how")
        if how == MOVE:
            found = line_at(desk.document, at, desk.mm(NEAR_PX))
            desk.lines.choose(found, event.mods)
            return RESTING if found is None else Moving(found, at)
        if how == FREEHAND:
            return Freehand(self, [at])
        return Penning(self, [Node(at)], at, event.t_s, is_down=True)

    def wants(self, event: KeyDown, desk: Desk) -> bool:
        """Return whether Delete is for the chosen lines."""
        is_delete = event.key in ("delete", "backspace")
        no_dots = not len(desk.selection.ids)
        return is_delete and no_dots and bool(desk.lines.alive(desk.document))

    def _deleted(self, desk: Desk) -> ToolState:
        chosen = desk.lines.alive(desk.document)

        def act(document: Document) -> None:
            for k in chosen:
                set_line(document, k, None)

        as_one_step(desk.document, "Delete lines" if len(chosen) > 1 else "Delete line", act)
        return RESTING

    def line(self, path: LinePath, document: Document) -> Line:
        """Return a line as the parameters have it."""
        from stippler.drawing import records
        from stippler.drawing.line import Line

        return Line(
            f"line {document.drawing.first_free(records.LINE)}",
            path,
            (self.value("start_mm"), self.value("end_mm")),
            self.value("printed"),
            self.value("meeting"),
            self.value("distance_mm"),
            self.value("reach_mm"),
        )

    def overlay(self, sight: Sight) -> Overlay:
        """Return the axes of the chosen lines."""
        if sight.document is None or sight.is_held:
            return NOTHING
        return chosen_overlay(sight.document, sight.lines.alive(sight.document))


def chosen_overlay(document: Document, chosen: list[int]) -> Overlay:
    """Return the axes of lines."""
    paths = []
    for k in chosen:
        at = lines_of(document)[k].path.points_mm
        at = at[:: max(1, len(at) // _MOST_OUTLINE)]
        paths.append(Path(tuple((float(x), float(y)) for x, y in at), dashed=True))
    return Overlay(tuple(paths))
