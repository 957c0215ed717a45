"""First dots from the border begin at a row that lies along it, and line up with it."""

import numpy as np
import pytest
import shapely

from stippler.api import process
from stippler.drawing.area_edits import edit_areas
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.border_rows import behind_rows
from stippler.stippling.lines import border_lines, row_along


def with_row(away_mm, gap_mm=1.0):
    """Return a disc with a fixed row inside its border, under an even grey."""
    drawing = Drawing.blank(Page(30.0, 30.0), Style(n_dots=400))
    drawing.reference = Reference(np.full((300, 300), 0.4, np.float32), 30.0)
    document = Document(drawing)
    t = np.linspace(0.0, 2 * np.pi, 181)[:-1]
    ring = Path.polyline(15 + 12 * np.column_stack([np.cos(t), np.sin(t)]), closed=True)
    edit_areas(document, "area", lambda areas: edits.add(areas, ring, edits.IS_CUT))
    (line,) = border_lines(document.drawing.areas[1].outline_mm, "inside", away_mm)
    document.begin("row")
    rows = document.insert(Dots.round(line.at(row_along(line, None, gap_mm, None)), 0.3))
    document.change("constraint", rows, np.full(len(rows), FIXED, np.int8))
    document.commit()
    return document.drawing


@pytest.mark.parametrize("away_mm", [0.3, 0.6, 1.0])
def test_first_dots_line_up_with_a_row_inside_the_border(away_mm):
    drawing = with_row(away_mm)
    outline = drawing.areas[1].outline_mm
    inner = 12.0 - away_mm
    first = {}
    for start in ("border", "top"):
        dots = process(drawing, 1, start=start, iterations=0, dots=400).dots
        assert (dots.area == 1).sum() == 400
        free = dots.position_mm[~dots.fixed]
        from_middle = np.hypot(*(free - 15).T)
        assert shapely.contains_xy(outline, *free.T).all()
        first[start] = np.sort(inner - from_middle)
    n_next = 50  # about as many as the next row has
    assert first["border"].min() > 0.35  # none between the row and the border
    assert np.std(first["border"][:n_next]) < 0.6 * np.std(first["top"][:n_next])


def test_only_rows_close_off_what_lies_behind_them():
    density = np.zeros((80, 80), np.float32)
    density[10:70, 10:70] = 1 / 36
    row = np.column_stack([np.arange(12.0, 69.0, 6.0), np.full(10, 14.0)])
    behind = behind_rows(density, row)
    assert behind[10:14, 13:66].all()
    assert not behind[16:, 22:58].any()
    assert not behind[:10].any()
    alone = np.array([(40.0, 14.0), (12.0, 40.0), (60.0, 60.0), (40.0, 40.0)])
    assert not behind_rows(density, alone).any()
    deep = np.add(row[2:8], (0.0, 20.0))
    assert not behind_rows(density, deep).any()
    assert not behind_rows(density, row[:2]).any()
