"""Patterns by hand: picked, filled, bent with their dots, undone."""

import numpy as np
import shapely

from stippler.drawing.drawing import Drawing, Page
from stippler.editor.tools import bending
from stippler.stippling.patterns import cells_of


def test_a_pattern_is_picked_filled_bent_and_undone(desk, tmp_path):
    host, app, editor = desk.host, desk.app, desk.app.editor
    app.session.show(Drawing.blank(Page(60.0, 45.0)))
    host.settle()
    editor.commands["tool.pattern"].run()
    editor.patterns.size_mm = 30.0
    host.settle()
    document = app.session.document
    host.click("pattern hexagons")
    ((k, pattern),) = document.drawing.patterns.items()
    assert pattern.area == 0
    app.session.filling = app.session.filling.__class__(n_dots=600, radius_mm=0.2)
    host.click("Fill")
    host.until(lambda: not app.session.busy, "the filling")
    assert app.session.n_dots == 600
    cells = cells_of(document.drawing.outlines()[0], pattern).polygons
    at = shapely.points(document.dots.position_mm)
    found = shapely.STRtree(cells).query(at, predicate="intersects")[1]
    assert len(found) == 600
    sizes = np.array([cell.area for cell in cells])
    counts = np.bincount(found, minlength=len(cells))
    assert np.abs(counts - sizes / sizes.sum() * 600).max() < 1.01  # each by its size
    assert shapely.distance(at[:, None], at[None])[~np.eye(600, dtype=bool)].min() > 0.4
    editor.painting.toolbox.tool.set("how", "cage")
    host.settle()
    (_, place) = bending.grips(pattern.deformation, (0, 0, 60, 45), "cage", 0.1)[5]

    def on_screen(x, y):
        px = editor.view.camera.page_to_screen([(x, y)], editor.view.size_px)[0]
        left, top = editor.pointer.origin_px
        return float(px[0]) + left, float(px[1]) + top

    before = document.dots.position_mm.copy()
    host.drag(on_screen(*place), on_screen(place[0] + 6, place[1] + 4), "left")
    bent = document.drawing.patterns[k]
    assert bent.deformation.cage is not None
    moved = document.dots.position_mm
    assert np.abs(moved - before).max() > 4
    cells = cells_of(document.drawing.outlines()[0], bent).polygons
    assert len(shapely.STRtree(cells).query(shapely.points(moved), predicate="dwithin",
                                            distance=1e-3)[0]) >= 595  # fmt: skip
    host.drag(on_screen(*place), on_screen(place[0] + 6, place[1] + 4), "left")  # empty now
    host.drag(on_screen(place[0] + 6, place[1] + 4), on_screen(59, 44), "left")
    assert not len(document.drawing.patterns[k].deformation.folds((0, 0, bent.columns, bent.rows)))
    host.key("z", ctrl=True)
    host.key("z", ctrl=True)
    assert np.array_equal(document.dots.position_mm, before)
    assert document.drawing.patterns[k] == pattern
    path = tmp_path / "mine.svg"
    path.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path d="M0 0h9v9"/></svg>'
    )
    editor.patterns.add_file(path)
    assert "1 open path" in host.said()
    host.move(900, 650)
    host.settle()
    host.click("pattern mine")
    assert document.drawing.patterns[k].polygons.name == "mine"
    host.click("Remove")
    assert not document.drawing.patterns


def test_what_lies_between_becomes_an_area_of_its_own_style(desk):
    host, app, editor = desk.host, desk.app, desk.app.editor
    app.session.show(Drawing.blank(Page(60.0, 45.0)))
    host.settle()
    editor.commands["tool.pattern"].run()
    editor.patterns.size_mm = 30.0
    host.settle()
    drawing = app.session.document.drawing
    editor.patterns.put("hexagons")
    editor.commands["pattern.between"].run()
    assert [area.name for area in drawing.areas.values()] == ["page", "between page"]
    assert len({area.style for area in drawing.areas.values()}) == 2
    cells = cells_of(app.session.document.partition.part_of(0), drawing.patterns[0]).polygons
    between = drawing.areas[max(drawing.areas)].outline_mm
    whole = sum(cell.area for cell in cells) + between.area
    assert abs(whole - 60 * 45) < 0.01 * 60 * 45
    for _ in range(3):
        host.key("z", ctrl=True)
    assert len(drawing.areas) == 1
    assert not drawing.patterns
