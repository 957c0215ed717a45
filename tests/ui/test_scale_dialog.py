"""The dialog that scales the drawing, or the areas that are chosen."""

from __future__ import annotations

import numpy as np
import pytest

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Page
from stippler.drawing.planar import edits
from stippler.ui.panels.layout import AREAS
from tests.editor.area_hands import box


@pytest.fixture
def desk_of_areas(desk):
    session = desk.app.session
    session.new(Page(120.0, 90.0))
    desk.host.until(lambda: session.document is not None and session.paintable, "the page")
    desk.app.editor.area_acts.edit("Draw area", lambda m: edits.add(m, box(30, 20, 70, 60)))
    document = session.document
    document.begin("dots")
    at = np.random.default_rng(2).random((2000, 2)) * (120, 90)
    document.insert(Dots.round(at, 0.4))
    document.commit()
    desk.app.editor.show_panel(AREAS)
    desk.host.settle()
    return desk


def open_dialog(desk):
    desk.app.editor.commands["work.scale"].run()
    desk.host.leave()
    desk.host.settle()
    assert desk.app.editor.popups.scale.is_open
    return desk.app.editor.popups.scale


def wait(desk, label):
    document = desk.app.session.document
    desk.host.until(
        lambda: not desk.app.session.busy and document.history.steps[-1].label == label, label
    )
    return document


def test_without_a_choice_it_scales_the_whole(desk_of_areas):
    desk = desk_of_areas
    dialog = open_dialog(desk)
    assert not dialog.only_areas
    dialog.percent, dialog.least_mm = 50.0, 0.0
    desk.host.click("Scale")
    document = wait(desk, "Scale drawing")
    assert document.drawing.page.width_mm == 60.0


def test_the_chosen_area_is_scaled_alone(desk_of_areas):
    desk = desk_of_areas
    desk.host.click("area area 1")
    dialog = open_dialog(desk)
    assert dialog.only_areas
    dialog.percent, dialog.least_mm = 50.0, 0.0
    desk.host.click("Scale")
    document = wait(desk, "Scale area 1")
    assert document.drawing.page.width_mm == 120.0
    assert document.drawing.areas[1].outline_mm.area == pytest.approx(400, rel=1e-3)
    document.undo()
    assert document.drawing.areas[1].outline_mm.area == pytest.approx(1600, rel=1e-3)


def test_what_cannot_be_scaled_is_said(desk_of_areas):
    desk = desk_of_areas
    desk.host.click("area area 1")
    dialog = open_dialog(desk)
    dialog.percent = 300.0
    desk.host.click("Scale")
    desk.host.until(lambda: not desk.app.session.busy, "the end")
    desk.host.settle()
    assert "page's edge" in desk.app.session.messages.current.text
    assert desk.app.session.document.drawing.areas[1].outline_mm.area == pytest.approx(1600)
