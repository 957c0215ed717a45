"""The drawing never lives on the GPU alone: a context made anew shows the same, to the bit."""

from __future__ import annotations

import moderngl
import numpy as np
import pytest

from stippler.ui.panels.layout import SHAPE
from stippler.ui.window.window import Window

PLACE = (650.0, 330.0)
_STATUS = 28


@pytest.fixture
def painted(desk, picture):
    """A drawing with marks, its picture under it, turned and through the lens, with a stroke."""
    host, editor = desk.host, desk.app.editor
    host.drop(picture)
    host.until(lambda: desk.app.session.phase == "done", "the drawing")
    editor.show_panel(SHAPE)
    for key in ("period", "r", "x", "a"):
        host.key(key)
    host.drag(PLACE, (PLACE[0] + 80, PLACE[1] + 40), "left")
    host.key("a", ctrl=True)
    host.key("q")
    host.move(*PLACE)
    desk.app.session.messages.dismiss()
    host.settle()
    return desk


def pixels(host) -> np.ndarray:
    """Return what is seen but for the status line, which counts frames."""
    return host.screenshot()[:-_STATUS]


def test_a_context_made_anew_shows_the_same(painted) -> None:
    host, app = painted.host, painted.app
    before, ctx = pixels(host), app.window.ctx
    assert before.std() > 10
    app.editor.renew_graphics()
    host.move(*PLACE)
    host.settle()
    assert app.window.ctx is not ctx
    assert np.array_equal(pixels(host), before)


def test_a_driver_that_is_reset_within_a_stroke_loses_nothing(painted, monkeypatch) -> None:
    """The stroke ends; all before it stays; work goes on in the same window."""
    host, app = painted.host, painted.app
    host.key("escape")
    host.key("a")
    host.move(*PLACE)
    host.press()
    host.move(PLACE[0] + 30, PLACE[1])
    n = len(app.session.document.dots)
    lost = iter([True])
    monkeypatch.setattr(Window, "is_lost", property(lambda _: next(lost, False)))
    host.move(PLACE[0] + 31, PLACE[1])
    host.settle()
    assert "reset" in host.said()
    assert not app.session.document.in_stroke
    assert len(app.session.document.dots) == n
    host.drag((PLACE[0], PLACE[1] + 60), (PLACE[0] + 60, PLACE[1] + 60), "left")
    assert len(app.session.document.dots) > n
    app.session.messages.dismiss()
    host.move(*PLACE)
    host.settle()
    seen = pixels(host)
    app.editor.renew_graphics()
    host.move(*PLACE)
    host.settle()
    assert np.array_equal(pixels(host), seen)


def test_a_lost_context_that_refuses_everything_is_left(painted, monkeypatch) -> None:
    host, app = painted.host, painted.app
    before = pixels(host)

    def refuse(*_):
        raise moderngl.Error("context lost")

    monkeypatch.setattr(type(app.editor.canvas), "close", refuse)
    app.editor.renew_graphics()
    monkeypatch.undo()
    host.move(*PLACE)
    host.settle()
    assert np.array_equal(pixels(host), before)
