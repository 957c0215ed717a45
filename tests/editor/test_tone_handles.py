"""Handles of the tone curve: where they lie, and that the curve follows them."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.drawing.adjustment import GAMMA_RANGE, MIN_SPAN, NEUTRAL, Adjustment
from stippler.editor.tone_handles import Handle, ink_at, let_go, moved, nearest, place_of

SHARES = st.floats(0.0, 1.0)


@st.composite
def adjustments(draw: st.DrawFn) -> Adjustment:
    white = draw(st.integers(0, 90)) / 100
    black = draw(st.integers(round(100 * white) + 5, 100)) / 100
    return Adjustment(
        draw(st.integers(-60, 60)) / 100,
        draw(st.integers(-80, 80)) / 100,
        draw(st.floats(0.3, 3.0)),
        draw(st.booleans()),
        white,
        black,
    )


@given(adjustments(), st.sampled_from(Handle), st.floats(-1.0, 2.0), st.floats(-1.0, 2.0))
def test_any_drag_gives_a_curve_that_can_be_used(now, handle, x, y) -> None:
    after = moved(handle, (x, y), now)
    assert after.black - after.white >= MIN_SPAN - 1e-9
    assert (after.brightness, after.contrast, after.invert) == (
        now.brightness,
        now.contrast,
        now.invert,
    )
    tone = now.invert - x if now.invert else x
    if handle is Handle.WHITE and 0.0 <= tone <= now.black - MIN_SPAN:
        assert place_of(handle, after)[0] == pytest.approx(x, abs=0.0051)
    if handle is Handle.BLACK and now.white + MIN_SPAN <= tone <= 1.0:
        assert place_of(handle, after)[0] == pytest.approx(x, abs=0.0051)


@given(adjustments(), SHARES, st.floats(0.01, 0.99))
def test_the_curve_goes_through_where_it_is_dragged_to(now, x, y) -> None:
    after = moved(Handle.MIDDLE, (x, y), now)
    straight = ink_at(x, Adjustment(now.brightness, now.contrast, 1.0, now.invert, *ends(now)))
    if not 0.01 < straight < 0.99:
        return
    if GAMMA_RANGE[0] < after.gamma < GAMMA_RANGE[1]:  # two decimals of the power are kept
        assert ink_at(x, after) == pytest.approx(y, abs=0.025)
    else:
        assert (ink_at(x, after) - y) * (ink_at(x, now) - y) >= 0.0  # as near as powers go


def ends(now: Adjustment) -> tuple[float, float]:
    return now.white, now.black


@given(adjustments())
def test_the_ends_and_the_middle_lie_on_the_curve(now) -> None:
    plain = Adjustment(0.0, 0.0, 1.0, now.invert, *ends(now))
    out = -1e-4 if now.invert else 1e-4  # towards black: a hair beyond either end
    assert ink_at(place_of(Handle.WHITE, plain)[0] - out, plain) == 0.0
    assert ink_at(place_of(Handle.WHITE, plain)[0] + out, plain) > 0.0
    assert ink_at(place_of(Handle.BLACK, plain)[0] + out, plain) == 1.0
    assert ink_at(place_of(Handle.BLACK, plain)[0] - out, plain) < 1.0
    tone, ink = place_of(Handle.MIDDLE, now)
    assert 0.0 <= tone <= 1.0
    assert ink_at(tone, now) == ink


@given(adjustments())
def test_what_is_let_go_is_where_it_was_at_first(now) -> None:
    for handle in Handle:
        now = let_go(handle, now)
    assert (now.white, now.black, now.gamma) == (NEUTRAL.white, NEUTRAL.black, NEUTRAL.gamma)


def test_a_press_beyond_an_end_takes_the_end() -> None:
    now = Adjustment(white=0.3, black=0.6)
    assert nearest((0.1, 0.9), now) is Handle.WHITE
    assert nearest((0.7, 0.1), now) is Handle.BLACK
    assert nearest((0.5, 0.1), now) is Handle.MIDDLE
    turned = Adjustment(invert=True, white=0.3, black=0.6)
    assert nearest((0.9, 0.5), turned) is Handle.WHITE
    assert nearest((0.1, 0.5), turned) is Handle.BLACK
