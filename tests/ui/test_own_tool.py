"""A tool in one file is in strip, palette, panel and canvas; here, one that a test makes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from stippler.app import App
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Page
from stippler.drawing.parameter import by_default
from stippler.drawing.style import Style
from stippler.editor.events import LEFT, FocusLost, KeyDown, Moved, Pressed, Released
from stippler.editor.tools import toolbox as toolbox_module
from stippler.editor.tools.cards import Card
from stippler.editor.tools.tool import NOTHING, RESTING, Handle, Overlay, Path, Tool
from stippler.ui.window.scripted_host import Host


class RowTool(Tool):
    """Sets a row of dots from press to release."""

    @property
    def parameters(self):
        return (by_default("n_dots", "Dots", 5.0, "In the row.", 1, 50),)

    def begin(self, event, desk):
        if isinstance(event, Pressed) and event.button == LEFT:
            return Rowing(self, desk.at(event), desk.at(event))
        return None

    def overlay(self, sight):
        return Overlay(handles=(Handle(sight.at_mm),)) if sight.at_mm else NOTHING


@dataclass(slots=True)
class Rowing:
    tool: RowTool
    start: tuple[float, float]
    end: tuple[float, float]

    def take(self, event, desk):
        match event:
            case Moved():
                self.end = desk.at(event)
            case Released(button="left"):
                if self.end == self.start:
                    raise RuntimeError("no row")
                desk.document.begin("Row")
                n = round(self.tool.value("n_dots"))
                desk.document.insert(Dots.round(np.linspace(self.start, self.end, n), 0.2))
                desk.document.commit()
                return RESTING
            case KeyDown(key="escape") | FocusLost():
                return RESTING
        return self

    @property
    def overlay(self):
        return Overlay((Path((self.start, self.end), dashed=True),))

    def cancel(self, desk):
        pass


ROW = Card("row", "Row of dots", "n", "Drag a row of dots.", RowTool)


@pytest.fixture
def host(kernels: None, monkeypatch, tmp_path):
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    every = toolbox_module.all_cards
    monkeypatch.setattr(toolbox_module, "all_cards", lambda shelf: (*every(shelf), ROW))
    made = []

    def start() -> Host:
        style = Style(n_dots=300, iterations=4)
        app = App(style, tone="linear", width_mm=120.0, size=(1000, 700), offscreen=True)
        made.append(app)
        host = Host(app.window, app.editor, app.step)
        host.app = app
        app.session.new(Page(120.0, 90.0))
        host.until(lambda: app.session.document is not None, "the page")
        return host

    yield start
    made[-1].close()


def test_a_tool_of_one_file_is_everywhere(host) -> None:
    hands = host()
    hands.click("Row of dots")  # in the strip, by its letter
    assert hands.app.editor.painting.toolbox.name == "row"
    assert hands.shown("Dots")  # its parameter, in the panel
    hands.drag((500, 300), (700, 300), "left")
    document = hands.app.session.document
    assert len(document.dots) == 5
    assert document.history.steps[-1].label == "Row"
    hands.click((600, 400))  # fails; nothing is held afterwards
    assert not hands.app.editor.painting.is_busy
    assert "no row" in hands.said()
    hands.key("v")
    hands.key("p", ctrl=True, shift=True)
    hands.type("row of")
    hands.key("enter")
    toolbox = hands.app.editor.painting.toolbox
    assert toolbox.name == "row"
    toolbox.tool.set("n_dots", 7.0)
    hands.app.close()
    hands = host()
    hands.key("n")
    hands.drag((500, 300), (700, 300), "left")
    assert len(hands.app.session.document.dots) == 7


def test_ctrl_inverts_a_brush() -> None:
    from stippler.brushes.brush import Brush

    fix = Brush("mine", "fix", 3.0)
    assert fix.inverted.kind == "unfix"
    assert fix.inverted.inverted.kind == "fix"
    assert fix.inverted.radius_mm == 3.0
    size = Brush("mine", "size", values={"how": "enlarge", "amount": 7.0})
    assert size.inverted.values == {"how": "reduce", "amount": 7.0}
    assert Brush("mine", "size", values={"how": "tone"}).inverted is None
    assert Brush("mine", "push").inverted is None
    spray = Brush("mine", "spray", values={"per_s": 90.0, "apart_mm": 0.1})
    assert spray.inverted.values == {"per_s": 90.0}
