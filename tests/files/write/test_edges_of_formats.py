"""Formats at their edges: options that are none, empty and sorted layers, sizes beyond a format."""

import itertools
import json
import re
from dataclasses import replace

import numpy as np
import pytest

from stippler.drawing.dots import Dots
from stippler.errors import OutputError, ParameterError, PictureError
from stippler.files import presses
from stippler.files.checks import Process
from stippler.files.read import geojson, jpeg
from stippler.files.read.outlines import OutlineError, read_outlines
from stippler.files.read.picture import (
    darkness_of_array,
    darkness_of_image,
    read_picture,
    small_grey,
)
from stippler.files.read.pixels import with_alpha
from stippler.files.write import dxf, svg, tiff
from stippler.files.write.formats import format_named, format_of
from stippler.files.write.lettering import width_mm, wrapped
from stippler.files.write.options import Option
from stippler.files.write.pdf import PLACES, places_for
from stippler.files.write.pen_paths import paths_of
from stippler.files.write.plate import length_text
from stippler.files.write.profiles import with_profile
from stippler.files.write.sheet import Layer, Sheet
from stippler.files.write.sizes import STEP, by_size

NUMBER = Option("dot_size", 2.0, "Size.", "mm", 1.0, 5.0)
WHOLE = Option("n_rows", 3, "Rows.", low=1, high=9)
FLAG = Option("sort", False, "Sort.")
WORD = Option("how", "one", "How.", choices=("one", "two"))
MAY_LACK = Option("width", None, "Width.", low=1, high=9, kind=float)


def test_options_by_their_kind():
    assert (NUMBER.check("2.5"), NUMBER.check(1), NUMBER.check(5.0)) == (2.5, 1.0, 5.0)
    assert WHOLE.check(3.0) == 3
    assert isinstance(WHOLE.check(3.0), int)
    assert FLAG.check(True) is True
    assert WORD.check("two") == "two"
    assert MAY_LACK.check(None) is None
    assert NUMBER.title == "Dot size"
    assert NUMBER.flag == "--dot-size"


@pytest.mark.parametrize(
    ("option", "value"),
    [
        (NUMBER, 0.99), (NUMBER, 5.01), (NUMBER, "x"), (NUMBER, None), (NUMBER, np.nan),
        (WHOLE, 2.5), (WHOLE, 0), (FLAG, 1), (FLAG, "yes"), (WORD, "three"), (MAY_LACK, 0.5),
    ],
)  # fmt: skip
def test_values_that_an_option_cannot_take(option, value):
    with pytest.raises(ParameterError, match="cannot be used"):
        option.check(value)


def test_formats_by_ending_and_by_name():
    for ending in ("svg", "PDF", "tif", "tiff", "csv"):
        assert format_of(f"a/b.{ending}") is format_named(ending)
        assert format_named(f".{ending}") is format_named(ending)
    for name, why in (("a.doc", "'.doc' is not written"), ("a", "has no ending")):
        with pytest.raises(OutputError, match=why):
            format_of(name)
    with pytest.raises(ParameterError, match="'doc' is no format"):
        format_named("doc")


def test_profiles_give_what_is_not_given():
    with pytest.raises(ParameterError, match="name a profile"):
        with_profile({"column": 1}, ())
    assert with_profile({"dpi": 300}, ()) == {"dpi": 300}


def test_words_are_wrapped_where_they_must_be():
    text = "of dots and of a wordlongerthanallothers in it"
    most = width_mm("of dots and", 2.0)
    rows = wrapped(text, 2.0, most)
    assert " ".join(rows) == text
    assert rows[0] == "of dots and"
    assert all(width_mm(row, 2.0) <= most or " " not in row for row in rows)
    for row, following in itertools.pairwise(rows):
        assert width_mm(f"{row} {following.split()[0]}", 2.0) > most
    assert wrapped("", 2.0, 5.0) == [""]


def test_lengths_have_the_unit_that_makes_them_small():
    told = [length_text(mm) for mm in (2000.0, 100.0, 99.0, 20.0, 1.0, 0.5, 0.001, 0.0005)]
    assert told == ["2 m", "10 cm", "99 mm", "20 mm", "1 mm", "500 µm", "1 µm", "500 nm"]


def test_decimals_of_a_pdf_suit_its_smallest_dot():
    assert places_for(5.0) == PLACES
    for smallest in (0.05, 0.009, 0.0007):
        places = places_for(smallest)
        assert 10.0**-places <= 0.1 * smallest or places == 6
        assert places == PLACES or 10.0 ** (1 - places) > 0.1 * smallest


def test_dots_of_one_size_keep_their_ink_together():
    rng = np.random.default_rng(0)
    radius = rng.uniform(0.1, 0.3, 2000).astype(np.float32)
    ink, rows = 0.0, []
    last = 0.0
    for diameter, mine in by_size(radius):
        assert diameter > last
        assert np.abs(2 * radius[mine] / diameter - 1).max() < STEP
        ink += len(mine) * (diameter / 2) ** 2
        last = diameter
        rows += mine.tolist()
    assert sorted(rows) == list(range(2000))
    assert ink == pytest.approx(float((radius.astype(float) ** 2).sum()))
    assert list(by_size(radius[:0])) == []


def sheet(n=60):
    at = np.random.default_rng(1).random((n, 2)) * (40, 20)
    return Sheet(40.0, 20.0, (Layer("dots", Dots.round(at, 0.25)), Layer("none")))


def travel(at):
    return np.hypot(*np.diff(at, axis=0).T).sum()


def test_sorted_dots_are_the_same_dots_in_a_shorter_way():
    one = sheet()
    position = one.layers[0].dots.position_mm

    def of_svg(values):
        text = b"".join(svg.chunks(one, {"round_dots": "circles", **values})).decode()
        return np.array(re.findall(r'cx="([-\d.]+)" cy="([-\d.]+)"', text), float)

    def of_dxf(values):
        text = b"".join(dxf.chunks(one, {"dots_as": "circles", **values})).decode()
        found = re.findall(r"CIRCLE\n8\n\S+\n10\n([-\d.]+)\n20\n([-\d.]+)", text)
        return np.array(found, float) * (1, -1) + (0, 20.0)

    for read in (of_svg, of_dxf):
        plain, short = read({}), read({"sort": True})
        assert np.allclose(plain, position, atol=1e-3)
        assert np.allclose(np.sort(short, axis=0), np.sort(plain, axis=0))
        assert travel(short) < 0.5 * travel(plain)


def test_a_layer_that_a_pen_has_nothing_to_do_in():
    found = paths_of(Layer("none"), sheet(), 0.3, sort=True)
    assert len(found.points_mm) == 0


def test_a_tiff_beyond_what_one_can_hold_is_refused(monkeypatch):
    monkeypatch.setattr(tiff, "_MOST_BYTES", 200)
    with pytest.raises(OutputError, match="larger than a TIFF"):
        list(tiff.chunks(sheet(), {"dpi": 100, "bits": 8}))


# --- what readers refuse ------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["least_dot_mm", "least_gap_mm", "gain_mm"])
def test_processes_that_are_none(name):
    assert getattr(Process(**{name: 10.0}), name) == 10.0
    for value in (-0.1, 10.1, np.nan):
        with pytest.raises(ParameterError, match=f"{name[:-3]}"):
            Process(**{name: value})


def test_presses_of_no_file_are_none(tmp_path):
    assert presses.presses(tmp_path) == {}


def test_outlines_of_other_files_are_refused(tmp_path):
    for name, why in (("a.txt", ".txt is no kind"), ("a", "no ending is no kind")):
        path = tmp_path / name
        path.write_bytes(b"{}")
        with pytest.raises(OutlineError, match=why):
            read_outlines(path)


def test_more_outlines_than_are_read_are_refused(monkeypatch):
    square = {"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]}
    data = json.dumps({"type": "GeometryCollection", "geometries": [square] * 3}).encode()
    assert len(geojson.outlines_of_geojson(data, "here").shapes) == 3
    for name, most in (("MOST_SHAPES", 2), ("MOST_VERTICES", 11)):
        with monkeypatch.context() as patch:
            patch.setattr(geojson, name, most)
            with pytest.raises(OutlineError, match="has more than"):
                geojson.outlines_of_geojson(data, "here")


@pytest.mark.parametrize(
    ("values", "why"),
    [
        ([[1, 2], [3]], "rows differ"),
        (np.zeros((2, 2, 5)), "is no picture"),
        (np.zeros(4), "is no picture"),
        (np.zeros((0, 4)), "is no picture"),
        (np.array([["a"]]), "are no picture"),
        (np.array([[1.1]]), "0 \\(black\\) to 1"),
        (np.array([[np.nan]]), "0 \\(black\\) to 1"),
        (np.array([[-1]]), "negative"),
    ],
)
def test_arrays_that_are_no_picture(values, why):
    with pytest.raises(ParameterError, match=why):
        darkness_of_array(values)


def test_whole_numbers_of_any_width_go_over_their_range():
    for kind in (np.uint8, np.uint16, np.uint32, np.int16, np.int64):
        most = np.iinfo(kind).max
        found = darkness_of_array(np.array([[0, most // 2, most]], kind), "perceptual")
        assert found[0] == pytest.approx([1.0, 0.5, 0.0], abs=0.005)
    assert darkness_of_array(np.array([[True, False]]))[0].tolist() == [0.0, 1.0]


def test_one_colour_that_is_transparent():
    samples = np.array([[(1, 2, 3), (1, 2, 4)]], np.uint8)
    assert with_alpha(samples, (1, 2, 3), 255)[0].tolist() == [[1, 2, 3, 0], [1, 2, 4, 255]]
    grey = np.array([[7, 8]], np.uint16)
    assert with_alpha(grey, (8,), 65535)[0].tolist() == [[7, 65535], [8, 0]]


def test_small_pictures_for_lists(tmp_path):
    from PIL import Image

    path = tmp_path / "a.png"
    half = np.zeros((40, 80, 4), np.uint8)
    half[:, 40:] = (0, 0, 0, 255)
    Image.fromarray(half).save(path)
    grey = small_grey(path, 20)
    assert grey.shape == (10, 20)
    assert grey[5, 2] == 255  # what is transparent is paper
    assert grey[5, 17] == 0
    path.write_bytes(path.read_bytes()[:60])
    assert small_grey(path, 20) is None
    assert small_grey(tmp_path / "none.png", 20) is None


@pytest.mark.filterwarnings("ignore:Corrupt EXIF")
def test_a_broken_block_of_exif_leaves_a_picture_upright():
    assert jpeg._orientation(b"Exif\0\0II*\0\xff\xff\xff\xff") == 1
    assert jpeg._orientation(b"") == 1


def test_jpegs_whose_frame_is_none_are_refused():
    frame = jpeg.Frame((2, 2), 12, 1, False)
    for odd, why in (
        (replace(frame, channels=7), "7 channels"),
        (replace(frame, bits=17), "17 bits"),
        (replace(frame, bits=1), "1 bits"),
    ):
        with pytest.raises(PictureError, match=why):
            jpeg.decode(None, odd)


def test_what_the_system_says_of_a_file_is_told(tmp_path, monkeypatch):
    with pytest.raises(PictureError, match="no such file"):
        read_picture(tmp_path / "none.png", tone="linear", width_mm=9.0)
    with pytest.raises(PictureError, match="is a folder"):
        read_picture(tmp_path, tone="linear", width_mm=9.0)
    path = tmp_path / "a.png"
    path.write_bytes(b"x")

    def fails(error):
        def raises(*given, **more):
            raise error

        return raises

    for error, why in (
        (PermissionError(13, "no"), "may not be read"), (MemoryError(), "more memory"),
    ):  # fmt: skip
        with monkeypatch.context() as patch:
            patch.setattr("pathlib.Path.read_bytes", fails(error))
            patch.setattr("pathlib.Path.open", fails(error))
            with pytest.raises(PictureError, match=why):
                read_picture(path, tone="linear", width_mm=9.0)


def test_an_image_beyond_the_limit_is_refused(monkeypatch):
    from PIL import Image

    image = Image.new("L", (4, 3), 0)
    assert darkness_of_image(image).shape == (3, 4)
    monkeypatch.setattr("stippler.files.read.picture.MAX_PIXELS", 11)
    with pytest.raises((PictureError, ParameterError), match="pixels"):
        darkness_of_image(image)
    with pytest.raises(ParameterError, match="megapixels"):
        darkness_of_array(np.zeros((3, 4)))
