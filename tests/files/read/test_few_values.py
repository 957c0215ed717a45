"""Grey of whole numbers, read by a table of its values, is what it is pixel by pixel."""

import numpy as np
import pytest

from stippler.files.read import darkness
from stippler.files.read.darkness import levels_of_pixels
from stippler.files.read.pixels import of_array


@pytest.mark.parametrize("tone", ["illustration", "linear", "perceptual"])
@pytest.mark.parametrize("meaning", [{}, {"inverted": True}, {"gamma": 1.8}, {"orientation": 6}])
@pytest.mark.parametrize("kind", ["noise", "paper", "white", "black"])
@pytest.mark.parametrize("white", [255, 4095, 65535])
def test_the_table_gives_the_same_bits(monkeypatch, tone, meaning, kind, white):
    rng = np.random.default_rng(1)
    depth = np.uint8 if white == 255 else np.dtype(">u2")
    samples = {
        "noise": rng.integers(0, white + 1, (70, 41)),
        "paper": np.where(rng.random((70, 41)) < 0.9, 231, 40),
        "white": np.full((9, 7), white),
        "black": np.zeros((9, 7)),
    }[kind].astype(depth)
    quick, told = levels_of_pixels(of_array(samples, "grey", white, **meaning), tone)
    assert not np.shares_memory(quick.of_pixel, samples)
    monkeypatch.setattr(darkness, "_grey_values", lambda pixels, tone: None)
    slow, told_slowly = levels_of_pixels(of_array(samples, "grey", white, **meaning), tone)
    assert np.array_equal(quick.darkness(), slow.darkness())
    assert told == told_slowly


def test_samples_above_white_are_no_levels():
    samples = np.array([[0, 4096]], np.uint16)
    with pytest.raises(IndexError):
        levels_of_pixels(of_array(samples, "grey", 4095), "linear")
