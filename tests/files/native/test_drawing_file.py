from dataclasses import fields, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely.geometry import Polygon

from stippler.drawing.adjustment import Adjustment
from stippler.drawing.area import Area
from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import DrawingFileError
from stippler.files.native import arrays, structure
from stippler.files.native.container import read_container, write_container
from stippler.files.native.drawing_file import (
    STRUCTURE,
    drawing_of,
    members_of,
    open_drawing,
    save_drawing,
)
from stippler.files.read.picture import picture_of_bytes, read_picture


def some_drawing(n=50, seed=0):
    rng = np.random.default_rng(seed)
    drawing = Drawing.blank(Page(80.0, 60.0), Style(n_dots=1234, seed=7, name="bone"))
    drawing.styles[3] = Style(size_range_mm=(0.1, 0.3), pen="quill")
    corner = Polygon([(0, 0), (20 + seed % 97 / 3, 0), (0, 1 / 3 + 10)])
    drawing.areas[5] = Area('ear é\n"<', corner, style=3, locked=True, border="wall")
    dots = Dots.round(rng.random((n, 2)) * (80, 60), 0.1 + rng.random(n))
    dots.elongation[:] = 1 + rng.random(n)
    dots.angle_rad[:] = rng.random(n)
    dots.constraint[::7] = FIXED
    dots.area[::3] = 5
    dots.id[:] = rng.permutation(n * 3)[:n]
    drawing.dots = dots
    drawing.next_id = {"dot": 1000, "area": 9}
    return drawing


def assert_same(one, other):
    for f in fields(Dots):
        a, b = getattr(one.dots, f.name), getattr(other.dots, f.name)
        assert a.dtype == b.dtype
        assert a.tobytes() == b.tobytes(), f.name
        assert b.flags.writeable
    assert one.page == other.page
    assert one.areas == other.areas
    assert one.styles == other.styles
    assert one.reference == other.reference
    for kind in ("dot", "area", "style"):
        assert one.first_free(kind) == other.first_free(kind)


def opened(path):
    return open_drawing(path, picture_of_bytes)


@settings(deadline=None)
@given(st.integers(0, 40), st.integers(0, 2**32 - 1))
def test_a_drawing_comes_back_to_the_bit(tmp_path_factory, n, seed):
    path = tmp_path_factory.mktemp("file") / "one.stipple"
    drawing = some_drawing(n, seed)
    save_drawing(drawing, path)
    again, more = opened(path)
    assert_same(drawing, again)
    assert list(more) == ["thumbnail.png"]
    before = path.read_bytes()
    save_drawing(again, path)
    assert path.read_bytes() == before


def test_the_picture_comes_back_as_it_came(tmp_path, sample_path):
    drawing = some_drawing()
    reference = read_picture(sample_path, tone="linear", width_mm=80.0)
    drawing.reference = reference.adjusted(Adjustment(brightness=0.1, gamma=1.5))
    save_drawing(drawing, tmp_path / "one.stipple")
    again, _ = opened(tmp_path / "one.stipple")
    assert_same(drawing, again)
    assert again.reference.source.data == sample_path.read_bytes()
    assert again.reference.darkness.tobytes() == drawing.reference.darkness.tobytes()


def test_darkness_from_no_file_comes_back(tmp_path):
    drawing = some_drawing()
    drawing.reference = Reference(np.linspace(0, 1, 35, dtype=np.float32).reshape(5, 7), 80.0)
    save_drawing(drawing, tmp_path / "one.stipple")
    assert_same(drawing, opened(tmp_path / "one.stipple")[0])


def test_what_a_later_program_put_in_survives(tmp_path):
    members = dict(members_of(some_drawing()))
    document = structure.from_bytes(members[STRUCTURE], "here")
    document["layers"] = [1, {"a": None}]
    document["area"]["5"]["glow"] = "soft"
    document["page"]["grain"] = 2.5
    members[STRUCTURE] = structure.to_bytes(document)
    members["future/thing.bin"] = b"\0\1"
    path = tmp_path / "one.stipple"
    with path.open("wb") as stream:
        write_container(stream, members, "stippler 99")
    drawing, more = opened(path)
    more.pop("thumbnail.png", None)
    assert more == {"future/thing.bin": b"\0\1"}
    drawing.foreign = replace(drawing.foreign, members=more)
    save_drawing(drawing, path)
    found = read_container(path)
    assert found["future/thing.bin"] == b"\0\1"
    assert structure.from_bytes(found[STRUCTURE], "here") == document


@pytest.mark.parametrize(
    ("field", "value", "told"),
    [
        ("position_mm", np.nan, "dot 4: its position"),
        ("radius_mm", -1.0, "dot 4: its radius"),
        ("radius_mm", np.inf, "dot 4: its radius"),
        ("elongation", 9.0, "dot 4: its elongation"),
        ("roughness", 1.5, "dot 4: its roughness"),
        ("angle_rad", np.nan, "dot 4: its angle"),
        ("area", 77, "dot 4: its area"),
        ("constraint", 9, "dot 4: its constraint"),
        ("constraint", 2, "dot 4: its line"),
        ("id", -1, "dot 4: its id"),
        ("id", 2**60, "dot 4: its id"),
        ("parameter", np.nan, "dot 4: its place"),
    ],
)
def test_what_no_dot_can_be_is_refused_with_its_place(field, value, told):
    drawing = some_drawing()
    getattr(drawing.dots, field)[4] = value
    with pytest.raises(DrawingFileError, match=told):
        drawing_of(members_of(drawing), picture_of_bytes, "ear.stipple")


def test_an_id_that_stands_twice_is_refused():
    drawing = some_drawing()
    drawing.dots.id[4] = drawing.dots.id[5]
    with pytest.raises(DrawingFileError, match="twice"):
        drawing_of(members_of(drawing), picture_of_bytes, "ear.stipple")


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("dots", "n"), -1),
        (("dots", "n"), 10**12),
        (("dots", "n"), 49),
        (("dots", "n"), True),
        (("dots", "arrays", "radius_mm"), ["f8", [50]]),
        (("dots", "arrays", "position_mm"), ["f8", [2, 50]]),
        (("dots", "arrays"), None),
        (("page", "width_mm"), 0),
        (("page", "width_mm"), "wide"),
        (("page",), None),
        (("area", "5", "outline_mm"), "POINT (1 2)"),
        (("area", "5", "outline_mm"), "POLYGON ((0 0"),
        (("area", "5", "style"), 99),
        (("area", "5"), []),
        (("area",), []),
        (("style", "3", "pen"), "no such pen"),
        (("style", "3", "size_range_mm"), [3, 1]),
        (("style", "3", "iterations"), 1e300),
        (("next_id", "dot"), -3),
        (("next_id",), 3),
        (("reference",), {"picture": "none"}),
        (("pictures",), {"x": {"file": "missing"}}),
    ],
)
def test_a_wrong_document_is_refused_with_its_place(path, value):
    members = dict(members_of(some_drawing()))
    document = structure.from_bytes(members[STRUCTURE], "here")
    inside = document
    for name in path[:-1]:
        inside = inside[name]
    inside[path[-1]] = value
    members[STRUCTURE] = structure.to_bytes(document)
    with pytest.raises(DrawingFileError, match=r"^ear\.stipple"):
        drawing_of(members, picture_of_bytes, "ear.stipple")


def test_a_large_id_costs_nothing(tmp_path):
    drawing = some_drawing()
    drawing.dots.id[3] = 2**52
    save_drawing(drawing, tmp_path / "one.stipple")
    again, _ = opened(tmp_path / "one.stipple")
    assert again.first_free("dot") == 2**52 + 1


def test_a_hundred_thousand_dots_take_four_megabytes_at_most(tmp_path):
    rng = np.random.default_rng(1)
    drawing = Drawing.blank(Page(200.0, 200.0))
    drawing.dots = Dots.round(rng.random((100_000, 2)) * 200, 0.1 + 0.1 * rng.random(100_000))
    save_drawing(drawing, tmp_path / "one.stipple")
    assert (tmp_path / "one.stipple").stat().st_size < 4_000_000


def test_a_member_that_is_missing_is_told():
    members = dict(members_of(some_drawing()))
    for name in list(members):
        less = {k: v for k, v in members.items() if k != name}
        with pytest.raises(DrawingFileError):
            drawing_of(less, picture_of_bytes, "ear.stipple")
        short = {**members, name: members[name][:-1]}
        with pytest.raises(DrawingFileError):
            drawing_of(short, picture_of_bytes, "ear.stipple")


def test_arrays_of_the_drawing_are_its_own(tmp_path):
    members = members_of(some_drawing())
    drawing, _ = drawing_of(members, picture_of_bytes, "ear")
    drawing.dots.position_mm[:] = 0
    again, _ = drawing_of(members, picture_of_bytes, "ear")
    assert arrays.to_bytes(again.dots.position_mm) == members["dots/position_mm.f8"]
