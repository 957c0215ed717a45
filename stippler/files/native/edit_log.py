"""What a document tells, as records of its journal, and a drawing made anew from them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.document import Document
from stippler.drawing.edit import Edit
from stippler.drawing.edit_check import check_edit
from stippler.drawing.history import History, edit_of
from stippler.drawing.log import ENDED, MADE, OPENED, PART, REDONE, STEP, UNDONE, Entry
from stippler.drawing.reference import Picture
from stippler.errors import DrawingFileError, StipplerError
from stippler.files.native import arrays
from stippler.files.native.drawing_file import ReadPicture
from stippler.files.native.limits import DEFAULT_LIMITS, Limits

_PICTURE = "picture"
_WRONG = (
    StipplerError, KeyError, IndexError, TypeError, ValueError, AttributeError, OverflowError,
    RecursionError,
)  # fmt: skip


class EditLog:
    """Makes records of what a document tells; each picture is written once.

    Parameters
    ----------
    append : callable
        Takes a record, as a function that makes its bytes in another thread.
    document : Document
        As it is when the journal begins; steps of its history from before are not in it.
    """

    def __init__(self, append: Callable[[Callable[[], bytes]], None], document: Document) -> None:
        reference = document.drawing.reference
        self._append = append
        self._known = {reference.source.digest} if reference is not None else set()
        self._first = document.history.n_done  # step of the document that is the journal's first

    def take(self, entry: Entry) -> None:
        """Write down what has happened; returns at once."""
        if entry.edit is not None:
            for digest, picture in entry.edit.pictures.items():
                if digest not in self._known:
                    self._known.add(digest)
                    self._append(partial(of_picture, picture))
        if entry.what in (STEP, OPENED):
            self._first = min(self._first, entry.n_done - 1)
        n_done = max(entry.n_done - self._first, 0)
        self._append(partial(of_entry, replace(entry, n_done=n_done)))


def of_entry(entry: Entry) -> bytes:
    """Return a record."""
    head = {
        "what": entry.what,
        "of_job": entry.of_job,
        "n_done": entry.n_done,
        "edit": entry.edit is not None,
    }
    return arrays.pack(head, dict(entry.edit.arrays()) if entry.edit is not None else {})


def of_picture(picture: Picture) -> bytes:
    """Return the record of a picture."""
    head = {"what": _PICTURE, "digest": picture.digest, "name": picture.name, "tone": picture.tone}
    if picture.data is not None:
        return arrays.pack(head, {"data": np.frombuffer(picture.data, np.uint8)})
    return arrays.pack(head, {"darkness": picture.levels.darkness()})


def replay(
    document: Document,
    records: Iterable[bytes],
    read_picture: ReadPicture,
    limits: Limits = DEFAULT_LIMITS,
) -> tuple[int, str]:
    """Do to a document all that a journal's records tell of, as far as they make sense.

    Returns
    -------
    n_done : int
        How many records were followed.
    problem : str
        Why the next was not; empty if all were.
    """
    pictures: dict[str, Picture] = {}
    if document.drawing.reference is not None:
        picture = document.drawing.reference.source
        pictures[picture.digest] = picture
    n_done, in_run, problem, order = 0, False, "", _Order()
    for record in records:
        try:
            entry = entry_of(record, pictures, read_picture, f"record {n_done}", limits)
            if entry is not None:
                order.check(entry, document)
                document.replay(replace(entry, n_done=order.n_done))
                in_run = entry.what == OPENED or (in_run and entry.what != ENDED)
        except _WRONG as error:
            problem = f"record {n_done}: {str(error) or type(error).__name__}"
            break
        n_done += 1
    if in_run:
        document.replay(Entry(ENDED))
    return n_done, problem


class _Order:
    """Refuses entries that a document would not tell in that order, or in that state.

    Attributes
    ----------
    n_done : int
        How many steps of the document's history are in effect after the entry checked last, if it
        undoes or redoes one. Steps from before the journal are in no history.
    """

    def __init__(self) -> None:
        self._of_run: NDArray[np.int64] | None = None  # ids of the dots that the run began with
        self._before: list[Edit] = []  # undone steps from before the journal, the oldest last
        self.n_done = 0

    def check(self, entry: Entry, document: Document) -> None:
        """Raise `ValueError` unless an entry may be replayed now."""
        edit, history = entry.edit, document.history
        if edit is not None:
            check_edit(edit, document)
        if entry.what not in (STEP, MADE, UNDONE, REDONE, OPENED, PART, ENDED):
            raise ValueError(f"tells of {entry.what[:40]!r}, which is unknown")
        if entry.what == OPENED:
            if edit is None or not edit.is_empty or self._of_run is not None:
                raise ValueError("begins a run within another, or with a change")
            self._of_run = np.array(document.dots.id)
        elif entry.what == ENDED:
            self._of_run = None
        elif entry.what == PART:
            self._check_part(edit)
        elif entry.what == MADE and history.steps:
            raise ValueError("makes dots when there is a history already")
        elif entry.what in (UNDONE, REDONE):
            if self._of_run is not None:
                raise ValueError("is undone within a run")
            if edit is None:
                raise ValueError("undoes or redoes another step than the last")
            self.n_done = (self._undone if entry.what == UNDONE else self._redone)(edit, history)
        if entry.what in (STEP, OPENED):
            self._before.clear()

    def _undone(self, edit: Edit, history: History) -> int:
        """Check what undoes the last step; return how many are in effect then."""
        step = history.undone
        if step is None:
            self._before.append(edit.inverse())
            return 0
        known = edit_of(step)
        if known is not None and not _are_same(known.inverse(), edit):
            raise ValueError("undoes another step than the last")
        return history.n_done - 1

    def _redone(self, edit: Edit, history: History) -> int:
        """Check what does the last undone step again; return how many are in effect then."""
        if self._before:
            if not _are_same(self._before[-1], edit):
                raise ValueError("redoes another step than the last that was undone")
            self._before.pop()
            return 0
        step = history.redone
        if step is None:
            if history.steps:
                raise ValueError("redoes a step that was not undone")
            return 0  # it was undone before the journal
        known = edit_of(step)
        if known is not None and not _are_same(known, edit):
            raise ValueError("redoes another step than the last that was undone")
        return history.n_done + 1

    def _check_part(self, edit: Edit | None) -> None:
        if edit is None or self._of_run is None:
            raise ValueError("is part of no run")
        dots = edit.dots
        if len(dots.removed) or len(dots.inserted) or len(dots.shifted.ids) or edit.values:
            raise ValueError("is more than a run does")
        if not all(np.isin(change.ids, self._of_run).all() for change in dots.changes.values()):
            raise ValueError("moves dots that the run does not know")


def _are_same(wanted: Edit, edit: Edit) -> bool:
    """Return whether two edits change the same."""
    mine, others = dict(wanted.arrays()), dict(edit.arrays())
    del mine["values"], others["values"]
    same_dots = mine.keys() == others.keys() and all(
        np.array_equal(mine[name], others[name]) for name in mine
    )
    return same_dots and wanted.values == edit.values


def entry_of(
    record: bytes,
    pictures: dict[str, Picture],
    read_picture: ReadPicture,
    where: str,
    limits: Limits,
) -> Entry | None:
    """Return what a record tells; None for a picture, which is kept in `pictures`.

    Raises
    ------
    StipplerError, or what Python has for values of a wrong kind
        If it makes no sense.
    """
    head, found = arrays.unpack(record, where, limits)
    what = head.get("what")
    if what == _PICTURE:
        name, tone = str(head.get("name", "")), str(head.get("tone", ""))
        data = found.get("data")
        if data is not None:
            picture = read_picture(data.tobytes(), name, tone)
        else:
            picture = Picture.of(found["darkness"], tone, name, str(head.get("digest")))
        pictures[str(head.get("digest"))] = picture
        return None
    if not isinstance(what, str):
        raise DrawingFileError("tells nothing", where)
    edit = Edit.from_arrays(found, pictures) if head.get("edit") is True else None
    n_done = head.get("n_done", 0)
    if type(n_done) is not int:
        raise DrawingFileError("counts no steps", where)
    return Entry(what, edit, head.get("of_job") is True, n_done)
