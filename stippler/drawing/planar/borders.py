"""Finding borders: the nearest place, ways along them, places that lines enclose."""

from __future__ import annotations

import heapq
import itertools
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, MultiPolygon, Point, Polygon

from stippler.drawing.planar.overlay import grown, in_box, meets
from stippler.drawing.planar.path import UNIT_MM, Path, Points, to_grid
from stippler.drawing.planar.planar_map import PlanarMap, Segments
from stippler.drawing.planar.slivers import LEAST_WIDTH_MM
from stippler.errors import GeometryError

XY = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Snap:
    """A place on a border near a point.

    Attributes
    ----------
    at_mm : (x, y)
    arc : int
    vertex : int or None
        The node it is; None along a segment.
    along : float
        Vertices passed since the arc's begin.
    """

    at_mm: XY
    arc: int
    vertex: int | None
    along: float


def snap(areas: PlanarMap, point_mm: XY, within_mm: float) -> Snap | None:
    """Return the nearest node within a distance, or else the nearest place on a border."""
    x, y = float(point_mm[0]) / UNIT_MM, float(point_mm[1]) / UNIT_MM
    reach = within_mm / UNIT_MM
    node: tuple[float, int, int] | None = None
    side: tuple[float, int, int, float] | None = None
    for k, a in areas.arcs.items():
        b = a.box
        if b[0] > x + reach or b[2] < x - reach or b[1] > y + reach or b[3] < y - reach:
            continue
        at = a.path.vertices - (x, y)
        far = np.hypot(at[:, 0], at[:, 1])
        nodes = a.path.nodes()
        i = nodes[int(np.argmin(far[nodes]))]
        if far[i] <= reach and (node is None or far[i] < node[0]):
            node = (float(far[i]), k, i)
        d = np.diff(at, axis=0)
        t = np.clip(-(at[:-1] * d).sum(axis=1) / (d * d).sum(axis=1), 0.0, 1.0)
        off = np.hypot(*(at[:-1] + t[:, None] * d).T)
        j = int(np.argmin(off))
        if off[j] <= reach and (side is None or off[j] < side[0]):
            side = (float(off[j]), k, j, float(t[j]))
    if node is not None:
        _, k, i = node
        px, py = (areas.arcs[k].path.vertices[i] * UNIT_MM).tolist()
        return Snap((px, py), k, i, float(i))
    if side is None:
        return None
    _, k, j, t0 = side
    p = areas.arcs[k].path.vertices[j : j + 2] * UNIT_MM
    px, py = (p[0] + t0 * (p[1] - p[0])).tolist()
    return Snap((px, py), k, None, j + t0)


def welded(areas: PlanarMap, path: Path, within_mm: float = LEAST_WIDTH_MM) -> Path:
    """Return a path whose vertices lie on nodes and borders that are all but there already."""
    reach = within_mm / UNIT_MM
    box = grown(path.box(), int(reach) + 1)
    near = Segments.of([a for a in areas.arcs.values() if meets(a.box, box)]).xy
    near = near[in_box(near, box)]
    if not len(near):
        return path
    tree = shapely.STRtree(shapely.linestrings(near.reshape(-1, 2, 2).astype(np.float64)))
    at = path.vertices.copy()
    vertex, segment = tree.query_nearest(
        shapely.points(at.astype(np.float64)), max_distance=reach, all_matches=False
    )
    p, s = at[vertex].astype(np.float64), near[segment].astype(np.float64)
    d = s[:, 2:] - s[:, :2]
    t = np.clip(((p - s[:, :2]) * d).sum(axis=1) / (d * d).sum(axis=1), 0.0, 1.0)
    foot = s[:, :2] + t[:, None] * d
    for end in (s[:, :2], s[:, 2:]):
        close = np.hypot(*(p - end).T) <= reach
        foot[close] = end[close]
    at[vertex] = np.floor(foot + 0.5).astype(np.int64)
    if (np.diff(at, axis=0) == 0).all(axis=1).any():
        return path if path.curves else Path(_distinct(at))
    return Path(at, path.curves)


def _distinct(at: NDArray[np.int64]) -> NDArray[np.int64]:
    return np.ascontiguousarray(at[np.r_[True, (np.diff(at, axis=0) != 0).any(axis=1)]])


def trace(areas: PlanarMap, start: Snap, end: Snap) -> Points:
    """Return the shortest way along borders between two places on them, as (n, 2) mm.

    Raises
    ------
    GeometryError
        If no border leads from one to the other.
    """
    ways: dict[tuple[int, int], list[tuple[float, tuple[int, int], Points]]] = {}
    goal, begin = (-1, 1), (-1, 0)

    def link(p: tuple[int, int], q: tuple[int, int], at: Points) -> None:
        length = float(np.hypot(*np.diff(at, axis=0).T).sum())
        ways.setdefault(p, []).append((length, q, at))
        ways.setdefault(q, []).append((length, p, at[::-1]))

    for k, a in areas.arcs.items():
        at = a.path.points_mm
        stops: list[tuple[float, tuple[int, int], XY]] = [
            (0.0, a.start, tuple(at[0])),
            (float(len(at) - 1), a.end, tuple(at[-1])),
        ]
        for name, place in ((begin, start), (goal, end)):
            if place.arc == k:
                stops.append((place.along, name, place.at_mm))
        stops.sort(key=lambda s: s[0])
        for (u, p, here), (v, q, there) in itertools.pairwise(stops):
            between = at[int(np.floor(u)) + 1 : int(np.ceil(v))]
            link(p, q, np.vstack([here, between, there]))
    return _shortest(ways, begin, goal)


def _shortest(
    ways: dict[tuple[int, int], list[tuple[float, tuple[int, int], Points]]],
    begin: tuple[int, int],
    goal: tuple[int, int],
) -> Points:
    best = {begin: 0.0}
    came: dict[tuple[int, int], tuple[tuple[int, int], Points]] = {}
    queue = [(0.0, begin)]
    while queue:
        far, p = heapq.heappop(queue)
        if p == goal:
            parts: list[Points] = []
            while p != begin:
                p, at = came[p]
                parts.append(at)
            way = np.concatenate(parts[::-1])
            return np.asarray(way[np.r_[True, (np.diff(way, axis=0) != 0).any(axis=1)]])
        if far > best[p]:
            continue
        for length, q, at in ways.get(p, ()):
            if far + length < best.get(q, np.inf):
                best[q] = far + length
                came[q] = (p, at)
                heapq.heappush(queue, (far + length, q))
    raise GeometryError("do not hang together", "borders", "choose two places on one border")


def enclosed(
    areas: PlanarMap, point_mm: XY, gap_mm: float = 0.0, lines_mm: Sequence[Points] = ()
) -> list[Path]:
    """Return the outline of the place around a point that borders and lines enclose.

    Parameters
    ----------
    gap_mm : float
        Openings up to this width count as closed.
    lines_mm : sequence of (n, 2) float64
        Drawn lines that enclose as borders do.

    Raises
    ------
    GeometryError
        If the point is off the page, on a line, or nothing encloses it.
    """
    if not np.isfinite(point_mm).all() or gap_mm < 0:
        raise GeometryError("is no place", "fill", "click on the page")
    area = int(areas.area_at([point_mm])[0])
    if area < 0:
        raise GeometryError("lies off the page", "fill", "click on the page")
    parts = areas.parts(area)
    here = Point(point_mm)
    polygon = next((p.polygon for p in parts if p.polygon.intersects(here)), None)
    if polygon is None:  # pragma: no cover: where rounding puts it beside both
        raise GeometryError("lies on a border", "fill", "click beside it")
    open_part: Polygon | MultiPolygon = polygon
    walls = [LineString(line) for line in lines_mm if len(line) > 1]
    grown = 0.5 * gap_mm
    if walls:
        thickness = max(grown, 4 * UNIT_MM)
        open_part = polygon.difference(shapely.unary_union(walls).buffer(thickness))
    if grown:
        open_part = (
            open_part.buffer(-grown)
            if not walls
            else open_part.intersection(polygon.buffer(-grown))
        )
    piece = _piece_at(open_part, here)
    if grown or walls:
        piece = _grown_back(piece, polygon, walls, max(grown, 4 * UNIT_MM))
    return paths_of(piece)


def _piece_at(shape: Polygon | MultiPolygon, here: Point) -> Polygon:
    parts = list(shape.geoms) if hasattr(shape, "geoms") else [shape]
    parts = [p for p in parts if isinstance(p, Polygon) and not p.is_empty]
    holding = [p for p in parts if p.intersects(here)]
    if not holding and parts:
        holding = [min(parts, key=lambda p: p.distance(here))]
    if not holding:
        raise GeometryError("is narrower than the gap", "fill", "take a smaller gap")
    return holding[0]


def _grown_back(piece: Polygon, polygon: Polygon, walls: list[LineString], by: float) -> Polygon:
    """Return a place that was shrunk by half a gap at its full width, up to borders and lines."""
    wide = piece.buffer(by * 1.0001, join_style="mitre").intersection(polygon)
    if walls:
        cells = shapely.difference(wide, shapely.unary_union(walls).buffer(UNIT_MM))
        return _piece_at(cells, piece.representative_point())
    return _piece_at(wide, piece.representative_point())


def paths_of(shape: Polygon | MultiPolygon) -> list[Path]:
    """Return the rings of a shape as closed paths; holes turn the other way."""
    polygons = list(shape.geoms) if hasattr(shape, "geoms") else [shape]
    out = []
    for polygon in polygons:
        turned = shapely.geometry.polygon.orient(polygon)
        rings: Iterable[NDArray[np.float64]] = (
            shapely.get_coordinates(r) for r in (turned.exterior, *turned.interiors)
        )
        for ring in rings:
            at = _distinct(to_grid(ring))
            if len(at) >= 4:
                out.append(Path(at))
    return out
