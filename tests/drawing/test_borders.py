"""Snapping, ways along borders and enclosed places, against shapely."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.random_areas import run
from stippler.drawing.planar import edits
from stippler.drawing.planar.borders import enclosed, snap, trace
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import PlanarMap
from stippler.errors import GeometryError
from tests.conftest import EXAMPLES


@pytest.fixture(scope="module")
def areas():
    return run(3, 40, check_every=40)[0]


def lines_of(areas):
    return shapely.unary_union([shapely.linestrings(a.path.points_mm) for a in areas.arcs.values()])


@given(x=st.floats(-2, 102), y=st.floats(-2, 82), within=st.floats(0.01, 8))
@settings(max_examples=30 * EXAMPLES, deadline=None)
def test_snap_finds_the_nearest_node_or_else_the_nearest_place(areas, x, y, within):
    found = snap(areas, (x, y), within)
    point = shapely.Point(x, y)
    nodes = np.concatenate([a.path.points_mm[a.path.nodes()] for a in areas.arcs.values()])
    to_node = np.hypot(*(nodes - (x, y)).T).min()
    to_line = point.distance(lines_of(areas))
    if to_line > within + 1e-9:
        assert found is None
        return
    if found is None:
        assert to_line == pytest.approx(within, abs=1e-6)
        return
    away = np.hypot(found.at_mm[0] - x, found.at_mm[1] - y)
    if found.vertex is not None:
        assert away == pytest.approx(to_node, abs=1e-9)
    else:
        assert to_node >= within - 1e-9
        assert away == pytest.approx(to_line, abs=1e-6)
    assert shapely.Point(found.at_mm).distance(lines_of(areas)) < 1e-6


@given(
    a=st.tuples(st.floats(0, 100), st.floats(0, 80)),
    b=st.tuples(st.floats(0, 100), st.floats(0, 80)),
)
@settings(max_examples=20 * EXAMPLES, deadline=None)
def test_a_traced_way_lies_on_borders_and_is_no_longer_than_back(areas, a, b):
    start, end = snap(areas, a, 200.0), snap(areas, b, 200.0)
    try:
        way = trace(areas, start, end)
    except GeometryError:
        assert areas.groups[start.arc] != areas.groups[end.arc]
        return
    if len(way) < 2:
        return
    line = shapely.linestrings(way)
    assert line.difference(lines_of(areas).buffer(1e-6)).length < 1e-9
    assert tuple(way[0]) == pytest.approx(start.at_mm)
    assert tuple(way[-1]) == pytest.approx(end.at_mm)
    assert shapely.linestrings(trace(areas, end, start)).length == pytest.approx(line.length)


def test_a_way_takes_the_short_side_of_a_ring():
    areas = PlanarMap.of_page(100, 80)
    areas = edits.add(
        areas, Path.polyline([(10, 10), (50, 10), (50, 40), (10, 40)], closed=True)
    ).map
    way = trace(areas, snap(areas, (20, 10), 1), snap(areas, (10, 20), 1))
    assert shapely.linestrings(way).length == pytest.approx(20)


@given(gap=st.floats(0.2, 3.0), closed=st.booleans())
@settings(max_examples=15 * EXAMPLES, deadline=None)
def test_gaps_up_to_a_width_are_closed_and_wider_ones_are_not(gap, closed):
    areas = PlanarMap.of_page(100, 80)
    width = gap * (0.8 if closed else 1.3)
    walls = [
        np.array([(20.0, 20.0), (60.0, 20.0), (60.0, 60.0), (20.0, 60.0), (20.0, 40.0 + width)]),
        np.array([(20.0, 20.0), (20.0, 40.0)]),
    ]
    place = shapely.Polygon(enclosed(areas, (40, 40), gap, walls)[0].points_mm)
    if closed:
        assert place.area == pytest.approx(1600, rel=0.03)
        assert place.within(shapely.box(20, 20, 60, 60).buffer(0.6 * gap))
    else:
        assert place.area > 3000


def test_places_that_are_none_are_refused():
    areas = PlanarMap.of_page(100, 80)
    with pytest.raises(GeometryError, match="off the page"):
        enclosed(areas, (120, 10))
    with pytest.raises(GeometryError, match="no place"):
        enclosed(areas, (np.nan, 10))
