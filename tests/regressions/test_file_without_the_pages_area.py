"""Drawings saved once whose areas covered the page lacked its own area, and were refused."""

import numpy as np
import pytest
from shapely.geometry import box

from stippler.drawing.area import Area
from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits
from stippler.drawing.style import Style
from stippler.errors import DrawingFileError
from stippler.files.native.drawing_file import save_drawing
from stippler.opening import open_file


def saved_as_then(path, outlines):
    """Write a file as it was done then: with areas, and without the page's."""
    drawing = Drawing.blank(Page(40.0, 30.0))
    drawing.dots = Dots.round(np.array([[0.0, 0.0], [10.0, 10.0], [30.0, 10.0]]), 0.2)
    drawing.dots.area[:] = 0, 1, len(outlines)  # the first lies on the very rim
    drawing.styles[4] = Style(n_dots=7)
    del drawing.areas[0]
    drawing.areas |= {k: Area(f"area {k}", o, 4) for k, o in enumerate(outlines, start=1)}
    save_drawing(drawing, path)


@pytest.mark.parametrize(
    ("outlines", "rest"),
    [
        ([box(0, 0, 40, 30)], 0.0),
        ([box(0, 0, 20, 30), box(20, 0, 40, 30)], 0.0),
        ([box(-5, -5, 20, 35), box(20 + 1e-9, -5, 45, 35)], 0.0),
        ([box(0, 0, 20, 30), box(25, 0, 40, 30)], 150.0),
    ],
)
def test_it_is_put_back(tmp_path, outlines, rest):
    path = tmp_path / "then.stipple"
    saved_as_then(path, outlines)
    found = open_file(path)
    assert sorted(found.areas) == [0, *range(1, len(outlines) + 1)]
    assert found.areas[0].outline_mm.area == pytest.approx(rest)
    assert found.areas[0].outline_mm.is_empty == (rest == 0.0)
    assert found.style_of(0).n_dots == 7
    assert found.dots.area.tolist() == [0, 1, len(outlines)]
    again = tmp_path / "again.stipple"
    save_drawing(found, again)
    assert sorted(open_file(again).areas) == sorted(found.areas)
    document = Document(found)
    edit_areas(document, "Remove", lambda areas: edits.remove(areas, 1))
    assert document.drawing.areas[0].outline_mm.area == pytest.approx(
        rest + outlines[0].intersection(box(0, 0, 40, 30)).area
    )


def test_a_file_with_no_area_at_all_is_refused(tmp_path):
    path = tmp_path / "none.stipple"
    saved_as_then(path, [])
    with pytest.raises(DrawingFileError, match=r"the page's own area|area is not"):
        open_file(path)
