"""Filling a page that has no picture, in the window."""

from __future__ import annotations

from stippler.drawing.drawing import Page


def test_a_new_page_is_filled_and_emptied_again(desk) -> None:
    session = desk.app.session
    session.fill()
    assert "no page to fill" in desk.host.said()
    session.new(Page(100.0, 80.0))
    desk.host.until(lambda: session.paintable, "the page")
    desk.host.settle()
    desk.host.fill("Fill with", "500")
    desk.host.click("By chance")
    desk.host.fill("Dot radius", "0.8")
    desk.host.click("Fill the page")
    desk.host.until(lambda: session.n_dots == 500 and not session.busy, "the dots")
    session.undo()
    assert session.n_dots == 0
