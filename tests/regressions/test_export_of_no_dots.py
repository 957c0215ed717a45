"""Ctrl+S on a page without dots wrote drawing.svg, unasked, over one that was there."""

from pathlib import Path

import pytest

from stippler.drawing.drawing import Page
from stippler.drawing.style import Style
from stippler.editor.session import Session
from stippler.jobs.work import PREPARE, Work
from stippler.jobs.worker import Update
from stippler.ui.popups.file_dialogs import Dialogs
from stippler.ui.popups.filing import Filing
from stippler.ui.preferences import Preferences


class Worker:
    """Ends what it is asked when a test says so."""

    def __init__(self):
        self.n, self.ended = 0, False

    def start(self, run):
        self.n, self.ended = self.n + 1, False
        return self.n

    def poll(self):
        if not self.n or self.ended:
            return None
        self.ended = True
        return Update(self.n, Work(PREPARE), "finished", None, 1)


@pytest.mark.parametrize("ask", ["export", "export_as"])
def test_nothing_is_written(ask):
    exporter = Worker()
    session = Session(
        Worker(), exporter, Style(), tone="linear", width_mm=100.0, stipple=lambda *asked: iter(())
    )
    session.new(Page(50.0, 50.0))
    session.poll()
    assert session.document is not None
    filing = Filing(session, Dialogs(use_native=False), Preferences(), lambda: None)
    getattr(filing, ask)()
    session.export(Path("drawing.svg"), 600.0)
    assert exporter.n == 0
    assert "no dots" in session.messages.log[-1].text
