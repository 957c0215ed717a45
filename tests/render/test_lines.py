"""Lines on screen: as much ink as they have, at any zoom, and as exports have it."""

import numpy as np
import pytest
import shapely

from stippler.camera import Camera
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line
from stippler.drawing.planar.moves import smooth_path
from stippler.drawing.planar.path import Path
from stippler.files.write.raster import grey_strips
from stippler.files.write.sheet import sheet_of
from stippler.headless import render_image
from stippler.render.frame import Frame

PAGE = Page(60.0, 40.0)
CORNERS = [(8, 8), (30, 12), (22, 30), (52, 33)]


def wave(width):
    return Line("wave", smooth_path(Path.polyline(CORNERS)), width)


def drawing_of(*lines):
    drawing = Drawing.blank(PAGE)
    drawing.lines = dict(enumerate(lines))
    return drawing


@pytest.mark.parametrize("width", [(0.3, 0.3), (2.0, 2.0), (0.1, 1.5), (4.0, 0.5)])
@pytest.mark.parametrize("px_per_mm", [3.0, 10.0, 30.0])
def test_ink_is_that_of_the_outline(width, px_per_mm):
    for line in (wave(width), Line("corners", Path.polyline(CORNERS), width)):
        grey = render_image(drawing_of(line), px_per_mm=px_per_mm, grey=True)
        ink = (1.0 - grey / 255.0).sum() / px_per_mm**2
        assert ink == pytest.approx(line.outline().area, rel=0.005)


@pytest.mark.parametrize("width", [(0.5, 0.5), (0.2, 1.6)])
def test_screen_and_export_agree(width):
    closed = Line("ring", Path.polyline(CORNERS, closed=True), width)
    drawing = drawing_of(wave(width), closed)
    screen = render_image(drawing, px_per_mm=300 / 25.4, grey=True)
    written = np.concatenate(list(grey_strips(sheet_of(drawing), 300)))
    assert screen.shape == written.shape
    assert (255.0 - screen).sum() == pytest.approx((255.0 - written).sum(), rel=0.005)
    assert np.abs(screen.astype(float) - written).max() < 128  # nowhere a pixel beside


def test_a_line_of_short_segments_is_as_dark_as_one(ctx, renderer, ink):
    x = np.linspace(2, 58, 20_000)
    fine = Line("fine", Path.polyline(np.column_stack([x, np.full_like(x, 20.0)])), (0.05, 0.05))
    renderer.scene.set_page(60, 40)
    renderer.scene.set_lines({1: fine})
    found = ink(Camera((30.0, 20.0), 8.0), (480, 320)).sum() / 64
    assert found == pytest.approx(fine.outline().area, rel=0.02)  # of 8 bits a pixel


def test_guides_are_marks_only(ctx, renderer, canvas):
    guide = Line("guide", Path.polyline([(5, 20), (55, 20)]), (1.0, 1.0), printed=False)
    hidden = Line("hidden", Path.polyline([(30, 5), (30, 35)]), (1.0, 1.0), hidden=True)
    renderer.scene.set_page(60, 40)
    renderer.scene.set_lines({1: guide, 2: hidden})
    target = canvas((480, 320))

    def drawn(**shown):
        frame = Frame(Camera((30.0, 20.0), 8.0), (480, 320), paper=(1, 1, 1), desk=(1, 1, 1),
                      **shown)  # fmt: skip
        renderer.draw(frame, target.framebuffer)
        return target.pixels().astype(int)

    assert (drawn(marks=None) == 255).all()
    marks = drawn()
    assert (marks[160, 100:400].max(axis=1) < 255).all()  # nowhere interrupted
    assert (marks[20:140, 240] == 255).all()
    drawing = drawing_of(guide, hidden)
    assert [layer.name for layer in sheet_of(drawing).layers] == []
    shown = drawn(dots=False)
    assert np.array_equal(shown, marks)


def test_lines_follow_a_document(ctx, renderer, ink):
    document = Document(Drawing.blank(PAGE))
    camera, size = Camera((30.0, 20.0), 8.0), (480, 320)
    renderer.scene.sync(document)
    assert ink(camera, size).sum() == 0
    document.begin("Draw")
    k = document.add("line", wave((1.0, 1.0)))
    document.insert(Dots.round([(5, 35)], 1.0))
    document.commit()
    renderer.scene.sync(document)
    both = ink(camera, size)
    only = ink(camera, size, dots=False)
    assert both.sum() == pytest.approx(only.sum() + 64 * np.pi, rel=0.01)
    held = renderer.scene.lines.revision
    document.begin("Dots")
    document.insert(Dots.round([(9, 35)], 1.0))
    document.commit()
    renderer.scene.sync(document)
    assert renderer.scene.lines.revision == held  # lines that stay are not sent again
    document.begin("Move")
    document.set("line", k, Line("line", Path.polyline([(2, 2), (50, 2)]), (2.0, 2.0)))
    document.commit()
    renderer.scene.sync(document)
    assert ink(camera, size, dots=False)[:40].sum() == pytest.approx(
        64 * document.drawing.lines[k].outline().area, rel=0.005
    )
    document.undo()
    renderer.scene.sync(document)
    assert np.array_equal(ink(camera, size, dots=False), only)


def test_dots_upon_a_line_are_inked_once(ctx, renderer, ink):
    renderer.scene.set_page(60, 40)
    renderer.scene.set_dots(Dots.round([(20, 20), (30, 20)], 0.8))
    line = Line("wide", Path.polyline([(10, 20), (50, 20)]), (3.0, 3.0))
    renderer.scene.set_lines({0: line})
    found = ink(Camera((30.0, 20.0), 10.0), (600, 400)).sum() / 100
    assert found == pytest.approx(shapely.area(line.outline()), rel=0.005)


def test_outlines_of_patterns_are_marked_where_asked(ctx, renderer, canvas):
    from stippler.drawing.deformation import Deformation
    from stippler.drawing.pattern import Pattern
    from stippler.stippling.patterns import builtin

    pattern = Pattern.over(0, builtin("bricks"), (0, 0, 60, 40), 30.0)
    beyond = Pattern(0, builtin("bricks"), 1, 1, Deformation((1, 0, 0, 0, 1, 0, 1, 0, -0.5)))
    renderer.scene.set_page(60, 40)
    renderer.scene.lines.set_patterns([beyond, pattern], renderer.scene.origin_mm)
    target = canvas((480, 320))

    def drawn(**shown):
        frame = Frame(Camera((30.0, 20.0), 8.0), (480, 320), paper=(1, 1, 1), desk=(1, 1, 1),
                      **shown)  # fmt: skip
        renderer.draw(frame, target.framebuffer)
        return (target.pixels().astype(int) < 250).any(axis=2).mean()

    assert drawn() == 0.0
    assert drawn(patterns=True, marks=None) == 0.0
    assert 0.1 < drawn(patterns=True) < 0.5
    renderer.scene.lines.set_patterns([], renderer.scene.origin_mm)
    assert drawn(patterns=True) == 0.0
