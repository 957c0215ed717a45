"""Fills an enclosed place with an area; gaps up to a width count as closed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stippler.drawing.parameter import Parameter, by_default
from stippler.editor.events import LEFT, Event, Moved, Pressed
from stippler.editor.messages import INFO
from stippler.editor.tools.area_tool import ADD, CUT_OUT, NEW, make_area
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
    import shapely

    from stippler.drawing.document import Document
    from stippler.drawing.planar.path import Path as Curves

_WHOLE = 1e-3  # share of an area that may be missing where a place is all of it


class BucketTool(Tool):
    """Makes an area of the place under the pointer that borders and lines enclose."""

    commands = ("area.unite", "area.remove")
    shows_areas = True

    def __init__(self) -> None:
        super().__init__()
        self._known: tuple[object, shapely.Polygon, list[Curves]] | None = None

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """What a person can set."""
        return (
            by_default(
                "gap", "Gaps up to", 0.0, "Openings up to this width count as closed.",
                0.0, 50.0, "mm",
            ),
            by_default(
                "does", "Makes", NEW, "A new area, or adds to the chosen one.", options=(NEW, ADD)
            ),
        )  # fmt: skip

    def begin(self, event: Event, desk: Desk) -> ToolState | None:
        """Fill the place that is pressed."""
        if isinstance(event, Moved):
            return None
        if not (isinstance(event, Pressed) and event.button == LEFT):
            return None
        at = desk.at(event)
        paths = self.place(desk.document, at)
        if self.value("does") == ADD:
            make_area(desk, paths, ADD, "takes")
            return RESTING
        self._make(desk, at, paths)
        return RESTING

    def _make(self, desk: Desk, at: Point, paths: list[Curves]) -> None:
        from stippler.editor.area_choice import area_at

        k = area_at(desk.document, at)
        area = desk.document.drawing.areas.get(k) if k is not None else None
        polygon = self._known[1] if self._known else None
        if area is not None and k and polygon is not None:
            rest = area.outline_mm.area - polygon.area
            if rest < _WHOLE * area.outline_mm.area:
                desk.areas.choose((k,))
                desk.say(f"{area.name} fills this place already; it is chosen now", INFO)
                return
        desk.areas.choose(() if not k else (k,))
        outcome = make_area(desk, paths, CUT_OUT if k else NEW, "is-cut", "even-odd")
        desk.areas.choose(outcome.made)

    def place(self, document: Document, at: Point) -> list[Curves]:
        """Return the outline of the place around a point; kept while the point stays in it."""
        import shapely

        from stippler.drawing.area_edits import current_map
        from stippler.drawing.planar.borders import enclosed

        drawing = document.drawing
        areas, gap = current_map(document), float(self.value("gap"))
        key = (id(areas), gap, tuple(map(id, drawing.lines.values())))
        known = self._known
        if known is not None and known[0] == key and known[1].covers(shapely.Point(at)):
            return known[2]
        lines = [line.path.points_mm for line in drawing.lines.values()]  # type: ignore[attr-defined]
        paths = enclosed(areas, at, gap, lines)
        rings = [path.points_mm for path in paths]
        polygon = shapely.Polygon(rings[0], rings[1:])
        self._known = (key, polygon, paths)
        return paths

    def overlay(self, sight: Sight) -> Overlay:
        """Return the outline of the place under the pointer."""
        if sight.document is None or sight.at_mm is None:
            return NOTHING
        try:
            paths = self.place(sight.document, sight.at_mm)
        except GeometryError:
            return NOTHING
        lines = (tuple((x, y) for x, y in p.points_mm.tolist()) for p in paths)
        return Overlay(tuple(Path(line, closed=True) for line in lines))

    def forget(self) -> None:
        """Know no place."""
        self._known = None
