"""Dots in cusps of spiky polygons, beside crowds at the limit of rounding, left their polygon."""

import numpy as np
import pytest
import shapely
from shapely import affinity

from stippler.stippling.relax import DensityField, Relaxation


def spiky(rng):
    """A polygon with needles, holes or a second part, of any size and place."""
    m = rng.integers(3, 40)
    turn = np.sort(rng.random(m)) * 2 * np.pi
    away = rng.choice([1, 0.01, rng.random()], m)
    shape = shapely.Polygon(np.c_[away * np.cos(turn), away * np.sin(turn)]).buffer(0)
    if rng.random() < 0.5:
        hole = shapely.Point(rng.normal(0, 0.3, 2))
        wide = 0.1 * rng.random() + 0.001
        shape = shape.difference(hole.buffer(wide, quad_segs=int(rng.integers(1, 9))))
    if rng.random() < 0.3:
        shape = shapely.union(shape, affinity.translate(shapely.box(0, 0, 1, 1), 1.5, 0))
    if rng.random() < 0.2:
        shape = shapely.box(0, 0, 1, rng.choice([1, 1e-6, 1e3]))
    scale = 10.0 ** rng.integers(-6, 7)
    shape = affinity.scale(shape, scale, scale, origin=(0, 0))
    off = rng.choice([0, 1, 1e3]) * scale
    return affinity.translate(shape, off, off), scale


def dots_in(rng, shape, scale):
    """Dots anywhere, on corners and sides, and sometimes a crowd about one of them."""
    n = int(rng.choice([1, 2, 3, 10, 100, 1000]))
    x0, y0, x1, y1 = shape.bounds
    points = rng.random((n * 3, 2)) * (x1 - x0, y1 - y0) + (x0, y0)
    corners = shapely.get_coordinates(shape)
    some = corners[rng.integers(0, len(corners), n)]
    points = np.r_[points, some, (some + np.roll(some, 1, 0)) / 2]
    if rng.random() < 0.3:
        at = points[rng.integers(0, len(points))]
        near = at + rng.normal(0, 1e-7 * scale, (200, 2))
        nearest = at + rng.normal(0, 1e-14 * scale, (50, 2))
        points = np.r_[points, np.repeat(at[None], 30, 0), near, nearest]
    if rng.random() < 0.2:
        points = np.round(points / scale * 8) / 8 * scale
    return rng.permutation(points[shapely.intersects_xy(shape, *points.T)])


@pytest.mark.parametrize("seed", [1060, 20016, 20149, 20232, 20337, 20763])
def test_no_dot_leaves_its_polygon(seed):
    rng = np.random.default_rng(seed)
    shape, scale = spiky(rng)
    points = dots_in(rng, shape, scale)
    fixed = rng.random(len(points)) < rng.choice([0, 0.5, 1])
    field = None
    if rng.random() < 0.5:
        values = rng.random(tuple(rng.integers(1, 50, 2))) * (rng.random() < 0.8)
        values[values < 0.5] = 0
        field = DensityField.over_box(values, np.array(shape.bounds), len(points))
    over = float(rng.choice([1, 1.5, 0.5]))
    engine = Relaxation(points, shape, fixed, density=field, over_relaxation=over)
    for _ in range(int(rng.integers(1, 12))):
        engine.step()
        assert shapely.intersects_xy(shape, *engine.points.T).all()
