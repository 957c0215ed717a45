"""What each parameter of a style does to the dots."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial import KDTree

import stippler
from stippler.analysis.tone_error import measure_tone
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.jobs.processing import process_now
from stippler.stippling.size_noise import noise_at
from stippler.stippling.stipple import stages

W = 60.0


def field(low=0.15, high=0.75) -> Reference:
    ramp = np.linspace(low, high, 240, dtype=np.float32)
    return Reference(np.tile(ramp, (160, 1)), W)


def dots_of(reference: Reference, **style):
    *_, last = stages(reference, Style(**{"n_dots": 1200, "iterations": 6, **style}))
    return np.array(last.position_mm), np.array(last.radius_mm, float)


def ink_in_columns(position, radius, n=6):
    which = np.minimum(position[:, 0] / W * n, n - 1).astype(int)
    return np.bincount(which, math.pi * radius**2, n) / (W / n * 40.0)


@pytest.mark.parametrize("spacing", ["hexagonal", "square"])
@pytest.mark.parametrize("angle", [0.0, 20.0, -63.0])
def test_a_grid_has_its_distances_direction_and_number_and_keeps_the_tone(spacing, angle):
    position, radius = dots_of(field(), spacing=spacing, direction_deg=angle)
    assert abs(len(position) - 1200) <= 12
    inner = (np.abs(position - (30, 20)) < (22, 12)).all(axis=1)
    near = KDTree(position).query(position[inner], k=5)[0][:, 1:]
    assert near.std() / near.mean() < 1e-6
    nearest = KDTree(position).query(position[inner], k=2)[1][:, 1]
    along = np.degrees(np.arctan2(*(position[nearest] - position[inner]).T[::-1]))
    fold = 60.0 if spacing == "hexagonal" else 90.0
    assert np.allclose(np.mod(along - angle + fold / 2, fold), fold / 2, atol=1e-3)
    error = measure_tone(position * 4.0, radius * 4.0, field().darkness)
    assert abs(error.bias) < 0.002
    assert error.tone_rmse < 0.05  # cells are coarse beside the ramp
    assert error.gain == pytest.approx(1.0, abs=0.08)


@pytest.mark.parametrize("angle", [0.0, 35.0, 90.0])
def test_rows_run_along_their_direction_closer_in_the_dark(angle):
    position, _ = dots_of(field(), spacing="along", direction_deg=angle)
    assert abs(len(position) - 1200) <= 12
    turn = math.radians(angle)
    across = (position - (30.0, 20.0)) @ [-math.sin(turn), math.cos(turn)]
    rows = np.unique(np.round(across, 4))
    assert len(rows) < 90
    assert np.allclose(np.diff(rows), np.diff(rows)[0], atol=1e-3)
    n_light, n_dark = (np.count_nonzero(np.abs(position[:, 0] - x) < 8) for x in (12, 48))
    assert n_dark > 1.3 * n_light


@pytest.mark.parametrize("by", ["cell", "spacing"])
def test_jitter_moves_by_no_more_than_its_share(by):
    plain, _ = dots_of(field(), iterations=0, weighted=False)
    moved, _ = dots_of(field(), iterations=0, weighted=False, jitter=50.0, jitter_by=by)
    far = np.hypot(*(moved - plain).T)
    spacing = math.sqrt(60 * 40 / 1200)
    assert 0.1 * spacing < far.mean() < 0.5 * spacing
    left, right = far[plain[:, 0] < 15].mean(), far[plain[:, 0] > 45].mean()
    assert (left > 1.15 * right) == (by == "cell")  # dots in the dark move less


def test_white_dots_carry_what_the_dark_leaves():
    position, radius = dots_of(field(0.3, 0.9), polarity="white-on-black")
    asked = 1.0 - np.linspace(0.3, 0.9, 6 * 2 + 1)[1::2]
    assert ink_in_columns(position, radius) == pytest.approx(asked, abs=0.04)


def test_the_curve_is_the_style_s():
    style = {"tone_white": 0.2, "tone_black": 0.7, "tone_gamma": 1.5, "tone_deepest": 0.6}
    position, radius = dots_of(field(0.0, 1.0), **style)
    middle = np.linspace(0.0, 1.0, 6 * 8 + 1)
    curve = 0.6 * np.clip((middle - 0.2) / 0.5, 0, 1) ** 1.5
    asked = [curve[8 * k : 8 * k + 9].mean() for k in range(6)]
    assert ink_in_columns(position, radius) == pytest.approx(asked, abs=0.03)
    assert position[:, 0].min() > 0.19 * W


def test_long_dots_lie_as_set_or_along_edges():
    y, x = np.mgrid[0:200, 0:200] - 99.5
    disc = np.clip(0.9 - np.hypot(x, y) / 130.0, 0.0, 1.0)  # its edges are circles
    made = stippler.stipple(1.0 - disc, 800, 60.0, tone="linear", elongation=3.0,
                            direction_by="edges", iterations=3)  # fmt: skip
    at = made.dots.position_mm - 30.0
    inner = np.hypot(*at.T) > 6.0
    tangent = np.arctan2(*at.T[::-1]) + math.pi / 2
    off = np.mod(made.dots.angle_rad - tangent + math.pi / 2, math.pi) - math.pi / 2
    assert np.quantile(np.abs(off[inner]), 0.9) < 0.2
    assert made.dots.elongation.mean() == pytest.approx(3.0, abs=0.15)
    made = stippler.stipple(1.0 - disc, 400, 60.0, elongation=2.0, direction_by="set",
                            direction=30.0, iterations=1)  # fmt: skip
    assert np.abs(made.dots.angle_rad - math.radians(30.0)).max() < 0.2


def test_a_draft_lies_along_the_edges_of_where_its_dots_end():
    y, x = np.mgrid[0:120, 0:120] - 59.5
    reference = Reference(np.clip(np.hypot(x, y) / 90, 0, 1).astype(np.float32), W)
    style = Style(n_dots=300, iterations=5, elongation=3.0, direction_by="edges")
    drawing = Drawing.blank(Page(60.0, 60.0), style)
    drawing.reference = reference
    made = Document(drawing)
    process_now(made, [0])
    at = made.dots.position_mm - 30.0
    inner = np.hypot(*at.T) > 8.0
    tangent = np.arctan2(*at.T[::-1]) + math.pi / 2
    off = np.mod(made.dots.angle_rad - tangent + math.pi / 2, math.pi) - math.pi / 2
    assert np.quantile(np.abs(off[inner]), 0.9) < 0.25


def test_mottling_changes_sizes_over_wide_places_and_keeps_the_mean():
    flat = Reference(np.full((160, 240), 0.4, np.float32), W)
    position, plain = dots_of(flat)
    same, mottled = dots_of(flat, size_noise=40.0, size_noise_mm=10.0)
    assert np.array_equal(position, same)
    share = mottled / plain
    assert 0.599 < share.min() < 0.85
    assert 1.15 < share.max() < 1.401
    assert share.mean() == pytest.approx(1.0, abs=0.12)
    near = KDTree(position).query(position, k=2)[1][:, 1]
    assert np.corrcoef(share, share[near])[0, 1] > 0.9


def test_grain_is_longer_along_its_direction():
    at = np.random.default_rng(0).random((4000, 2)) * 100
    turn = math.radians(30.0)
    step = np.array([math.cos(turn), math.sin(turn)])
    here = noise_at(at, 3.0, 1, stretch=10.0, angle_rad=turn)
    along = noise_at(at + 3.0 * step, 3.0, 1, stretch=10.0, angle_rad=turn)
    across = noise_at(at + 3.0 * step[::-1] * (-1, 1), 3.0, 1, stretch=10.0, angle_rad=turn)
    assert np.abs(along - here).mean() < 0.5 * np.abs(across - here).mean()
    assert not np.array_equal(here, noise_at(at, 3.0, 2, stretch=10.0, angle_rad=turn))


def test_a_density_is_a_number_for_the_page():
    position, _ = dots_of(field(), n_dots=None, density_per_cm2=50.0)
    assert abs(len(position) - 1200) <= 12
