"""Reading: pictures, drawings that were saved, and what a crash has left."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.jobs.preparing import make_ready
from stippler.jobs.work import PREPARE, READ, Source, Work

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.reference import Reference
    from stippler.files.native.recovery import Lost


def read_source(source: Source) -> tuple[Reference, tuple[str, ...]]:
    """Read a picture: from the drawing that holds it, or from its file; tell what is to be said."""
    from stippler.drawing.reference import Reference
    from stippler.files.read.picture import picture_of_bytes, read_picture

    if source.data is None:
        notes: list[str] = []
        tone, width_mm = source.tone, source.width_mm
        return read_picture(source.path, tone=tone, width_mm=width_mm, notes=notes), tuple(notes)
    picture = picture_of_bytes(source.data, source.path.name, source.tone)
    return Reference.of(picture, source.width_mm), ()


def read_only(source: Source, *, is_warm: Callable[[], bool]) -> Iterator[Work]:
    """Read a picture, to be drawn after by hand, and load everything that painting needs."""
    yield Work(READ)
    reference, notes = read_source(source)
    reference = reference.adjusted(source.adjustment)
    yield Work(READ, 1, 1, reference, notes=notes)
    for ready in make_ready(is_warm=is_warm):  # only the latest result may be seen
        yield replace(ready, reference=reference, notes=notes)


def open_drawing(path: Path, *, is_warm: Callable[[], bool]) -> Iterator[Work]:
    """Open a drawing that was saved."""
    yield Work(READ)
    from stippler.opening import open_document

    document, note = open_document(path)
    yield Work(READ, 1, 1)
    yield from make_ready(is_warm=is_warm)
    yield Work(PREPARE, 1, 1, document=document, note=note)


def recover(lost: Lost, *, is_warm: Callable[[], bool]) -> Iterator[Work]:
    """Make a drawing anew that a crash has left, with all its steps."""
    yield Work(READ)
    document = recovered(lost)
    yield from make_ready(is_warm=is_warm)
    yield Work(PREPARE, 1, 1, document=document)


def recovered(lost: Lost) -> Document:
    """Return the drawing that a crash has left, as its last whole step was."""
    from stippler.drawing.document import Document
    from stippler.files.native.drawing_file import drawing_of
    from stippler.files.native.edit_log import replay
    from stippler.files.read.picture import picture_of_bytes
    from stippler.opening import keeping

    members, journal = lost.read()
    document = Document(keeping(*drawing_of(members, picture_of_bytes, lost.name)))
    replay(document, journal.records, picture_of_bytes)
    return document
