import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree

from stippler.kernels.cells.close_pairs import find_close
from stippler.kernels.tone.radii import compare_sizes, even_sizes
from stippler.stippling.density import DensityField
from stippler.stippling.postprocess import sorted_by_place
from stippler.stippling.radii import Sizes
from stippler.stippling.tessellation import Tessellation
from stippler.stippling.tone import DotRule


def ask(points, share, enough, size=100):
    points = np.ascontiguousarray(points, float)
    n = len(points)
    field = np.ones((size, size), np.float32)
    order, cell_start, frame = sorted_by_place(points, field)
    xy = points[order]
    nearest, lack, awake = np.empty(n, np.int32), np.empty(n), np.ones(n, bool)
    find_close(0, n, xy, cell_start, frame, share, np.full(n, enough), awake, nearest, lack)
    return xy, nearest, lack


@settings(max_examples=40)
@given(st.integers(0, 10**6), st.integers(8, 400), st.booleans())
def test_the_nearest_and_what_lacks_are_those_of_a_tree(seed, n, clustered):
    rng = np.random.default_rng(seed)
    points = rng.random((n, 2)) * 100
    if clustered:
        points[: n // 2] = points[0] * 0.98 + rng.random((n // 2, 2))
    xy, nearest, lack = ask(points, 0.5, 8.0)
    distance, which = KDTree(xy).query(xy, k=8)
    assert np.array_equal(nearest, which[:, 1])
    wanted = np.minimum(0.5 * distance[:, 7], 8.0)
    assert lack == pytest.approx(np.maximum(wanted - distance[:, 1], 0.0), abs=1e-9)


def test_with_fewer_than_seven_neighbours_nothing_lacks():
    _, _, lack = ask(np.array([[1.0, 1.0], [1.5, 1.0], [90.0, 90.0]]), 0.5, 50.0)
    assert (lack == 0).all()


def test_sizes_even_out_and_no_ink_is_lost():
    rng = np.random.default_rng(4)
    points = rng.random((600, 2)) * 100
    page = [(0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0)]
    field = DensityField(np.full((100, 100), 0.4, np.float32), 1.0)
    cells = Sizes(Tessellation.of(points, page, None, field), DotRule(0.1, 10.0))
    before = cells.asked.copy()
    cells.fit(0.1, 10.0)
    noise = np.log(cells.radii).std()
    cells.even_sizes()
    assert cells.asked.sum() == pytest.approx(before.sum(), rel=1e-3)
    cells.fit(0.1, 10.0)
    assert np.log(cells.radii).std() < 0.9 * noise


def test_no_ink_goes_across_an_edge():
    first, beyond = np.array([0, 4, 8], np.int32), np.full(8, -1, np.int32)
    beyond[0], beyond[4] = 1, 0
    area = np.full(2, 4.0)
    radii, odd, tone, new = np.array([1.0, 2.0]), np.empty(2), np.empty(2), np.empty(2)
    for asked, moves in (([1.6, 2.4], True), ([0.4, 3.9], False)):
        ink = np.array(asked)
        compare_sizes(0, 2, first, beyond, area, ink, radii, odd, tone)
        assert tone == pytest.approx(ink / 4)
        assert odd == pytest.approx([-np.log(2), np.log(2)])
        even_sizes(0, 2, first, beyond, radii, odd, tone, 0.1, 0.7, ink, new)
        assert (new[0] > ink[0]) == moves
        assert new.sum() == pytest.approx(ink.sum())
