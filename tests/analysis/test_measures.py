import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import KDTree

from stippler.analysis.spacing import measure_spacing
from stippler.analysis.spectrum import measure_spectrum
from stippler.analysis.tone_error import draw_ink, measure_size_noise, measure_tone


def grid(n, spacing=1.0):
    y, x = np.mgrid[0:n, 0:n]
    return np.column_stack((x.ravel() + 0.5 * (y.ravel() % 2), y.ravel() * math.sqrt(0.75))) * (
        spacing
    )


def test_a_hexagonal_grid_is_perfectly_even():
    spacing = measure_spacing(grid(30, 2.0))
    assert spacing.mean == pytest.approx(2.0)
    assert spacing.nearest_cv == pytest.approx(0.0, abs=1e-9)
    assert spacing.relative_min > 0.28  # corners see their seventh far off
    assert spacing.edge_variance == pytest.approx(0.0, abs=1e-9)


def test_random_dots_are_uneven_and_their_spectrum_flat():
    points = np.random.default_rng(1).random((1500, 2)) * 30
    assert measure_spacing(points).relative_cv == pytest.approx(0.47, abs=0.03)
    spectrum = measure_spectrum(points, (0, 0, 30, 30))
    assert spectrum.power[2:].mean() == pytest.approx(1.0, abs=0.05)
    assert spectrum.low == pytest.approx(1.0, abs=0.15)
    assert spectrum.direction_db == pytest.approx(0.0, abs=1.0)


def test_the_spectrum_is_the_fourier_transform():
    rng = np.random.default_rng(2)
    points = rng.random((40, 2)) * (7, 5) + (1, 2)
    spectrum = measure_spectrum(points, (1, 2, 8, 7), reach=1.0)
    m = spectrum.picture.shape[0] // 2
    for fx, fy in ((0, 0), (2, -3), (-m, m)):
        phase = np.exp(-2j * np.pi * (fx * (points[:, 0] - 1) + fy * (points[:, 1] - 2)) / 7)
        assert spectrum.picture[fy + m, fx + m] == pytest.approx(abs(phase.sum()) ** 2 / 40)


@pytest.mark.parametrize("n", [0, 1, 2])
def test_too_few_dots_have_no_spacing(n):
    assert math.isnan(measure_spacing(np.zeros((n, 2))).relative_cv)
    assert math.isnan(measure_size_noise(np.zeros((n, 2)), np.ones(n)))


def test_dots_on_one_line_have_no_delaunay_edges():
    points = np.column_stack((np.arange(12.0), np.zeros(12)))
    assert math.isnan(measure_spacing(points).edge_variance)
    assert measure_spacing(points).mean == pytest.approx(1.0)


@settings(max_examples=20)
@given(st.integers(0, 10**6), st.floats(0.4, 3.0))
def test_a_lone_disc_has_its_area(seed, r):
    x, y = np.random.default_rng(seed).uniform(5, 15, 2)
    ink = draw_ink(np.array([[x, y]]), np.array([r]), (20, 20), zoom=32)
    assert ink.sum() == pytest.approx(math.pi * r * r, rel=0.015)
    assert ((ink >= 0) & (ink <= 1)).all()


def test_tone_error_sees_bias_gain_and_overlap():
    points = grid(40)
    pitch = 4.1237  # no whole number of samples
    points = points[(points[:, 0] < 39) & (points[:, 1] < 34)] * pitch + 2
    radii = np.full(len(points), 1.4)
    share = math.pi * 1.4**2 / (pitch**2 * math.sqrt(0.75))
    shape = (145, 165)
    exact = measure_tone(points, radii, np.full(shape, share))
    assert exact.bias == pytest.approx(0.0, abs=0.02)  # the rim is bare
    assert math.isnan(exact.gain)
    assert exact.overlap == pytest.approx(0.0, abs=0.01)
    light = measure_tone(points, radii, np.full(shape, share - 0.1))
    assert light.bias - exact.bias == pytest.approx(0.1, abs=1e-6)
    assert light.tone_rmse > 0.08
    twice = measure_tone(np.repeat(points, 2, 0), np.repeat(radii, 2), np.full(shape, share))
    assert twice.overlap == pytest.approx(0.5, abs=0.01)
    asked = draw_ink(points, radii, shape, 4)
    asked[:70] *= 0.5
    halves = measure_tone(points, radii, asked)
    assert halves.gain < 1.0
    assert halves.detail_rmse > 0.05


def test_size_noise_is_the_logarithm_against_neighbours():
    rng = np.random.default_rng(3)
    points, radii = rng.random((200, 2)), rng.uniform(1, 2, 200)
    near = KDTree(points).query(points, k=7)[1][:, 1:]
    expected = [math.log(radii[i] / radii[near[i]].mean()) ** 2 for i in range(200)]
    assert measure_size_noise(points, radii) == pytest.approx(math.sqrt(np.mean(expected)))
    assert measure_size_noise(points, np.ones(200)) == 0.0
