"""Dots beside walls: where they go, where they come to rest, and that none crosses a wall."""

import numpy as np
import pytest
import shapely
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from shapely.geometry import Point, Polygon, box

from stippler.stippling.relax import Relaxation
from stippler.stippling.tessellation import Tessellation
from tests.stippling.degenerate import shape_and_dots, wrong_cells
from tests.stippling.shapes import comb, gear, points_in, spiked, spiral, star

SETTINGS = settings(max_examples=30, deadline=None, suppress_health_check=list(HealthCheck))


SHAPES = {"star": star(), "gear": gear(), "spiral": spiral(), "comb": comb(5), "spiked": spiked()}


def stuck(engine: Relaxation) -> list[int]:
    """Dots nearer to a wall than a tenth of the spacing that do not belong there.

    A dot belongs where its centroid is or, if that lies outside its piece, at the piece's nearest
    point to it.
    """
    cells = engine.tessellation()
    walls = shapely.MultiLineString(cells.compartments.edges.reshape(-1, 2, 2).tolist())
    points = shapely.points(cells.position)
    shapely.prepare(walls)
    out = []
    for i in np.flatnonzero(shapely.distance(walls, points) < 0.1 * np.sqrt(cells.area)):
        piece, centroid = cells.polygon(i), Point(cells.centroid[i])
        nearest = shapely.get_coordinates(shapely.shortest_line(piece, centroid))[0]
        if np.hypot(*(nearest - cells.position[i])) > 0.15 * np.sqrt(cells.area[i]):
            out.append(int(i))
    return out


@pytest.mark.parametrize("name", SHAPES)
def test_no_dot_is_stuck_on_a_wall(name):
    polygon = SHAPES[name]
    for n in (3, 40, 900):
        engine = Relaxation(points_in(polygon, n, n), polygon)
        engine.run(120)
        assert stuck(engine) == [], n


@SETTINGS
@given(seed=st.integers(0, 10**6), n=st.integers(1, 60), name=st.sampled_from(sorted(SHAPES)))
def test_a_step_stays_in_the_piece_and_nears_its_least_moment(seed, n, name):
    polygon = SHAPES[name]
    engine = Relaxation(points_in(polygon, n, seed), polygon)
    for _ in range(4):
        cells = engine.tessellation()
        energy, whole = engine.energy(), cells.area.sum() > polygon.area * (1 - 1e-9)
        engine.step()
        moved = engine.points
        for i in range(n):
            piece, centroid = cells.polygon(i), cells.centroid[i]
            assert piece.buffer(1e-9).contains(Point(moved[i]))
            before = np.hypot(*(cells.position[i] - centroid))
            after = np.hypot(*(moved[i] - centroid))
            assert after <= before + 1e-9
            if piece.buffer(-1e-6).contains(Point(centroid)):
                assert after < 1e-9
        if whole:
            assert engine.energy() <= energy * (1 + 1e-12)


def test_a_centroid_round_a_corner_is_reached():
    shape = Polygon([(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)])
    engine = Relaxation([[3.9, 0.5], [0.5, 3.9]], shape)
    for place in ([0.6, 3.9], [0.1, 0.1]):
        one = Relaxation([place], shape)
        centroid = one.centroids()[0]
        assert not shape.contains(Point(centroid))
        one.run(40)
        rest = np.hypot(*(one.points[0] - centroid))
        assert rest == pytest.approx(shape.distance(Point(centroid)) + 0.1 * np.sqrt(7), rel=0.3)
    engine.run(50)
    assert stuck(engine) == []


def test_a_wall_along_a_bisector_or_through_its_corner():
    shape = Polygon([(0, 0), (20, 0), (20, 10), (10, 10), (10, 20), (0, 20)])
    dots = [[11.25, 3.75], [16.25, 8.75], [8.75, 3.75], [18.75, 3.75]]
    engine = Relaxation(dots, shape, fixed=[False, True, True, True])
    np.testing.assert_allclose(engine.cell_areas(), [37.5, 31.25, 500 / 3, 31.25], rtol=1e-9)
    engine.run(100)
    assert np.hypot(*(engine.points[0] - dots[0])) > 0.5


def test_holes_that_touch_each_other_and_the_border():
    shape = box(0, 0, 100, 100)
    for hole in (box(20, 40, 50, 70), box(50, 10, 80, 40), box(0, 70, 20, 90)):
        shape = shape.difference(hole)
    assert shape.is_valid
    engine = Relaxation(points_in(shape, 300, 1), shape)
    engine.run(30)
    cells = engine.tessellation()
    assert wrong_cells(shape, cells.position, cells.area, cells.centroid) == []
    assert stuck(engine) == []


@pytest.mark.parametrize("first", range(0, 2000, 100))
def test_degenerate_cells_are_shapelys(first):
    """A short run; ``python -m tests.long.degenerate_cells`` judges a million cells."""
    for seed in range(first, first + 100):
        shape, xy = shape_and_dots(seed)
        if len(xy):
            cells = Tessellation.of(xy, shape)
            assert wrong_cells(shape, xy, cells.area, cells.centroid) == [], seed


@pytest.mark.parametrize("seed", [5064412, 5095832])
def test_cells_go_through_necks_narrower_than_the_reference_sees(seed):
    shape, xy = shape_and_dots(seed)
    cells = Tessellation.of(xy, shape)
    assert wrong_cells(shape, xy, cells.area, cells.centroid) == []
    assert wrong_cells(shape, xy, 1.001 * cells.area, cells.centroid) != []
