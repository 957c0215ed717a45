"""Sheets at their edges: layers without dots, rough dots in blocks, one line, points, marks."""

import re
from dataclasses import replace

import numpy as np
import pytest
import shapely

from stippler.drawing.dots import ON_CURVE, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.line import Line as DrawnLine
from stippler.drawing.planar.path import Path
from stippler.files.read.outlines import read_outlines
from stippler.files.read.table import read_csv
from stippler.files.write import dxf, estimate, pen_paths, plate, press, proof, raster, svg, table
from stippler.files.write.formats import FORMATS, PNG
from stippler.files.write.outlines import path_data
from stippler.files.write.proof import Window
from stippler.files.write.sheet import Layer, Line, Sheet, shape_of, sheet_of
from stippler.stippling.tour import tour


def some(n=40, kind="round", seed=1):
    rng = np.random.default_rng(seed)
    dots = Dots.round(rng.random((n, 2)) * (40, 20), rng.uniform(0.1, 0.4, n))
    if kind == "rough":
        dots.elongation[:], dots.roughness[:] = 1.5, 0.5
    return dots


def sheet(*layers):
    return Sheet(40.0, 20.0, layers or (Layer("dots", some()),))


# --- DXF ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["round", "rough"])
def test_dots_as_points_of_a_dxf_are_their_middles_whatever_their_shape(kind):
    one = sheet(Layer("dots", some(kind=kind)))
    text = b"".join(dxf.chunks(one, {"dots_as": "points"})).decode()
    found = np.array(re.findall(r"\nPOINT\n8\ndots\n10\n([-\d.]+)\n20\n([-\d.]+)\n30\n0.0", text))
    places = one.layers[0].dots.position_mm
    assert np.allclose(found.astype(float), places * (1, -1) + (0, 20), atol=1e-4)
    assert "CIRCLE" not in text
    assert "POLYLINE" not in text


# --- one line -----------------------------------------------------------------------------------


@pytest.mark.parametrize("closed", [True, False])
def test_dots_become_one_line_a_layer_through_all_of_them(closed):
    empty, lined = Layer("none"), Layer("lined", lines=(Line(np.zeros((2, 2)), 0.1),))
    pair = Layer("pair", some(2))
    found = plate.one_line(sheet(Layer("dots", some()), empty, lined, pair), 0.3, closed=closed)
    dots, none, kept, two = found.layers
    (line,) = dots.lines
    assert len(dots.dots) == len(two.dots) == 0
    assert sorted(map(tuple, line.points_mm)) == sorted(map(tuple, some().position_mm))
    assert (line.width_mm, line.closed) == (0.3, closed)
    drawn = shapely.LineString([*line.points_mm, line.points_mm[0]] if closed else line.points_mm)
    assert drawn.is_simple
    assert none.lines == ()
    assert kept.lines == lined.lines
    assert not two.lines[0].closed  # there and back again is no ring


# --- marks, proofs, estimates -------------------------------------------------------------------


@pytest.mark.parametrize(("marks", "n_lines"), [("crop", 8), ("all", 8 + 4 * 3)])
def test_marks_stand_at_the_corners_and_where_asked_at_the_middles(marks, n_lines):
    found = plate._marked(sheet(), marks)
    lines = found.layers[-1].lines
    assert len(lines) == n_lines
    margin = (found.width_mm - 40.0) / 2
    at = np.concatenate([line.points_mm for line in lines])
    inside = (at > margin).all(axis=1) & (at < margin + np.array([40.0, 20.0])).all(axis=1)
    assert not inside.any()
    assert (at >= 0).all()
    assert (at <= (found.width_mm, found.height_mm)).all()
    mirrored = np.sort(np.round([found.width_mm, found.height_mm] - at, 6), axis=0)
    assert np.allclose(np.sort(at, axis=0), mirrored, atol=1e-5)
    assert np.allclose(found.layers[0].dots.position_mm, some().position_mm + margin)


def test_a_proof_of_more_pixels_than_are_looked_at_shows_outlines(monkeypatch):
    one, window = sheet(Layer("dots", some(kind="rough"))), Window(5.0, 5.0, 10.0, 10.0, 200, 200)
    pixels, outlines = proof.proof(one, window, 600.0), proof.proof(one, window)
    assert not np.array_equal(pixels, outlines)
    monkeypatch.setattr(proof, "_MOST_PIXELS", (10 / 25.4 * 600) ** 2 * 0.9)
    assert np.array_equal(proof.proof(one, window, 600.0), outlines)


def test_a_small_picture_is_written_whole_to_be_estimated(monkeypatch):
    one, values = sheet(), {"dpi": 100.0, "bits": 8}
    values = {option.name: option.default for option in PNG.options} | values
    n_bytes = sum(map(len, PNG.write(one, values)))
    assert estimate.estimate(PNG, one, values).n_bytes == n_bytes
    monkeypatch.setattr(estimate, "_WHOLE_PX", 0)
    monkeypatch.setattr(estimate, "_BANDS", 2)
    monkeypatch.setattr(estimate, "_BAND_PX", 8)
    assert estimate.estimate(PNG, one, values).n_bytes != n_bytes
    monkeypatch.setattr(estimate, "_BAND_PX", 50)  # bands of more rows than there are
    assert estimate.estimate(PNG, one, values).n_bytes == n_bytes


# --- outlines -----------------------------------------------------------------------------------


def test_open_and_closed_paths_come_back(tmp_path):
    corners = [(1.0, 2.0), (7.0, 2.0), (7.0, 9.0)]
    open_path, ring = Path.polyline(corners), Path.polyline(corners, closed=True)
    assert path_data([open_path]).count("L") == 2
    assert not path_data([open_path]).endswith("Z")
    assert path_data([ring]).count("L") == 2
    assert path_data([ring]).endswith("Z")
    text = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="9mm" height="9mm" viewBox="0 0 9 9">'
        f'<path d="{path_data([open_path])}"/><path d="{path_data([ring])}"/></svg>'
    )
    (tmp_path / "one.svg").write_text(text)
    found = read_outlines(tmp_path / "one.svg").shapes
    assert [shape.paths[0].is_closed for shape in found] == [False, True]


# --- pens ---------------------------------------------------------------------------------------


def test_paths_of_a_pen_in_their_own_order_are_those_of_the_dots():
    layer, thick = Layer("dots", some()), Layer("rough", some(kind="rough"))
    plain = pen_paths.paths_of(layer, sheet(), 5.0, sort=False)
    assert np.array_equal(plain.points_mm, layer.dots.position_mm)  # all are taps
    short = pen_paths.paths_of(layer, sheet(), 5.0, sort=True)
    assert np.array_equal(short.points_mm, layer.dots.position_mm[tour(layer.dots.position_mm)])
    one, other = (pen_paths.paths_of(thick, sheet(), 0.05, sort=s) for s in (False, True))
    assert len(one) == len(other)
    assert one.drawn_mm == pytest.approx(other.drawn_mm)
    assert one.travelled_mm > 2 * other.travelled_mm
    for paths in (False, True):
        assert len(pen_paths.paths_of(Layer("none"), sheet(), 0.3, sort=paths).points_mm) == 0
    night = Layer("night", inverse=True)
    assert len(pen_paths.paths_of(night, sheet(), 0.3).points_mm) == 0


# --- presses ------------------------------------------------------------------------------------


def test_what_a_press_would_close_is_left_out_and_the_rest_grows():
    wide, thin = shape_of(shapely.box(5, 5, 15, 15)), shape_of(shapely.box(20, 5, 20.1, 15))
    hole = shapely.box(25, 5, 35, 15).difference(shapely.box(27, 7, 33, 13))
    shrunk = press._shapes((wide, thin, shape_of(hole)), -0.5)
    assert len(shrunk) == 2
    areas = [press._polygon(shape).area for shape in shrunk]
    assert areas == pytest.approx([81.0, 81.0 - shapely.box(0, 0, 6, 6).buffer(0.5).area], abs=0.1)
    assert len(press._shapes((wide, thin), 0.5)) == 2


# --- rasters ------------------------------------------------------------------------------------


def test_rough_dots_are_traced_for_the_rows_they_lie_in_and_all_are_painted(monkeypatch):
    dots = some(60, "rough")
    whole = np.concatenate(list(raster.grey_strips(sheet(Layer("dots", dots)), 200.0)))
    monkeypatch.setattr(raster, "_OUTLINES_AT_ONCE", 7)
    monkeypatch.setattr(raster, "_STRIP_BITS", 20_000)
    strips = list(raster.grey_strips(sheet(Layer("dots", dots)), 200.0))
    assert len(strips) > 3
    assert np.array_equal(np.concatenate(strips), whole)
    assert whole.min() < 30


# --- lines that are drawn -----------------------------------------------------------------------


def test_a_closed_line_is_a_ring_whose_end_is_not_its_beginning():
    drawing = Drawing.blank(Page(40.0, 20.0))
    corners = [(5.0, 5.0), (15.0, 5.0), (10.0, 12.0)]
    drawing.lines = {
        1: DrawnLine("ring", Path.polyline(corners, closed=True), (0.2, 0.2), True),
        2: DrawnLine("way", Path.polyline(corners), (0.2, 0.2), True),
    }
    lines = [line for layer in sheet_of(drawing).layers for line in layer.lines]
    assert [line.closed for line in lines] == [True, False]
    assert [len(line.points_mm) for line in lines] == [3, 3]
    assert all(not (line.points_mm[0] == line.points_mm[-1]).all() for line in lines)


# --- SVG ----------------------------------------------------------------------------------------


def test_an_svg_without_paper_has_none():
    with_paper, without = (
        b"".join(svg.chunks(sheet(), {"paper": paper})).decode() for paper in (True, False)
    )
    assert 'id="paper"' in with_paper
    assert 'id="paper"' not in without
    assert without == re.sub(r'<g id="paper".*?</g>\n', "", with_paper, flags=re.S)


# --- tables -------------------------------------------------------------------------------------


def test_dots_that_hold_on_to_a_line_keep_that_in_a_table(tmp_path):
    drawing = Drawing.blank(Page(40.0, 20.0))
    drawing.dots = some(5)
    assert len(table.columns_of(drawing.dots)) == 9
    held = drawing.dots.copy()
    held.curve[:2], held.constraint[:2], held.parameter[:2] = 2, ON_CURVE, (0.5, 1.5)
    for dots in (replace(drawing.dots, id=drawing.dots.id + 3), held):
        path = tmp_path / "one.csv"
        path.write_bytes(b"".join(table.csv_chunks(dots)))
        again = read_csv(path)
        for name in ("id", "curve", "constraint", "parameter", "seed", "area"):
            assert np.array_equal(getattr(again, name), getattr(dots, name)), name


def test_all_formats_write_a_sheet_of_nothing():
    drawing = Drawing.blank(Page(10.0, 10.0))
    for one in FORMATS:
        values = {option.name: option.default for option in one.options}
        what = drawing if one.is_data else sheet_of(drawing)
        assert sum(map(len, one.write(what, values))) > 0
