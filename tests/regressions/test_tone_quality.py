"""Scores of whole drawings by the outside measure; what was reached once is kept."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import gaussian_filter

from stippler.analysis.tone_error import measure_tone
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.stipple import stages

ROOT = Path(__file__).parents[2]


def measure(result, darkness):
    spec = importlib.util.spec_from_file_location("scorer", ROOT / "benchmarks/scorer.py")
    scorer = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(scorer)
    return scorer.measure(
        np.asarray(result.position_mm), result.radius_mm.astype(np.float64), darkness
    )


def drawn(darkness, **style):
    reference = Reference(darkness.astype(np.float32), float(darkness.shape[1]))
    *_, last = stages(reference, Style(**style), snapshots=False)
    return last


def sphere_ramp():
    grey = Image.open(ROOT / "tests/data/sphere_ramp.png").convert("L")
    return 1.0 - np.asarray(grey, float) / 255


def test_sphere_and_ramp_with_ten_thousand_dots():
    darkness = sphere_ramp()
    score = measure(drawn(darkness, n_dots=10_000), darkness)
    assert abs(score["dots"] - 10_000) <= 100
    assert score["tone_rmse"] <= 0.004
    assert score["detail_rmse"] <= 0.006
    assert abs(score["tone_bias"]) <= 0.001
    assert 0.995 <= score["tone_gain"] <= 1.005
    assert score["ssim"] >= 0.998
    assert score["rel_nn_cv"] <= 0.127
    assert score["min_rel"] >= 0.47
    assert score["size_noise"] <= 0.03


def test_a_picture_that_runs_over_the_edge_of_the_page():
    rng = np.random.default_rng(5)
    rough = gaussian_filter(rng.standard_normal((500, 600)), 25, mode="wrap")
    darkness = np.clip(0.5 + 0.18 * rough / rough.std(), 0.02, 0.98)
    score = measure(drawn(darkness, n_dots=6000), darkness)
    assert score["tone_rmse"] <= 0.007  # 0.03 where dots line up along the edge, 0.01 unevened
    assert score["detail_rmse"] <= 0.01
    assert score["ssim"] >= 0.995
    assert score["min_rel"] >= 0.47
    assert abs(score["tone_bias"]) <= 0.004
    assert score["rel_nn_cv"] <= 0.127
    assert score["size_noise"] <= 0.05


@pytest.mark.parametrize("dark", [0.97, 1.0])
def test_very_dark_parts_are_filled_by_overlapping_dots(dark):
    darkness = np.pad(np.full((200, 200), dark), 60)
    result = drawn(darkness, n_dots=3000)
    error = measure_tone(result.position_mm, result.radius_mm.astype(np.float64), darkness)
    assert error.bias == pytest.approx(0.0, abs=0.002)
    assert error.overlap > 0.05
