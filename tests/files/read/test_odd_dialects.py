"""What readers make of the rarer words of their dialects: transforms, arcs, odd pages of TIFF."""

import io

import numpy as np
import pytest
import tifffile

from stippler.errors import PictureError, StipplerError
from stippler.files.read import svg_data
from stippler.files.read.picture import picture_of_bytes
from stippler.files.read.svg_outlines import outlines_of_svg
from stippler.files.read.table import read_csv


def moved(text, x, y):
    return (svg_data.matrix(text) @ (x, y, 1.0))[:2].tolist()


def test_transforms_by_their_definitions():
    assert moved("rotate(90)", 3, 1) == pytest.approx([-1, 3])
    assert moved("rotate(90 2 2)", 3, 2) == pytest.approx([2, 3])
    assert moved("scale(2)", 3, 1) == [6, 2]
    assert moved("scale(2 5)", 3, 1) == [6, 5]
    assert moved("skewX(45)", 3, 1) == pytest.approx([4, 1])
    assert moved("skewY(45)", 3, 1) == pytest.approx([3, 4])
    assert moved("translate(7) rotate(90)", 3, 1) == pytest.approx([6, 3])
    for wrong in ("rotate()", "scale()", "skewX()", "fly(3)"):
        with pytest.raises(ValueError, match=r"rotate|scale|skewX|fly"):
            svg_data.matrix(wrong)


def boxes(body):
    text = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 96 96">{body}</svg>'
    found = outlines_of_svg(text.encode(), "here")
    return [
        np.r_[shape.paths[0].points_mm.min(axis=0), shape.paths[0].points_mm.max(axis=0)]
        * (96 / 25.4)
        for shape in found.shapes
    ], found.notes


def test_shapes_of_no_extent_or_unknown_transforms_are_left_out_and_told():
    square = '<rect width="10" height="10"/>'
    found, notes = boxes(
        f'{square}<rect width="0" height="5"/><rect width="5" height="-1"/>'
        '<rect width="9" height="9" transform="fly(3)"/>'
    )
    assert len(found) == 1
    assert any("unknown transform" in note for note in notes)


def test_symbols_are_drawn_where_they_are_used():
    found, _ = boxes(
        '<symbol id="s"><rect width="10" height="4"/></symbol><use href="#s" x="20" y="30"/>'
    )
    assert [np.round(b, 3).tolist() for b in found] == [[20, 30, 30, 34]]


def test_arcs_without_a_radius_are_lines_and_to_where_they_begin_nothing():
    for text in ("M0 0 A0 5 0 0 1 30 40 L30 0 Z", "M30 40 A9 9 0 0 1 30 40 L0 0 L30 0 Z"):
        found, _ = boxes(f'<path d="{text}"/>')
        assert np.round(found[0], 3).tolist() == [0, 0, 30, 40]


def test_a_path_has_to_begin_with_a_move():
    found, _ = boxes('<rect width="9" height="9"/><path d="L5 5 L9 0 Z"/>')
    assert len(found) == 1


def written(samples, **options):
    stream = io.BytesIO()
    tifffile.imwrite(stream, samples, **options)
    return stream.getvalue()


def darkness(data):
    return picture_of_bytes(data, "a.tif", "perceptual").darkness


@pytest.mark.parametrize(
    ("data", "why"),
    [
        (written(np.zeros((2, 8, 8), np.uint8), volumetric=True, tile=(16, 16, 16)), "a volume"),
        (written(np.zeros((8, 8), np.complex64)), "complex numbers"),
        (
            written(
                np.zeros((8, 8, 4), np.uint8), photometric="separated",
                extratags=[(332, "H", 1, 2, True)],
            ),
            "other than CMYK",
        ),
        (
            written(np.zeros((8, 8), np.uint8), extratags=[(50706, "B", 4, (1, 4, 0, 0), True)]),
            "raw|camera|DNG",
        ),
    ],
)  # fmt: skip
def test_pages_that_are_no_picture(data, why):
    with pytest.raises(PictureError, match=why):
        darkness(data)


def test_a_palette_of_small_numbers_is_stretched():
    """Some programs write colours of 0 to 255 where 0 to 65535 is meant."""
    ramp = np.linspace(0, 255, 256).astype(np.uint16)
    samples = np.arange(64, dtype=np.uint8).reshape(8, 8) * 4
    small = written(samples, photometric="palette", colormap=np.stack([ramp] * 3))
    full = written(samples, photometric="palette", colormap=np.stack([ramp * 257] * 3))
    assert np.allclose(darkness(small), darkness(full), atol=1e-6)
    assert darkness(small).max() == pytest.approx(1.0)


def test_floats_with_a_told_top_are_of_it():
    samples = np.array([[0.0, 500.0, 1000.0]], np.float32).repeat(4, 0)
    told = written(samples, extratags=[(341, "f", 1, 1000.0, True)])
    assert darkness(told)[0] == pytest.approx([1.0, 0.5, 0.0], abs=0.01)


def test_tables_that_are_no_file(tmp_path):
    for path, why in ((tmp_path / "none.csv", "no such file"), (tmp_path, "is a folder")):
        with pytest.raises(StipplerError, match=why):
            read_csv(path)
