"""Areas that fill little of their own box: filling them took all memory, or hours."""

import numpy as np
import pytest
import shapely
from shapely.geometry import Point, Polygon, box

import stippler
from stippler.errors import GeometryError

SLIVER = Polygon([(0.0, 0.0), (100.0, 100.0), (100.0, 100.0001)])
RING = Point(0, 0).buffer(100).difference(Point(0, 0).buffer(99.99))


@pytest.mark.parametrize("arrangement", ["hexagonal", "random"])
@pytest.mark.parametrize("area", [SLIVER, RING], ids=["sliver", "ring"])
@pytest.mark.parametrize("n", [10, 1000])
def test_a_thin_area_is_filled(area, arrangement, n):
    points = stippler.fill(area, n, arrangement)
    assert abs(len(points) - n) <= 0.1 * n
    assert shapely.contains_xy(area, *points.T).all()
    assert len(np.unique(points, axis=0)) == len(points)


def test_boxes_of_a_thin_area_share_one_grid():
    """Two squares far apart are gridded by boxes; each dot has the neighbours of a whole grid."""
    squares = shapely.union(box(0, 0, 1, 1), box(99, 99, 100, 100))
    points = stippler.fill(squares, 400)
    gaps = np.sqrt(((points[:, None] - points[None]) ** 2).sum(axis=2))
    nearest = np.where(gaps == 0, np.inf, gaps).min(axis=1)
    assert np.ptp(nearest) < 1e-9
    assert 380 <= len(points) <= 420


def test_an_area_no_grid_fits_is_refused():
    with pytest.raises(GeometryError, match="area: is too narrow"):
        stippler.fill(box(0, 0, 100, 1e-6), 100)
    assert len(stippler.fill(box(0, 0, 100, 1e-6), 100, "random")) == 100
