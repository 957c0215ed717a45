"""Opening a drawing that was kept: its own file, or a table of its dots."""

from __future__ import annotations

import math
import warnings
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.drawing.drawing import Drawing
from stippler.drawing.page import MAX_PAGE_MM, Page
from stippler.errors import (
    DrawingFileError,
    GeometryError,
    StipplerError,
    StipplerWarning,
    TableError,
)
from stippler.files.native.signature import ENDING, is_container

if TYPE_CHECKING:
    from stippler.drawing.document import Document

TABLES = (".csv", ".tsv")


def is_drawing(path: Path) -> bool:
    """Return whether a file is a drawing rather than a picture, by its name or its beginning."""
    return path.suffix.lower() in (ENDING, *TABLES) or is_container(path)


def open_file(path: Path) -> Drawing:
    """Open a drawing; errors as `stippler.open`. What was mended in it is warned of."""
    if path.suffix.lower() in TABLES:
        return _of_table(path)
    drawing, mended = _opened(path)
    if mended:
        warnings.warn(f"{path}: {mended}", StipplerWarning, stacklevel=3)
    return drawing


def _opened(path: Path) -> tuple[Drawing, str]:
    """Open a file of our own; return the drawing, and what was mended in it."""
    from stippler.drawing.mending import with_sound_borders
    from stippler.files.native.drawing_file import open_drawing
    from stippler.files.read.picture import picture_of_bytes

    drawing = keeping(*open_drawing(path, picture_of_bytes))
    try:
        return with_sound_borders(drawing)
    except GeometryError as error:
        do = "open a backup of the drawing"
        raise DrawingFileError(f"has areas that make no map ({error})", path, do) from None


def keeping(drawing: Drawing, members: Mapping[str, bytes]) -> Drawing:
    """Let a drawing keep the members of its file that are made anew by nobody here."""
    from stippler.files.native.thumbnail import MEMBER

    strange = {name: data for name, data in members.items() if name != MEMBER}
    drawing.foreign = replace(drawing.foreign, members=strange)
    return drawing


def open_document(path: Path) -> tuple[Document, str]:
    """Open a drawing to be edited, with the steps that its file holds; and say what they lack."""
    from stippler.drawing.document import Document
    from stippler.files.native import step_file
    from stippler.files.read.picture import picture_of_bytes

    if path.suffix.lower() in TABLES:
        return Document(_of_table(path)), ""
    drawing, mended = _opened(path)
    document = Document(drawing)
    steps = drawing.foreign.members.get(step_file.MEMBER)
    lack = ""
    if steps is not None:
        try:
            if not step_file.give_steps(document, steps, picture_of_bytes, str(path)):
                lack = "its history is not taken over: the drawing was changed without it"
        except StipplerError as error:
            lack = f"its history cannot be read: {error}"
    return document, "; ".join(text for text in (mended, lack) if text)


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
