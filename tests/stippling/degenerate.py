"""Random cases where bisectors run along walls and through corners, and what cells are there.

Dots lie on a lattice, on walls and in corners too; shapes are made of squares and half squares of
the same lattice, with holes that touch each other and the border, with slits and spikes.
"""

import math
import random

import numpy as np
import shapely
from shapely.geometry import Point, Polygon, box

_SHRUNK = 1e-9
"""What of a cell's rim the reference leaves off, so that what only touches is apart."""


def _squares(rng: random.Random, halves: bool) -> shapely.Geometry:
    nx, ny, share = rng.randint(2, 7), rng.randint(2, 7), rng.uniform(0.4, 0.95)
    parts = []
    for i in range(nx):
        for j in range(ny):
            if rng.random() > share:
                continue
            corners = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
            if halves and rng.random() < 0.4:
                corners.pop(rng.randrange(4))
            parts.append(Polygon(corners))
    return shapely.unary_union(parts)


def _with_slivers(rng: random.Random, shape: shapely.Geometry) -> shapely.Geometry:
    x0, y0, x1, y1 = (int(v) for v in shape.bounds)
    for _ in range(rng.randint(1, 3)):
        x, y, width = rng.randint(x0, x1), rng.randint(y0, y1), 2.0 ** -rng.randint(4, 20)
        length = rng.choice([1, 2, 3.5])
        needle = Polygon([(x - width, y), (x + width, y), (x, y + length)])
        if rng.random() < 0.5:
            needle = shapely.transform(needle, lambda xy: xy[:, ::-1])
        shape = shape.difference(needle) if rng.random() < 0.7 else shape.union(needle)
    return shape


def _lattice_polygon(rng: random.Random) -> shapely.Geometry:
    n = rng.randint(3, 12)
    angles = sorted(rng.uniform(0, 2 * math.pi) for _ in range(n))
    radii = [rng.uniform(1, 4.4) for _ in range(n)]
    ring = [
        (round(4 + r * math.cos(a)), round(4 + r * math.sin(a)))
        for a, r in zip(angles, radii, strict=True)
    ]
    polygon = Polygon(ring)
    return polygon if polygon.is_valid else polygon.buffer(0)


def shape_and_dots(seed: int) -> tuple[Polygon, np.ndarray]:
    """Make a case; there is none (no dots) for some seeds."""
    rng = random.Random(seed)
    kind = rng.choice(["squares", "halves", "slivers", "lattice", "thin"])
    if kind == "lattice":
        shape = _lattice_polygon(rng)
    else:
        shape = _squares(rng, halves=kind in ("halves", "slivers"))
        if kind == "slivers" and not shape.is_empty:
            shape = _with_slivers(rng, shape)
    shape = max(shapely.get_parts(shape), key=shapely.area, default=Polygon())
    if shape.geom_type != "Polygon" or shape.is_empty or not shape.is_valid:
        return box(0, 0, 1, 1), np.empty((0, 2))
    if rng.random() < 0.3:
        shape = shapely.normalize(shape)
    step = rng.choice([1.0, 0.5, 0.5, 0.25])
    x0, y0, x1, y1 = shape.bounds
    x, y = np.meshgrid(np.arange(x0, x1 + step, step), np.arange(y0, y1 + step, step))
    xy = np.c_[x.ravel(), y.ravel()]
    xy = xy[shapely.intersects_xy(shape, *xy.T)]
    if rng.random() < 0.5:
        xy = xy[shapely.contains_xy(shape, *xy.T)]
    keep = rng.sample(range(len(xy)), min(len(xy), rng.randint(1, 24)))
    xy = xy[keep]
    if kind == "thin":
        squeeze = np.array([1.0, 2.0 ** -rng.randint(2, 8)])
        shape = shapely.transform(shape, lambda at: at * squeeze)
        xy = xy * squeeze
    if rng.random() < 0.3:  # another scale and place, where sums still come out even
        scale, shift = 2.0 ** rng.randint(-6, 6), np.array([rng.randint(-64, 64), 3.0])
        shape = shapely.transform(shape, lambda at: (at + shift) * scale)
        xy = (xy + shift) * scale
    return shape, xy[shapely.intersects_xy(shape, *xy.T)]


def _cell(points: list[tuple[float, float]], i: int, reach: float, shrunk: float) -> Polygon:
    """Cut a box by all bisectors; shapely's own diagram is wrong for dots on a lattice."""
    x, y = points[i]
    ring = [(-reach, -reach), (reach, -reach), (reach, reach), (-reach, reach)]
    for k, (px, py) in enumerate(points):
        a, b = px - x, py - y
        if k == i or (a == 0.0 and b == 0.0):
            continue
        c = 0.5 * (a * a + b * b) - shrunk * math.hypot(a, b)
        beyond = [a * u + b * v - c for u, v in ring]
        kept = []
        for s, (u, v) in enumerate(ring):
            t = s + 1 if s + 1 < len(ring) else 0
            if beyond[s] <= 0.0:
                kept.append((u, v))
            if (beyond[s] <= 0.0) != (beyond[t] <= 0.0):
                r = beyond[s] / (beyond[s] - beyond[t])
                kept.append((u + r * (ring[t][0] - u), v + r * (ring[t][1] - v)))
        ring = kept
    return Polygon([(x + u, y + v) for u, v in ring])


def wrong_cells(
    shape: Polygon, xy: np.ndarray, area: np.ndarray, centroid: np.ndarray
) -> list[int]:
    """Return the dots whose area or centroid is not that of the piece the dot stands in.

    A dot in a corner where the inside meets itself may stand in either piece. Where necks are
    narrower than what the reference leaves off, the whole of the cell may be right instead.
    """
    points = [tuple(p) for p in xy.tolist()]
    x0, y0, x1, y1 = shape.bounds
    size = max(x1 - x0, y1 - y0)
    return [
        i
        for i in range(len(points))
        if not any(
            _is_piece(shape, points, i, size, shrunk, area[i], centroid[i])
            for shrunk in (_SHRUNK, 0.0)
        )
    ]


def _is_piece(
    shape: Polygon, points: list, i: int, size: float, shrunk: float, area: float,
    centroid: np.ndarray,
) -> bool:  # fmt: skip
    piece = _cell(points, i, 4 * size, shrunk * size).intersection(shape)
    parts = [g for g in shapely.get_parts(piece) if g.geom_type == "Polygon" and g.area > 0.0]
    slack, here = 1e-7 * size, Point(*points[i])
    for g in parts:
        off = math.hypot(g.centroid.x - centroid[0], g.centroid.y - centroid[1])
        is_near = g.distance(here) < 10 * _SHRUNK * size
        if is_near and abs(g.area - area) < slack * size and off * g.area < slack * size**2:
            return True
    return False
