"""Adjustments of a picture against a plain formula, and the promise that paper stays bare."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from stippler.drawing.adjustment import NEUTRAL, Adjustment
from stippler.drawing.reference import Reference
from stippler.errors import ParameterError

adjustments = st.builds(
    Adjustment,
    st.floats(-0.9, 0.9),
    st.floats(-1, 1),
    st.floats(0.2, 5),
    st.booleans(),
)
GREYS = np.linspace(0, 1, 301, dtype=np.float32)


def expected(d: float, brightness: float, contrast: float, gamma: float, invert: bool) -> float:
    """Follow the definition, value by value and in double precision."""
    d = 1.0 - d if invert else d
    d = d - brightness if brightness > 0 else d / (1.0 + brightness)
    d = min(max(d, 0.0), 1.0)
    k = 4.0**contrast
    return (d**k / (d**k + (1.0 - d) ** k)) ** gamma


@given(adjustments)
@example(Adjustment(5e-07, -1.0, 1.0, False))
def test_the_field_follows_the_definition(adjustment: Adjustment) -> None:
    a = adjustment
    for d, out in zip(GREYS, adjustment.apply(GREYS), strict=True):
        near = float(d) - 3e-7, float(d) + 3e-7  # curves may be steep, at white and black, too
        ends = sorted(expected(e, a.brightness, a.contrast, a.gamma, a.invert) for e in near)
        assert ends[0] - 1e-5 <= out <= ends[1] + 1e-5


@given(adjustments)
def test_white_is_exactly_white_and_greys_keep_their_order(adjustment: Adjustment) -> None:
    out = adjustment.apply(GREYS)
    assert out.dtype == np.float32
    assert out[-1 if adjustment.invert else 0] == 0.0
    assert out.min() >= 0.0
    assert out.max() <= 1.0
    steps = np.diff(out[::-1] if adjustment.invert else out)
    assert steps.min() >= -1e-6


def test_each_does_what_its_name_says() -> None:
    grey = np.float32([[0.1, 0.4, 0.6, 0.9]])
    lighter = Adjustment(brightness=0.2).apply(grey)
    np.testing.assert_allclose(lighter, [[0.0, 0.2, 0.4, 0.7]], atol=1e-6)
    assert (Adjustment(brightness=-0.2).apply(grey) > grey).all()
    harder = Adjustment(contrast=0.5).apply(grey) - grey
    assert (np.sign(harder) == [[-1, -1, 1, 1]]).all()
    assert (np.sign(Adjustment(contrast=-0.5).apply(grey) - grey) == [[1, 1, -1, -1]]).all()
    assert (Adjustment(gamma=2.0).apply(grey) < grey).all()
    np.testing.assert_allclose(Adjustment(invert=True).apply(grey), 1 - grey, atol=1e-6)
    assert (NEUTRAL.apply(grey) == grey).all()


@pytest.mark.parametrize(
    ("field", "value"),
    [("brightness", 0.95), ("contrast", float("nan")), ("gamma", 0.0), ("gamma", float("inf"))],
)
def test_what_is_out_of_range_is_refused(field: str, value: float) -> None:
    with pytest.raises(ParameterError, match=field):
        Adjustment(**{field: value})


def test_a_reference_is_adjusted_from_the_picture_whatever_was_before() -> None:
    picture = Reference(np.tile(GREYS, (2, 1)), 60.0)
    lighter, darker = Adjustment(brightness=0.3), Adjustment(brightness=-0.3)
    twice = picture.adjusted(lighter).adjusted(darker)
    assert (twice.darkness == picture.adjusted(darker).darkness).all()
    assert (twice.adjustment, twice.width_mm, twice.picture) == (darker, 60.0, picture)
    assert twice.adjusted(darker) is twice
    assert twice.adjusted(NEUTRAL) is picture
    assert not twice.darkness.flags.writeable
