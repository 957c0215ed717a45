"""Whether an edit that comes from a file fits the document that it is to change.

Edits made here always do. One that does not, from a journal that was tampered with or written by a
faulty program, would leave rows without dots, or values that no dot can have, and with them every
later edit: so it is refused before anything is changed. What taking it back would bring is looked
at, too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing import records
from stippler.drawing.dot_edit import Change, DotEdit, DotRows
from stippler.drawing.dot_rules import LARGEST_ID, LIKE, first_fault
from stippler.drawing.dots import Dots

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.edit import Edit

_LARGEST_RECORD = 10**9
_TABLES = (records.AREA, records.LINE, records.PATTERN, records.STYLE, records.BORDER)


def check_edit(edit: Edit, document: Document) -> None:
    """Raise `ValueError` unless an edit fits a document as it is."""
    _check_values(edit, document)
    dots = edit.dots
    for placed in (dots.removed, dots.inserted):
        if placed is not DotRows.none():
            _check_placed(placed)
    for name, change in dots.changes.items():
        _check_change(name, change)
    if len(dots.removed) or len(dots.inserted) or len(dots.shifted.ids):
        _check_layout(dots, document)
    for change in dots.changes.values():
        stays = document.rows(change.ids) >= 0
        if len(dots.removed):
            stays &= ~np.isin(change.ids, dots.removed.dots.id)
        if not stays.all():
            raise ValueError("changes dots that are not there before and after")
    _check_owners(edit, document)


def _check_array(name: str, values: NDArray[Any], n: int) -> None:
    like = LIKE[name]
    if values.dtype != like.dtype or values.shape != (n, *like.shape[1:]):
        raise ValueError(f"{name} is not what it should be")
    if (fault := first_fault(name, values)) is not None:
        raise ValueError(f"{name}, value {fault[0]}: its {fault[1]}")


def _check_rows(rows: NDArray[Any], n: int) -> None:
    if rows.dtype != np.int64 or rows.shape != (n,):
        raise ValueError("rows are not what they should be")


def _check_placed(placed: DotRows) -> None:
    n = len(placed.dots.id)
    _check_rows(placed.rows, n)
    for name in LIKE:
        _check_array(name, getattr(placed.dots, name), n)
    if len(np.unique(placed.dots.id)) < n:
        raise ValueError("an id stands twice")


def _check_change(name: str, change: Change) -> None:
    n = len(change.ids)
    if name not in LIKE or name == "id":
        raise ValueError(f"{name[:40]} is nothing of a dot that changes")
    _check_array("id", change.ids, n)
    if len(np.unique(change.ids)) < n:
        raise ValueError("changes a dot twice")
    for values in (change.before, change.after):
        _check_array(name, values, n)


def _check_layout(dots: DotEdit, document: Document) -> None:
    """Every row has one dot afterwards."""
    removed, inserted, shifted = dots.removed, dots.inserted, dots.shifted
    n, n_after = len(document.dots), len(document.dots) - len(removed) + len(inserted)
    for rows in (shifted.before, shifted.after):
        _check_rows(rows, len(shifted.ids))
    _check_array("id", shifted.ids, len(shifted.ids))
    if not (
        np.array_equal(document.rows(removed.dots.id), removed.rows)
        and np.array_equal(document.rows(shifted.ids), shifted.before)
        and (document.rows(inserted.dots.id) < 0).all()
    ):
        raise ValueError("takes dots from rows that they are not in")
    taken = np.zeros(max(n, n_after), np.int64)
    taken[:n] = 1
    np.subtract.at(taken, removed.rows, 1)
    np.subtract.at(taken, shifted.before, 1)
    for rows in (shifted.after, inserted.rows):
        if len(rows) and not 0 <= rows.min() <= rows.max() < n_after:
            raise ValueError("puts dots into rows that there are not")
        np.add.at(taken, rows, 1)
    if (taken[:n_after] != 1).any() or taken[n_after:].any():
        raise ValueError("leaves rows without a dot")


def _check_values(edit: Edit, document: Document) -> None:
    for kind, changed in edit.values.items():
        for i, (before, after) in changed.items():
            if kind in records.SINGLE:
                if i != 0 or (kind == records.PAGE and None in (before, after)):
                    raise ValueError(f"{kind} {i} is no value of a drawing")
            elif kind not in _TABLES or not 0 <= i < _LARGEST_RECORD:
                raise ValueError(f"{kind} {i} is no value of a drawing")
            if (before is None) != (document.drawing.get(kind, i) is None):
                raise ValueError(f"{kind} {i} is not as it was before")
    for kind, i in edit.next_id.items():
        if kind not in (records.DOT, *_TABLES) or not 0 <= i < LARGEST_ID:
            raise ValueError(f"{kind} {i} is no id")
    for side in (0, 1):
        styles = _ids(records.STYLE, edit, document, side)
        areas = {**document.drawing.areas}
        areas |= {i: pair[side] for i, pair in edit.values.get(records.AREA, {}).items()}
        if areas.get(0) is None or any(a and a.style not in styles for a in areas.values()):
            raise ValueError("leaves an area without its style, or no page")


def _ids(kind: str, edit: Edit, document: Document, side: int) -> set[int]:
    """Return the ids that a table has after an edit (1), or once it is taken back (0)."""
    ids = set(document.drawing.table(kind))
    for i, pair in edit.values.get(kind, {}).items():
        (ids.discard if pair[side] is None else ids.add)(i)
    return ids


def _check_owners(edit: Edit, document: Document) -> None:
    """Dots belong to areas that there are, and lie on lines that there are."""
    for field, kind in (("area", records.AREA), ("curve", records.LINE)):
        for side, placed in ((0, edit.dots.removed), (1, edit.dots.inserted)):
            told = [getattr(placed.dots, field)] if len(placed) else []
            change = edit.dots.changes.get(field)
            if change is not None:
                told.append(change.after if side else change.before)
            if kind in edit.values:
                told.append(_left_alone(field, edit, document.dots))
            if not told:
                continue
            there = np.fromiter(_ids(kind, edit, document, side), np.int64)
            for values in told:
                owned = values if field == "area" else values[values >= 0]
                if not np.isin(owned, there).all():
                    raise ValueError(f"leaves dots with no {kind}")


def _left_alone(field: str, edit: Edit, dots: Dots) -> NDArray[Any]:
    """Return a field of the dots of which an edit changes nothing there."""
    change = edit.dots.changes.get(field)
    out = edit.dots.removed.dots.id
    if change is not None:
        out = np.concatenate([out, change.ids])
    values: NDArray[Any] = getattr(dots, field)[~np.isin(dots.id, out)]
    return values
