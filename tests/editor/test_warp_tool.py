"""One cage bends dots, lines and areas together: tone kept, nothing folds, undo exact."""

import numpy as np
import pytest
import shapely

from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.editor.area_choice import AreaChoice
from stippler.editor.events import LEFT, KeyDown, Moved, Pressed, Released
from stippler.editor.tools import bending
from stippler.editor.tools.selection import Selection
from stippler.editor.tools.tool import RESTING, Desk
from stippler.editor.tools.warp_tool import WarpTool, stretch


@pytest.fixture
def desk():
    drawing = Drawing.blank(Page(60.0, 40.0))
    grid = np.stack(np.meshgrid(np.arange(0.5, 60), np.arange(0.5, 40)), -1).reshape(-1, 2)
    drawing.dots = Dots.round(grid, 0.15)
    document = Document(drawing)
    ring = Path.polyline([(15, 10), (30, 8), (45, 12), (44, 28), (30, 32), (16, 30)], closed=True)
    edit_areas(document, "area", lambda areas: edits.add(areas, ring, edits.IS_CUT))
    document.begin("line")
    document.add("line", Line("axis", Path.polyline([(20, 20), (40, 20)]), (0.4, 0.4)))
    document.commit()
    choice = AreaChoice()
    choice.choose((1,))
    return Desk(document, Selection(), lambda x, y: (x, y), 4.0, lambda: 1, lambda *_: None, choice)


def state(document):
    dots, drawing = document.dots.by_id(), document.drawing
    arrays = [getattr(dots, name).tobytes() for name in dots.__slots__]
    return arrays, dict(drawing.areas), dict(drawing.lines), dict(drawing.borders)


def dragged(tool, desk, start, end, *, escape=False):
    held = tool.begin(Pressed(LEFT, *start), desk)
    for share in (0.5, 1.0):
        at = [a + share * (b - a) for a, b in zip(start, end, strict=True)]
        held = held.take(Moved(*at), desk)
    if escape:
        return held.take(KeyDown("escape"), desk)
    return held.take(Released(LEFT, *end), desk)


def grip(tool, desk, k):
    from stippler.editor.tools.warp_tool import target_of

    box = target_of(tool.value("what"), desk.document, desk).box
    return bending.grips(tool.rest(box), box, tool.value("how"), 0.25)[k][1]


def test_areas_lines_and_dots_go_together(desk):
    tool, document = WarpTool(), desk.document
    tool.set("what", "areas")
    before = state(document)
    ink = float((document.dots.radius_mm[document.dots.area == 1].astype(float) ** 2).sum())
    size = document.drawing.areas[1].outline_mm.area
    start = grip(tool, desk, 6)
    end = (start[0] + 4, start[1] - 3)
    assert dragged(tool, desk, start, end, escape=True) is RESTING
    assert state(document) == before
    assert dragged(tool, desk, start, end) is RESTING
    after, area = state(document), document.drawing.areas[1].outline_mm
    assert after != before
    assert document.history.steps[-1].label == "Warp"
    assert area.is_valid
    assert area.area != pytest.approx(size, rel=1e-3)
    dots = document.dots
    owned = shapely.contains_xy(area, *dots.position_mm.T)
    assert (owned == (dots.area == 1)).mean() > 0.999
    line = document.drawing.lines[0].path.points_mm
    assert np.abs(line[:, 1] - 20).max() > 0.1
    now = float((dots.radius_mm[dots.area == 1].astype(float) ** 2).sum())
    assert now / area.area == pytest.approx(ink / size, rel=0.06)
    outside = dots.position_mm[:, 0] < 10
    assert (dots.radius_mm[outside] == np.float32(0.15)).all()
    document.undo()
    assert state(document) == before
    document.redo()
    assert state(document) == after


def test_a_selection_is_bent_alone(desk):
    tool, document = WarpTool(), desk.document
    assert tool.begin(Pressed(LEFT, 20, 20), desk) is RESTING  # nothing chosen
    inside = (np.abs(document.dots.position_mm - (30, 20)) < (10, 6)).all(axis=1)
    desk.selection.choose(document.dots.id[inside].copy())
    others = document.dots.position_mm[~inside].copy()
    start = grip(tool, desk, 5)
    dragged(tool, desk, start, (start[0] + 2, start[1] + 1))
    assert np.array_equal(document.dots.position_mm[~inside], others)
    moved = document.dots.position_mm[inside]
    assert np.abs(moved - np.floor(moved) - 0.5).max() > 0.2


def test_it_does_not_fold_over(desk):
    tool = WarpTool()
    tool.set("what", "all")
    tool.set("relaxes", False)
    start = grip(tool, desk, 5)
    dragged(tool, desk, start, (58, 38))
    at = desk.document.dots.position_mm
    assert ((at >= 0) & (at <= (60, 40))).all()
    assert len(np.unique(at.round(6), axis=0)) == len(at)


def test_stretch_is_how_much_room_grows():
    from stippler.drawing.deformation import Deformation

    at = np.random.default_rng(0).random((20, 2)) * 40
    assert np.allclose(stretch(Deformation((2, 0, 0, 0, 3, 0, 0, 0, 1)), at), 6)
    mirrored = Deformation((-1, 0, 0, 0.5, 1, 0, 0, 0, 1))
    assert np.allclose(stretch(mirrored, at), 1)


def test_patterns_of_the_areas_are_bent_too(desk):
    from stippler.drawing.pattern import Pattern
    from stippler.stippling.patterns import builtin

    tool, document = WarpTool(), desk.document
    tool.set("what", "areas")
    pattern = Pattern.over(1, builtin("bricks"), document.partition.part_of(1).bounds, 15.0)
    document.begin("Lay")
    k = document.add("pattern", pattern)
    document.commit()
    start = grip(tool, desk, 5)
    dragged(tool, desk, start, (start[0] + 3, start[1] + 2))
    from stippler.drawing.deformation import Cage, Deformation

    box = (15.0, 8.0, 45.0, 32.0)
    warp = Deformation(cage=Cage.over(box).moved({5: (start[0] + 3, start[1] + 2)}))
    before, now = pattern.rings_mm()[0], document.drawing.patterns[k].rings_mm()[0]
    assert np.abs(now - before).max() > 2
    inside = ((before > box[:2]) & (before < box[2:])).all(axis=1)
    assert np.abs(now[inside] - warp.apply(before[inside])).max() < 0.1
    document.undo()
    assert document.drawing.patterns[k] == pattern


def test_borders_are_shown_where_they_will_be(desk):
    tool, document = WarpTool(), desk.document
    tool.set("what", "areas")
    start = grip(tool, desk, 6)
    held = tool.begin(Pressed(LEFT, *start), desk)
    assert not held.overlay.has_borders  # nothing has moved
    end = (start[0] + 4, start[1] - 3)
    held = held.take(Moved(*end), desk)
    overlay = held.overlay
    assert overlay.has_borders
    shown = shapely.Polygon(overlay.paths[0].points_mm)
    before = document.drawing.areas[1].outline_mm
    assert shown.symmetric_difference(before).area > 5
    held.take(Released(LEFT, *end), desk)
    after = document.drawing.areas[1].outline_mm
    assert shown.symmetric_difference(after).area < 0.01 * after.length
    rings = [shapely.LinearRing(p.points_mm) for p in overlay.paths if len(p.points_mm) > 3]
    assert any(r.hausdorff_distance(after.exterior) < 0.1 for r in rings)


def test_what_areas_grow_over_is_inked_once(desk):
    tool, document = WarpTool(), desk.document
    tool.set("what", "areas")
    tool.set("relaxes", False)
    before = state(document)
    own = document.dots.id[document.dots.area == 1].copy()
    outside = document.dots.id[document.dots.area == 0].copy()
    start = grip(tool, desk, 7)
    dragged(tool, desk, start, (start[0] + 5, start[1]))
    area, dots = document.drawing.areas[1].outline_mm, document.dots
    assert np.isin(own, dots.id).all()  # its own go along, all of them
    left = dots.position_mm[np.isin(dots.id, outside)]
    assert len(left) < len(outside)
    assert not shapely.contains_xy(shapely.buffer(area, -1e-3), *left.T).any()
    document.undo()
    assert state(document) == before
