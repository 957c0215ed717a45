"""Lines by hand: pen, freehand, moving, their panel, rows of dots."""

import math
from dataclasses import replace

import numpy as np
import pytest

from stippler.drawing.dots import ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page


@pytest.fixture
def lines(desk):
    """An editor on a page of evenly strewn dots, with the line tool at hand."""
    drawing = Drawing.blank(Page(120.0, 90.0))
    grid = np.stack(np.meshgrid(np.arange(2, 119, 2.5), np.arange(2, 89, 2.5)), -1).reshape(-1, 2)
    drawing.dots = Dots.round(grid, 0.2)
    desk.app.session.show(drawing)
    desk.host.settle()
    desk.app.editor.commands["tool.line"].run()
    desk.host.settle()
    return desk


def document(desk):
    return desk.app.session.document


def table(desk):
    return document(desk).drawing.lines


def test_a_pen_draws_curves_and_closes_them(lines):
    host = lines.host
    host.drag((500, 300), (540, 240), "left")
    host.click((700, 400))
    assert len(table(lines)) == 1  # in ink while it is drawn
    assert document(lines).in_stroke
    host.key("escape")
    assert not table(lines)
    host.drag((500, 300), (540, 240), "left")
    host.click((700, 400))
    host.click((800, 300))
    host.key("backspace")
    host.click((600, 500))
    host.click((500, 300))  # the start
    (line,) = table(lines).values()
    assert line.is_closed
    assert len(line.path.curves) == 2
    assert len(line.path.nodes()) == 4
    assert not document(lines).in_stroke
    host.key("z", ctrl=True)
    assert not table(lines)


def test_freehand_lines_are_smooth_and_taper(lines):
    tool = lines.app.editor.painting.toolbox.tool
    tool.set("how", "freehand")
    tool.set("end_mm", 2.0)
    host = lines.host
    host.move(500, 400)
    host.press()
    for k in range(40):
        host.move(500 + 8 * k, 400 + 50 * math.sin(k / 6))
    host.release()
    host.settle()
    (line,) = table(lines).values()
    assert line.width_mm == pytest.approx((0.3, 2.0))
    assert 3 <= len(line.path.nodes()) < 25
    assert line.path.curves
    assert [step.label for step in document(lines).history.steps] == ["Draw line"]


def test_a_moved_line_takes_its_dots_along(lines):
    tool, host = lines.app.editor.painting.toolbox.tool, lines.host
    tool.set("meeting", "adhere")
    tool.set("reach_mm", 3.0)
    host.click((500, 300))
    host.click((800, 320))
    host.key("enter")
    dots = document(lines).dots
    held = dots.id[dots.constraint == ON_CURVE].copy()
    assert len(held) > 10
    tool.set("how", "move")
    before = dots.position_mm[document(lines).rows(held)].copy()
    host.drag((650, 310), (650, 400), "left")
    after = document(lines).dots.position_mm[document(lines).rows(held)]
    shift_mm = 90 / lines.app.editor.view.camera.px_per_mm
    assert np.median(after[:, 1] - before[:, 1]) == pytest.approx(shift_mm, abs=0.5)
    host.key("z", ctrl=True)
    assert np.array_equal(document(lines).dots.position_mm[document(lines).rows(held)], before)
    host.key("delete")
    assert not table(lines)
    assert not (document(lines).dots.constraint == ON_CURVE).any()


def test_the_panel_changes_lines_and_lays_rows(lines):
    host, editor = lines.host, lines.app.editor
    host.click((500, 300))
    host.click((800, 300))
    host.key("enter")
    host.fill("Its width", "1.5")
    (k,) = table(lines)
    assert table(lines)[k].width_mm == (1.5, 1.5)  # one width stays one
    host.fill("Its end", "0.5")
    assert table(lines)[k].width_mm == (1.5, 0.5)
    host.click("Guide")
    assert not table(lines)[k].printed
    n = len(document(lines).dots)
    editor.lines.row = editor.lines.row.__class__(by_number=True, n_dots=31, radius_mm=0.4)
    host.settle()
    editor.commands["line.row"].run()
    dots = document(lines).dots
    rows = np.flatnonzero((dots.constraint == ON_CURVE) & (dots.curve == k))
    assert len(dots) == n + 31 == n + len(rows)
    gaps = np.diff(np.sort(dots.position_mm[rows, 0]))
    assert np.ptp(gaps) < 0.01 * gaps.mean()
    host.click("Line up")
    assert table(lines)[k].meeting == "adhere"
    host.click("Free dots")
    assert not (document(lines).dots.constraint == ON_CURVE).any()
    for place in ("edges", "border", "hatching"):
        before = len(document(lines).dots)
        editor.lines.row = editor.lines.row.__class__(place=place, distance_mm=3.0, lines_mm=9.0)
        host.settle()
        editor.commands["line.row"].run()
        assert len(document(lines).dots) > before
    host.click("Delete line")
    assert not table(lines)
    while document(lines).history.undone is not None:
        host.key("z", ctrl=True)
    assert len(document(lines).dots) == n


def test_wrong_values_are_refused_with_a_line(lines):
    host = lines.host
    host.click((500, 300))
    host.click((800, 300))
    host.key("enter")
    host.fill("Its width", "900")
    assert "0 to 100 mm" in host.said()
    (line,) = table(lines).values()
    assert line.width_mm == pytest.approx((0.3, 0.3))
    host.fill("Dot gap", "-3")
    host.click("Lay the row")
    assert "no distance" in host.said()


def test_nodes_of_lines_are_dragged_and_their_dots_go_along(lines):
    tool, host = lines.app.editor.painting.toolbox.tool, lines.host
    tool.set("meeting", "adhere")
    tool.set("reach_mm", 3.0)
    host.click((500, 300))
    host.click((650, 300))
    host.click((800, 300))
    host.key("enter")
    lines.app.editor.commands["tool.nodes"].run()
    host.settle()
    host.drag((650, 300), (650, 380), "left")
    (k,) = table(lines)
    line = table(lines)[k]
    assert len(line.path.nodes()) == 3
    assert np.ptp(line.path.points_mm[:, 1]) > 5
    dots = document(lines).dots
    rows = np.flatnonzero((dots.constraint == ON_CURVE) & (dots.curve == k))
    assert len(rows) > 10
    assert np.allclose(dots.position_mm[rows], line.at(dots.parameter[rows]), atol=1e-9)
    host.key("delete")  # the node, not the line
    assert len(table(lines)[k].path.nodes()) == 2
    host.key("z", ctrl=True)
    host.key("z", ctrl=True)
    assert np.ptp(table(lines)[k].path.points_mm[:, 1]) < 1


def test_relaxing_spreads_dots_on_lines_and_leaves_them_there(lines):
    host, session = lines.host, lines.app.session
    host.click((500, 300))
    host.click((800, 300))
    host.key("enter")
    (k,) = table(lines)
    lines.app.editor.lines.row = lines.app.editor.lines.row.__class__(by_number=True, n_dots=12)
    lines.app.editor.commands["line.row"].run()
    rows = np.flatnonzero(document(lines).dots.constraint == ON_CURVE)
    document(lines).begin("Crowd")
    document(lines).change("parameter", rows, np.linspace(1.0, 4.0, 12))
    document(lines).commit()
    lines.app.editor.commands["work.relax"].run()
    host.until(lambda: not session.busy, "relaxing")
    dots = document(lines).dots
    gaps = np.diff(np.sort(dots.parameter[rows]))
    assert np.ptp(gaps) < 0.01 * gaps.mean()
    assert np.allclose(dots.position_mm[rows], table(lines)[k].at(dots.parameter[rows]), atol=1e-9)
    labels = [step.label for step in document(lines).history.steps]
    assert labels[-2:] == ["Crowd", "Relax all"]  # one step, which is undone as one
    host.key("z", ctrl=True)
    assert np.allclose(np.sort(document(lines).dots.parameter[rows]), np.linspace(1.0, 4.0, 12))


def test_filling_lines_dots_up(lines):
    host, session = lines.host, lines.app.session
    host.click((500, 300))
    host.click((800, 300))
    host.key("enter")
    (k,) = table(lines)
    lines.app.editor.lines.change([k], meeting="adhere", reach_mm=2.0)
    before = (document(lines).dots.constraint == ON_CURVE).sum()
    session.filling = replace(session.filling, n_dots=20_000)
    session.fill()
    host.until(lambda: not session.busy, "filling")
    dots = document(lines).dots
    on = dots.constraint == ON_CURVE
    assert on.sum() > before + 5
    assert np.allclose(dots.position_mm[on], table(lines)[k].at(dots.parameter[on]), atol=1e-9)
    host.key("z", ctrl=True)
    assert (document(lines).dots.constraint == ON_CURVE).sum() == before
