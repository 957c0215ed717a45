"""A frame that came late was the last: the tooltip that it had begun stayed unseen."""

import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from imgui_bundle import imgui

from stippler.app import App
from stippler.drawing.drawing import Page
from stippler.drawing.style import Style
from stippler.ui.window.scripted_host import Host


@pytest.fixture
def app(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[App]:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    monkeypatch.delenv("STIPPLER_SCALE", raising=False)
    app = App(Style(), tone="linear", width_mm=100.0, size=(1000, 700), offscreen=True)
    try:
        yield app
    finally:
        app.close()


def is_told() -> bool:
    """Return whether a tooltip is seen; in its first frame it is measured, and has no size."""
    window = imgui.internal.find_window_by_name("##Tooltip_00")
    return window is not None and window.active and window.size.x > 40


def test_a_tooltip_comes_by_itself(app: App) -> None:
    host = Host(app.window, app.editor, app.step)
    app.session.new(Page(120.0, 90.0))
    host.until(lambda: app.session.document is not None, "the page")
    host.settle()
    host.move(*host.place("Spray dots"))
    host.move(*host.place("Zoom"))
    host.settle()
    time.sleep(0.7)  # no frame for longer than tooltips take
    deadline = time.monotonic() + 3.0
    while time.monotonic() < deadline and not is_told():
        app.step(0.05)
    assert is_told()
