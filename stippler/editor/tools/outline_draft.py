"""An outline or a line while it is drawn: corners with handles, ways along borders."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from stippler.editor.tools.tool import Desk, Point
from stippler.errors import GeometryError

if TYPE_CHECKING:
    from stippler.drawing.planar.borders import Snap
    from stippler.drawing.planar.path import Path

SNAP_PX = 8.0
_CURVED = 24  # steps of a curve in the preview


@dataclass(frozen=True, slots=True)
class Corner:
    """A corner that was set.

    Attributes
    ----------
    handle : (x, y) or None
        Out of it; the one into it is opposite. None is a corner without.
    snap : Snap or None
        The place of a border that it lies on.
    via : tuple of (x, y)
        The way along borders from the corner before, without both ends.
    """

    at: Point
    handle: Point | None = None
    snap: Snap | None = None
    via: tuple[Point, ...] = ()
    is_traced: bool = False

    @property
    def handle_in(self) -> Point | None:
        """The handle into it."""
        if self.handle is None:
            return None
        return 2 * self.at[0] - self.handle[0], 2 * self.at[1] - self.handle[1]


def snapped(desk: Desk, at: Point) -> tuple[Point, Snap | None]:
    """Return a point moved onto a node or border that is near; Alt keeps it where it is."""
    if desk.mods.alt or len(desk.document.drawing.areas) < 2:
        return _on_page_edge(desk, at), None
    from stippler.drawing.area_edits import current_map
    from stippler.drawing.planar.borders import snap

    found = snap(current_map(desk.document), at, desk.mm(SNAP_PX))
    return (at, None) if found is None else (found.at_mm, found)


def _on_page_edge(desk: Desk, at: Point) -> Point:
    """Return a point moved onto the page's edge, where that is near; Alt keeps it where it is."""
    if desk.mods.alt:
        return at
    page, reach = desk.document.drawing.page, desk.mm(SNAP_PX)
    x, y = at
    for edge in (0.0, page.width_mm):
        x = edge if abs(x - edge) <= reach else x
    for edge in (0.0, page.height_mm):
        y = edge if abs(y - edge) <= reach else y
    return x, y


def traced(desk: Desk, before: Corner, after: Corner) -> Corner:
    """Return a corner with the way along borders to it, where both lie on borders that meet."""
    from stippler.drawing.area_edits import current_map
    from stippler.drawing.planar.borders import trace

    if before.snap is None or after.snap is None:
        return after
    try:
        way = trace(current_map(desk.document), before.snap, after.snap)
    except GeometryError:
        return after
    return replace(after, via=tuple((x, y) for x, y in way[1:-1].tolist()), is_traced=True)


def pieces_between(before: Corner, after: Corner) -> list[list[Point]]:
    """Return what lies between two corners, as pieces of 2 or 4 control points."""
    if after.is_traced:
        way = [before.at, *after.via, after.at]
        return [[a, b] for a, b in itertools.pairwise(way)]
    if before.handle is None and after.handle is None:
        return [[before.at, after.at]]
    return [[before.at, before.handle or before.at, after.handle_in or after.at, after.at]]


def path_of(corners: Sequence[Corner], *, closed: bool) -> Path:
    """Return the path through corners."""
    from stippler.drawing.planar.path import path_of_cubics

    pieces: list[list[Point]] = []
    for before, after in itertools.pairwise(corners):
        pieces += pieces_between(before, after)
    if closed and len(corners) > 1:
        pieces += pieces_between(corners[-1], replace(corners[0], via=(), is_traced=False))
    return path_of_cubics(pieces, closed=closed)


def points_of(corners: Sequence[Corner], *, closed: bool = False) -> tuple[Point, ...]:
    """Return the path through corners as a line for the overlay."""
    import numpy as np

    from stippler.drawing.planar.path import on_cubic

    if len(corners) < 2:
        return tuple(c.at for c in corners)
    ring = [*corners, replace(corners[0], via=(), is_traced=False)] if closed else list(corners)
    out = [ring[0].at]
    for before, after in itertools.pairwise(ring):
        for piece in pieces_between(before, after):
            if len(piece) == 2:
                out.append(piece[1])
            else:
                t = np.linspace(0.0, 1.0, _CURVED + 1)[1:]
                out += [(x, y) for x, y in on_cubic(np.array(piece), t).tolist()]
    return tuple(out)


def freehand(points: Sequence[Point], smoothing_mm: float, *, closed: bool) -> Path:
    """Return the path of a freehand line: without its shaking, as smooth curves.

    Parameters
    ----------
    smoothing_mm : float
        How far the path may leave the line; 0 keeps every point.
    """
    import numpy as np
    import shapely

    from stippler.drawing.planar.moves import smooth_path
    from stippler.drawing.planar.path import Path

    at = np.array(points)
    if closed and len(at) > 2:
        at = np.vstack([at, at[:1]])
    if smoothing_mm <= 0.0 or len(at) < 3:
        return Path.polyline(at)
    line = shapely.simplify(shapely.linestrings(at), smoothing_mm, preserve_topology=False)
    kept = shapely.get_coordinates(line)
    if closed and len(kept) < 4:
        kept = at
    path = Path.polyline(kept)
    return smooth_path(path) if len(path) > 2 else path


def is_far(a: Point, b: Point, mm: float) -> bool:
    """Return whether two points are farther apart than a length."""
    return math.dist(a, b) > mm
