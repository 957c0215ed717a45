"""Levels of darkness are counted and looked up as numpy does it, to the bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.kernels.tone.darkness_levels import count_levels, look_up_levels


def some_darkness(seed, shape=(13, 17)):
    rng = np.random.default_rng(seed)
    darkness = rng.random(shape).astype(np.float32)
    darkness[rng.random(shape) < 0.2] = 0.0
    darkness[rng.random(shape) < 0.1] = 1.0
    darkness[0, 0] = 1e-30  # nearly white is not white
    darkness.flags.writeable = False
    return darkness


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.sampled_from([1, 7, 1024]))
def test_pixels_and_their_darkness_are_added_up_by_level(seed, top):
    flat = some_darkness(seed).ravel()
    counts, sums = np.zeros(top + 1), np.zeros(top + 1)
    count_levels(flat, counts, sums)
    level = np.ceil(flat * np.float32(top)).astype(np.intp)
    assert np.array_equal(counts, np.bincount(level, minlength=top + 1))
    assert np.array_equal(sums, np.bincount(level, flat, minlength=top + 1))
    assert sums[0] == 0.0


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.sampled_from([0.3, 1.0]))
def test_what_a_table_makes_of_darkness_is_looked_up(seed, darkest):
    darkness = some_darkness(seed) * np.float32(darkest)
    darkness.flags.writeable = False
    table = np.random.default_rng(seed).random(65_536).astype(np.float32)
    scale = np.float32(65_535 / darkest)
    out = np.empty_like(darkness)
    for start, stop in ((0, 6), (6, len(darkness))):
        look_up_levels(start, stop, darkness, float(scale), table, out)
    level = np.minimum(np.ceil(darkness * scale), np.float32(65_535)).astype(np.uint16)
    assert np.array_equal(out, table[level])


@pytest.mark.parametrize("value", [0.0, 1.0])
def test_white_and_black_have_the_ends(value):
    counts, sums = np.zeros(9), np.zeros(9)
    flat = np.full(5, value, np.float32)
    flat.flags.writeable = False
    count_levels(flat, counts, sums)
    assert counts[8 if value else 0] == 5
    assert counts.sum() == 5
    assert sums.sum() == 5 * value
