"""Rules that few files need: what is drawn of an SVG, names, words, limits, raw files."""

import io
import json
import struct
import zlib
from pathlib import Path

import numpy as np
import pytest
import tifffile
from PIL import Image

from stippler.errors import PictureError
from stippler.files.read import geojson, outlines, pillow, svg_outlines
from stippler.files.read.kinds import is_table, kind_of
from stippler.files.read.outlines import OutlineError, read_outlines
from stippler.files.read.picture import picture_of_bytes
from stippler.files.read.pixels import with_alpha
from stippler.files.read.svg_outlines import outlines_of_svg
from stippler.files.read.table import read_csv

PX = 25.4 / 96


def shapes(body, attributes=""):
    text = f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}>{body}</svg>'
    return outlines_of_svg(text.encode(), Path("here"))


def boxes(body, attributes=""):
    """Return the corners of each shape in pixels: left, top, right, bottom."""
    found = shapes(body, attributes)
    return [
        tuple(
            np.round(np.r_[at.min(axis=0), at.max(axis=0)] / PX, 1).tolist()
        )
        for at in (np.concatenate([p.points_mm for p in s.paths]) for s in found.shapes)
    ]  # fmt: skip


SQUARE = '<rect id="a" width="10" height="10"/>'


# --- SVG ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("tag", ["defs", "symbol", "metadata", "title"])
def test_what_is_kept_for_use_is_not_drawn_by_itself(tag):
    hidden = f'<{tag}><rect width="5" height="5"/></{tag}>'
    assert boxes(SQUARE + hidden) == [(0, 0, 10, 10)]
    assert boxes(f'{SQUARE}<x:{tag}><rect width="5" height="5"/></x:{tag}>') == [(0, 0, 10, 10)]


def test_a_use_moves_what_it_shows_and_a_nested_svg_what_is_in_it():
    assert boxes(f'<defs>{SQUARE}</defs><use href="#a" x="30" y="20"/>') == [(30, 20, 40, 30)]
    inner = f'<svg x="30" y="20">{SQUARE}</svg>'
    assert boxes(inner) == [(30, 20, 40, 30)]
    scaled = f'<svg x="30" y="20" width="40" height="40" viewBox="0 0 20 20">{SQUARE}</svg>'
    assert boxes(scaled) == [(30, 20, 50, 40)]


@pytest.mark.parametrize(
    ("align", "box"),
    [
        ("xMinYMin", (0, 0, 10, 10)), ("xMidYMid", (10, 0, 20, 10)), ("xMaxYMax", (20, 0, 30, 10)),
        ("none", (0, 0, 20, 10)), ("", (10, 0, 20, 10)),
    ],
)  # fmt: skip
def test_a_view_is_laid_into_its_page_as_it_asks(align, box):
    sizes = 'width="40px" height="20px" viewBox="0 0 20 20"'
    assert boxes(SQUARE, f'{sizes} preserveAspectRatio="{align}"') == [box]


def test_a_view_that_begins_elsewhere_is_moved_there():
    sizes = 'width="40px" height="40px" viewBox="5 3 20 20"'
    assert boxes(SQUARE, sizes) == [(-10, -6, 10, 14)]


def test_rules_and_names_are_those_of_the_file():
    found = shapes(
        '<g fill-rule="evenodd"><rect width="9" height="9"/>'
        '<rect id="b" width="9" height="9" fill-rule="nonzero"/></g>' + SQUARE
    ).shapes
    assert [s.rule for s in found] == ["even-odd", "non-zero", "non-zero"]
    assert [s.name for s in found] == ["", "b", "a"]


def test_a_shape_beyond_all_bounds_takes_no_other_with_it():
    far = "M0 0L1e300 0L0 9ZM0 0L9 0L0 9Z"
    found = shapes(f'<path d="{far}"/>{SQUARE}')
    assert len(found.shapes) == 2
    assert found.notes == ("left out: 1 x shapes beyond all bounds",)
    tiny = shapes(f'<path d="M0 0L0 0ZM0 0L9 0L0 9Z"/>{SQUARE}')
    assert [len(s.paths) for s in tiny.shapes] == [1, 1]
    assert tiny.notes == ("left out: 1 x shapes without extent",)


@pytest.mark.parametrize(("rx", "ry"), [(3.0, 3.0), (99.0, 2.0), (2.0, 99.0), (99.0, 99.0)])
def test_corners_are_round_up_to_half_of_a_side(rx, ry):
    body = f'<rect x="1" y="2" width="20" height="10" rx="{rx}" ry="{ry}"/>'
    (shape,) = shapes(body).shapes
    at = shape.paths[0].points_mm / PX
    x, y = min(rx, 10.0), min(ry, 5.0)
    assert np.r_[at.min(axis=0), at.max(axis=0)] == pytest.approx([1, 2, 21, 12], abs=0.01)
    away = np.maximum(np.abs(at - [11, 7]) - [10 - x, 5 - y], 0) / [x, y]
    on_arc = (away > 1e-3).all(axis=1)
    assert on_arc.any()
    assert np.hypot(*away[on_arc].T) == pytest.approx(np.ones(on_arc.sum()), abs=0.01)


def test_uses_are_counted_one_by_one(monkeypatch):
    monkeypatch.setattr(svg_outlines, "_MOST_USES", 3)
    three = f"<defs>{SQUARE}</defs>" + '<use href="#a"/>' * 3
    assert len(shapes(three).shapes) == 3
    four = shapes(three + '<use href="#a"/>')
    assert len(four.shapes) == 3
    assert four.notes == ("left out: 1 x <use> of too many",)


def test_limits_of_outlines_are_met_exactly(tmp_path, monkeypatch):
    path = tmp_path / "one.svg"
    text = f'<svg xmlns="http://www.w3.org/2000/svg">{SQUARE}</svg>'
    path.write_text(text)
    monkeypatch.setattr(outlines, "MOST_BYTES", len(text))
    assert len(read_outlines(path).shapes) == 1
    monkeypatch.setattr(outlines, "MOST_BYTES", len(text) - 1)
    with pytest.raises(OutlineError):
        read_outlines(path)
    monkeypatch.setattr(svg_outlines, "MOST_VERTICES", 5)
    assert len(shapes(SQUARE).shapes) == 1
    monkeypatch.setattr(svg_outlines, "MOST_VERTICES", 4)
    with pytest.raises(OutlineError, match="vertices"):
        shapes(SQUARE)


def test_collections_in_collections_are_read_to_a_depth(monkeypatch):
    item = {"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 0]]]}
    for _ in range(4):
        item = {"type": "GeometryCollection", "geometries": [item]}
    monkeypatch.setattr(geojson, "_MOST_DEPTH", 4)
    data = json.dumps(item).encode()
    assert len(geojson.outlines_of_geojson(data, Path("here")).shapes) == 1
    monkeypatch.setattr(geojson, "_MOST_DEPTH", 3)
    with pytest.raises(OutlineError, match="no polygon or line"):
        geojson.outlines_of_geojson(data, Path("here"))


# --- pictures -----------------------------------------------------------------------------------


def chunk(name, body):
    data = name + body
    return struct.pack(">I", len(body)) + data + struct.pack(">I", zlib.crc32(data))


def png(*extra):
    rows = b"".join(b"\0" + bytes(range(k, k + 64)) for k in range(0, 192, 64))
    head = struct.pack(">IIBBBBB", 64, 3, 8, 0, 0, 0, 0)
    parts = [(b"IHDR", head), *extra, (b"IDAT", zlib.compress(rows)), (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts)


def dark(data, name="a.png"):
    return picture_of_bytes(data, name, "linear").levels.darkness()


def test_a_gamma_that_is_as_good_as_srgbs_is_srgb():
    plain = dark(png())
    for told in (45455, 45200, 45900):
        assert np.array_equal(dark(png((b"gAMA", struct.pack(">I", told)))), plain)
    other = dark(png((b"gAMA", struct.pack(">I", 55555))))
    level = np.arange(192).reshape(3, 64) / 255
    assert other == pytest.approx(1 - level**1.8, abs=2e-3)


def exif(orientation):
    image = Image.new("L", (3, 2))
    tags = Image.Exif()
    tags[0x0112] = orientation
    stream = io.BytesIO()
    image.save(stream, "png", exif=tags)
    return Image.open(io.BytesIO(stream.getvalue()))


@pytest.mark.parametrize(("told", "wanted"), [(0, 1), (1, 1), (2, 2), (8, 8), (9, 1), (700, 1)])
def test_orientations_are_those_that_there_are(told, wanted):
    assert pillow.orientation_of(exif(told)) == wanted


def test_only_what_is_transparent_in_all_its_colours_is():
    samples = np.array([[[9, 9, 9], [9, 9, 8], [1, 2, 3], [8, 9, 9]]], np.uint8)
    found = with_alpha(samples, (9, 9, 9), 255)
    assert found[0, :, 3].tolist() == [0, 255, 255, 255]
    assert np.array_equal(found[..., :3], samples)


@pytest.mark.parametrize("photometric", [32803, 34892])
def test_sensors_of_cameras_are_refused_as_raw(photometric):
    stream = io.BytesIO()
    options = {"photometric": photometric}
    if photometric == 32803:
        options["extratags"] = [(33421, "H", 2, (2, 2), True), (33422, "B", 4, b"\0\1\1\2", True)]
    shape = (8, 8) if photometric == 32803 else (8, 8, 3)
    tifffile.imwrite(stream, np.zeros(shape, np.uint16), **options)
    with pytest.raises(PictureError, match=r"raw|camera"):
        dark(stream.getvalue(), "a.tif")


def test_the_brightest_of_a_palette_is_white():
    ramp = np.linspace(0, 65535, 256).astype(np.uint16)
    stream = io.BytesIO()
    samples = np.arange(256, dtype=np.uint8).reshape(16, 16)
    tifffile.imwrite(stream, samples, photometric="palette", colormap=np.stack([ramp] * 3))
    found = dark(stream.getvalue(), "a.tif")
    assert (found[0, 0], found[-1, -1]) == (1.0, 0.0)


# --- tables -------------------------------------------------------------------------------------


def test_words_for_yes_and_no_in_a_table(tmp_path):
    path = tmp_path / "one.csv"
    words = {"true": 1, "false": 0, "wahr": 1, "falsch": 0, "yes": 1, "no": 0, "TRUE": 1, "1": 1}
    path.write_text("x,y,fixed\n" + "".join(f"{k},{k},{w}\n" for k, w in enumerate(words)))
    assert read_csv(path).fixed.tolist() == [bool(v) for v in words.values()]


def test_what_looks_like_a_table_in_any_of_its_first_lines():
    assert is_table(b"# made by hand\n" * 10 + b"X_mm,y_mm\n1,2\n")
    assert not is_table(b"# made by hand\n" * 12 + b"X_mm,y_mm\n1,2\n")
    assert is_table(b"a,b\n1,2\n3,4\n5,")
    assert not is_table(b"a,b\n1,2\nfive,")
    assert not is_table(b"\0" + b"x_mm,y_mm\n1,2\n")


@pytest.mark.parametrize(
    ("head", "kind"),
    [(b"II*\0", "tiff"), (b"MM\0*", "tiff"), (b"II+\0", "tiff"), (b"MM\0+", "tiff"),
     (b"\x89PNG\r\n\x1a\n", "png"), (b"\xff\xd8\xff\xe0", "jpeg"), (b"%PDF-1.7", ""),
     (b"<svg xmlns=", ""), (b"GIF89a", ""), (b"", "")],
)  # fmt: skip
def test_who_reads_a_file_is_told_by_its_beginning(head, kind):
    assert kind_of(head + bytes(40)) == kind
