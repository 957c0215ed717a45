import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import MultiPoint, Point, Polygon, box

from stippler.analysis.tone_error import draw_ink
from stippler.kernels.tone.pixel_owner import onto_ink, sample
from stippler.kernels.tone.radii import fit_radii
from stippler.stippling.density import DensityField
from stippler.stippling.radii import Sizes
from stippler.stippling.tessellation import Tessellation
from stippler.stippling.tone import DotRule


def frozen(field):
    field = np.array(field, np.float32)
    field.flags.writeable = False
    return field


def cells_of(points, darkness):
    h, w = darkness.shape
    page = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)]
    return Tessellation.of(points, page, None, DensityField(darkness, 1.0))


def voronoi(points, w, h):
    """The cells as shapely sees them, in the order of the points."""
    parts = shapely.get_parts(
        shapely.voronoi_polygons(MultiPoint(points), extend_to=box(-9 * w, -9 * h, 10 * w, 10 * h))
    )
    tree = shapely.STRtree(parts)
    which = tree.query(shapely.points(points), predicate="within")
    found = np.empty(len(points), object)
    found[which[0]] = parts[which[1]]
    return [cell.intersection(box(0, 0, w, h)) for cell in found]


@settings(max_examples=25)
@given(st.integers(0, 10**6), st.integers(1, 60), st.sampled_from(["even", "clusters", "line"]))
def test_cells_and_their_ink_agree_with_shapely(seed, n, kind):
    rng = np.random.default_rng(seed)
    w, h = 31, 23
    points = rng.random((n, 2)) * (w, h)
    if kind == "clusters":
        points = np.clip(rng.choice(points[:3], n) + rng.normal(0, 0.4, (n, 2)), 0.01, h - 0.01)
    elif kind == "line":
        points[:, 1] = 11.3
    points = np.unique(points, axis=0)
    darkness = frozen(rng.random((h, w)) * (rng.random((h, w)) < 0.7))
    cells = cells_of(points, darkness)
    expected = voronoi(points, w, h)
    for i in range(len(points)):
        found = cells.polygon(i)
        assert found.area == pytest.approx(expected[i].area, rel=1e-9, abs=1e-9)
        assert cells.area[i] == pytest.approx(expected[i].area, rel=1e-9, abs=1e-9)
        assert found.symmetric_difference(expected[i]).area < 1e-8
        asked = 0.0
        x0, y0, x1, y1 = (int(v) for v in expected[i].bounds)
        for y in range(y0, min(y1 + 1, h)):
            for x in range(x0, min(x1 + 1, w)):
                if darkness[y, x] > 0:
                    asked += darkness[y, x] * expected[i].intersection(box(x, y, x + 1, y + 1)).area
        assert cells.mass[i] == pytest.approx(asked, rel=1e-6, abs=1e-6)


@given(
    st.lists(st.floats(0, 2 * math.pi), min_size=3, max_size=9, unique=True),
    st.floats(0.2, 2.0),
    st.floats(0.05, 3.0),
)
def test_a_radius_gives_the_ink_asked_for(angles, size, share):
    angles = np.sort(angles)
    if np.diff(angles, append=angles[0] + 2 * math.pi).max() > 3.0:  # the dot has to be inside
        return
    corners = np.column_stack((np.cos(angles), np.sin(angles))) * size
    cell = Polygon(corners)
    if cell.area < 1e-3:
        return
    first, following = np.array([0, len(corners)], np.int32), np.roll(np.arange(len(corners)), -1)
    cells = first, corners, following.astype(np.int32)
    asked = np.array([min(share, 0.999) * cell.area])
    radius, left = np.empty(1), np.empty(1)
    before = np.full(1, -1.0)
    fit_radii(0, 1, *cells, asked, before, 1e-3, 10.0, radius, left)
    ink = Point(0, 0).buffer(radius[0], quad_segs=256).intersection(cell).area
    assert ink == pytest.approx(asked[0], rel=2e-4, abs=1e-5)
    assert abs(left[0]) <= 1e-5
    low, high = 0.9 * radius[0], 0.95 * radius[0]
    fit_radii(0, 1, *cells, asked, before, low, high, radius, left)
    assert radius[0] == high
    assert left[0] > 0
    fit_radii(0, 1, *cells, asked, before, 1.1 * high, 1.2 * high, radius, left)
    assert radius[0] == pytest.approx(1.1 * high)
    assert left[0] < 0


@settings(max_examples=15)
@given(st.integers(0, 10**6), st.floats(0.3, 1.4))
def test_the_union_of_equal_discs_is_the_sum_over_their_cells(seed, r):
    rng = np.random.default_rng(seed)
    w = h = 16
    points = rng.random((60, 2)) * (w, h)
    cells = Sizes(cells_of(points, frozen(np.ones((h, w)))), DotRule(r, r))
    cells.fit(r, r)
    union = shapely.union_all(shapely.buffer(shapely.points(points), r, quad_segs=64))
    true = union.intersection(box(0, 0, w, h)).area
    assert (cells.asked - cells.left).sum() == pytest.approx(true, rel=1e-3)


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.floats(0.5, 1.5), st.floats(1.0, 2.0))
def test_passing_ink_on_loses_none_and_helps(seed, low, ratio):
    rng = np.random.default_rng(seed)
    darkness = frozen(rng.random((20, 20)))
    cells = Sizes(cells_of(rng.random((60, 2)) * 20, darkness), DotRule(low, low * ratio))
    cells.fit(low, low * ratio)
    asked, missed = cells.asked.sum(), np.abs(cells.left).sum()
    cells.pass_on(low, low * ratio)
    assert cells.asked.sum() == pytest.approx(asked, rel=1e-6)
    cells.fit(low, low * ratio)
    assert np.abs(cells.left).sum() <= missed * (1 + 1e-6) + 1e-6


@given(st.integers(0, 10**6), st.sampled_from([0.5, 0.95, 1.0]))
def test_dots_on_white_move_to_the_nearest_ink(seed, white):
    rng = np.random.default_rng(seed)
    field = frozen(rng.random((17, 23)) * (rng.random((17, 23)) >= white))
    points = rng.random((20, 2)) * (23, 17)
    before, moved = points.copy(), np.empty(20, np.uint8)
    onto_ink(0, 20, points, field, 40, moved)
    y, x = np.nonzero(field)
    for i in range(20):
        if field[int(before[i, 1]), int(before[i, 0])] > 0:
            assert moved[i] == 0
            assert np.array_equal(points[i], before[i])
        elif not len(x):
            assert moved[i] == 2
        else:
            dx = np.maximum(np.maximum(x - before[i, 0], before[i, 0] - x - 1), 0)
            dy = np.maximum(np.maximum(y - before[i, 1], before[i, 1] - y - 1), 0)
            assert moved[i] == 1
            assert field[int(points[i, 1]), int(points[i, 0])] > 0
            assert np.hypot(*(points[i] - before[i])) <= np.hypot(dx, dy).min() + 0.03
    values = np.empty(20, np.float32)
    sample(0, 20, points, field, values)
    assert np.array_equal(values, field[points[:, 1].astype(int), points[:, 0].astype(int)])


def test_ink_is_the_union_of_discs():
    rng = np.random.default_rng(4)
    points, radii = rng.random((40, 2)) * (30, 20), rng.uniform(0.3, 2.5, 40)
    union = shapely.union_all(shapely.buffer(shapely.points(points), radii, quad_segs=64))
    ink = draw_ink(points, radii, (20, 30), zoom=16)
    for y in range(20):
        for x in range(30):
            true = union.intersection(box(x, y, x + 1, y + 1)).area
            assert ink[y, x] == pytest.approx(true, abs=0.04)
