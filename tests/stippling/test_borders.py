"""Bleed, wall and through: borders of areas, arc by arc."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter1d
from scipy.spatial import KDTree
from shapely.geometry import LineString, Point, Polygon, box

from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import OUTSIDE, PlanarMap
from stippler.drawing.reference import Reference
from stippler.errors import ParameterError
from stippler.stippling.borders import BLEED, THROUGH, WALL, Borders
from stippler.stippling.density import DensityField
from stippler.stippling.picture_field import PictureField
from stippler.stippling.tessellation import Tessellation
from stippler.stippling.window import Window
from tests.conftest import EXAMPLES


def ring(polygon):
    return shapely.get_coordinates(polygon.exterior)


def test_the_edge_of_the_page_bleeds_and_other_borders_are_walls():
    page = PlanarMap.of_page(40.0, 30.0)
    corner = Path.polyline([(-5, -5), (12, -5), (12, 10), (-5, 10)], closed=True)
    areas = edits.add(page, corner, edits.IS_CUT).map
    k = next(a for a in areas.areas if a != 0)
    borders = Borders.of_area(areas, k)
    assert borders.grown(3.0).symmetric_difference(box(-3, -3, 12, 10)).area < 1.0  # its ends flat
    assert borders.grown(3.0).covers(box(-2.9, -2.9, 0, 0))
    seen = Borders.of_area(
        areas, k, lambda _, arc: WALL if OUTSIDE in (arc.left, arc.right) else THROUGH
    )
    grown = seen.grown(2.0)
    assert grown.covers(box(12, 0, 13.9, 11.9))
    assert not grown.intersects(box(-2, 0, -0.1, 10))
    assert Borders.of_area(areas, k, lambda *_: WALL).grown(3.0).equals(borders.outline)
    with pytest.raises(ParameterError, match="'fence' is unknown"):
        Borders.of_area(areas, k, lambda *_: "fence")


@pytest.mark.parametrize("clockwise", [False, True])
def test_closed_borders_grow_outwards_and_holes_inwards(clockwise):
    outer, hole = ring(Point(0, 0).buffer(10)), ring(Point(0, 0).buffer(4))
    if clockwise:
        outer, hole = outer[::-1], hole[::-1]
    area = Polygon(outer, [hole])
    out = Borders.of(area, [(outer, BLEED)]).grown(2.0)
    assert out.area == pytest.approx(np.pi * (12**2 - 4**2), rel=0.01)
    inwards = Borders.of(area, [(hole, THROUGH)]).grown(1.0)
    assert inwards.area == pytest.approx(np.pi * (10**2 - 3**2), rel=0.01)


def test_arcs_join_whatever_way_they_run():
    area = box(0, 0, 10, 10)
    sides = [(np.array([(0, 0), (10, 0)]), BLEED), (np.array([(10, 10), (10, 0)]), BLEED)]
    for arcs in (sides, sides[::-1]):
        grown = Borders.of(area, arcs).grown(2.0)
        assert grown.equals(box(0, -2, 12, 10))


@settings(max_examples=20 * EXAMPLES, deadline=None)
@given(st.integers(0, 10_000), st.integers(0, 250))
def test_trimmed_dots_are_the_areas_own(seed, n_wanted):
    rng = np.random.default_rng(seed)
    turn = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    reach = rng.uniform(4, 9, 12)
    area = Polygon(np.column_stack([np.cos(turn), np.sin(turn)]) * reach[:, None])
    arcs = [(ring(area)[:7], BLEED), (ring(area)[6:], WALL)]
    borders = Borders.of(area, arcs)
    dots = rng.uniform(-10, 10, (300, 2))
    kept, places = borders.trimmed(dots, np.full(300, 1.0), n_wanted)
    assert shapely.intersects_xy(area, *places.T).all()
    inside = shapely.intersects_xy(area, *dots.T)
    assert set(np.flatnonzero(inside)) <= set(kept)
    drawn = ~inside[kept]
    assert (shapely.distance(LineString(arcs[0][0]), shapely.points(places[drawn])) < 1e-3).all()
    assert (np.hypot(*(places - dots[kept])[drawn].T) <= 2.0 + 1e-9).all()
    near = shapely.distance(LineString(arcs[0][0]), shapely.points(dots[~inside])) <= 2.0
    assert len(kept) == min(max(n_wanted, inside.sum()), inside.sum() + near.sum())


R = np.sqrt(0.4 * 0.81 / np.pi)
"""Of dots 0.9 mm apart that lay down a darkness of 0.4."""


@pytest.mark.parametrize("is_closed", [False, True])
def test_ink_along_any_line_meets_the_tone(is_closed):
    line, within = np.array([(1.0, 2.0), (55.0, 24.0)]), LineString([(0.96, 2.03), (54.98, 24.04)])
    area = Polygon([*line, (55, 60), (1, 60)])
    if is_closed:
        area, within = Point(30, 14).buffer(11, 64), Point(30, 14).buffer(11 - 0.1 * R, 64).exterior
        line = ring(area)
    borders = Borders.of(area, [(line, BLEED)])
    rng = np.random.default_rng(1)
    grid = np.stack(np.meshgrid(np.arange(-2, 60, 0.9), np.arange(-12, 60, 0.9)), -1).reshape(-1, 2)
    dots = grid + rng.normal(0, 0.15, grid.shape)
    kept, places = borders.trimmed(dots, np.full(len(dots), R))
    radius = np.full(len(kept), R)
    curve = borders.bleeding[0]

    def error(at):
        """Return how far the ink is off 0.4 just inside the line, seen from two spacings."""
        xy = shapely.get_coordinates(shapely.line_interpolate_point(within, np.arange(0, 50, 0.05)))
        far = KDTree(at).query(xy)[0]
        mode = "wrap" if is_closed else "nearest"
        return np.sqrt(np.mean(np.square(gaussian_filter1d((far < R) - 0.4, 36, mode=mode))))

    before = error(places)
    for give in (0.6, 0.3, 0.2):
        after = borders.rim_evened(places, radius, lambda p: np.full(len(p), 0.4), give)
        moved = np.hypot(*(after - places).T)
        assert moved.max() <= give * R + 1e-6
        assert shapely.intersects_xy(area, *after.T).all()
        assert (moved[shapely.distance(curve, shapely.points(places)) > 2.0] == 0.0).all()
        places = after
    assert error(places) < (0.7 if is_closed else 0.6) * before


def test_walls_move_nobody():
    borders = Borders.of(box(0, 0, 10, 10), [])
    dots = np.random.default_rng(1).random((50, 2)) * 10
    after = borders.rim_evened(dots, np.full(50, 0.5), lambda p: np.full(len(p), 0.4), 0.6)
    assert (after == dots).all()


def test_a_picture_goes_on_mirrored_beyond_its_page():
    values = np.random.default_rng(2).random((30, 40)).astype(np.float32)
    reference = Reference(values, 20.0)
    pad = np.pad(values, 8, mode="symmetric")
    area = box(-3.3, -2.1, 9.0, 17.2)
    dots = np.random.default_rng(3).random((200, 2)) * (12.3, 19.3) + (-3.3, -2.1)
    cells = Tessellation.of(dots, area, None, PictureField.of(reference, bleed_mm=4.0))
    expected = Tessellation.of(dots, area, None, DensityField(pad, 0.5, (-4.0, -4.0)))
    np.testing.assert_allclose(cells.mass, expected.mass, atol=2e-5)
    window = Window.of(reference, area.bounds, 10_000, bleed_mm=4.0)
    assert window.origin_mm == pytest.approx((-3.5, -2.5))
    x, y = 1, 3  # of the mirrored picture's pixels
    np.testing.assert_allclose(window.darkness, pad[y:-3, x : x + 25], atol=1e-5)
