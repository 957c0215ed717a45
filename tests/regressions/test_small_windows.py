"""A window made smaller than 320 was called broken settings at the next start.

And the panel of shapes failed where a window left no room for it.
"""

from pathlib import Path

import pytest

from stippler.app import App
from stippler.drawing.style import Style
from stippler.editor.messages import ERROR
from stippler.ui.panels.layout import SHAPE
from stippler.ui.window.placement import SMALLEST, Place
from stippler.ui.window.scripted_host import Host


def test_a_small_window_is_larger_the_next_time() -> None:
    kept = Place((200, 500)).as_dict()
    assert Place.from_dict(kept) == Place((SMALLEST, 500))


@pytest.mark.parametrize("size", [(200, 150), (1, 1)])
def test_every_panel_draws(size, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    monkeypatch.setenv("STIPPLER_SCALE", "3")
    app = App(Style(), tone="linear", width_mm=100.0, size=size, offscreen=True)
    try:
        host = Host(app.window, app.editor, app.step)
        for name in (SHAPE, *app.editor.panels.names):
            app.editor.show_panel(name)
            host.settle()
        assert not [line.text for line in app.session.messages.log if line.level == ERROR]
    finally:
        app.close()
