"""Checks against what shapely says of the same dots; repairs keep tone."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.errors import ParameterError
from stippler.files import checks
from stippler.files.checks import Process, check


def drawing(dots: Dots, width=40.0, height=30.0) -> Drawing:
    one = Drawing.blank(Page(width, height))
    one.dots = dots
    return one


def ink(dots: Dots) -> float:
    return float((math.pi * dots.radius_mm.astype(np.float64) ** 2).sum())


@settings(max_examples=60)
@given(st.integers(0, 2**32 - 1), st.integers(0, 80), st.sampled_from([None, 10.0, 80.0]))
def test_counts_are_shapelys(seed, n, print_width):
    rng = np.random.default_rng(seed)
    dots = Dots.round(rng.uniform(-2, 42, (n, 2)) * (1, 0.75), rng.uniform(0.05, 1.2, n))
    process = Process(print_width, 0.3, 0.4, 0.15)
    found = check(drawing(dots), process)
    scale = (print_width or 40.0) / 40.0
    discs = shapely.buffer(
        shapely.points(dots.position_mm * scale), dots.radius_mm * scale, quad_segs=64
    )
    gaps = {(i, j): shapely.distance(discs[i], discs[j]) for i in range(n) for j in range(i + 1, n)}
    near = 1e-3
    for pairs, limit in ((found.too_close, 0.4), (found.bleeding, 0.3)):
        seen = {tuple(sorted(pair)) for pair in pairs.tolist()}
        assert {p for p, gap in gaps.items() if near < gap < limit - near} <= seen
        assert seen <= {p for p, gap in gaps.items() if gap < limit + near}
    page = shapely.box(0, 0, 40 * scale, 30 * scale)
    off = [i for i in range(n) if discs[i].distance(page) > 2 * near]
    cut = [
        i
        for i in range(n)
        if discs[i].intersects(page) and not page.buffer(near).contains(discs[i])
    ]
    assert set(off) <= set(found.off_page)
    assert set(cut) <= {*found.cut, *found.off_page}
    assert set(found.too_small) == set(np.flatnonzero(2 * scale * dots.radius_mm < 0.3))


@pytest.mark.parametrize("size", [0.02, 0.05])
def test_small_dots_are_enlarged_and_thinned_and_the_ink_stays(size):
    rng = np.random.default_rng(1)
    dots = Dots.round(rng.uniform((1, 1), (39, 29), (5000, 2)), rng.uniform(size, 0.1, 5000))
    one, process = drawing(dots), Process(least_dot_mm=0.15)
    assert len(check(one, process).too_small) > 1000
    made = checks.enlarged(one, process)
    assert len(made) < len(dots)
    assert len(check(drawing(made), process).too_small) == 0
    assert ink(made) == pytest.approx(ink(dots), rel=1e-3)
    # and locally, too: in each sixteenth of the page
    for row in range(4):
        for column in range(4):
            left, top = 10 * column, 7.5 * row
            inks = []
            for some in (dots, made):
                x, y = some.position_mm.T
                inside = (x >= left) & (x < left + 10) & (y >= top) & (y < top + 7.5)
                inks.append(ink(some.take(inside)))
            assert inks[1] == pytest.approx(inks[0], rel=0.05)
    np.testing.assert_array_equal(dots.radius_mm, one.dots.radius_mm)


def test_close_dots_are_parted_and_fixed_ones_stay():
    rng = np.random.default_rng(2)
    grid = np.stack(np.meshgrid(np.arange(1.0, 39), np.arange(1.0, 29)), -1).reshape(-1, 2)
    dots = Dots.round(grid + rng.uniform(-0.1, 0.1, grid.shape), 0.42)
    dots.constraint[::5] = FIXED
    one, process = drawing(dots), Process(least_gap_mm=0.1, gain_mm=0.0)
    before = len(check(one, process).too_close)
    made = checks.parted(one, process)
    assert before > 300
    assert len(check(drawing(made), process).too_close) < 0.02 * before
    np.testing.assert_array_equal(made.position_mm[::5], dots.position_mm[::5])
    assert np.hypot(*(made.position_mm - dots.position_mm).T).max() < 0.3


def test_dots_beside_the_page_go_and_cut_ones_move_in():
    dots = Dots.round([(-3, 5), (0.2, 5), (20, 15), (39.9, 29.9), (20, 33)], 0.5)
    dots.elongation[3], dots.angle_rad[3] = 3, 0.4
    one = drawing(dots)
    found = check(one, Process())
    assert found.off_page.tolist() == [0, 4]
    assert found.cut.tolist() == [1, 3]
    made = checks.within_page(one)
    assert len(made) == 3
    after = check(drawing(made), Process())
    assert len(after.cut) == len(after.off_page) == 0
    np.testing.assert_array_equal(made.position_mm[1], [20, 15])


def test_tone_lost_by_a_coarse_bitmap():
    rng = np.random.default_rng(3)
    tiny = Dots.round(rng.uniform((1, 1), (39, 29), (4000, 2)), 0.1)
    fine = check(drawing(tiny), Process(dpi=2400)).tone_lost
    assert abs(fine) < 0.004
    gone = Dots.round(
        np.stack(np.meshgrid(np.arange(2, 38), np.arange(2, 28)), -1).reshape(-1, 2), 0.02
    )
    lost = check(drawing(gone), Process(dpi=25.4)).tone_lost  # between all pixels' middles
    assert lost > 0.9
    assert any("loses" in line for line in check(drawing(gone), Process(dpi=25.4)).lines())


def test_no_dots_have_no_faults():
    found = check(drawing(Dots.none()), Process(dpi=300))
    assert found.n == 0
    assert found.lines() == []
    assert len(checks.repaired(drawing(Dots.none()), Process())) == 0


@pytest.mark.parametrize("gain", [-0.03, 0.0, 0.02, 0.05])
def test_the_gain_is_found_from_what_a_sheet_measures(gain):
    """The printed sheet is simulated by shapely: every edge grown, and the union's area taken."""
    sheet = checks.calibration_sheet()
    x = sheet.dots.position_mm[:, 0]
    measured = []
    for k, share in enumerate(checks.SHEET_STEPS):
        dots = sheet.dots.take((x >= 18 * k) & (x < 18 * (k + 1)))
        middle = shapely.box(18 * k + 4, 4, 18 * k + 14, 14)
        printed = shapely.union_all(
            shapely.buffer(shapely.points(dots.position_mm), dots.radius_mm + gain, quad_segs=32)
        )
        measured.append(printed.intersection(middle).area / middle.area)
        if gain == 0:
            assert measured[-1] == pytest.approx(share, abs=0.02)
    assert checks.gain_of(measured) == pytest.approx(gain, abs=0.005)


def test_compensated_dots_print_as_large_as_drawn():
    dots = Dots.round([(10, 10), (20, 10), (30, 10)], [0.3, 0.3, 0.02])
    dots.elongation[1] = 3
    process = Process(print_width_mm=20, gain_mm=0.02)
    made = checks.compensated(drawing(dots), process)
    gain = 0.04  # half the size in print: twice the growth on the drawing
    for k in (0, 1):
        root = math.sqrt(dots.elongation[k])
        a, b = made.radius_mm[k] * root + gain, made.radius_mm[k] / root + gain
        assert a * b == pytest.approx(float(dots.radius_mm[k]) ** 2, rel=1e-5)
    assert len(made) == 2  # the third is lost by the process, and its ink is next to nothing


def test_values_no_sheet_measures():
    with pytest.raises(ParameterError, match="7 shares"):
        checks.gain_of([0.1, 0.2])
    with pytest.raises(ParameterError, match="7 shares"):
        checks.gain_of([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 1.7])


def test_a_dot_beside_a_corner_lies_beside_the_page():
    """Its box touches the page, and its disc does not; found by Hypothesis."""
    dots = Dots.round([(-0.4, -0.4), (40.3, 30.3)], 0.5)
    found = check(drawing(dots), Process())
    assert found.off_page.tolist() == [0]
    assert found.cut.tolist() == [1]
