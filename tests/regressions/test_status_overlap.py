"""In a narrow window the fields of the status bar lay over the text at its left."""

from pathlib import Path

import pytest

from stippler.app import App
from stippler.drawing.style import Style
from stippler.ui.panels import status
from stippler.ui.window.scripted_host import Host


def test_fields_without_room_are_left_out() -> None:
    fields = [("12 dots", 96.0, ""), ("1:1", 60.0, ""), ("9 frames/s", 84.0, "")]
    assert status.fitting(fields, 240.0) == fields
    assert status.fitting(fields, 239.0) == fields[:2]
    assert status.fitting(fields, 95.0) == []


def test_a_long_message_leaves_the_last_fields_their_room(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    monkeypatch.delenv("STIPPLER_SCALE", raising=False)
    drawn: list[int] = []
    draw = status._draw_fields
    monkeypatch.setattr(
        status, "_draw_fields", lambda w, f, *more: (drawn.append(len(f)), draw(w, f, *more))[1]
    )
    app = App(Style(), tone="linear", width_mm=100.0, size=(480, 400), offscreen=True)
    try:
        host = Host(app.window, app.editor, app.step)
        app.editor.view.turn(0.3)  # which is told, too
        host.move(310, 200)
        app.session.messages.say(
            "/a/path/that/takes/all/the/room/there/is/and/more/drawing.svg is written"
        )
        host.move(300, 200)
    finally:
        app.close()
    assert drawn[-1] == status._KEPT < max(drawn)  # the message is shortened beside them
