"""Areas in the whole editor: list, names, order, files, work; what is hidden is not seen."""

from __future__ import annotations

import json

import numpy as np
import pytest

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Page
from stippler.drawing.planar import edits
from stippler.ui.panels.layout import AREAS
from tests.editor.area_hands import box


@pytest.fixture
def desk_of_areas(desk):
    """A page of 120 x 90 with dots in rows, two areas, and the panel in front."""
    session = desk.app.session
    session.new(Page(120.0, 90.0))
    desk.host.until(lambda: session.document is not None and session.paintable, "the page")
    document = session.document
    x, y = np.meshgrid(np.arange(2.0, 120.0, 3.0), np.arange(2.0, 90.0, 3.0))
    document.begin("dots")
    document.insert(Dots.round(np.stack([x.ravel(), y.ravel()], axis=1), 0.6))
    document.commit()
    acts = desk.app.editor.area_acts
    for path in (box(10, 10, 50, 60), box(50, 10, 90, 60)):
        acts.edit("Draw area", lambda m, p=path: edits.add(m, p))
    desk.app.editor.show_panel(AREAS)
    desk.host.settle()
    return desk


def names(desk):
    return [area.name for _, area in desk.app.editor.area_acts.listed()]


def test_the_list_chooses_renames_and_orders(desk_of_areas):
    desk, host = desk_of_areas, desk_of_areas.host
    acts, document = desk.app.editor.area_acts, desk.app.session.document
    assert names(desk) == ["area 2", "area 1", "page"]
    host.click("area area 1")
    assert acts.choice.ids == (1,)
    with host.batch():
        host.click("area area 1")
        host.click("area area 1")
    host.settle()
    host.key("a", ctrl=True)
    host.type("left wing")
    host.key("enter")
    host.settle()
    assert document.drawing.areas[1].name == "left wing"
    host.click("Area up in the list")
    assert names(desk) == ["left wing", "area 2", "page"]
    document.undo()
    document.undo()
    host.settle()
    assert names(desk) == ["area 2", "area 1", "page"]


def test_hidden_and_solo_areas_on_the_screen(desk_of_areas):
    desk, host = desk_of_areas, desk_of_areas.host

    def ink():
        host.leave()
        host.settle()
        view, origin = desk.app.editor.view, desk.app.editor.pointer.origin_px
        shot = host.screenshot().astype(int)
        found = []
        for x0, x1 in ((12, 48), (52, 88)):
            (a, b), (c, d) = view.camera.page_to_screen([(x0, 12), (x1, 58)], view.size_px)
            left, top = round(a + origin[0]), round(b + origin[1])
            part = shot[top : round(d + origin[1]), left : round(c + origin[0])]
            found.append(255.0 - part.mean())
        return found

    both = ink()
    host.click("hide area 1")
    left, right = ink()
    assert left < 0.2 * both[0]
    assert right == pytest.approx(both[1], rel=0.02)
    host.click("hide area 1")
    assert ink() == pytest.approx(both, rel=0.02)
    host.click("solo area 1")
    left, right = ink()
    assert left == pytest.approx(both[0], rel=0.02)
    assert right < 0.2 * both[1]
    host.click("solo area 1")
    assert ink() == pytest.approx(both, rel=0.02)


def test_areas_go_to_a_file_and_come_back(desk_of_areas, tmp_path):
    desk, host = desk_of_areas, desk_of_areas.host
    acts, session = desk.app.editor.area_acts, desk.app.session
    before = {k: a.outline_mm for k, a in session.drawing.areas.items()}
    for name in ("a.geojson", "a.svg"):
        acts.export_outlines(tmp_path / name)
        acts.choice.choose((1, 2))
        acts.remove()
        assert len(session.drawing.areas) == 1
        acts.import_outlines(tmp_path / name)
        host.until(lambda: not acts.jobs.busy, "the import")
        host.settle()
        made = {a.name: a.outline_mm for a in session.drawing.areas.values()}
        assert made["area 1"].equals(before[1])
        assert made["area 2"].equals(before[2])
        session.undo()
        session.undo()
        assert session.drawing.areas[1].outline_mm.equals(before[1])


def test_a_file_that_holds_nothing_is_said(desk_of_areas, tmp_path):
    desk, host = desk_of_areas, desk_of_areas.host
    acts = desk.app.editor.area_acts
    (tmp_path / "empty.geojson").write_text(json.dumps({"type": "Point", "coordinates": [1, 2]}))
    n = len(desk.app.session.document.history.steps)
    acts.import_outlines(tmp_path / "empty.geojson")
    host.until(lambda: not acts.jobs.busy, "the end")
    assert "holds no polygon" in desk.app.session.messages.log[-1].text
    assert len(desk.app.session.document.history.steps) == n


def test_work_on_the_chosen_area_leaves_the_others_to_the_bit(desk_of_areas):
    desk, host = desk_of_areas, desk_of_areas.host
    session = desk.app.session
    area, place = session.document.dots.area.copy(), session.document.dots.position_mm.copy()
    host.click("area area 1")
    host.click("area.enlarge")
    radius = session.document.dots.radius_mm
    assert (radius[area == 1] > 0.65).all()
    assert (radius[area != 1] == np.float32(0.6)).all()
    host.click("area.relax")
    host.until(lambda: not session.busy, "relaxing")
    moved = (session.document.dots.position_mm != place).any(axis=1)
    assert moved[area == 1].any()
    assert not moved[area != 1].any()
    host.click("area.clear")
    assert not (session.document.dots.area == 1).any()
