"""The first warning of a window was built and not drawn, until the pointer moved."""

import numpy as np

from stippler.app import App
from stippler.drawing.drawing import Page
from stippler.drawing.style import Style
from stippler.editor.messages import WARNING
from stippler.ui.window.scripted_host import Host


def test_it_is_drawn_without_any_input(kernels, monkeypatch, tmp_path):
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    app = App(Style(n_dots=300), tone="linear", width_mm=120.0, size=(1000, 700), offscreen=True)
    host = Host(app.window, app.editor, app.step)
    try:
        app.session.new(Page(60.0, 50.0))
        host.until(lambda: not app.session.busy, "a page")
        host.settle()
        below = host.screenshot()[610:650, 430:960]
        app.session.messages.say("one.stipple is open in another window", WARNING)
        app.editor._schedule.note_result()  # as whatever says something does
        for _ in range(10):
            app.step(0.02)
        assert np.abs(host.screenshot()[610:650, 430:960].astype(int) - below).max() > 100
    finally:
        app.close()
