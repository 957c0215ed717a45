"""What the line tool holds: a line by a pen, a freehand line, a line that is moved."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from stippler.editor.events import LEFT, Event, FocusLost, KeyDown, Moved, Pressed, Released
from stippler.editor.line_edits import add_line, lines_of, meet, set_line
from stippler.editor.messages import WARNING
from stippler.editor.tools.drag import Drag
from stippler.editor.tools.tool import (
    NOTHING,
    RESTING,
    Desk,
    Handle,
    Overlay,
    Path,
    Point,
    ToolState,
)

if TYPE_CHECKING:
    from stippler.drawing.line import Line
    from stippler.drawing.planar.path import Path as LinePath
    from stippler.editor.tools.line_tool import LineTool

NEAR_PX = 8.0
_STILL_PX = 3.0
_DOUBLE_S = 0.35
_SNAP_RAD = math.radians(15.0)
_FINE_PX = 1.5  # a freehand line is simplified by this


@dataclass(slots=True)
class Node:
    """A node that is being drawn; its handles mirror each other."""

    at: Point
    out: Point | None = None

    @property
    def triple(self) -> tuple[Point, Point, Point]:
        """Handle in, node, handle out."""
        if self.out is None:
            return self.at, self.at, self.at
        (x, y), (u, v) = self.at, self.out
        return (2 * x - u, 2 * y - v), self.at, self.out


@dataclass(slots=True)
class Penning:
    """Nodes are set one after the other; the line is there in ink meanwhile."""

    tool: LineTool
    nodes: list[Node]
    at: Point
    pressed_s: float
    is_down: bool = False
    closes: bool = False
    made: Making = field(init=False)

    def __post_init__(self) -> None:
        self.made = Making(self.tool)

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer; end at Enter, a double click, or the first node."""
        match event:
            case Moved():
                self._follow(desk.at(event), desk)
            case Pressed(button=button) if button == LEFT:
                return self._press(desk.at(event), event.t_s, desk)
            case Released(button=button) if button == LEFT:
                self.is_down = False
                if self.closes:
                    return self._end(desk)
            case KeyDown(key="enter" | "kp_enter"):
                return self._end(desk)
            case KeyDown(key="backspace" | "delete") | KeyDown(key="z"):
                return self._back(desk)
            case KeyDown(key="escape"):
                self.cancel(desk)
                return RESTING
        return self

    def _follow(self, at: Point, desk: Desk) -> None:
        last = self.nodes[0] if self.closes else self.nodes[-1]
        if self.is_down:
            if math.dist(at, last.at) > desk.mm(_STILL_PX):
                last.out = _snapped(last.at, at, desk)
                self._show(desk)
        else:
            self.at = _snapped(last.at, at, desk)

    def _press(self, at: Point, t_s: float, desk: Desk) -> ToolState:
        is_double = t_s - self.pressed_s < _DOUBLE_S
        self.pressed_s, self.is_down = t_s, True
        if is_double and math.dist(at, self.nodes[-1].at) < desk.mm(NEAR_PX):
            return self._end(desk)
        if len(self.nodes) > 1 and math.dist(at, self.nodes[0].at) < desk.mm(NEAR_PX):
            self.closes = True
        else:
            self.nodes.append(Node(_snapped(self.nodes[-1].at, at, desk)))
        self._show(desk)
        return self

    def _back(self, desk: Desk) -> ToolState:
        self.nodes.pop()
        if not self.nodes:
            self.cancel(desk)
            return RESTING
        self._show(desk)
        return self

    def _show(self, desk: Desk) -> None:
        from stippler.drawing.planar.path import path_of_cubics

        nodes = [*self.nodes, self.nodes[0]] if self.closes else self.nodes
        pieces: list[tuple[Point, ...]] = []
        for a, b in itertools.pairwise(nodes):
            if a.out is None and b.out is None:
                pieces.append((a.at, b.at))
            else:
                pieces.append((a.at, a.triple[2], b.triple[0], b.at))
        self.made.show(path_of_cubics(pieces) if pieces else None, desk)

    def _end(self, desk: Desk) -> ToolState:
        self.made.end(desk)
        return RESTING

    @property
    def overlay(self) -> Overlay:
        """The nodes, and the way to the pointer."""
        last = self.nodes[-1]
        handles = [Handle(node.at) for node in self.nodes]
        paths = [] if self.is_down else [Path((last.at, self.at), dashed=True)]
        if self.is_down and last.out is not None:
            before, _, after = last.triple
            handles += [Handle(before, "control"), Handle(after, "control")]
            paths.append(Path((before, after)))
        return Overlay(tuple(paths), tuple(handles))

    def cancel(self, desk: Desk) -> None:
        """Take it back."""
        self.made.cancel(desk)


class Making:
    """A line that is being drawn, in a stroke of the document once there is something to see."""

    def __init__(self, tool: LineTool) -> None:
        self._tool = tool
        self._id: int | None = None

    def show(self, path: LinePath | None, desk: Desk) -> None:
        """Show the line as it is now."""
        from stippler.errors import GeometryError

        if path is None or len(path) < 2:
            self.cancel(desk)
            return
        try:
            line = self._tool.line(path, desk.document)
        except GeometryError:
            return  # not yet a line
        if self._id is None:
            desk.document.begin("Draw line")
            self._id = add_line(desk.document, line)
        else:
            name = lines_of(desk.document)[self._id].name
            set_line(desk.document, self._id, replace(line, name=name))

    def end(self, desk: Desk) -> None:
        """Let dots meet it; it is a step of the history then."""
        if self._id is None:
            return
        meet(desk.document, self._id, desk.say)
        desk.document.commit()
        desk.lines.choose(self._id)
        self._id = None

    def cancel(self, desk: Desk) -> None:
        """Take it back."""
        if self._id is not None:
            desk.document.cancel()
            self._id = None


def _snapped(start: Point, at: Point, desk: Desk) -> Point:
    """Return a point in a direction of whole steps from another while Shift is held."""
    if not desk.mods.shift:
        return at
    length = math.dist(start, at)
    turn = round(math.atan2(at[1] - start[1], at[0] - start[0]) / _SNAP_RAD) * _SNAP_RAD
    return start[0] + length * math.cos(turn), start[1] + length * math.sin(turn)


@dataclass(slots=True)
class Freehand:
    """A line follows the pointer; it is smoothed when the button comes up."""

    tool: LineTool
    points: list[Point]
    made: Making = field(init=False)
    overlay = NOTHING

    def __post_init__(self) -> None:
        self.made = Making(self.tool)

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer until the button comes up."""
        from stippler.drawing.planar.path import Path as LinePath

        match event:
            case Moved():
                if (at := desk.at(event)) != self.points[-1]:
                    self.points.append(at)
                    self.made.show(LinePath.polyline(self.points), desk)
            case Released(button=button) if button == LEFT:
                self._smooth(desk)
                self.made.end(desk)
                return RESTING
            case KeyDown(key="escape"):
                self.cancel(desk)
                return RESTING
            case FocusLost():
                self.made.end(desk)
                return RESTING
        return self

    def _smooth(self, desk: Desk) -> None:
        import shapely

        from stippler.drawing.planar.moves import smooth_path
        from stippler.drawing.planar.path import Path as LinePath

        if len(self.points) < 3:
            return
        ends_at_start = math.dist(self.points[0], self.points[-1]) < desk.mm(NEAR_PX)
        closed = ends_at_start and len(self.points) > 8
        points = [*self.points[:-1], self.points[0]] if closed else self.points
        fine = shapely.simplify(shapely.linestrings(points), desk.mm(_FINE_PX))
        path = LinePath.polyline(shapely.get_coordinates(fine), closed=closed)
        if len(path) > (3 if closed else 2):
            path = smooth_path(path)
        self.made.show(path, desk)

    def cancel(self, desk: Desk) -> None:
        """Take it back."""
        self.made.cancel(desk)


@dataclass(slots=True)
class Moving(Drag):
    """A line follows the pointer, with the dots on it."""

    k: int
    start: Point
    before: Line | None = None
    overlay = NOTHING

    def _follow(self, at: Point, desk: Desk) -> None:
        from stippler.drawing.deformation import Deformation

        if self.before is None:
            line = lines_of(desk.document).get(self.k)
            if line is None or math.dist(at, self.start) < desk.mm(_STILL_PX):
                return
            if line.locked:
                desk.say(f"{line.name} is locked", WARNING)
                self.start = (math.inf, math.inf)
                return
            if not math.isfinite(self.start[0]):
                return
            desk.document.begin("Move line")
            self.before = line
        by = (1.0, 0.0, at[0] - self.start[0], 0.0, 1.0, at[1] - self.start[1], 0.0, 0.0, 1.0)
        set_line(desk.document, self.k, self.before.deformed(Deformation(by)))

    def _let_go(self, desk: Desk) -> ToolState:
        if self.before is not None:
            meet(desk.document, self.k, desk.say)
            desk.document.commit()
        return RESTING

    def cancel(self, desk: Desk) -> None:
        """Put it back."""
        if self.before is not None:
            desk.document.cancel()
