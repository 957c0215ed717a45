"""When the lens is there and where it lies; no window."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.drawing.drawing import Page
from stippler.editor.events import Event, FocusLost, KeyDown, KeyUp
from stippler.editor.view import View
from stippler.ui.canvas.lens import LensKey, place_lens
from stippler.ui.look import Look

SIZE = (800, 600)


class Hands:
    """A lens whose keys are z and q."""

    def __init__(self) -> None:
        self.look = Look()
        self.key = LensKey(self.look)

    def take(self, *events: Event) -> str:
        for event in events:
            self.key.take(event)
            if isinstance(event, KeyDown) and not event.repeated:
                self.key.switch({"z": "reduce", "q": "magnify"}[event.key])
                self.key.note_frame(event.t_s)
        return self.look.lens


def test_a_tap_leaves_the_lens_there_until_the_next() -> None:
    hands = Hands()
    assert hands.take(KeyDown("z", t_s=1.0), KeyUp("z", t_s=1.1)) == "reduce"
    assert hands.take(KeyDown("q", t_s=2.0), KeyUp("q", t_s=2.1)) == "magnify"
    assert hands.take(KeyDown("q", t_s=3.0), KeyUp("q", t_s=9.0)) == "none"


def test_a_held_key_shows_it_for_so_long_and_gives_back_what_was_there() -> None:
    hands = Hands()
    assert hands.take(KeyDown("z", t_s=1.0), KeyDown("z", repeated=True, t_s=1.4)) == "reduce"
    assert hands.key.is_held
    assert hands.take(KeyUp("z", t_s=2.0)) == "none"
    hands.take(KeyDown("q", t_s=3.0), KeyUp("q", t_s=3.1))
    assert hands.take(KeyDown("z", t_s=4.0)) == "reduce"
    assert hands.take(KeyUp("q", t_s=4.5)) == "reduce"  # another key
    assert hands.take(KeyUp("z", t_s=5.0)) == "magnify"
    assert not hands.key.is_held


def test_a_tap_during_a_slow_frame_is_a_tap() -> None:
    hands = Hands()
    hands.key.take(KeyDown("z", t_s=1.0))
    hands.key.switch("reduce")
    hands.key.note_frame(2.0)  # the key came up meanwhile; it is heard of now
    hands.key.note_frame(2.1)
    assert hands.take(KeyUp("z", t_s=2.2)) == "reduce"


def test_a_lost_focus_lets_go() -> None:
    hands = Hands()
    assert hands.take(KeyDown("z", t_s=1.0), FocusLost()) == "none"
    assert hands.take(KeyUp("z", t_s=1.1)) == "none"


def test_a_switch_by_the_mouse_is_no_key_that_is_held() -> None:
    hands = Hands()
    hands.key.take(KeyUp("z", t_s=0.5))
    hands.key.switch("reduce")
    assert not hands.key.is_held
    assert hands.take(KeyUp("z", t_s=9.0)) == "reduce"


def test_the_wheel_takes_the_next_strength_of_the_lens_that_is_held() -> None:
    hands = Hands()
    hands.take(KeyDown("z"))
    for notches in (1.0, 2.0, 0.0):
        hands.key.strengthen(notches)
    assert (hands.look.reduction, hands.look.magnification) == (8, 4)
    assert hands.look.lens_factor == 1 / 8
    hands.take(KeyDown("q"))
    hands.key.strengthen(-1.0)
    assert (hands.look.reduction, hands.look.magnification) == (8, 2)
    assert hands.look.lens_factor == 2.0


@given(
    st.floats(0, 800), st.floats(0, 600), st.sampled_from([1 / 8, 0.5, 4]), st.floats(-3, 3),
    st.booleans(),
)  # fmt: skip
def test_the_page_under_the_pointer_is_in_the_middle_of_the_lens(
    x: float, y: float, factor: float, angle: float, flip: bool
) -> None:
    view = View(Page(100.0, 50.0), SIZE)
    view.turn_to(angle)
    if flip:
        view.flip()
    glass = place_lens(view, (x, y), factor, 240.0, None)
    assert glass.diameter_px == 240
    assert abs(glass.corner_px[0] + 120 - x) <= 0.5
    assert abs(glass.corner_px[1] + 120 - y) <= 0.5
    for dx, dy in ((0, 0), (30, 0), (0, 30)):
        seen = glass.camera.page_to_screen(view.at(x + dx, y + dy), (240, 240))
        assert seen == pytest.approx((120 + factor * dx, 120 + factor * dy), abs=0.501)


def test_it_shows_the_same_until_it_has_moved_by_one_of_its_pixels() -> None:
    view = View(Page(100.0, 50.0), SIZE)
    view.turn_to(0.3)
    seen = [place_lens(view, (300.0 + x, 200.0), 0.25, 240.0, None).camera for x in range(40)]
    assert len(set(seen)) == pytest.approx(14, abs=4)
    corners = [camera.page_to_screen((0.0, 0.0), (240, 240)) for camera in seen]
    assert np.ptp(np.mod(np.add(corners, 0.5), 1.0), axis=0).max() < 1e-6  # the same phase


@given(st.floats(0, 800), st.floats(0, 600), st.floats(0, 60), st.floats(100, 480))
def test_beside_a_brush_it_lies_on_the_canvas_and_off_the_brush(
    x: float, y: float, reach: float, diameter: float
) -> None:
    view = View(Page(100.0, 50.0), SIZE)
    glass = place_lens(view, (x, y), 0.25, diameter, reach)
    d, (left, top) = glass.diameter_px, glass.corner_px
    assert 0 <= left <= SIZE[0] - d
    assert 0 <= top <= SIZE[1] - d
    if d < 200 and reach < 30:  # there is room on one side or another
        away = ((left + d / 2 - x) ** 2 + (top + d / 2 - y) ** 2) ** 0.5
        assert away >= d / 2 + reach
    assert view.at(x, y) == pytest.approx(glass.camera.center_mm, abs=1 / glass.camera.px_per_mm)


def test_it_is_never_larger_than_the_canvas() -> None:
    view = View(Page(100.0, 50.0), (90, 41))
    glass = place_lens(view, (10, 10), 0.25, 480.0, None)
    assert glass.diameter_px == 40


def test_a_look_that_was_kept_begins_in_range() -> None:
    look = Look(lens="kaleidoscope", reduction=3000, magnification=-1, dots_shown=False)
    look.lens_diameter = math.nan
    look.begin()
    assert (look.lens, look.reduction, look.magnification) == ("none", 8, 2)
    assert look.dots_shown
    assert 100 <= look.lens_diameter <= 480
    kept = Look(lens="reduce", reduction=2, lens_diameter=300.0)
    kept.begin()
    assert kept == Look(lens="reduce", reduction=2, lens_diameter=300.0)
