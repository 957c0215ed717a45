"""Shapes and dots that are hard on cells, and cells by shapely."""

import numpy as np
import shapely
from scipy.spatial import HalfspaceIntersection
from shapely.geometry import MultiPoint, Point, Polygon, box


def star_polygon(seed: int, corners: int) -> Polygon:
    """A concave polygon with radii drawn at random, and holes wherever they fit."""
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.random(corners)) * 2 * np.pi
    angle += np.arange(corners) * 1e-3
    radius = rng.uniform(0.25, 1.0, corners)
    polygon = Polygon(np.c_[radius * np.cos(angle), radius * np.sin(angle)])
    if not polygon.is_valid:
        polygon = Polygon(polygon.exterior).buffer(0)
        if polygon.geom_type != "Polygon":
            polygon = max(polygon.geoms, key=lambda p: p.area)
    for _ in range(rng.integers(0, 5)):
        hole = Point(rng.uniform(-0.6, 0.6, 2)).buffer(rng.uniform(0.02, 0.15), quad_segs=2)
        rest = polygon.difference(hole)
        if rest.geom_type == "Polygon" and rest.is_valid:
            polygon = rest
    return polygon


def comb(teeth: int) -> Polygon:
    """Fingers that nearly touch, on a thin spine: every cell reaches across the gaps."""
    ring = [(0.0, -0.05)]
    for i in range(teeth):
        ring += [(i, 1.0), (i + 0.98, 1.0), (i + 0.99, 0.0)]
    ring += [(teeth - 0.01, -0.05)]
    return Polygon(ring)


def spiked() -> Polygon:
    """A square with needles cut in from outside and a hole that all but touches the border."""
    polygon = box(0, 0, 1, 1)
    for x in (0.2, 0.5, 0.8):
        polygon = polygon.difference(Polygon([(x - 1e-6, 0), (x + 1e-6, 0), (x, 0.9)]))
    return polygon.difference(box(0.9, 0.3, 1 - 1e-9, 0.6))


def star(points: int = 24) -> Polygon:
    a = np.arange(2 * points) * np.pi / points
    r = np.where(np.arange(2 * points) % 2, 0.8, 3.0)
    return Polygon(np.c_[r * np.cos(a), r * np.sin(a)])


def gear(teeth: int = 14) -> Polygon:
    a = np.arange(4 * teeth) * np.pi / (2 * teeth)
    r = np.where(np.arange(4 * teeth) % 4 < 2, 2.0, 3.0)
    return Polygon(np.c_[r * np.cos(a), r * np.sin(a)]).difference(Point(0, 0).buffer(1.6))


def spiral(turns: float = 3.0, width: float = 0.5) -> Polygon:
    a = np.linspace(0, 2 * np.pi * turns, 90)
    inner, outer = 0.6 + a / (2 * np.pi), 0.6 + width + a / (2 * np.pi)
    out = np.c_[outer * np.cos(a), outer * np.sin(a)]
    back = np.c_[inner * np.cos(a), inner * np.sin(a)]
    return Polygon(np.vstack([out, back[::-1]]))


def points_in(polygon: Polygon, n: int, seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    x0, y0, x1, y1 = polygon.bounds
    shapely.prepare(polygon)
    found = np.empty((0, 2))
    n_tried = 4 * n + 64
    while len(found) < n:  # a narrow one takes many
        xy = rng.random((n_tried, 2)) * [x1 - x0, y1 - y0] + [x0, y0]
        found = np.vstack([found, xy[shapely.contains_xy(polygon, xy[:, 0], xy[:, 1])]])
        n_tried = min(2 * n_tried, 65_536)
    return found[:n]


def half_planes(points: np.ndarray, polygon: Polygon) -> list[Polygon]:
    """Voronoi cells by shapely, in the order of the points, reaching beyond the polygon."""
    x0, y0, x1, y1 = polygon.bounds
    reach = 4 * max(x1 - x0, y1 - y0)
    around = box(x0 - reach, y0 - reach, x1 + reach, y1 + reach)
    if len(points) == 1:
        return [around]
    cells = shapely.voronoi_polygons(MultiPoint(points), extend_to=around)
    tree = shapely.STRtree(cells.geoms)
    return [cells.geoms[tree.query(Point(p), predicate="intersects")[0]] for p in points]


def cell_by_qhull(point: np.ndarray, others: np.ndarray) -> Polygon:
    """One Voronoi cell, within 100 of its dot, as Qhull meets half-planes."""
    normal = np.vstack([others - point, np.vstack([np.eye(2), -np.eye(2)])])
    offset = np.r_[0.5 * ((others - point) ** 2).sum(axis=1), np.full(4, 100.0)]
    corners = HalfspaceIntersection(np.c_[normal, -offset], np.zeros(2)).intersections
    return MultiPoint(corners + point).convex_hull


def cut_one_by_one(points: np.ndarray, polygon: Polygon) -> list[Polygon]:
    """Voronoi cells by cutting a box with every bisector: slow, but sure where dots line up.

    (shapely 2.2's own diagram of dots on a circle is wrong: all cells come out whole.)
    """
    x0, y0, x1, y1 = polygon.bounds
    reach = 4 * max(x1 - x0, y1 - y0)
    cells = []
    for i, point in enumerate(points):
        ring = np.array([(x0 - reach, y0 - reach), (x1 + reach, y0 - reach),
                         (x1 + reach, y1 + reach), (x0 - reach, y1 + reach)]) - point  # fmt: skip
        for normal in np.delete(points, i, axis=0) - point:
            beyond = ring @ normal - 0.5 * normal @ normal
            after = np.roll(beyond, -1)
            kept = []
            for k in range(len(ring)):
                if beyond[k] <= 0:
                    kept.append(ring[k])
                if (beyond[k] <= 0) != (after[k] <= 0):
                    t = beyond[k] / (beyond[k] - after[k])
                    kept.append(ring[k] + t * (np.roll(ring, -1, axis=0)[k] - ring[k]))
            ring = np.array(kept)
        cells.append(Polygon(ring + point).convex_hull)  # drops what rounding folded
    return cells
