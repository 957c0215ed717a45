"""Drawings kept in files, opened again by the program's three doors."""

import numpy as np
import pytest

import stippler
from stippler import cli
from stippler.errors import DrawingFileError, TableError


@pytest.fixture
def picture(tmp_path):
    from PIL import Image

    path = tmp_path / "ramp.png"
    ramp = np.tile(np.linspace(30, 250, 80).astype(np.uint8), (60, 1))
    Image.fromarray(ramp).save(path)
    return path


def test_a_drawing_saved_and_opened_gives_the_same_svg(tmp_path, picture):
    drawing = stippler.stipple(picture, dots=300, width=50)
    drawing.save(tmp_path / "one.stipple")
    drawing.save(tmp_path / "one.svg")
    again = stippler.open(tmp_path / "one.stipple")
    again.save(tmp_path / "two.svg")
    assert (tmp_path / "one.svg").read_bytes() == (tmp_path / "two.svg").read_bytes()
    assert again.reference.source.data == picture.read_bytes()
    assert again.style_of(0) == drawing.style_of(0)


def test_the_command_line_makes_and_takes_drawings(tmp_path, picture):
    one, two = tmp_path / "one.stipple", tmp_path / "two.svg"
    assert cli.run(["render", str(picture), "-o", str(one), "--dots", "300"]) == 0
    assert cli.run(["render", str(one), "-o", str(two)]) == 0
    assert two.read_bytes().startswith(b"<svg")
    assert cli.run(["render", str(one), "-o", str(one)]) == 1
    assert len(stippler.open(one).dots) > 250


def test_options_for_pictures_are_refused_for_drawings(tmp_path, picture, capsys):
    one = tmp_path / "one.stipple"
    assert cli.run(["render", str(picture), "-o", str(one), "--dots", "300"]) == 0
    assert cli.run(["render", str(one), "-o", str(tmp_path / "x.svg"), "--dots", "5"]) == 2
    assert "drawing already" in capsys.readouterr().err


def test_a_table_opens_as_a_drawing_on_a_page_that_holds_its_dots(tmp_path, picture):
    drawing = stippler.stipple(picture, dots=300, width=50)
    drawing.save(tmp_path / "one.csv")
    again = stippler.open(tmp_path / "one.csv")
    assert len(again.dots) == len(drawing.dots)
    assert again.page.width_mm >= again.dots.position_mm[:, 0].max()
    np.testing.assert_allclose(again.dots.position_mm, drawing.dots.position_mm, atol=1e-6)


def test_tables_with_places_off_any_page_are_told(tmp_path):
    (tmp_path / "a.csv").write_text("x,y\n-5,3\n")
    (tmp_path / "b.csv").write_text("x,y\n5,30000\n")
    for name in ("a.csv", "b.csv"):
        with pytest.raises(TableError):
            stippler.open(tmp_path / name)


def test_a_broken_drawing_is_told_in_one_line(tmp_path, capsys):
    (tmp_path / "x.stipple").write_bytes(b"not a drawing")
    with pytest.raises(DrawingFileError):
        stippler.open(tmp_path / "x.stipple")
    assert cli.run(["render", str(tmp_path / "x.stipple"), "-o", str(tmp_path / "x.svg")]) == 1
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert "x.stipple" in told
