"""The steps of a drawing's history as one member of its file, if a person asks for that.

Pieces with their length (8 bytes) before them: a head, the pictures that steps speak of, and the
steps from the oldest on, each as a record of the journal. The head tells the state of the drawing
that the steps lead to; with any other drawing they are worth nothing, and are left aside.
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Iterator, Sequence

from stippler.drawing import records
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.edit import Edit
from stippler.drawing.edit_check import check_edit
from stippler.drawing.history import Step, edit_of
from stippler.drawing.log import STEP, UNDONE, Entry
from stippler.drawing.reference import Picture
from stippler.errors import DrawingFileError, StipplerError
from stippler.files.native import arrays, structure
from stippler.files.native.drawing_file import ReadPicture
from stippler.files.native.edit_log import entry_of, of_entry, of_picture
from stippler.files.native.limits import DEFAULT_LIMITS, Limits

MEMBER = "history/steps"

_LENGTH = struct.Struct("<Q")
_HEAD = "history"
_MOST_STEPS = 1_000_000
_DO = "open it without its history"


def state_of(drawing: Drawing) -> str:
    """Return what tells a drawing's state from others: its dots, and which values there are.

    What later programs add to values or dots changes nothing of it.
    """
    mixed = hashlib.sha256()
    for name in _DOT_FIELDS:
        mixed.update(arrays.to_bytes(getattr(drawing.dots, name)))
    page, reference = drawing.page, drawing.reference
    told = [float(page.width_mm), float(page.height_mm)]
    ids = [sorted(drawing.table(kind)) for kind in _TABLES]
    picture = reference.source.digest if reference is not None else ""
    mixed.update(structure.to_bytes([told, ids, picture]))
    return mixed.hexdigest()


_DOT_FIELDS = (
    "id", "position_mm", "radius_mm", "seed", "elongation", "angle_rad", "roughness", "area",
    "constraint", "curve", "parameter",
)  # fmt: skip
_TABLES = (records.AREA, records.LINE, records.PATTERN, records.STYLE, records.BORDER)


def steps_to_bytes(steps: Sequence[Step], n_done: int, drawing: Drawing) -> bytes:
    """Return steps as a member of the file of the drawing that they lead to.

    A step that lay on disk and is lost takes those beyond it with it, as undoing would.
    """
    edits = [edit_of(step) for step in steps]
    first = max((k + 1 for k in range(n_done) if edits[k] is None), default=0)
    last = min((k for k in range(n_done, len(steps)) if edits[k] is None), default=len(steps))
    head = {"what": _HEAD, "of": state_of(drawing), "n_done": n_done - first}
    known = {drawing.reference.source.digest} if drawing.reference is not None else set()
    pieces = [arrays.pack(head, {})]
    kept = zip(steps[first:last], edits[first:last], strict=True)
    for step, edit in ((step, edit) for step, edit in kept if edit is not None):  # all are there
        for digest, picture in edit.pictures.items():
            if digest not in known:
                known.add(digest)
                pieces.append(of_picture(picture))
        pieces.append(of_entry(Entry(STEP, edit, step.of_job)))
    return b"".join(_LENGTH.pack(len(piece)) + piece for piece in pieces)


def is_of(data: bytes, drawing: Drawing) -> bool:
    """Return whether steps lead to a drawing as it is."""
    try:
        return _head(data, "history", DEFAULT_LIMITS)[0] == state_of(drawing)
    except DrawingFileError:
        return False


def give_steps(
    document: Document,
    data: bytes,
    read_picture: ReadPicture,
    where: str,
    limits: Limits = DEFAULT_LIMITS,
) -> bool:
    """Give a document just opened the steps of its file; return whether they are of its drawing.

    Raises
    ------
    DrawingFileError
        If they are damaged; the document is as it was.
    """
    place = f"{where}, {MEMBER}"
    state, n_done = _head(data, place, limits)
    if state != state_of(document.drawing):
        return False
    steps = list(_steps(document.drawing, data, read_picture, place, limits))
    if n_done > len(steps):
        raise DrawingFileError(f"counts {n_done:,} of {len(steps):,} steps", place, _DO)
    _check_way(document.drawing, [edit for edit, _ in steps], n_done, place)
    document.history.restore(steps, n_done)
    return True


def _check_way(drawing: Drawing, edits: list[Edit], n_done: int, where: str) -> None:
    """Go back to the start and on to the end, in a copy: each step has to fit the one before."""
    copy = Document(drawing.snapshot(), 0)
    way = [edit.inverse() for edit in reversed(edits[:n_done])] + edits
    for k, edit in enumerate(way):
        try:
            check_edit(edit, copy)
        except ValueError as error:
            raise DrawingFileError(f"does not fit ({error})", f"{where}, step {k}", _DO) from None
        copy.replay(Entry(UNDONE, edit))


def _head(data: bytes, where: str, limits: Limits) -> tuple[str, int]:
    first = next(_pieces(data, where), b"")
    head, _ = arrays.unpack(first, where, limits)
    state, n_done = head.get("of"), head.get("n_done")
    if head.get("what") != _HEAD or not isinstance(state, str):
        raise DrawingFileError("has no head", where, _DO)
    if type(n_done) is not int or n_done < 0:
        raise DrawingFileError("counts no steps", where, _DO)
    return state, n_done


def _steps(
    drawing: Drawing, data: bytes, read_picture: ReadPicture, where: str, limits: Limits
) -> Iterator[tuple[Edit, bool]]:
    pictures: dict[str, Picture] = {}
    if drawing.reference is not None:
        pictures[drawing.reference.source.digest] = drawing.reference.source
    for k, piece in enumerate(_pieces(data, where)):
        if k == 0:
            continue
        place = f"{where}, step {k}"
        try:
            entry = entry_of(piece, pictures, read_picture, place, limits)
        except StipplerError:
            raise
        except _WRONG as error:
            why = f"{type(error).__name__}: {error}"[:120]
            raise DrawingFileError(f"is wrong ({why})", place, _DO) from None
        if entry is not None and (entry.what != STEP or entry.edit is None):
            raise DrawingFileError("is no step", place, _DO)
        if entry is not None and entry.edit is not None and not entry.edit.is_empty:
            yield entry.edit, entry.of_job


_WRONG = (
    KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError, RecursionError,
)  # fmt: skip


def _pieces(data: bytes, where: str) -> Iterator[bytes]:
    at = n = 0
    while at < len(data):
        if at + _LENGTH.size > len(data) or n > _MOST_STEPS:
            raise DrawingFileError("is cut off", where, _DO)
        (length,) = _LENGTH.unpack_from(data, at)
        at += _LENGTH.size
        if length > len(data) - at:
            raise DrawingFileError("is cut off", where, _DO)
        yield data[at : at + length]
        at, n = at + length, n + 1
