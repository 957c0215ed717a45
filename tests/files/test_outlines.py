"""Outlines in SVG and GeoJSON: read, written, and bad ones refused or named."""

import gzip
import json

import numpy as np
import pytest
import resvg_py
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from stippler.drawing.planar import edits, moves
from stippler.drawing.planar.path import UNIT_MM, Path
from stippler.drawing.planar.planar_map import PlanarMap
from stippler.errors import StipplerError
from stippler.files.read import outlines as module
from stippler.files.read.outlines import OutlineError, read_outlines
from stippler.files.write.outlines import geojson_of_areas, svg_of_areas


def read(tmp_path, inside, head='width="100mm" height="80mm" viewBox="0 0 100 80"'):
    file = tmp_path / "shapes.svg"
    file.write_text(f'<svg xmlns="http://www.w3.org/2000/svg" {head}>{inside}</svg>')
    return read_outlines(file)


def polygon(shape):
    rings = [shapely.Polygon(p.points_mm) for p in shape.paths if p.is_closed]
    out = rings[0]
    for ring in rings[1:]:
        out = out.symmetric_difference(ring)
    return out


class TestSvg:
    def test_units_and_nested_transforms(self, tmp_path):
        found = read(
            tmp_path,
            '<g transform="translate(10 20) scale(2)"><rect transform="rotate(90)" width="3"'
            ' height="4" id="r"/></g>',
        )
        assert found.size_mm == (100, 80)
        assert found.shapes[0].name == "r"
        assert polygon(found.shapes[0]).bounds == pytest.approx((2, 20, 10, 26), abs=1e-3)

    def test_pixels_are_a_96th_of_an_inch(self, tmp_path):
        found = read(tmp_path, '<rect width="96" height="96"/>', 'width="192" height="192"')
        assert polygon(found.shapes[0]).bounds[2] == pytest.approx(25.4, abs=UNIT_MM)

    def test_a_page_of_another_shape_than_its_view(self, tmp_path):
        found = read(tmp_path, '<rect width="10" height="10"/>',
                     'width="40mm" height="20mm" viewBox="0 0 10 10"')  # fmt: skip
        assert polygon(found.shapes[0]).bounds == pytest.approx((10, 0, 30, 20))

    @pytest.mark.parametrize(
        "shape",
        [
            '<circle cx="50" cy="40" r="20"/>',
            '<ellipse cx="50" cy="40" rx="30" ry="10"/>',
            '<rect x="10" y="10" width="50" height="40" rx="8"/>',
            '<path d="M10 10 h40 v30 a10 20 30 1 0 -20 5 q-10 10 -20 -5z"/>',
            '<path d="M10,40 C20,0 40,0 50,40 S80,80 90,40 L90 70 T40 60 20 70 Z"/>',
            '<path d="M50 40a20 20 0 01-1 19.9A9 9 0 1110 50z"/>',
            '<path d="m10-5.5.5.5 20e0,30-15 3 Z m20 20 5 0 0 5z" fill-rule="evenodd"/>',
            '<polygon points="10,10 60,10 30,60"/>',
            '<path transform="skewX(10) matrix(.8 .1 -.1 .9 5 5)" d="M10 10L60 20 40 60z"/>',
        ],
    )
    def test_shapes_cover_what_resvg_fills(self, tmp_path, shape):
        found = read(tmp_path, shape)
        text = (tmp_path / "shapes.svg").read_text()
        drawn = _pixels(text)
        y, x = np.mgrid[0:320, 0:400] / 4 + 0.125
        inside = shapely.contains_xy(polygon(found.shapes[0]), x, y)
        assert (inside != (drawn > 127)).mean() < 0.004
        assert inside.sum() > 300

    def test_uses_and_symbols(self, tmp_path):
        found = read(
            tmp_path,
            '<defs><rect id="a" width="4" height="4"/></defs><use href="#a" x="10"/>'
            '<use href="#gone"/><use href="other.svg#a"/>',
        )
        assert len(found.shapes) == 1
        assert polygon(found.shapes[0]).bounds[0] == pytest.approx(10)
        assert any("<use>" in note for note in found.notes)

    def test_what_is_unsupported_is_named(self, tmp_path):
        found = read(
            tmp_path,
            "<text>no</text><image/><script>alert(1)</script><rect width='3' height='3'/>"
            "<g style='display:none'><rect width='3' height='3'/></g><path d='M0 0L5 5 bad'/>",
        )
        said = " ".join(found.notes)
        assert len(found.shapes) == 2
        assert not found.shapes[1].is_closed
        for what in ("<text>", "<image>", "<script>", "hidden", "path data"):
            assert what in said

    def test_entities_are_refused(self, tmp_path):
        file = tmp_path / "bomb.svg"
        for entity in ('<!ENTITY a "aaaa">', '<!ENTITY a SYSTEM "file:///etc/passwd">'):
            file.write_text(f'<!DOCTYPE svg [{entity}]><svg xmlns="http://www.w3.org/2000/svg">'
                            '<text>&a;</text></svg>')  # fmt: skip
            with pytest.raises(OutlineError, match="defines entities"):
                read_outlines(file)

    def test_uses_that_multiply_are_bounded(self, tmp_path):
        levels = "".join(
            f'<g id="g{k + 1}">' + f'<use href="#g{k}"/>' * 10 + "</g>" for k in range(12)
        )
        with pytest.raises(OutlineError):
            read(tmp_path, f'<defs><g id="g0"/>{levels}</defs><use href="#g12"/>')

    def test_a_use_of_itself_ends(self, tmp_path):
        found = read(tmp_path, '<rect width="3" height="3"/><g id="a"><use href="#a"/></g>')
        assert len(found.shapes) == 1

    def test_depth_size_and_number_are_bounded(self, tmp_path, monkeypatch):
        with pytest.raises(OutlineError):
            read(tmp_path, "<g>" * 5000 + "</g>" * 5000)
        monkeypatch.setattr("stippler.files.read.svg_outlines.MOST_VERTICES", 1000)
        with pytest.raises(OutlineError, match="more than"):
            read(
                tmp_path,
                '<path d="M0 0' + " 1 1 2 2" * 300 + '"/><path d="M0 0' + " 1 1 2 2" * 300 + '"/>',
            )
        monkeypatch.setattr(module, "MOST_BYTES", 100)
        with pytest.raises(OutlineError, match="larger"):
            read(tmp_path, " " * 200)

    @pytest.mark.parametrize("data", [b"", b"<svg", b"<html/>", b"\x1f\x8b\x00", b"\xff\xfe<"])
    def test_what_is_no_svg_is_refused(self, tmp_path, data):
        file = tmp_path / "no.svg"
        file.write_bytes(data)
        with pytest.raises(StipplerError):
            read_outlines(file)

    def test_packed_files_are_read(self, tmp_path):
        file = tmp_path / "a.svgz"
        file.write_bytes(gzip.compress(b'<svg><rect width="9" height="9"/></svg>'))
        assert len(read_outlines(file).shapes) == 1

    @given(st.text(alphabet="MmLlHhVvCcSsQqTtAaZz0123456789 ,.-+e", max_size=60))
    @settings(max_examples=200, deadline=None)
    def test_any_path_data_ends(self, data):
        from stippler.files.read.svg_data import subpaths

        for pieces, _ in subpaths(data, 10_000)[0]:
            assert all(len(p) in (2, 4) for p in pieces)


def _pixels(text):
    from io import BytesIO

    from PIL import Image

    text = text.replace('width="100mm" height="80mm"', 'width="400" height="320"')
    data = resvg_py.svg_to_bytes(svg_string=text)
    return np.array(Image.open(BytesIO(bytes(data))).convert("RGBA"))[:, :, 3]


def _areas():
    areas = PlanarMap.of_page(100, 80)
    turn = np.linspace(0, 2 * np.pi, 9)[:-1]
    ring = np.column_stack([40 + 20 * np.cos(turn), 40 + 20 * np.sin(turn)])
    areas = edits.add(areas, moves.smooth_path(Path.polyline(ring, closed=True))).map
    areas = edits.add(areas, Path.polyline(ring + np.array([18, 3]), closed=True)).map
    return edits.add(areas, Path.polyline(ring * 0.1 + (30, 36), closed=True)).map


@pytest.mark.parametrize("ending", ["svg", "geojson"])
def test_areas_come_back_as_they_were_written(tmp_path, ending):
    areas = _areas()
    file = tmp_path / f"areas.{ending}"
    names = {1: 'a "leaf" & <stem>'}
    file.write_text(
        svg_of_areas(areas, (100, 80), names) if ending == "svg" else geojson_of_areas(areas, names)
    )
    found = read_outlines(file)
    assert found.notes == ()
    assert found.shapes[1].name == names[1]
    for k, shape in zip(areas.areas, found.shapes, strict=True):
        difference = polygon(shape).symmetric_difference(areas.outline(k)).area
        assert difference < (0.05 if ending == "svg" else 1e-9)
    again = PlanarMap.of_page(100, 80)
    for shape in found.shapes[1:]:
        again = edits.add(again, list(shape.paths), rule=shape.rule).map
    again.check()
    if ending == "svg":  # curves are curves still
        assert any(arc.path.curves for arc in again.arcs.values())


def test_bad_geojson_is_named_or_refused(tmp_path):
    file = tmp_path / "a.geojson"
    square = [[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]
    parts = [
        {"type": "Point", "coordinates": [1, 2]},
        {"type": "Polygon", "coordinates": [square, [["x", 1], [2, 2], [3, 3]]]},
        {"type": "LineString", "coordinates": [[1, 1]]},
        {"type": "Polygon", "coordinates": 7},
        None,
    ]
    file.write_text(json.dumps({"type": "GeometryCollection", "geometries": parts}))
    found = read_outlines(file)
    assert len(found.shapes) == 1
    assert len(found.notes) == 4
    for text in ("", "[]", "{", '{"type":"Polygon"}', "[" * 100_000):
        file.write_text(text)
        with pytest.raises(OutlineError):
            read_outlines(file)
