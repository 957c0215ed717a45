"""What the node tool holds: nodes or a handle that follow the pointer, a box that chooses."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from stippler.editor.events import LEFT, Event, FocusLost, KeyDown, Moved, Released
from stippler.editor.messages import WARNING
from stippler.editor.tools.node_index import Grabbed
from stippler.editor.tools.node_source import Node, Trial
from stippler.editor.tools.tool import (
    RESTING,
    Desk,
    Handle,
    Overlay,
    Path,
    Point,
    ToolState,
)
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.drawing.planar.path import Path as Curves
    from stippler.editor.tools.node_tool import Held, NodeTool

_STILL_PX = 3.0
_SNAP_PX = 8.0


@dataclass(slots=True)
class Dragging:
    """The chosen nodes, or one handle, follow the pointer; the drawing changes at the release.

    Attributes
    ----------
    about : Node or None
        The node that was pressed, which snaps to others; a press on a piece has none.
    handle : Grabbed or None
    """

    tool: NodeTool
    held: Held
    start: Point
    start_px: Point
    about: Node | None = None
    handle: Grabbed | None = None
    is_dragged: bool = False
    trial: Trial | None = None
    to_mm: dict[Node, Point] = field(default_factory=dict)
    why_not: str = ""
    wanted: tuple[Path, ...] = ()

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer until the button comes up, or Escape lets all be."""
        match event:
            case Moved() | Released():
                away = math.dist((event.x_px, event.y_px), self.start_px)
                if self.is_dragged or away > _STILL_PX:
                    self.is_dragged = True
                    self._follow(desk.at(event), desk)
                if isinstance(event, Released) and event.button == LEFT:
                    return self._let_go(desk)
            case KeyDown(key="escape") | FocusLost():
                return RESTING
        return self

    def _follow(self, at: Point, desk: Desk) -> None:
        """Try what the pointer wants; what is refused is shown, and so is why at the release."""
        self.trial, self.why_not, self.wanted = None, "", ()
        try:
            self.trial = self._turn(at, desk) if self.handle else self._shift(at, desk)
        except GeometryError as error:
            self.why_not = str(error)

    def _shift(self, at: Point, desk: Desk) -> Trial:
        by = (at[0] - self.start[0], at[1] - self.start[1])
        nodes = self.held.nodes
        if self.about is not None and not desk.mods.alt:
            by = self._snapped(by, nodes, desk)
        self.to_mm = self.tool.moved(self.held, nodes, by)
        self._want(nodes)
        return self.held.source.move(desk.document, self.to_mm)

    def _snapped(self, by: Point, nodes: list[Node], desk: Desk) -> Point:
        """Return a shift that brings the pressed node onto another one that is near."""
        assert self.about is not None
        index = self.held.index
        x, y = index.place_mm(self.about)
        there = (x + by[0], y + by[1])
        near = index.node_at(there, desk.mm(_SNAP_PX))
        if near is None or index.owned(near) in {index.owned(node) for node in nodes}:
            return by
        px, py = index.place_mm(near)
        return px - x, py - y

    def _want(self, nodes: list[Node]) -> None:
        """Note the paths as they would be, for what is refused."""
        from stippler.drawing.planar.nodes import move_nodes

        by_path: dict[int, dict[int, Point]] = {}
        for k, i in nodes:
            by_path.setdefault(k, {})[i] = self.to_mm[k, i]
        paths = self.held.index.paths
        try:
            moved = {k: move_nodes(paths[k], to) for k, to in by_path.items()}
            self.wanted = shown(moved, refused=True)
        except GeometryError:
            self.wanted = ()

    def _turn(self, at: Point, desk: Desk) -> Trial:
        from stippler.drawing.planar.nodes import move_handle

        assert self.handle is not None
        (k, i), side = self.handle.node, self.handle.side
        path = move_handle(self.held.index.paths[k], i, side, at, free=desk.mods.alt)
        self.wanted = shown({k: path}, refused=True)
        return self.held.source.replace(desk.document, "Bend border", {k: path})

    def _let_go(self, desk: Desk) -> ToolState:
        if self.trial is not None:
            trial = self.trial
            self.tool.make(desk, self.held, lambda: trial, self.to_mm)
        elif self.why_not:
            desk.say(self.why_not, WARNING)
        elif self.about is not None and not desk.mods.shift:
            owned = self.held.index.owned(self.about)
            self.tool.choose_none()
            self.held.chosen = {owned}
        return RESTING

    @property
    def overlay(self) -> Overlay:
        """The paths as they would be; red where that is refused."""
        index = self.held.index
        if self.trial is None:
            handles = [Handle(index.place_mm(n), "node", chosen=True) for n in self.held.nodes]
            return Overlay(self.wanted, tuple(handles))
        handles = [Handle(at, "node", chosen=True) for at in self.to_mm.values()]
        return Overlay(shown(self.trial.paths), tuple(handles))

    def cancel(self, desk: Desk) -> None:
        """Nothing has been changed."""


@dataclass(slots=True)
class Boxing:
    """A box chooses the nodes in it; a click without a drag is the sources'."""

    tool: NodeTool
    start: Point
    start_px: Point
    corners: tuple[Point, ...] = ()

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer; choose when the button comes up."""
        match event:
            case Moved() | Released():
                (x0, y0), (x1, y1) = self.start_px, (event.x_px, event.y_px)
                if self.corners or math.dist((x0, y0), (x1, y1)) > _STILL_PX:
                    ends = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
                    self.corners = tuple(desk.page(*at) for at in ends)
                if isinstance(event, Released) and event.button == LEFT:
                    self._choose(desk)
                    return RESTING
            case KeyDown(key="escape") | FocusLost():
                return RESTING
        return self

    def _choose(self, desk: Desk) -> None:
        if not self.corners:
            self.tool.choose_none()
            for held in self.tool.held:
                held.source.click(desk, self.start)
            return
        x, y = zip(*self.corners, strict=True)
        self.tool.choose_box(desk, (min(x), min(y)), (max(x), max(y)))

    @property
    def overlay(self) -> Overlay:
        """The box."""
        if not self.corners:
            return Overlay()
        return Overlay((Path(self.corners, closed=True, dashed=True),))

    def cancel(self, desk: Desk) -> None:
        """Nothing has been chosen."""


def shown(paths: Mapping[int, Curves], *, refused: bool = False) -> tuple[Path, ...]:
    """Return paths as an overlay draws them."""
    return tuple(
        Path(tuple((x, y) for x, y in path.points_mm.tolist()), refused=refused)
        for path in paths.values()
    )
