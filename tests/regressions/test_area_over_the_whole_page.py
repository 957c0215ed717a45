"""An area drawn over the whole page took the page's own area out; the file could not be opened."""

import numpy as np
import pytest

from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.edit_check import check_edit
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.export import save
from stippler.opening import open_file

AROUND = Path.polyline(
    np.array([(-5.0, -5.0), (45.0, -5.0), (45.0, 35.0), (-5.0, 35.0)]), closed=True
)
HALF = Path.polyline(
    np.array([(-5.0, -5.0), (20.0, -5.0), (20.0, 35.0), (-5.0, 35.0)]), closed=True
)


def document(n=200):
    drawing = Drawing.blank(Page(40.0, 30.0))
    at = np.random.default_rng(1).random((n, 2)) * (40, 30)
    at[:4] = (0, 0), (40, 0), (40, 30), (20, 15)  # on the rim, and on the border of the halves
    drawing.dots = Dots.round(at, 0.2)
    drawing.dots.area[:] = 0
    return Document(drawing)


def whole(doc):
    assert 0 in doc.drawing.areas
    assert np.isin(doc.dots.area, list(doc.drawing.areas)).all()
    return doc


@pytest.fixture
def covered():
    doc = document()
    told = []
    doc.follow(told.append)
    edit_areas(doc, "Draw area", lambda areas: edits.add(areas, AROUND))
    check_edit(told[-1].edit.inverse(), doc)
    return whole(doc)


def test_the_page_keeps_its_area_and_its_style(covered):
    assert sorted(covered.drawing.areas) == [0, 1]
    assert covered.drawing.areas[0].outline_mm.is_empty
    assert covered.drawing.style_of(0) == covered.drawing.style_of(1)
    assert (covered.dots.area[4:] == 1).all()  # those on the very rim may stay the page's


def test_it_is_saved_opened_and_exported(covered, tmp_path):
    path = tmp_path / "covered.stipple"
    save(covered.drawing, path)
    found = open_file(path)
    assert sorted(found.areas) == [0, 1]
    assert np.array_equal(found.dots.area, covered.dots.area)
    again = tmp_path / "again.stipple"
    save(found, again)
    assert again.read_bytes() == path.read_bytes()
    for ending in (".svg", ".png", ".csv"):
        save(found, tmp_path / f"out{ending}")


def test_what_is_taken_from_it_becomes_the_pages_again(covered):
    edit_areas(covered, "Remove", lambda areas: edits.remove(areas, 1))
    assert sorted(whole(covered).drawing.areas) == [0]
    assert covered.drawing.areas[0].outline_mm.area == pytest.approx(1200)
    assert (covered.dots.area == 0).all()
    while covered.undo():
        whole(covered)
    assert covered.drawing.areas[0].outline_mm.area == pytest.approx(1200)
    while covered.redo():
        whole(covered)


def test_halves_that_cover_it_and_are_covered_lose_no_dot():
    doc = document()
    for label, path in (("Half", HALF), ("Page", AROUND), ("Half", HALF)):
        edit_areas(doc, label, lambda areas, path=path: edits.add(areas, path))
        whole(doc)
    for area in [k for k in doc.drawing.areas if k]:
        edit_areas(doc, "Remove", lambda areas, k=area: edits.remove(areas, k))
        whole(doc)
    assert (doc.dots.area == 0).all()
