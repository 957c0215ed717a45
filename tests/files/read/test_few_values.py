"""Grey of 8 bits, read by a table of its values, is what it is pixel by pixel."""

import numpy as np
import pytest

from stippler.files.read import darkness
from stippler.files.read.darkness import darkness_of_pixels
from stippler.files.read.pixels import of_array


@pytest.mark.parametrize("tone", ["illustration", "linear", "perceptual"])
@pytest.mark.parametrize("meaning", [{}, {"inverted": True}, {"gamma": 1.8}, {"orientation": 6}])
@pytest.mark.parametrize("kind", ["noise", "paper", "white", "black"])
def test_the_table_gives_the_same_bits(monkeypatch, tone, meaning, kind):
    rng = np.random.default_rng(1)
    samples = {
        "noise": rng.integers(0, 256, (70, 41), np.uint8),
        "paper": np.where(rng.random((70, 41)) < 0.9, 231, 40).astype(np.uint8),
        "white": np.full((9, 7), 255, np.uint8),
        "black": np.zeros((9, 7), np.uint8),
    }[kind]
    quick, told = darkness_of_pixels(of_array(samples, "grey", 255, **meaning), tone)
    monkeypatch.setattr(darkness, "_few_values", lambda pixels, tone: None)
    slow, told_slowly = darkness_of_pixels(of_array(samples, "grey", 255, **meaning), tone)
    assert np.array_equal(quick, slow)
    assert quick.dtype == slow.dtype == np.float32
    assert told == told_slowly
