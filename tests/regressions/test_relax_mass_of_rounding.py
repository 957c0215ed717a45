"""A cell over white whose mass was rounding alone sent its dot out of the polygon."""

import numpy as np
import pytest
import shapely

from stippler.stippling.relax import DensityField, Relaxation


@pytest.mark.parametrize("seed", [866, 1104, 1258])
def test_a_dot_over_white_stays_in_its_polygon(seed):
    rng = np.random.default_rng(seed)
    turn = np.sort(rng.random(7)) * 2 * np.pi
    polygon = shapely.Polygon(10 + 0.01 * np.c_[np.cos(turn), np.sin(turn)])
    x0, y0, x1, y1 = polygon.bounds
    points = rng.random((3000, 2)) * (x1 - x0, y1 - y0) + (x0, y0)
    crowd = points[rng.integers(0, 3000)] + rng.normal(0, 1e-9, (200, 2))
    points = np.r_[points, crowd]
    points = points[shapely.intersects_xy(polygon, *points.T)]
    density = rng.random((26, 20))
    density[density < 0.5] = 0
    field = DensityField.over_box(density, np.array(polygon.bounds), len(points))
    engine = Relaxation(points, polygon, density=field, over_relaxation=1.5)
    for _ in range(3):
        engine.step()
        assert shapely.intersects_xy(polygon, *engine.points.T).all()
