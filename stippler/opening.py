"""Opening a drawing that was kept: its own file, or a table of its dots."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from stippler.drawing.drawing import Drawing
from stippler.drawing.page import MAX_PAGE_MM, Page
from stippler.errors import TableError
from stippler.files.native.container import is_container
from stippler.files.native.drawing_file import ENDING, open_drawing

TABLES = (".csv", ".tsv")


def is_drawing(path: Path) -> bool:
    """Return whether a file is a drawing rather than a picture, by its name or its beginning."""
    return path.suffix.lower() in (ENDING, *TABLES) or is_container(path)


def open_file(path: Path) -> Drawing:
    """Open a drawing; errors as `stippler.open`."""
    if path.suffix.lower() in TABLES:
        return _of_table(path)
    from stippler.files.read.picture import picture_of_bytes

    drawing, more = open_drawing(path, picture_of_bytes)
    drawing.foreign = replace(drawing.foreign, members=_strange(more))
    return drawing


def _strange(members: dict[str, bytes]) -> dict[str, bytes]:
    """Return the members that are made anew by nobody here."""
    from stippler.files.native.thumbnail import MEMBER

    return {name: data for name, data in members.items() if name != MEMBER}


def _of_table(path: Path) -> Drawing:
    """Put the dots of a table on a page that holds them."""
    from stippler.files.read.table import read_csv

    dots = read_csv(path)
    far = [1.0, 1.0]
    if len(dots):
        if (dots.position_mm.min(axis=0) < 0).any():
            raise TableError("has dots at negative places", path, "shift them onto the page first")
        far = [float(side) for side in (dots.position_mm + dots.radius_mm[:, None]).max(axis=0)]
    if max(far) > MAX_PAGE_MM:
        raise TableError(f"has dots {max(far):.0f} mm away", path, "give places in mm")
    drawing = Drawing.blank(Page(*(min(math.ceil(side), MAX_PAGE_MM) for side in far)))
    dots.area[:] = 0
    drawing.dots = dots
    return drawing
