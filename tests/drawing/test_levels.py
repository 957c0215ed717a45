"""A picture is kept once, as levels and what they are: to the bit, or to the nearest step."""

import hashlib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.adjustment import Adjustment
from stippler.drawing.levels import N_LEVELS, Levels
from stippler.drawing.reference import Picture, Reference
from stippler.errors import ParameterError

CHANGE = Adjustment(brightness=0.1, contrast=0.3, gamma=1.4)


def some_values(n, shape=(300, 310), seed=1):
    """Return a field that has just so many different values."""
    rng = np.random.default_rng(seed)
    values = np.unique(rng.random(2 * n + 10).astype(np.float32))
    chosen = rng.permutation(values)[:n]
    flat = np.concatenate([chosen, rng.choice(chosen, shape[0] * shape[1] - n)])
    return rng.permutation(flat).reshape(shape)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.floats(0.0, 1.0, width=32), min_size=1, max_size=40))
def test_few_values_are_kept_to_the_bit(values):
    darkness = np.array(values, np.float32)[None]
    levels = Levels.of(darkness)
    assert levels.darkness().tobytes() == darkness.tobytes()
    assert len(levels.values) == len(np.unique(darkness.view(np.uint32)))


@pytest.mark.parametrize("n", [1, 256, N_LEVELS - 1, N_LEVELS])
def test_as_many_values_as_there_are_levels_are_kept_to_the_bit(n):
    darkness = some_values(n)
    levels = Levels.of(darkness)
    assert len(levels.values) == n
    assert levels.darkness().tobytes() == darkness.tobytes()
    assert levels.of_pixel.max() == n - 1


def test_more_values_are_rounded_once_and_then_stay():
    darkness = some_values(N_LEVELS + 1)
    levels = Levels.of(darkness)
    assert np.abs(levels.darkness().astype(np.float64) - darkness).max() <= 0.52 / (N_LEVELS - 1)
    assert np.array_equal(Levels.of(levels.darkness()).darkness(), levels.darkness())


def test_parts_of_a_picture_are_what_the_whole_is_there():
    levels = Levels.of(some_values(9000))
    whole = levels.darkness()
    assert np.array_equal(levels.darkness(slice(7, 90), slice(3, 9)), whole[7:90, 3:9])
    assert np.array_equal(levels.darkness(slice(None, None, 7)), whole[::7])
    assert np.array_equal(np.concatenate(list(levels.bands())), whole)
    with pytest.raises(ValueError, match="read-only"):
        whole[0, 0] = 1.0


def test_an_adjustment_of_values_is_that_of_each_pixel():
    darkness = some_values(5000)
    adjusted = Reference(darkness, 40.0).adjusted(CHANGE)
    assert adjusted.darkness.tobytes() == CHANGE.apply(darkness).tobytes()
    assert adjusted.source.levels.of_pixel is adjusted.levels.of_pixel


def test_tables_are_looked_up_as_the_nearest_even_steps():
    darkness = some_values(700)
    levels = Levels.of(darkness)
    nearest = Levels.rounded(darkness)
    seen = levels.table(CHANGE.apply, np.square)[levels.of_pixel]
    assert np.array_equal(seen, nearest.table(CHANGE.apply, np.square)[nearest.of_pixel])
    assert np.array_equal(levels.seen_through(CHANGE.apply, np.square).darkness(), seen)


@pytest.mark.parametrize("n", [5, N_LEVELS + 1])
def test_a_digest_is_that_of_all_values(n):
    picture = Picture.of(some_values(n), "perceptual")
    darkness = picture.levels.darkness()
    told = hashlib.blake2b(f"perceptual {darkness.shape}".encode(), digest_size=16)
    told.update(darkness)
    assert picture.digest == told.hexdigest()


def test_a_field_of_an_earlier_version_is_found_by_its_digest():
    darkness = some_values(N_LEVELS + 1)
    told = hashlib.blake2b(f"linear {darkness.shape}".encode(), digest_size=16)
    told.update(darkness)
    rounded = Picture.of(darkness, digest=told.hexdigest())
    assert rounded.digest == told.hexdigest() != Picture.of(darkness).digest
    assert Picture.of(darkness, digest="../other").digest == Picture.of(darkness).digest


def test_a_large_picture_is_kept_once():
    """Two bytes a pixel, adjusted or not; it was six, and four more for each adjustment."""
    reference = Reference(some_values(256, (1000, 1200)), 100.0)
    adjusted = reference.adjusted(CHANGE)
    assert adjusted.at(np.ones((1, 2))).shape == (1,)
    assert adjusted.table(np.square).shape == (N_LEVELS,)
    assert reference.source.levels.nbytes <= 2 * 1_200_000 + 4 * N_LEVELS
    assert adjusted.source is reference.source
    assert adjusted.values.nbytes <= 4 * N_LEVELS


def test_what_is_no_darkness_is_refused():
    with pytest.raises(ParameterError, match="2-d field"):
        Levels(np.zeros(3, np.uint16), np.zeros(1, np.float32))
    with pytest.raises(ParameterError, match=r"0\.\.1"):
        Levels(np.zeros((1, 3), np.uint16), np.full(1, 1.5, np.float32))
