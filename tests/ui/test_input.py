"""Pointer, keys, view and schedule by scripted events and a clock that is set."""

from __future__ import annotations

import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.drawing.drawing import Page
from stippler.editor.commands import CTRL, Command, Commands, Key
from stippler.editor.events import (
    LEFT,
    MIDDLE,
    RIGHT,
    Event,
    FocusLost,
    KeyDown,
    KeyUp,
    Mods,
    Moved,
    Pressed,
    Released,
    Scrolled,
)
from stippler.editor.messages import ERROR, INFO, Messages
from stippler.editor.pointer import Pointer
from stippler.editor.pointer_states import (
    Change,
    Hand,
    Idle,
    Pan,
    Panning,
    State,
    Turn,
    Turning,
    Zoom,
)
from stippler.editor.schedule import Schedule
from stippler.editor.view import View

PAGE = Page(100.0, 50.0)
SIZE = (800, 600)


def run(state: State, *events: Event) -> tuple[State, list[Change]]:
    changes: list[Change] = []
    for event in events:
        state, more = state.take(event)
        changes += more
    return state, changes


# --- states --------------------------------------------------------------------------------


def test_the_middle_button_pans_until_it_comes_up() -> None:
    state, changes = run(
        Idle(), Pressed(MIDDLE, 10, 10), Moved(15, 12), Moved(20, 9), Released(MIDDLE, 20, 9)
    )
    assert isinstance(state, Idle)
    assert changes == [Pan(5, 2), Pan(5, -3)]
    assert run(state, Moved(50, 50))[1] == []


def test_space_and_the_left_button_pan() -> None:
    state, changes = run(Idle(), KeyDown("space"), Pressed(LEFT, 0, 0), Moved(7, 0))
    assert changes == [Pan(7, 0)]
    state, _ = run(state, Released(LEFT, 7, 0))
    assert isinstance(state, Hand)  # space is still held
    assert isinstance(run(state, KeyUp("space"))[0], Idle)


def test_space_that_comes_up_first_does_not_let_go_of_the_page() -> None:
    state, _ = run(Idle(), KeyDown("space"), Pressed(LEFT, 0, 0), KeyUp("space"))
    assert isinstance(state, Panning)
    state, changes = run(state, Moved(1, 1), Released(LEFT, 1, 1))
    assert changes == [Pan(1, 1)]
    assert isinstance(state, Idle)


SHIFT = Mods(shift=True)


def test_shift_turns_where_a_drag_would_pan() -> None:
    state, changes = run(
        Idle(),
        Pressed(MIDDLE, 10, 10, mods=SHIFT),
        Moved(15, 12),
        Moved(20, 9),
        Released(MIDDLE, 20, 9),
    )
    assert isinstance(state, Idle)
    assert changes == [Turn((10, 10), (15, 12)), Turn((15, 12), (20, 9))]
    state, changes = run(
        Idle(),
        KeyDown("space", SHIFT),
        Pressed(LEFT, 0, 0, mods=SHIFT),
        KeyUp("space"),
        Moved(7, 0),
    )
    assert isinstance(state, Turning)
    assert changes == [Turn((0, 0), (7, 0))]
    assert run(state, FocusLost())[0] == Idle()
    assert run(state, Released(LEFT, 7, 0))[0] == Idle()  # space has come up meanwhile


@pytest.mark.parametrize("button", [LEFT, RIGHT])
def test_other_buttons_do_nothing_yet(button: str) -> None:
    assert run(Idle(), Pressed(button, 0, 0), Moved(9, 9), Released(button, 9, 9)) == (Idle(), [])


def test_another_button_does_not_end_panning() -> None:
    state, changes = run(
        Idle(), Pressed(MIDDLE, 0, 0), Released(LEFT, 0, 0), Pressed(LEFT, 0, 0), Moved(3, 0)
    )
    assert isinstance(state, Panning)
    assert changes == [Pan(3, 0)]


def test_losing_the_keyboard_lets_go_of_everything() -> None:
    assert run(Idle(), KeyDown("space"), Pressed(LEFT, 0, 0), FocusLost()) == (Idle(), [])
    assert run(Idle(), KeyDown("space"), FocusLost()) == (Idle(), [])


def test_the_wheel_zooms_where_the_pointer_is() -> None:
    _, (zoom,) = run(Idle(), Scrolled(0, 2, 30, 40))
    assert isinstance(zoom, Zoom)
    assert zoom.factor == pytest.approx(1.44)
    assert (zoom.x_px, zoom.y_px) == (30, 40)
    assert run(Idle(), Scrolled(3, 0, 30, 40))[1] == []


_EVENTS = st.one_of(
    st.builds(Moved, st.floats(-50, 900), st.floats(-50, 700)),
    st.builds(
        Pressed,
        st.sampled_from([LEFT, MIDDLE, RIGHT]),
        st.floats(0, 800),
        st.floats(0, 600),
        mods=st.sampled_from([Mods(), Mods(shift=True)]),
    ),
    st.builds(
        Released, st.sampled_from([LEFT, MIDDLE, RIGHT]), st.floats(0, 800), st.floats(0, 600)
    ),
    st.builds(Scrolled, st.floats(-9, 9), st.floats(-9, 9), st.floats(0, 800), st.floats(0, 600)),
    st.builds(KeyDown, st.sampled_from(["space", "f"])),
    st.builds(KeyUp, st.sampled_from(["space", "f"])),
    st.just(FocusLost()),
)


@given(st.lists(st.tuples(_EVENTS, st.booleans()), max_size=40))
def test_any_input_leaves_a_sane_view_and_nothing_held(events: list[tuple[Event, bool]]) -> None:
    view = View(PAGE, SIZE)
    pointer = Pointer(view)
    for event, elsewhere in events:
        pointer.take(event, elsewhere=elsewhere)
        view.advance(0.02)
        camera = view.camera
        assert 0 <= camera.center_mm[0] <= PAGE.width_mm
        assert 0 <= camera.center_mm[1] <= PAGE.height_mm
        assert math.isfinite(camera.px_per_mm)
        assert camera.px_per_mm > 0
        assert abs(camera.rotation_rad) <= math.pi
    for event in (Released(LEFT, 0, 0), Released(MIDDLE, 0, 0), KeyUp("space")):
        pointer.take(event, elsewhere=True)
    assert pointer.state == Idle()


def test_a_press_on_a_panel_is_none_of_the_canvas() -> None:
    pointer = Pointer(View(PAGE, SIZE))
    before = pointer._view.camera
    pointer.take(Pressed(MIDDLE, 5, 5), elsewhere=True)
    pointer.take(Moved(50, 5), elsewhere=False)
    pointer.take(Scrolled(0, 1, 50, 5), elsewhere=True)
    assert pointer._view.camera == before
    assert not pointer._view.moving


def test_a_drag_goes_on_over_panels() -> None:
    view = View(PAGE, SIZE)
    pointer = Pointer(view)
    before = view.camera.center_mm[0]
    pointer.take(Pressed(MIDDLE, 400, 300), elsewhere=False)
    pointer.take(Moved(350, 300), elsewhere=True)
    assert view.camera.center_mm[0] == pytest.approx(before + 50 / view.camera.px_per_mm)


def test_the_pointer_knows_its_place_on_the_page() -> None:
    view = View(PAGE, SIZE)
    pointer = Pointer(view)
    pointer.place((300.0, 20.0))
    pointer.take(Moved(300.0 + 400.0, 20.0 + 300.0), elsewhere=False)
    assert pointer.at_mm == pytest.approx((50.0, 25.0))
    pointer.take(Moved(10.0, 20.0), elsewhere=True)
    assert pointer.at_mm is None


# --- view ----------------------------------------------------------------------------------


def test_a_drag_round_the_middle_takes_the_page_along() -> None:
    view = View(PAGE, SIZE)
    view.pan((30, -40))
    held = view.at(650, 300)
    pointer = Pointer(view)
    pointer.take(Pressed(MIDDLE, 650, 300, mods=SHIFT), elsewhere=False)
    for angle in (0.2, 0.9, 1.4, 3.0, -2.5):
        at = (400 + 250 * math.cos(angle), 300 + 250 * math.sin(angle))
        pointer.take(Moved(*at), elsewhere=False)
        assert view.camera.page_to_screen(held, SIZE) == pytest.approx(at)
    turned = view.camera
    pointer.take(Moved(401, 300), elsewhere=False)  # on the axle a pixel would be a leap
    assert view.camera == turned


@given(st.lists(st.sampled_from([-15.0, 15.0, 90.0, 7.5, 180.0, math.nan]), max_size=60))
def test_turns_add_up_without_drift_and_keep_the_middle(turns: list[float]) -> None:
    view = View(PAGE, SIZE)
    view.pan((31, 17))
    before, total = view.camera, 0.0
    for degrees in turns:
        view.turn(math.radians(degrees))
        total += degrees if math.isfinite(degrees) else 0.0
    assert view.camera.center_mm == before.center_mm
    assert view.camera.px_per_mm == before.px_per_mm
    assert math.remainder(math.degrees(view.camera.rotation_rad) - total, 360) == pytest.approx(
        0, abs=1e-9
    )
    view.turn_to(0.0)
    assert view.camera == before


def test_a_flip_mirrors_what_is_seen_and_upright_undoes_it() -> None:
    view = View(PAGE, SIZE)
    view.turn(0.4)
    place = view.camera.page_to_screen((20, 10), SIZE)
    view.flip()
    mirrored = view.camera.page_to_screen((20, 10), SIZE)
    assert mirrored == pytest.approx((800 - place[0], place[1]))
    view.upright()
    assert view.camera == View(PAGE, SIZE).camera


@given(st.floats(-4, 4), st.booleans())
def test_fit_and_zoom_respect_the_turn(angle: float, flip: bool) -> None:
    view = View(PAGE, SIZE)
    view.turn_to(angle)
    if flip:
        view.flip()
    view.fit()
    corners = view.camera.page_to_screen([(0, 0), (100, 0), (100, 50), (0, 50)], SIZE)
    assert corners.min() >= 0
    assert (corners <= SIZE).all()
    place = view.at(250, 330)
    view.zoom(3.0, (250, 330))
    while view.moving:
        view.advance(0.05)
    assert view.at(250, 330) == pytest.approx(place, abs=1e-6)
    view.show_box((10, 10), (12, 11))
    assert view.at(400, 300) == pytest.approx((11, 10.5))
    assert view.camera.px_per_mm > 100


@given(
    st.lists(st.floats(-6, 6), min_size=1, max_size=8),
    st.floats(200, 600),
    st.floats(200, 400),
)
def test_a_smooth_zoom_ends_at_its_target_with_the_point_under_the_cursor(
    notches: list[float], x: float, y: float
) -> None:
    view = View(PAGE, SIZE)
    start = view.camera.px_per_mm
    place = view.at(x, y)
    for notch in notches:
        view.zoom(1.2**notch, (x, y))
    target = start * 1.2 ** sum(notches)
    frames = 0
    while view.advance(0.016):
        frames += 1
        assert frames < 200
    if max(abs(sum(notches[: i + 1])) for i in range(len(notches))) < 8:  # off the limits
        assert view.camera.px_per_mm == pytest.approx(target, rel=1e-6)
        inside = 0 < view.camera.center_mm[0] < 100 and 0 < view.camera.center_mm[1] < 50
        if inside and sum(notches) > 0:
            assert view.at(x, y) == pytest.approx(place, abs=1e-6)


def test_zoom_is_smooth_and_does_not_depend_on_the_frame_rate() -> None:
    views = []
    for n_frames in (3, 30):
        view = View(PAGE, SIZE)
        view.zoom(4.0, (400, 300))
        before = view.camera.px_per_mm
        for _ in range(n_frames):
            view.advance(0.06 / n_frames)
        assert before < view.camera.px_per_mm < 4.0 * before
        views.append(view.camera.px_per_mm)
    assert views[0] == pytest.approx(views[1], rel=1e-6)


@pytest.mark.parametrize("factor", [1e9, 1e-9])
def test_zoom_has_limits(factor: float) -> None:
    view = View(PAGE, SIZE)
    fitted = view.camera.px_per_mm
    view.zoom(factor, (400, 300))
    while view.advance(0.1):
        pass
    assert fitted * 0.099 < view.camera.px_per_mm < 2001
    view.zoom(float("nan"), (0, 0))
    view.zoom(-1.0, (0, 0))
    assert not view.moving


def test_the_page_stays_fitted_until_the_person_moves() -> None:
    view = View(PAGE, SIZE)
    fitted = view.camera
    assert fitted.center_mm == (50, 25)
    view.resize((400, 300))
    assert view.camera.px_per_mm == pytest.approx(fitted.px_per_mm / 2)
    view.pan((10, 0))
    scale = view.camera.px_per_mm
    view.resize(SIZE)
    assert view.camera.px_per_mm == scale
    view.fit()
    assert view.camera == fitted


def test_print_size_and_another_page() -> None:
    view = View(PAGE, SIZE)
    view.print_size(3.78)
    assert view.camera.px_per_mm == 3.78
    view.show(Page(100.0, 50.0))  # the same size: where the person looks is kept
    assert view.camera.px_per_mm == 3.78
    view.show(Page(10.0, 10.0))
    assert view.camera.center_mm == (5, 5)


# --- commands ------------------------------------------------------------------------------


def test_commands_run_by_key_once_and_by_name() -> None:
    ran: list[str] = []
    commands = Commands(
        [
            Command("view.fit", "Fit", lambda: ran.append("fit"), (Key("f"), Key("home"))),
            Command("file.open", "Open", lambda: ran.append("open"), (Key("o", CTRL),)),
        ]
    )
    assert commands.take(KeyDown("home"))
    assert commands.take(KeyDown("home", repeated=True))  # taken, but not run again
    assert not commands.take(KeyDown("o"))
    assert not commands.take(KeyDown("f", Mods(shift=True)))
    assert commands.take(KeyDown("o", CTRL))
    commands["view.fit"].run()
    assert ran == ["fit", "open", "fit"]
    assert commands["file.open"].hint == "Open (Ctrl+O)"
    assert [command.name for command in commands] == ["view.fit", "file.open"]


@pytest.mark.parametrize(
    "second",
    [
        Command("a", "Other", lambda: None, (Key("y"),)),
        Command("b", "Other", lambda: None, (Key("x"),)),
    ],
)
def test_two_commands_do_not_share_a_name_or_a_key(second: Command) -> None:
    with pytest.raises(ValueError, match=r"two commands"):
        Commands([Command("a", "One", lambda: None, (Key("x"),)), second])


# --- schedule ------------------------------------------------------------------------------


def drawn(schedule: Schedule, now: float, cost: float = 0.01, **more: Any) -> int:
    """Draw for as long as a frame is due; return how many were drawn."""
    n = 0
    while schedule.due(now) and n < 50:
        schedule.note_frame(now - cost, now, moving=more.get("moving", False))
        n += 1
    return n


def test_nothing_is_drawn_while_nothing_changes() -> None:
    schedule = Schedule()
    assert drawn(schedule, 0.0) == 5
    assert schedule.sleep_s(0.0) == 10.0
    assert not schedule.due(9.9)
    assert schedule.idle
    schedule.note_result()
    assert not schedule.idle


def test_input_is_drawn_at_once_and_once_more_when_a_tooltip_is_due() -> None:
    schedule = Schedule()
    drawn(schedule, 0.0)
    schedule.note_input()
    assert schedule.sleep_s(1.0) == 0.0
    assert drawn(schedule, 1.0) == 5
    schedule.wake_at(1.5)
    assert schedule.sleep_s(1.0) == pytest.approx(0.5)
    assert drawn(schedule, 1.6) == 1
    assert schedule.sleep_s(1.6) == 10.0


def test_results_wait_as_long_as_a_slow_frame_took() -> None:
    schedule = Schedule()
    drawn(schedule, 1.0, cost=0.06)
    schedule.note_result()
    assert not schedule.due(1.0)
    assert schedule.sleep_s(1.0) == pytest.approx(0.06)
    assert schedule.due(1.061)
    schedule.note_frame(1.061, 1.065, moving=False)  # a fast one
    schedule.note_result()
    assert schedule.due(1.065)
    schedule.note_frame(2.0, 9.0, moving=False)  # something was loaded: no rest of 7 seconds
    schedule.note_result()
    assert schedule.due(9.3)


def test_input_does_not_wait_for_a_slow_frame() -> None:
    schedule = Schedule()
    drawn(schedule, 1.0, cost=0.5)
    schedule.note_result()
    schedule.note_input()
    assert schedule.due(1.0)


def test_motion_goes_on_until_it_ends() -> None:
    schedule = Schedule()
    assert drawn(schedule, 0.0, moving=True) == 50
    assert drawn(schedule, 0.0) == 1


# --- messages ------------------------------------------------------------------------------


def test_messages_go_after_a_while_and_the_log_keeps_them() -> None:
    now = [0.0]
    messages = Messages(lambda: now[0])
    messages.say("one\n  line", INFO)
    assert messages.current is not None
    assert messages.current.text == "one line"
    now[0] = 6.1
    assert messages.current is None
    messages.say("trouble", ERROR)
    assert messages.current is not None
    messages.dismiss()
    assert messages.current is None
    assert messages.left_s == 0.0
    assert [message.text for message in messages.log] == ["one line", "trouble"]


def test_an_error_in_every_frame_is_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    messages = Messages(lambda: 0.0)
    for _ in range(100):
        messages.say("the panel failed", ERROR, ValueError("x"))
        messages.say("the page failed", ERROR, ValueError("y"))
    assert [record.message for record in caplog.records] == ["the panel failed", "the page failed"]
    messages.say("x" * 5000)
    assert len(messages.log[-1].text) == 300
