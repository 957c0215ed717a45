"""Measures by name, on dots whose values are known."""

import math

import numpy as np
import pytest

from stippler.analysis.report import measure_against, measure_dots


def lattice(n, m, pitch):
    y, x = np.mgrid[0:m, 0:n]
    return (np.column_stack((x.ravel(), y.ravel())) + 0.5) * pitch


def test_a_square_lattice():
    points = lattice(100, 60, 2.0)
    report = measure_dots(points, np.full(len(points), 0.5, np.float32))
    assert report["dots"] == 6000
    assert report["radius_min_mm"] == report["radius_max_mm"] == 0.5
    assert report["spacing_mm"] == pytest.approx(2.0)
    assert report["spacing_cv"] == pytest.approx(0.0, abs=1e-9)
    assert report["size_noise"] == 0.0
    assert report["spectrum_dots"] == 60 * 60  # the middle square, as high as the drawing
    assert report["spectrum_peak"] > 30


def test_the_spectrum_takes_the_middle_of_many_dots():
    points = np.random.default_rng(4).random((20_000, 2)) * (50, 20)
    report = measure_dots(points, np.ones(len(points)))
    assert 3900 <= report["spectrum_dots"] <= 4000
    assert report["spectrum_low"] == pytest.approx(1.0, abs=0.15)
    assert report["direction_db"] == pytest.approx(0.0, abs=0.5)


@pytest.mark.parametrize("n", [0, 1, 2, 20])
def test_too_few_dots_have_no_value(n):
    points = np.column_stack((np.arange(n), np.zeros(n))).astype(float)  # on a line
    report = measure_dots(points, np.ones(n))
    assert report["dots"] == n
    assert math.isnan(report["direction_db"])
    assert math.isnan(report["edge_variance"])


@pytest.mark.parametrize("px_per_mm", [2, 30])  # the finer picture is averaged first
def test_ink_against_a_grey(px_per_mm):
    points = np.random.default_rng(7).random((400, 2)) * (0.3, 2.0)
    points = lattice(20, 20, 3.0)[:, ::-1] + points  # no whole number of samples
    points = points[points[:, 1] < 39]
    radii = np.full(len(points), 0.7)
    share = len(points) * math.pi * 0.49 / (60 * 40)
    grey = np.full((40 * px_per_mm, 60 * px_per_mm), share, np.float32)
    report = measure_against(points, radii, grey, 60.0)
    assert report["tone_bias"] == pytest.approx(0.0, abs=0.004)
    assert report["overlap"] == pytest.approx(0.0, abs=0.03)
    darker = measure_against(points, radii, grey + np.float32(0.2), 60.0)
    assert darker["tone_bias"] == pytest.approx(report["tone_bias"] - 0.2, abs=2e-3)


def test_no_dots_have_no_tone():
    report = measure_against(np.empty((0, 2)), np.empty(0), np.ones((4, 4), np.float32), 4.0)
    assert all(math.isnan(value) for value in report.values())
