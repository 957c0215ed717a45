"""The nearest places on lines against shapely's."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import LineString

from stippler.stippling.borders import along_line
from stippler.stippling.near_lines import NearLines
from tests.conftest import EXAMPLES


@settings(max_examples=60 * EXAMPLES, deadline=None)
@given(st.integers(0, 10_000), st.floats(0.05, 40.0), st.floats(1e-3, 1e3))
def test_nearest_places_are_shapelys(seed, reach, unit):
    rng = np.random.default_rng(seed)
    lines = []
    for _ in range(int(rng.integers(1, 4))):
        at = np.cumsum(rng.normal(0, 5, (int(rng.integers(2, 9)), 2)), axis=0)
        closed = rng.random() < 0.4 and len(at) > 3
        lines.append(LineString((np.vstack([at, at[:1]]) if closed else at) * unit))
    points = rng.normal(0, 12, (80, 2)) * unit
    found = NearLines(lines, reach * unit).nearest(points)
    away = np.array([shapely.distance(line, shapely.points(points)) for line in lines])
    best = away.min(axis=0)
    near = best <= reach * unit
    np.testing.assert_array_equal(np.isfinite(found.away), near)
    np.testing.assert_array_equal(found.line >= 0, near)
    np.testing.assert_allclose(found.away[near], best[near], rtol=1e-9, atol=1e-9 * unit)
    for i in np.flatnonzero(near).tolist():
        line = lines[found.line[i]]
        assert shapely.distance(line, shapely.points(points[i])) <= best[i] * (1 + 1e-9) + 1e-9
        there = line.interpolate(found.along[i]).coords[0]
        np.testing.assert_allclose(found.feet[i], there, atol=1e-7 * unit)
        ahead = line.interpolate(min(found.along[i] + 1e-4 * unit, line.length)).coords[0]
        step = np.subtract(ahead, there)
        if np.hypot(*step) > 0.9e-4 * unit and np.hypot(*(points[i] - there)) > 1e-3 * unit:
            corner = shapely.distance(shapely.points(there), shapely.multipoints(line.coords))
            if corner > 1e-3 * unit:
                np.testing.assert_allclose(step / np.hypot(*step), found.direction[i], atol=1e-4)


def test_no_lines_are_near_nothing():
    found = NearLines([], 3.0).nearest(np.zeros((4, 2)))
    assert (found.line == -1).all()
    assert np.isinf(found.away).all()


@settings(max_examples=30 * EXAMPLES, deadline=None)
@given(st.integers(0, 10_000), st.integers(1, 60))
def test_places_along_a_line_are_shapelys(seed, n):
    rng = np.random.default_rng(seed)
    line = LineString(np.cumsum(rng.normal(0, 5, (int(rng.integers(2, 9)), 2)), axis=0))
    at = (np.arange(n) + 0.5) / n * line.length
    expected = shapely.get_coordinates(shapely.line_interpolate_point(line, at))
    np.testing.assert_allclose(along_line(line, n), expected, atol=1e-9)
