"""Areas drawn, parted, filled and united by hand: one step each, exact coverage, said refusals."""

import numpy as np
import pytest

from stippler.drawing import records
from stippler.drawing.line import Line
from stippler.drawing.planar.path import Path
from stippler.editor.events import KeyDown, Mods
from tests.editor.area_hands import AreaHands, box, same, state

SHIFT, ALT = Mods(shift=True), Mods(alt=True)


@pytest.fixture
def hands(tmp_path):
    return AreaHands(tmp_path, tool="area")


def corners(hands, *places):
    for place in places:
        hands.move(place)
        hands.click(place)


def test_clicks_draw_an_area_that_is_chosen(hands):
    start = state(hands.document)
    corners(hands, (10, 10), (50, 10), (50, 50))
    hands.key("enter")
    hands.check()
    assert hands.labels == ["Draw area"]
    assert hands.size(1) == pytest.approx(800)
    assert hands.toolbox.areas.ids == (1,)
    hands.document.undo()
    assert same(state(hands.document), start)


def test_a_double_click_and_the_first_corner_close(hands):
    corners(hands, (10, 10), (30, 10), (30, 30))
    hands.double_click((10, 30))
    assert hands.size(1) == pytest.approx(400)
    corners(hands, (50, 10), (70, 10), (70, 30), (50, 10))
    assert hands.size(2) == pytest.approx(200)


def test_a_pulled_handle_bends_the_outline(hands):
    hands.click((20, 40))
    hands.drag((50, 20), (60, 20))
    hands.click((80, 40))
    hands.key("enter")
    hands.check()
    assert hands.size(1) > 0.5 * 60 * 20
    curves = [c for k in hands.map.arcs_of(1) for c in hands.map.arcs[k].path.curves]
    assert len(curves) == 2


def test_backspace_takes_a_corner_back_and_escape_all(hands):
    corners(hands, (10, 10), (30, 10), (70, 70))
    hands.key("backspace")
    corners(hands, (30, 30))
    hands.key("enter")
    assert hands.size(1) == pytest.approx(200)
    before, n = state(hands.document), len(hands.labels)
    corners(hands, (50, 10), (70, 10), (70, 30))
    hands.key("escape")
    assert same(state(hands.document), before)
    assert len(hands.labels) == n


def test_what_is_refused_can_be_drawn_on(hands):
    corners(hands, (110, 10), (130, 10), (130, 30))  # off the page
    hands.key("enter")
    assert "no place" in hands.said[-1][1]
    assert hands.toolbox.is_busy
    corners(hands, (60, 40))
    hands.key("enter")
    assert not hands.toolbox.is_busy
    assert any("off the page" in text for _, text in hands.said)
    hands.check()


def test_an_outline_of_no_extent_is_refused_and_a_crossing_one_is_mended_and_said(hands):
    corners(hands, (10, 10), (30, 10))
    hands.key("enter")
    assert "no extent" in hands.said[-1][1]
    hands.key("escape")
    corners(hands, (10, 10), (50, 50), (50, 10), (10, 50))
    hands.key("enter")
    assert "crossed itself" in hands.said[-1][1]
    hands.check()
    assert hands.size(1) == pytest.approx(800)


def test_a_lasso_is_smooth_and_keeps_to_what_was_drawn(hands):
    hands.tool.set("shape", "lasso")
    t = np.linspace(0, 2 * np.pi, 200)
    ring = np.column_stack([50 + 20 * np.cos(t), 40 + 15 * np.sin(t)])
    hands.drag(*map(tuple, ring))
    hands.check()
    assert hands.size(1) == pytest.approx(np.pi * 300, rel=0.02)
    nodes = sum(len(hands.map.arcs[k].path.nodes()) for k in hands.map.arcs_of(1))
    assert nodes < 40


@pytest.mark.parametrize(
    ("others", "sizes"),
    [("gives way", (1200, 1600)), ("stays", (1600, 1200)), ("forbids it", (1600, None))],
)
def test_what_another_area_does_is_a_choice(hands, others, sizes):
    hands.add(box(10, 10, 50, 50))
    hands.tool.set("others", others)
    hands.tool.set("follow", False)
    corners(hands, (30, 30), (70, 30), (70, 70), (30, 70))
    hands.key("enter")
    hands.check()
    assert hands.size(1) == pytest.approx(sizes[0])
    if sizes[1] is None:
        assert "lies on area 1" in hands.said[-1][1]
    else:
        assert hands.size(2) == pytest.approx(sizes[1])


def test_corners_snap_to_borders_and_are_joined_along_them(hands):
    wave = [(10, 40 + 4 * np.sin(x)) for x in (0,)] + [
        (10 + x, 40 + 4 * np.sin(x / 4)) for x in range(1, 80)
    ]
    hands.add(Path.polyline([*wave, (90, 10), (10, 10)], closed=True))
    corners(hands, (20.3, 40 + 4 * np.sin(10 / 4) + 0.3), (80.2, 40 + 4 * np.sin(70 / 4) - 0.2))
    corners(hands, (80, 70), (20, 70))
    hands.key("enter")
    hands.check()
    assert hands.map.neighbours(2) == [0, 1]
    before = hands.size(1)
    shared = [a for a in hands.map.arcs.values() if {a.left, a.right} == {1, 2}]
    assert len(shared) == 1
    assert len(shared[0].path) > 55
    hands.document.undo()
    assert hands.size(1) == pytest.approx(before, abs=0.5)


def test_shift_joins_corners_straight(hands):
    hands.add(box(10, 10, 50, 50))
    hands._take(KeyDown("left_shift"))
    for place in ((50, 20), (50, 40)):
        hands.move(place, SHIFT)
        hands.click(place, SHIFT)
    hands.click((80, 30), SHIFT)
    hands.key("enter")
    hands.check()
    assert hands.size(2) == pytest.approx(0.5 * 20 * 30)


def test_the_chosen_area_is_extended_and_cut_into(hands):
    hands.add(box(10, 10, 50, 50))
    hands.toolbox.areas.choose((1,))
    hands.tool.set("follow", False)
    hands.tool.set("does", "add")
    corners(hands, (40, 20), (60, 20), (60, 40), (40, 40))
    hands.key("enter")
    assert hands.size(1) == pytest.approx(1600 + 200)
    hands.tool.set("does", "take away")
    corners(hands, (20, 20), (30, 20), (30, 30), (20, 30))  # a hole
    hands.key("enter")
    hands.check()
    assert len(hands.document.drawing.areas[1].outline_mm.interiors) == 1
    assert hands.size(1) == pytest.approx(1700)
    hands.tool.set("does", "cut out")
    corners(hands, (5, 35), (25, 35), (25, 55), (5, 55))
    hands.key("enter")
    hands.check()
    assert hands.size(2) == pytest.approx(15 * 15)
    assert hands.labels == ["Draw area", "Add to area", "Take from area", "Cut out"]


def test_without_a_choice_adding_is_refused(hands):
    hands.tool.set("does", "add")
    with pytest.raises(Exception, match="none is chosen"):
        hands.click((10, 10))


def test_a_locked_area_gives_nothing(hands):
    from dataclasses import replace

    hands.add(box(10, 10, 50, 50))
    document = hands.document
    document.begin("Lock")
    document.set(records.AREA, 1, replace(document.drawing.areas[1], locked=True))
    document.commit()
    hands.tool.set("follow", False)
    corners(hands, (30, 30), (70, 30), (70, 70), (30, 70))
    hands.key("enter")
    hands.check()
    assert hands.size(1) == pytest.approx(1600)
    assert hands.size(2) == pytest.approx(1200)


def test_the_knife_parts_what_it_crosses(hands):
    hands.add(box(10, 10, 50, 50), box(50, 10, 90, 50))
    hands.toolbox.choose("knife")
    hands.drag((10.2, 30), (30, 30), (60, 30), (89.9, 30))
    hands.check()
    assert sorted(hands.document.drawing.areas) == [0, 1, 2, 3, 4]
    assert [hands.size(k) for k in (1, 2, 3, 4)] == pytest.approx([800] * 4, rel=0.02)
    assert hands.labels[-1] == "Split area"
    hands.document.undo()
    hands.toolbox.areas.choose((2,))
    hands.tool.set("shape", "corners")
    corners(hands, (5, 30), (95, 30))
    hands.key("enter")
    hands.check()
    assert hands.size(1) == pytest.approx(1600)
    assert len(hands.document.drawing.areas) == 4


def test_a_part_takes_the_style_of_where_it_came_from(hands):
    from dataclasses import replace

    hands.add(box(10, 10, 50, 50))
    document = hands.document
    document.begin("Style")
    i = document.add(records.STYLE, replace(document.drawing.styles[0], name="fur"))
    document.set(records.AREA, 1, replace(document.drawing.areas[1], style=i))
    document.commit()
    hands.toolbox.choose("knife")
    hands.drag((5, 30), (60, 30))
    assert hands.document.drawing.areas[2].style == i


def test_a_line_that_parts_nothing_is_said(hands):
    hands.add(box(10, 10, 50, 50))
    hands.toolbox.choose("knife")
    with pytest.raises(Exception, match="does not part"):
        hands.drag((5, 30), (30, 30))


def test_the_bucket_fills_a_place_and_closes_gaps(hands):
    document = hands.document
    document.begin("Lines")
    for points in ([(20, 20), (60, 20), (60, 60)], [(60, 63), (20, 63), (20, 20)]):
        document.add(records.LINE, Line("line", Path.polyline(points)))
    document.commit()
    hands.toolbox.choose("bucket")
    hands.tool.set("gap", 4.0)
    hands.move((40, 40))
    overlay = hands.toolbox.overlay(document, (40, 40), 10.0)
    assert overlay.paths
    hands.click((40, 40))
    hands.check()
    assert hands.size(1) == pytest.approx(40 * 43, rel=0.01)
    hands.click((40, 40))
    assert "fills this place already" in hands.said[-1][1]
    hands.document.undo()
    hands.tool.set("gap", 0.0)
    hands.click((40, 40))
    hands.check()
    assert hands.size(2) > 0.9 * 8000  # it runs out through the gap; ids are never given twice
