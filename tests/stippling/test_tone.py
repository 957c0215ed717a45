import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import gaussian_filter

from stippler.analysis.tone_error import draw_ink
from stippler.drawing.reference import Reference
from stippler.kernels.machine.pool import n_threads, set_threads
from stippler.stippling.density import DensityField
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.radii import solve_radii
from stippler.stippling.tessellation import Tessellation
from stippler.stippling.tone import DotRule, ink_for, rule_for, shortfall

NO_RIM = np.empty(0, np.float32)


def frozen(field):
    field = np.array(field, np.float32)
    field.flags.writeable = False
    return field


def solved(points, darkness, low, high):
    h, w = darkness.shape
    page = [(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)]
    cells = Tessellation.of(points, page, None, DensityField(darkness, 1.0))
    return solve_radii(cells, DotRule(low, high))


def hexagons(w, h, spacing):
    y = np.arange(spacing / 2, h, spacing * math.sqrt(0.75))
    points = [
        (x + (spacing / 2 if k % 2 else 0), v)
        for k, v in enumerate(y)
        for x in np.arange(spacing / 4, w - spacing / 2, spacing)
    ]
    return np.array(points)


@given(st.floats(0, 1), st.floats(0.1, 3), st.floats(1, 4), st.floats(0.5, 2))
def test_density_and_radius_lay_down_the_ink_together(darkness, low, ratio, scale):
    rule = DotRule(low, low * ratio, scale)
    d = np.array([darkness])
    assert low <= rule.radius(d)[0] <= low * ratio
    assert rule.density(d)[0] * math.pi * rule.radius(d)[0] ** 2 == pytest.approx(ink_for(d)[0])
    assert rule.density(np.zeros(1))[0] == 0.0


def test_ink_grows_with_darkness_and_is_more_than_it():
    d = np.linspace(0, 1, 400)
    assert (np.diff(ink_for(d)) > 0).all()
    assert (ink_for(d) >= d).all()


@given(st.integers(0, 10**6), st.integers(20, 5000))
def test_a_number_alone_is_met_with_a_range_of_one_to_two(seed, n):
    darkness = frozen(np.random.default_rng(seed).random((40, 50)))
    rule = rule_for(darkness, n, None, NO_RIM)
    assert rule.radius_max == 2 * rule.radius_min
    assert rule.density(darkness).sum() == pytest.approx(n, rel=2e-3)


@given(st.integers(0, 10**6), st.floats(0.1, 2), st.floats(1, 3), st.integers(1, 20_000))
def test_a_number_and_sizes_meet_or_thin(seed, low, ratio, n):
    darkness = frozen(np.random.default_rng(seed).random((40, 50)))
    rule = rule_for(darkness, n, (low, low * ratio), NO_RIM)
    found = rule.density(darkness).sum()
    assert (rule.radius_min, rule.radius_max) == (low, low * ratio)
    least = DotRule(low, low * ratio, 100).density(darkness).sum()
    most = DotRule(low, low * ratio, 1e-3).density(darkness).sum()
    assert found == pytest.approx(min(n, most), rel=5e-3)
    assert (rule.thin < 1) == (n < least * (1 - 1e-9)) or n == pytest.approx(least, rel=1e-6)


def test_shortfall_is_where_thin_dots_are_too_few():
    darkness = np.zeros((40, 100), np.float32)
    darkness[10:30, 50:] = 0.9
    full = DotRule(1.0, 2.0)
    assert shortfall(darkness, full, 0.5, 100, None).share == 0.0
    lack = shortfall(darkness, DotRule(1.0, 2.0, 9.0, thin=0.5), 0.5, 100, None)
    assert lack.share == pytest.approx(0.25)
    assert 0.3 < lack.missing < 0.6
    assert lack.box_mm == (25.0, 5.0, 50.0, 15.0)
    assert "no dots" in shortfall(darkness * 0, full, 0.5, 0, 10).notes[0]
    assert "50 of 100" in shortfall(darkness, full, 0.5, 50, 100).notes[0]


@settings(max_examples=12)
@given(st.floats(0.03, 0.97))
def test_on_a_grid_the_ink_is_exactly_the_darkness(darkness):
    field = frozen(np.full((120, 120), darkness))
    points = hexagons(120, 120, 6.1373)
    radii = solved(points, field, 0.05, 6.0)
    inner = (np.abs(points - 60) < 30).all(axis=1)
    assert np.ptp(radii[inner]) < 1e-3 * radii[inner].mean()
    ink = draw_ink(points, radii, (120, 120), zoom=16)
    seen = gaussian_filter(ink, 8.0)[50:70, 50:70]
    assert seen.mean() == pytest.approx(darkness, abs=2e-3)


@settings(max_examples=12)
@given(st.integers(0, 10**6), st.floats(1.2, 3.0))
def test_what_one_dot_cannot_lay_down_its_neighbours_do(seed, ratio):
    rng = np.random.default_rng(seed)
    field = frozen(gaussian_filter(rng.random((90, 90)), 12) * 0.8)
    points = hexagons(90, 90, 4.0) + rng.normal(0, 0.5, (len(hexagons(90, 90, 4.0)), 2))
    points = np.clip(points, 0.01, 89.99)
    middle = math.sqrt(field.sum() / len(points) / math.pi)
    low, high = middle / math.sqrt(ratio), middle * math.sqrt(ratio)
    radii = solved(points, field, low, high)
    assert (radii >= low).all()
    assert (radii <= high).all()
    ink = draw_ink(points, radii, (90, 90), zoom=6)
    assert ink.mean() == pytest.approx(field.mean(), rel=0.01 if ratio > 1.5 else 0.05)


def test_the_number_of_threads_changes_no_bit():
    rng = np.random.default_rng(7)
    points, field = rng.random((9000, 2)) * 300, frozen(rng.random((300, 300)))
    before = n_threads()
    results = []
    for threads in (1, 2, 5):
        set_threads(threads)
        results.append(solved(points, field, 0.4, 1.6))
    set_threads(before)
    assert np.array_equal(results[0], results[1])
    assert np.array_equal(results[0], results[2])


@pytest.mark.parametrize("n", [0, 1, 2])
def test_few_dots(n):
    radii = solved(np.array([[3.0, 4.0], [7.0, 2.0]])[:n], frozen(np.full((10, 10), 0.2)), 0.5, 5)
    assert len(radii) == n
    if n:
        assert np.pi * (radii**2).sum() == pytest.approx(20.0, rel=1e-3)


def test_dots_at_one_place_and_far_off_ones_are_survived():
    points = np.array([[5.0, 5.0]] * 30 + [[0.0, 0.0], [10.0, 10.0]])
    radii = solved(points, frozen(np.ones((10, 10))), 0.5, 2.0)
    assert np.isfinite(radii).all()


@given(st.integers(1, 400), st.integers(1, 400), st.integers(1, 100_000))
def test_a_sheet_is_as_fine_as_its_dots_need(h, w, n):
    reference = Reference(np.full((h, w), 0.4, np.float32), 100.0)
    raster = PageRaster.of(reference, n, None, bleeds=True)
    assert n / raster.darkness.size <= 0.25 + 1e-9
    assert raster.darkness.shape[1] * raster.pixel_mm == pytest.approx(100.0)
    outline = raster.outline_mm()
    assert np.allclose(outline[0], -outline[2] + raster.size_mm)


def test_a_fine_picture_is_averaged_and_white_kept_white():
    rng = np.random.default_rng(1)
    picture = rng.random((3203, 3301), dtype=np.float32)
    picture[:, 1500:] = 0.0
    raster = PageRaster.of(Reference(picture, 330.1), 1000, None, bleeds=False)
    assert raster.darkness.size < picture.size / 3
    assert raster.darkness.mean() == pytest.approx(picture.mean(), rel=2e-3)
    assert (raster.darkness[:, -300:] == 0).all()


def test_trimming_keeps_the_number_and_the_page():
    rng = np.random.default_rng(2)
    raster = PageRaster.of(Reference(np.full((100, 100), 0.5, np.float32), 100.0), 1000, None, True)
    assert raster.bleed > 0
    size = np.array(raster.size_mm) / raster.pixel_mm
    spread = size + 2 * raster.bleed
    n = round(1000 * float((spread / size).prod() * (1 - 0.02)))
    points = rng.random((n, 2)) * spread - raster.bleed
    kept = raster.trim(points, 1000)
    assert ((kept > 0) & (kept < size)).all()
    assert abs(len(kept) - 1000) < 40
    inside = ((points > 0) & (points < size)).all(axis=1)
    assert {tuple(p) for p in points[inside]} <= {tuple(p) for p in kept}
