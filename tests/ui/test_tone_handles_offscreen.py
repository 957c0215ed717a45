"""The tone curve, dragged over its histogram in the window."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from stippler.drawing.adjustment import NEUTRAL


@pytest.fixture
def tones(desk, tmp_path):
    """An editor with a drawing of a picture of all greys, its tones in sight."""
    path = tmp_path / "greys.png"
    Image.fromarray(np.tile(np.arange(256, dtype=np.uint8), (180, 1))).save(path)
    desk.host.drop(path)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.host.settle()
    if not desk.host.shown("Tones"):
        desk.host.click("More tones")
    desk.host.bring("Tones")
    return desk


def drag(desk, name: str, dx: float, dy: float) -> None:
    """Drag a handle by shares of the plot, to the right and up."""
    x0, y0, x1, y1 = desk.app.editor.widgets.marks["Tones"]
    knob = 9.0 * desk.app.editor.widgets.scale
    x, y = desk.host.place(name)
    to = (x + dx * (x1 - x0 - knob), y - dy * (y1 - y0 - knob))
    desk.host.drag((x, y), to, "left")


def test_ends_and_middle_are_dragged_and_the_picture_follows(tones) -> None:
    host, session = tones.host, tones.app.session
    tones.app.editor.look.dots_shown, tones.app.editor.look.opacity = False, 1.0
    host.settle()
    before = host.screenshot()
    drag(tones, "White point", 0.25, 0.0)
    assert session.adjustment.white == pytest.approx(0.25, abs=0.015)
    drag(tones, "Black point", -0.25, -0.5)
    assert session.adjustment.black == pytest.approx(0.75, abs=0.015)
    assert session.adjustment.gamma == 1.0
    drag(tones, "Middle tones", 0.0, 0.25)
    assert 0.5**session.adjustment.gamma == pytest.approx(0.75, abs=0.015)
    left, top, right, bottom = host.canvas()
    was, now = (p[(top + bottom) // 2, left:right].mean(1) for p in (before, host.screenshot()))
    columns = np.flatnonzero((was < 250) & (was > 5))
    shown = columns[len(columns) // 8 : -len(columns) // 8]
    assert np.abs(now[shown] - was[shown]).max() > 20  # live, without new dots
    assert session.reference.adjustment == NEUTRAL
    host.click("Use for the dots")
    host.until(lambda: session.reference.adjustment == session.adjustment, "the new dots")
    host.until(lambda: session.phase == "done", "the end")
    tones.app.editor.look.dots_shown = True
    host.key("z", ctrl=True)
    assert session.reference.adjustment == NEUTRAL  # the dots of before


def test_the_curve_is_taken_anywhere_and_a_press_alone_changes_nothing(tones) -> None:
    host, session = tones.host, tones.app.session
    x0, y0, x1, y1 = tones.app.editor.widgets.marks["Tones"]
    at = (x0 + 0.3 * (x1 - x0), y0 + 0.2 * (y1 - y0))
    host.click(at)
    assert session.adjustment == NEUTRAL
    at = (at[0] + 12.0, at[1])  # not where it was pressed: that would be a double click
    host.drag(at, (at[0], at[1] + 0.15 * (y1 - y0)), "left")
    assert session.adjustment.gamma == pytest.approx(np.log(0.2) / np.log(0.35), abs=0.2)
    host.drag((at[0] + 12.0, at[1]), (at[0] + 12.0, at[1] - 20 * y1), "left")
    assert session.adjustment.gamma == 0.2  # held


def test_a_double_click_puts_a_handle_back(tones) -> None:
    session = tones.app.session
    drag(tones, "White point", 0.4, 0.0)
    drag(tones, "Middle tones", 0.0, -0.2)
    gamma = session.adjustment.gamma
    assert gamma > 1.0
    for name in ("White point", "Middle tones"):
        with tones.host.batch():
            tones.host.click(tones.host.place(name))
            tones.host.click(tones.host.place(name))
        assert session.adjustment.white == 0.0
        assert session.adjustment.gamma == (gamma if name == "White point" else 1.0)


def test_keys_go_to_the_handle_in_use(tones) -> None:
    host, session = tones.host, tones.app.session
    host.click(host.place("White point"))
    host.key("right")
    host.key("right", shift=True)
    assert session.adjustment.white == 0.1
    host.move(*host.place("Black point"))
    host.type("70")
    host.key("enter")
    assert session.adjustment.black == 0.7
    host.click(host.place("Middle tones"))
    host.key("up")
    assert session.adjustment.gamma > 1.0
