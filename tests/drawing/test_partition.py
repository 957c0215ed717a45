"""Areas of points against shapely, on lattices too, where points lie on edges and corners."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import MultiPolygon, Polygon, box

from stippler.drawing.partition import NOWHERE, Partition
from tests.conftest import EXAMPLES

LATTICE = st.tuples(st.integers(0, 8), st.integers(0, 8))
PLANE = st.tuples(st.floats(0, 8), st.floats(0, 8))


def ring(n):
    """A polygon around its middle, so that it does not cross itself."""

    def made(drawn):
        corners = np.unique(np.array(drawn, float), axis=0)
        middle = corners.mean(axis=0) + np.array([0.01, 0.003])
        turn = np.arctan2(*(corners - middle).T)
        return Polygon(corners[np.argsort(turn)])

    return st.lists(n, min_size=3, max_size=9, unique=True).map(made)


SHAPE = st.one_of(ring(LATTICE), ring(PLANE)).filter(lambda p: p.is_valid and p.area > 0.05)


@settings(max_examples=200 * EXAMPLES)
@given(st.lists(SHAPE, min_size=1, max_size=6), st.booleans(), st.data())
def test_the_uppermost_outline_that_holds_a_point_owns_it(shapes, on_a_page, data):
    if len(shapes) > 2 and data.draw(st.booleans()):  # holes, and several parts
        cut = shapely.difference(shapes[0], shapes[1])
        parts = [p for p in shapely.get_parts(cut) if isinstance(p, Polygon) and p.area > 1e-3]
        shapes[0] = MultiPolygon(parts) if parts else shapes[0]
    outlines = {3 * k + 1: shape for k, shape in enumerate(shapes)}
    if on_a_page:
        outlines = {0: box(0, 0, 8, 8), **outlines}
    grid = np.stack(np.meshgrid(np.arange(-1, 10), np.arange(-1, 10)), axis=-1).reshape(-1, 2)
    free = np.random.default_rng(data.draw(st.integers(0, 9))).uniform(-0.5, 8.5, (200, 2))
    corners = np.concatenate([shapely.get_coordinates(shape) for shape in shapes])
    points = np.concatenate([grid, free, corners]).astype(float)
    expected = np.full(len(points), NOWHERE)
    sure = np.ones(len(points), bool)
    for k, outline in outlines.items():
        expected[shapely.intersects_xy(outline, points)] = k
        with np.errstate(divide="ignore", invalid="ignore"):
            away = shapely.distance(outline.boundary, shapely.points(points))
        exact = bool((shapely.get_coordinates(outline) % 1 == 0).all())
        lattice = (points % 1 == 0).all(axis=1)
        is_corner = np.isin(points @ [1, 1j], shapely.get_coordinates(outline) @ [1, 1j])
        sure &= (away == 0) & is_corner | (away > 1e-9) | (lattice & exact)
    assert sure.sum() > 100
    partition = Partition(outlines)
    found = partition.area_at(points)
    assert np.array_equal(found[sure], expected[sure])
    for k in outlines:
        own = partition.part_of(k)
        with np.errstate(divide="ignore", invalid="ignore"):
            away = shapely.distance(own.boundary, shapely.points(points)) > 1e-6
        away &= sure
        assert np.array_equal(shapely.intersects_xy(own, points)[away], (found == k)[away])


def test_no_areas_and_one_box():
    points = np.array([(0.0, 0.0), (3.0, 3.0), (3.1, 1.0)])
    assert Partition({}).area_at(points).tolist() == [NOWHERE] * 3
    assert Partition({5: box(0, 0, 3, 3)}).area_at(points).tolist() == [5, 5, NOWHERE]


def test_moves_end_in_the_area_that_owns_the_dot():
    partition = Partition({0: box(0, 0, 10, 10), 1: box(4, 4, 6, 6)})
    old = np.array([(3.0, 5.0), (5.0, 5.0)])
    new = np.array([(5.0, 5.0), (9.0, 5.0)])
    ends = partition.confine(old, new, np.array([0, 1], np.int32))
    assert partition.area_at(ends).tolist() == [0, 1]
    assert 3.0 < ends[0, 0] < 4.0
    assert 5.0 < ends[1, 0] <= 6.0
