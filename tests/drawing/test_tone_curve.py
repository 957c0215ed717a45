"""The illustrator's curve: paper white, deep parts open, the whole within bounds."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from stippler.drawing.adjustment import Adjustment
from stippler.drawing.tone_curve import DEEPEST, ToneCurve, illustration
from stippler.errors import ParameterError
from stippler.files.read.picture import darkness_of_array, read_darkness
from stippler.resources import assets


def picture(seed, white, power):
    """A picture with much of every tone, some paper, and its own mood."""
    rng = np.random.default_rng(seed)
    rough = np.asarray(
        Image.fromarray(rng.random((12, 16)).astype(np.float32)).resize((320, 240)), np.float32
    )
    field = np.clip(rough, 0, 1) ** np.float32(power)
    field[: int(240 * white)] = 0.0
    return field.astype(np.float32)


@settings(deadline=None, max_examples=40)
@given(seed=st.integers(0, 999), white=st.sampled_from([0.0, 0.1, 0.3]), power=st.floats(0.3, 2.5))
def test_a_picture_becomes_open_ink_within_bounds(seed, white, power):
    field = picture(seed, white, power)
    ink = illustration(field).apply(field)
    assert ink.min() >= 0.0
    assert ink.max() <= np.float32(DEEPEST)
    assert (ink[field == 0.0] == 0.0).all()
    assert 0.2 <= ink.mean() <= 0.5
    assert np.all(np.diff(ink.ravel()[np.argsort(field.ravel())]) >= 0.0)


@pytest.mark.parametrize("name", ["ammonite.png", "honey-bee.jpg", "sandstone.jpg"])
def test_samples_are_open_and_within_bounds(name):
    ink = read_darkness(assets() / "samples" / name, "illustration")
    assert 0.2 <= ink.mean() <= 0.5
    assert (ink > 0.88).mean() <= 0.03


def test_paper_that_is_grey_becomes_white():
    rng = np.random.default_rng(2)
    page = np.full((200, 200), 0.92) + rng.normal(0, 0.004, (200, 200))
    page[90:110, 20:180] = 0.1
    ink = darkness_of_array(np.clip(page, 0, 1).astype(np.float32), "illustration")
    assert (ink[:80] == 0.0).mean() > 0.99
    assert ink[100, 100] > 0.7


@pytest.mark.parametrize("value", [0.0, 0.4, 1.0])
def test_one_tone_alone_has_a_curve(value):
    field = np.full((20, 30), value, np.float32)
    ink = illustration(field).apply(field)
    assert np.isfinite(ink).all()
    assert (ink.max() > 0.0) == (value > 0.0) or value == 0.4  # grey paper may be taken for white


def test_ranges_are_checked():
    with pytest.raises(ParameterError):
        ToneCurve(0.6, 0.5)
    with pytest.raises(ParameterError):
        Adjustment(white=0.5, black=0.5)


def test_white_and_black_points_spread_what_lies_between():
    tones = np.array([[0.0, 0.2, 0.45, 0.7, 0.9]], np.float32)
    ink = Adjustment(white=0.2, black=0.7).apply(tones)
    assert ink == pytest.approx(np.array([[0.0, 0.0, 0.5, 1.0, 1.0]]), abs=1e-6)
