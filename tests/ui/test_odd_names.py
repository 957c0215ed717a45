"""Pictures and folders whose names are no text, and exports over the picture itself."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from stippler.editor.messages import ERROR
from stippler.ui.preferences import Preferences

from .conftest import Desk


def done(desk: Desk, picture: Path) -> None:
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.host.settle()


@pytest.fixture
def odd(picture: Path, tmp_path: Path) -> Path:
    """A picture in a folder, both named in Latin-1."""
    folder = Path(os.fsdecode(os.fsencode(tmp_path) + b"/b\xfccher"))
    folder.mkdir()
    return Path(shutil.copy(picture, os.fsdecode(os.fsencode(folder) + b"/caf\xe9.png")))


def test_a_name_that_is_no_text_is_opened_exported_and_remembered(desk: Desk, odd: Path) -> None:
    session = desk.app.session
    done(desk, odd)
    assert session.source is not None
    assert session.source.path == odd
    assert session.name == "caf\N{REPLACEMENT CHARACTER}.png"
    filing = desk.app.editor.popups.filing
    assert [command.label for command in filing.recent()] == [f"Open {session.name}"]
    desk.host.key("p", ctrl=True, shift=True)
    desk.host.type("caf")
    desk.host.key("escape")
    session.export(odd.with_suffix(".csv"), 300.0)
    desk.host.until(lambda: not session.exporting, "the export")
    desk.host.settle()
    assert odd.with_suffix(".csv").exists()
    desk.host.key("o", ctrl=True)  # a dialog in that folder
    desk.host.settle()
    desk.host.key("escape")
    kept = Preferences(odd.parent)
    kept.note_opened(odd)
    kept.keep()
    assert Preferences.load(odd.parent).recent == [odd]


def test_an_export_over_the_picture_is_refused(desk: Desk, picture: Path, tmp_path: Path) -> None:
    photo = Path(shutil.copy(picture, tmp_path / "photo.png"))
    before = photo.read_bytes()
    done(desk, photo)
    desk.app.session.export(photo, 300.0)
    desk.host.until(lambda: not desk.app.session.exporting, "the export")
    assert photo.read_bytes() == before
    assert desk.app.session.messages.log[-1].level == ERROR
    assert "the very file that is read" in desk.app.session.messages.log[-1].text
