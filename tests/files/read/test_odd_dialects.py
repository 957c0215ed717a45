"""What readers make of the rarer words of their dialects: transforms, arcs, odd pages of TIFF."""

import io
from pathlib import Path

import numpy as np
import pytest
import tifffile

from stippler.errors import PictureError, StipplerError
from stippler.files.read import svg_data, table
from stippler.files.read.picture import picture_of_bytes
from stippler.files.read.svg_data import subpaths
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
    return picture_of_bytes(data, "a.tif", "perceptual").levels.darkness()


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


# --- paths at their limits, pages of one side, masks ----------------------------------------------


def test_path_data_is_read_up_to_its_limit_and_what_was_drawn_by_then_is_kept():
    text = "M0 0L1 0L1 1L0 1"
    whole, done = subpaths(text, 4)
    assert done
    ((pieces, closed),) = whole
    assert (len(pieces), closed) == (3, False)
    cut, done = subpaths(text, 3)
    assert not done
    assert len(cut[-1][0]) == 2
    for most, n_found in ((2, 1), (3, 1), (4, 1), (5, 2)):  # nothing of no length is left over
        found, done = subpaths("M0 0L1 0ZM5 5L6 5", most)
        assert [len(pieces) for pieces, _ in found] == [1] * n_found
        assert done is (most == 5)


def test_subpaths_begin_anew_at_each_move_and_after_each_close():
    found, done = subpaths("M0 0L1 0M5 5L6 5m1 1l1 0zl0 1", 99)
    assert done
    begins = [[float(v) for v in pieces[0][0]] for pieces, _ in found]
    assert begins == [[0, 0], [5, 5], [7, 6], [7, 6]]
    assert [closed for _, closed in found] == [False, False, True, False]
    assert subpaths("ZM1 1L2 2", 9)[0][0][0][0].tolist() == [[1, 1], [2, 2]]
    assert subpaths("L1 1", 9) == ([], False)
    assert subpaths("M1 1L2 2!", 9)[1] is False


def size_of(attributes):
    data = (
        f'<svg xmlns="http://www.w3.org/2000/svg" {attributes}><rect width="2" height="1"/></svg>'
    )
    found = outlines_of_svg(data.encode(), Path("here"))
    (shape,) = found.shapes
    points = shape.paths[0].points_mm
    return found.size_mm, tuple((points.max(axis=0) - points.min(axis=0)).round(4).tolist())


PX = 25.4 / 96


@pytest.mark.parametrize(
    ("attributes", "page", "rect"),
    [
        ('viewBox="0 0 20 10" width="40mm" height="20mm"', (40, 20), (4, 2)),
        ('viewBox="0 0 20 10" width="40mm"', (40, 20), (4, 2)),
        ('viewBox="0 0 20 10" height="20mm"', (40, 20), (4, 2)),
        ('viewBox="0 0 20 10"', (20 * PX, 10 * PX), (2 * PX, PX)),
        ('viewBox="0 0 20 10" width="40mm" height="40mm"', (40, 40), (4, 2)),
        ('viewBox="0 0 20 0" width="40mm" height="40mm"', (40, 40), (2 * PX, PX)),
        ('viewBox="0 0 20" width="40mm"', None, (2 * PX, PX)),
        ('viewBox="0 0 20 10" width="40mm" height="40mm" preserveAspectRatio="none"',
         (40, 40), (4, 4)),
        ('viewBox="0 0 20 10" width="40mm" height="40mm" preserveAspectRatio="xMinYMin slice"',
         (40, 40), (8, 4)),
    ],
)  # fmt: skip
def test_a_page_has_the_size_that_is_told_or_follows_from_it(attributes, page, rect):
    size, sides = size_of(attributes)
    assert sides == pytest.approx(rect, abs=2e-3)
    assert size == (page if page is None else pytest.approx(page))


def test_a_shape_with_a_mask_is_kept_whole_and_that_is_told():
    for name in ("clip-path", "mask", "filter"):
        found = boxes_and_notes(f'<rect width="9" height="9" {name}="url(#a)"/>')
        assert found == (1, (f"left out: 1 x {name} (the shape is kept whole)",))
    plain = boxes_and_notes('<rect width="9" height="9" style="fill:red"/>')
    assert plain == (1, ())


def boxes_and_notes(body):
    data = f'<svg xmlns="http://www.w3.org/2000/svg">{body}</svg>'
    found = outlines_of_svg(data.encode(), Path("here"))
    return len(found.shapes), found.notes


def test_lines_of_a_single_corner_are_nothing():
    body = '<polygon points="1,1"/><polyline points="1,1 2"/><polyline points="1,1 2,2 3"/>'
    assert boxes_and_notes(body)[0] == 1
    assert boxes_and_notes('<line x2="5" y2="5"/>')[0] == 1


def test_a_table_that_may_not_be_read_says_why(tmp_path, monkeypatch):
    def fails(_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "read_bytes", fails)
    with pytest.raises(StipplerError, match=r"cannot be read \(Permission denied.*check the file"):
        read_csv(tmp_path / "one.csv")


def test_our_own_tables_with_rows_of_another_length_are_refused_by_line(tmp_path):
    head = ",".join(table.NAMES)
    rows = ["1,2,0.5,1,0,0,7,0,0", "3,4,0.5,1,0,0,7,0,0"]
    path = tmp_path / "one.csv"
    path.write_text("\n".join([head, *rows]) + "\n")
    assert len(read_csv(path)) == 2
    path.write_text("\n".join([head, *(row + ",5" for row in rows)]) + "\n")
    with pytest.raises(StipplerError, match="line 2"):
        read_csv(path)


def test_ids_in_a_table_count_where_each_stands_once(tmp_path):
    path = tmp_path / "one.csv"
    for ids, wanted in (([7, 3], [7, 3]), ([7, 7], [0, 1])):
        path.write_text("x,y,id\n" + "".join(f"{k},{k},{i}\n" for k, i in enumerate(ids, 1)))
        assert read_csv(path).id.tolist() == wanted
