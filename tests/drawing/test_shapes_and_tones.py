"""How pens and changes shape dots, levels of pictures, curves of tone: by their definitions."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.drawing.dots import Dots
from stippler.drawing.levels import N_LEVELS, Levels
from stippler.drawing.page import Page
from stippler.drawing.pens import PENS, pen_named
from stippler.drawing.shape_change import (
    KEEP,
    MAX_RADIUS_MM,
    MIN_RADIUS_MM,
    LinearChange,
    ShapeChange,
    to,
)
from stippler.drawing.style import Style
from stippler.drawing.tone_curve import DEEPEST, ToneCurve, illustration
from stippler.errors import ParameterError
from stippler.kernels.shapes.dot_shape import MAX_ELONGATION


def dots(n=4000, **values):
    made = Dots.round(np.random.default_rng(2).random((n, 2)) * 90, 0.2)
    for name, value in values.items():
        getattr(made, name)[:] = value
    return made


# --- pens ---------------------------------------------------------------------------------------

DEGREE = math.pi / 180
DRAWN = {  # elongation, roughness, angle, and how far it scatters
    "technical-pen": ((1.0, 1.0), (0.0, 0.0), 0.0, 0.0),
    "quill": ((1.15, 1.7), (0.10, 0.25), -38 * DEGREE, 14 * DEGREE),
    "brush": ((1.7, 3.2), (0.12, 0.35), -62 * DEGREE, 26 * DEGREE),
    "rough-paper": ((1.0, 1.25), (0.45, 0.85), 0.0, 90 * DEGREE),
    "stick": ((1.1, 1.9), (0.6, 1.0), -20 * DEGREE, 90 * DEGREE),
}


@pytest.mark.parametrize("name", DRAWN)
def test_each_pen_draws_dots_of_its_own_shape_all_over_its_ranges(name):
    elongation, roughness, angle, scatter = DRAWN[name]
    drawn = pen_named(name).drawn(dots())
    for values, (low, high) in ((drawn.elongation, elongation), (drawn.roughness, roughness)):
        assert values.min() == pytest.approx(low, abs=2e-3 * (high - low) + 1e-6)
        assert values.max() == pytest.approx(high, abs=2e-3 * (high - low) + 1e-6)
        assert values.mean() == pytest.approx((low + high) / 2, abs=0.02 * (high - low) + 1e-6)
    if scatter or angle:
        away = (drawn.angle_rad - angle + math.pi / 2) % math.pi - math.pi / 2
        assert np.abs(away).max() == pytest.approx(scatter, rel=2e-3)
        assert away.mean() == pytest.approx(0.0, abs=0.05 * scatter)
    assert np.array_equal(drawn.radius_mm, dots().radius_mm)


def test_all_pens_are_tried():
    assert {pen.name for pen in PENS} == set(DRAWN)


# --- changes ------------------------------------------------------------------------------------


@given(
    st.floats(1.0, 4.0), st.floats(0.0, 2.0), st.floats(-3.0, 3.0), st.floats(0.0, 1.0),
    st.sampled_from(["elongation", "roughness"]),
)  # fmt: skip
def test_a_dot_goes_as_far_towards_its_new_value_as_its_weight_says(
    start, factor, addend, weight, name
):
    low, high = (1.0, MAX_ELONGATION) if name == "elongation" else (0.0, 1.0)
    start = start if name == "elongation" else (start - 1.0) / 3.0
    some = dots(3, **{name: start})
    new = ShapeChange(**{name: LinearChange(factor, addend)}).of(some, weight)
    if LinearChange(factor, addend) == KEEP:
        assert new == {}
        return
    old = float(getattr(some, name)[0])
    wanted = min(max(old + weight * (old * factor + addend - old), low), high)
    assert new[name] == pytest.approx(np.full(3, wanted), abs=1e-5)


def test_each_dot_has_dice_of_its_own_within_the_spread():
    some = dots(elongation=1.5)
    new = ShapeChange(elongation=LinearChange(1.0, 0.25, 0.5)).of(some, 0.5)["elongation"]
    assert 1.625 <= new.min() < 1.627
    assert 1.873 < new.max() <= 1.875
    assert len(np.unique(new)) > 3000


def test_sizes_stay_within_what_a_dot_can_be():
    some = dots(3)
    small = ShapeChange(radius=LinearChange(0.0, 0.0)).of(some)["radius_mm"]
    large = ShapeChange(radius=LinearChange(1.0, 1e6)).of(some)["radius_mm"]
    assert (float(small[0]), float(large[0])) == (np.float32(0.005), 50.0)
    assert (MIN_RADIUS_MM, MAX_RADIUS_MM) == (0.005, 50.0)
    half = ShapeChange(radius=LinearChange(4.0)).of(some, 0.5)["radius_mm"]
    assert half == pytest.approx(np.full(3, 0.4), rel=1e-5)  # by ratio


def test_stretching_a_round_dot_makes_it_so_much_longer_that_way():
    some = dots(3, angle_rad=0.3)
    new = ShapeChange(angle_rad=1.0, stretch=0.75).of(some)
    assert new["elongation"] == pytest.approx(np.full(3, 1.75))
    assert new["angle_rad"] == pytest.approx(np.full(3, 1.0))
    half = ShapeChange(angle_rad=1.0, stretch=0.75).of(some, 0.5)
    assert half["elongation"] == pytest.approx(np.full(3, 1.375))
    assert half["angle_rad"] == pytest.approx(np.full(3, 1.0))
    across = ShapeChange(angle_rad=1.0 + math.pi / 2, stretch=0.75).of(
        dots(3, angle_rad=1.0, elongation=1.75)
    )
    assert across["elongation"] == pytest.approx(np.ones(3), abs=1e-6)
    most = ShapeChange(angle_rad=1.0, stretch=1e3).of(some)["elongation"]
    assert most == pytest.approx(np.full(3, MAX_ELONGATION))


def test_what_a_change_does_to_round_smooth_dots_is_known():
    assert not ShapeChange(elongation=to(1.0)).elongates
    assert ShapeChange(elongation=to(1.0, 0.5)).elongates
    assert ShapeChange(stretch=0.1).elongates
    assert not ShapeChange(roughness=LinearChange(0.5)).roughens
    assert ShapeChange(roughness=LinearChange(0.5, 0.0, 0.1)).roughens
    assert [ShapeChange().turns, ShapeChange(angle_rad=0.0).turns] == [False, True]
    assert ShapeChange(scatter_rad=0.1).turns


# --- levels and sizes of pages --------------------------------------------------------------------


@given(st.lists(st.floats(0.0, 1.0, width=32), min_size=1, max_size=40))
def test_levels_are_the_nearest_and_only_white_is_none(values):
    dark = np.array(values, np.float32)
    found = Levels.rounded(dark[None]).of_pixel[0].astype(np.float64)
    assert np.abs(found - dark.astype(np.float64) * (N_LEVELS - 1)).max() <= 1.0
    middle = dark * np.float32(N_LEVELS - 1)
    plain = (middle > 0.5) & (middle % 1 != 0.5)
    assert np.array_equal(found[plain], np.rint(middle[plain]))
    assert np.array_equal(found == 0, dark == 0)


def test_the_ends_of_levels():
    dark = np.array([0, 1e-12, 0.5 / 65535, 1 / 65535, 1.5001 / 65535, 1], np.float32)
    assert Levels.rounded(dark[None]).of_pixel.tolist() == [[0, 1, 1, 1, 2, 65535]]


def test_pages_are_of_sizes_that_there_are():
    assert Page(10_000.0, 0.01).width_mm == 10_000.0
    for wrong in ((10_000.5, 5.0), (5.0, 0.0099), (math.nan, 5.0)):
        with pytest.raises(ParameterError):
            Page(*wrong)


def test_zero_is_a_seed():
    assert Style(seed=0).seed == 0
    with pytest.raises(ParameterError):
        Style(seed=-1)


# --- tone ---------------------------------------------------------------------------------------


def spread(low, high, n=10_000, power=1.0):
    return (low + (high - low) * np.linspace(0, 1, n, dtype=np.float32) ** power).reshape(100, -1)


def test_a_picture_of_paper_alone_has_the_plain_curve():
    assert illustration(np.full((9, 9), 0.2, np.float32)) == ToneCurve(0.0, 1.0, 1.0, DEEPEST)


def test_so_much_at_each_end_is_clipped():
    dark = spread(0.2, 0.9)
    curve = illustration(dark)
    share = [float((dark < curve.white).mean()), float((dark > curve.black).mean())]
    assert share == pytest.approx([0.005, 0.005], abs=1.5e-3)


def test_pale_pictures_keep_a_least_contrast():
    curve = illustration(spread(0.4, 0.5))
    assert curve.black - curve.white == pytest.approx(0.3)
    assert curve.black == pytest.approx(0.7, abs=0.01)


def test_a_background_of_one_tone_is_paper_where_there_is_enough_of_it():
    def framed(share, tone=0.2):
        dark = spread(0.35, 0.9)
        dark.reshape(-1)[: int(share * dark.size)] = tone
        return illustration(dark).white

    assert framed(0.25) == pytest.approx(0.2, abs=1e-3)
    assert framed(0.15) < 0.2
    assert framed(0.25, 0.34) < 0.34  # too dark to be paper


@pytest.mark.parametrize(
    ("power", "low", "high"), [(0.3, 0.40, 0.48), (1.0, 0.28, 0.40), (3.0, 0.22, 0.40)]
)
def test_the_mean_ink_comes_within_its_bounds(power, low, high):
    dark = spread(0.0, 1.0, power=power)
    dark[0, :30] = 0.0
    ink = float(illustration(dark).at(dark).mean())
    assert low - 5e-3 <= ink <= high + 5e-3


@pytest.mark.parametrize(("power", "bound"), [(14.0, 4.0), (0.01, 0.4)])
def test_powers_go_no_further_than_they_serve(power, bound):
    gamma = illustration(spread(0.0, 1.0, power=power)).gamma
    assert 0.4 <= gamma <= 4.0
    assert abs(gamma - 1.0) > 0.3, bound


def test_a_curve_is_what_it_says():
    curve = ToneCurve(0.2, 0.8, 2.0, 0.5)
    assert curve.at(np.array([0.0, 0.2, 0.5, 0.8, 1.0])) == pytest.approx([0, 0, 0.125, 0.5, 0.5])
    field = np.linspace(0, 1, 700, dtype=np.float32).reshape(350, 2)
    assert curve.apply(field) == pytest.approx(curve.at(field), abs=3e-5)
    for wrong in ((0.5, 0.5), (-0.1, 1.0), (0.0, 1.1)):
        with pytest.raises(ParameterError, match="no range"):
            ToneCurve(*wrong)
    for wrong in ((0.0, 1.0), (1.0, 0.0), (1.0, 1.1)):
        with pytest.raises(ParameterError, match="gamma"):
            ToneCurve(0.0, 1.0, *wrong)
