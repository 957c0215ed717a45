"""Before and after, a picture to draw after by hand, rulers, the navigator, dropped files."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from stippler.drawing.drawing import Page
from stippler.editor.view import View
from stippler.ui.canvas.rulers import mm_along, tick_steps


@pytest.fixture
def by_hand(desk, picture: Path):
    """A picture open as reference only, with a stroke of spray on it."""
    filing, session = desk.app.editor.popups.filing, desk.app.session
    filing.open_reference(picture)
    desk.host.until(lambda: session.phase == "done" and session.reference is not None, "the page")
    desk.host.settle()
    return desk


def test_a_picture_only_to_draw_after(by_hand) -> None:
    session = by_hand.app.session
    assert session.n_dots == 0
    assert by_hand.app.editor.look.reference_shown
    assert "reference only" in by_hand.host.said()
    by_hand.host.key("a")
    by_hand.host.click((650, 330))
    assert session.n_dots == 1
    by_hand.app.editor.commands["work.start"].run()  # and it can be stippled all the same
    by_hand.host.until(lambda: session.phase == "done" and session.n_dots > 100, "the dots")


def test_keys_show_the_picture_and_what_was_before(by_hand) -> None:
    host, session, look = by_hand.host, by_hand.app.session, by_hand.app.editor.look
    host.key("a")
    host.click((650, 330))
    document = session.document
    plain = host.screenshot()
    host.key_down("d", shift=True)
    host.settle()
    assert look.peek == "picture"
    assert (host.screenshot() != plain).any()
    host.key_up("d", shift=True)
    host.settle()
    assert look.peek == ""
    host.key_down("z", shift=True)
    assert len(document.dots) == 0
    host.key_up("z", shift=True)
    assert len(document.dots) == 1
    host.key_down("z", shift=True)
    host.click((700, 330))  # a hand on the canvas ends it, and the step is not lost
    assert len(document.dots) == 2
    assert document.history.n_done == 2
    host.key_up("z", shift=True)
    assert len(document.dots) == 2


def test_the_navigator_moves_what_is_seen(by_hand) -> None:
    host, editor = by_hand.host, by_hand.app.editor
    editor.commands["view.navigator"].run()
    editor.commands["view.rulers"].run()
    editor.view.zoom_to(8.0 * editor.view.camera.px_per_mm)
    host.move(650, 330)
    host.settle()
    x0, y0, x1, y1 = editor.widgets.marks["navigator"]
    host.click((x0 + 0.25 * (x1 - x0), y0 + 0.25 * (y1 - y0)))
    page = by_hand.app.session.drawing.page
    quarter = (0.25 * page.width_mm, 0.25 * page.height_mm)
    assert editor.view.camera.center_mm == pytest.approx(quarter, abs=1.5)


def test_several_files_are_told_of(desk, picture: Path, tmp_path: Path) -> None:
    others = [tmp_path / f"{k}.png" for k in range(2)]
    desk.host.drop(picture, *others)
    assert any(
        "disc.png is opened" in line.text and "0.png, 1.png are not" in line.text
        for line in desk.app.session.messages.log
    )


@pytest.mark.parametrize("quarter", [0, 1, 2, 3])
@pytest.mark.parametrize("flip", [False, True])
def test_rulers_tell_the_pages_own_mm(quarter: int, flip: bool) -> None:
    view = View(Page(120.0, 90.0), (800, 600))
    view.turn_to(quarter * math.pi / 2)
    if flip:
        view.flip()
    for axis in (0, 1):
        first, per_px = mm_along(view, axis)
        for px in (0.0, 123.0, 456.0):
            at = view.at(*((px, 300.0) if axis == 0 else (400.0, px)))
            own = at[axis if quarter % 2 == 0 else 1 - axis]
            assert first + px * per_px == pytest.approx(own, abs=1e-6)


def test_ticks_are_round_numbers_with_room() -> None:
    for px_per_mm in (0.01, 0.37, 4.0, 55.0, 2000.0):
        label, tick = tick_steps(px_per_mm, 1.0)
        assert label * px_per_mm >= 56.0
        assert tick == label or tick * px_per_mm >= 7.0
        assert round(label / 10 ** math.floor(math.log10(label)), 6) in (1, 2, 5)
