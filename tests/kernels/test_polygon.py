"""Depths in polygons, against shapely."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.kernels.cells.polygon import find_depths


@given(n=st.integers(3, 30), seed=st.integers(0, 999))
@settings(max_examples=40, deadline=None)
def test_depths_are_distances_to_the_border_signed_by_the_inside(n, seed):
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * np.pi, n))
    corners = rng.uniform(0.2, 1.0, (n, 1)) * np.column_stack([np.cos(angle), np.sin(angle)])
    polygon = shapely.Polygon(corners)
    points = rng.uniform(-1.2, 1.2, (200, 2))
    found = np.empty(200)
    find_depths(points, corners, found)
    placed = shapely.points(points)
    distance = shapely.distance(polygon.exterior, placed)
    assert np.allclose(np.abs(found), distance, atol=1e-12)
    if polygon.is_valid:
        clear = distance > 1e-9
        assert np.array_equal(found[clear] > 0, shapely.contains(polygon, placed)[clear])


def test_corners_that_coincide_do_no_harm():
    corners = np.array([(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (1.0, 1.0)])
    found = np.empty(2)
    find_depths(np.array([(0.75, 0.25), (2.0, 0.0)]), corners, found)
    assert np.allclose(found, [0.25, -1.0])
