"""The border policy in the panel of areas: chosen by hand, kept, undone, and used."""

from __future__ import annotations

import numpy as np
import pytest

import stippler
from stippler.drawing.planar import edits
from stippler.ui.panels.layout import AREAS, TOOL
from tests.editor.area_hands import box


@pytest.fixture
def halves(desk, picture):
    """A picture of which an area takes the left part."""
    desk.host.drop(picture)
    session = desk.app.session
    desk.host.until(lambda: session.phase == "done", "the drawing")
    acts = desk.app.editor.area_acts
    page = session.document.drawing.page
    left = box(0, 0, page.width_mm / 2, page.height_mm)
    acts.edit("Draw area", lambda m: edits.add(m, left))
    desk.app.editor.show_panel(AREAS)
    desk.host.settle()
    return desk


def test_a_border_is_seen_through_by_hand(halves, tmp_path):
    host, session = halves.host, halves.app.session
    acts, document = halves.app.editor.area_acts, session.document
    host.click("area page")
    host.key("p", ctrl=True, shift=True)
    host.type("border through")
    host.key("enter")
    host.settle()
    assert [document.drawing.border_of(k) for k in (0, 1)] == ["through", "automatic"]
    assert session.style.border == document.drawing.style_of(0).border == "automatic"
    document.undo()
    assert document.drawing.border_of(0) == "automatic"
    document.redo()
    acts.set_border((1,), "through")
    acts.choice.choose((0, 1))
    acts.process()
    host.until(lambda: not session.busy, "the dots")
    dots = document.dots
    np.testing.assert_array_equal(document.partition.area_at(dots.position_mm), dots.area)
    assert set(np.unique(dots.area)) == {0, 1}
    path = tmp_path / "halves.stipple"
    session.save(path)
    host.until(lambda: path.exists() and not session.exporting, "the file")
    again = stippler.open(path)
    assert [again.areas[k].border for k in (0, 1)] == ["through", "through"]
    acts.set_border((0, 1), "")
    assert [document.drawing.border_of(k) for k in (0, 1)] == ["automatic", "automatic"]


def test_a_piece_of_a_border_is_seen_through_by_hand(halves):
    host, session, editor = halves.host, halves.app.session, halves.app.editor
    document = session.document
    page = document.drawing.page
    editor.show_panel(TOOL)
    editor.painting.toolbox.choose("nodes")
    host.settle()
    (k,) = (k for k, a in document.drawing.borders.items() if {a.left, a.right} == {0, 1})
    middle = (page.width_mm / 2, page.height_mm / 2)

    def at(x, y):
        (sx, sy), (ox, oy) = (
            editor.view.camera.page_to_screen([(x, y)], editor.view.size_px)[0],
            editor.pointer.origin_px,
        )
        return sx + ox, sy + oy

    def dark_along():
        host.leave()
        host.settle()
        shot = host.screenshot().astype(int).sum(axis=2)
        column = round(at(*middle)[0])
        rows = slice(round(at(0, 0)[1]) + 6, round(at(0, page.height_mm)[1]) - 6)
        return shot[rows, column - 1 : column + 2].min(axis=1) < 300

    host.click(at(*middle))
    host.settle()
    host.click("Through")
    host.settle()
    assert document.drawing.borders[k].policies == ((0, 1, "through"),)
    editor.painting.toolbox.choose("area")
    gaps = np.count_nonzero(np.diff(dark_along().astype(int)) == 1)
    document.undo()
    host.settle()
    assert document.drawing.borders[k].policies == ()
    assert gaps > 10 + np.count_nonzero(np.diff(dark_along().astype(int)) == 1)
