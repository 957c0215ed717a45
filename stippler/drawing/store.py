"""The dots of an open drawing: found by id, changed in time proportional to what changes."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dot_edit import DotEdit, DotRows, Shift
from stippler.drawing.dots import Dots
from stippler.drawing.ids import GONE, MAX_ID, IdTable, Rows
from stippler.errors import GeometryError

__all__ = ["GONE", "DotStore", "Rows", "union"]

_SPARE = 1024
_NAMES = tuple(f.name for f in fields(Dots))
_EDITED, _SEEN = "_edited", "_seen"


class DotStore:
    """Arrays with room to grow, and the row of each id.

    Removing closes gaps with the last rows, so dots change rows; ids stay.

    Parameters
    ----------
    dots : Dots
        Copied. Ids unique and not below 0.
    next_id : int
        No dot has had this id, or a larger one.

    Attributes
    ----------
    dots : Dots
        Views of the rows in use; renewed whenever dots come or go. Only the store writes to them.
    edited : (n,) int32
        The revision in which a person last changed each dot; 0 if never.
    seen : (n,) uint16
        Room for a stroke's notes on each dot; those of new dots are 0.
    n_layouts : int
        Grows whenever rows change hands.
    """

    def __init__(self, dots: Dots, next_id: int = 0) -> None:
        n = len(dots)
        ids = dots.id
        if n and (int(ids.min()) < 0 or int(ids.max()) > MAX_ID or len(np.unique(ids)) != n):
            raise GeometryError("ids have to be unique and not below 0", "dots")
        self._room: dict[str, NDArray[np.generic]] = {}
        self.next_id = max(next_id, int(ids.max()) + 1 if n else 0)
        self.n_layouts = 0
        self._row_of = IdTable()
        self._row_of.put(ids, np.arange(n, dtype=np.int64))
        for name in _NAMES:
            given = getattr(dots, name)
            room = np.empty((n + _SPARE, *given.shape[1:]), given.dtype)
            room[:n] = given
            self._room[name] = room
        self._room[_EDITED] = np.zeros(n + _SPARE, np.int32)
        self._room[_SEEN] = np.zeros(n + _SPARE, np.uint16)
        self._use(n)

    def __len__(self) -> int:
        return len(self.dots)

    @property
    def n_bytes(self) -> int:
        """Memory it takes, spare room included."""
        return sum(room.nbytes for room in self._room.values()) + self._row_of.n_bytes

    def rows(self, ids: NDArray[np.int64]) -> Rows:
        """Return the rows of ids; `GONE` for dots that are not there."""
        return self._row_of.find(ids)

    def new_ids(self, n: int) -> NDArray[np.int64]:
        """Return ids that no dot has used, and use them."""
        ids = np.arange(self.next_id, self.next_id + n, dtype=np.int64)
        self.next_id += n
        return ids

    def write(self, field: str, rows: Rows, values: NDArray[np.generic]) -> None:
        """Set one field of some rows."""
        room = getattr(self.dots, field)
        if room.ndim == 2 and np.shape(values) == (len(rows), 2):
            _flat(room)[rows] = _flat(values.astype(room.dtype, copy=False))
        else:
            room[rows] = values

    def append(self, dots: Dots) -> Rows:
        """Add dots in new rows at the end; return those."""
        n = len(self)
        rows = np.arange(n, n + len(dots), dtype=np.int64)
        self._put(DotRows(dots, rows), n + len(dots))
        return rows

    def remove(self, rows: Rows) -> Shift:
        """Remove rows; return which dots moved into the gaps.

        Parameters
        ----------
        rows : sorted, each once
        """
        n_after = len(self) - len(rows)
        tail = np.arange(n_after, len(self), dtype=np.int64)
        stay = tail[~np.isin(tail, rows[rows >= n_after], assume_unique=True)]
        gaps = rows[rows < n_after]
        ids = self.dots.id[stay]
        shift = Shift(ids, stay, gaps)
        self._row_of.drop(self.dots.id[rows])
        self._move(shift)
        self._use(n_after)
        return shift

    def cut(self, n: int, next_id: int) -> None:
        """Take out the rows from n on, whose ids, from `next_id` on, nobody has got to know."""
        self._row_of.drop(self.dots.id[n:])
        self.next_id = next_id
        self._use(n)

    def apply(self, edit: DotEdit) -> tuple[Rows, Rows]:
        """Apply an edit to the state it was made for.

        Returns
        -------
        tuple of rows
            All that have changed, those at and beyond the new number of dots among them; and those
            of the dots that the edit changes or inserts, and not only gives other rows.
        """
        touched: list[Rows] = []
        meant: list[Rows] = [edit.inserted.rows]
        most = len(self)
        if len(edit.removed) or len(edit.inserted) or len(edit.shifted.ids):
            n_after = len(self) - len(edit.removed) + len(edit.inserted)
            most = max(n_after, most)
            self._grow(n_after)  # first: where memory runs out, nothing has been changed
            self._row_of.drop(edit.removed.dots.id)
            self._move(edit.shifted)
            self._put(edit.inserted, n_after)
            touched.append(edit.removed.rows)
            touched += [edit.shifted.before, edit.shifted.after]
        for name, change in edit.changes.items():
            rows = self.rows(change.ids)
            self.write(name, rows, change.after)
            meant.append(rows)
        own = union(meant, most)
        return (union([own, *touched], most) if touched else own), own

    def _move(self, shift: Shift) -> None:
        if not len(shift.ids):
            return
        for room in self._room.values():
            flat = _flat(room)
            flat[shift.after] = flat.take(shift.before)
        self._row_of.put(shift.ids, shift.after)

    def _put(self, placed: DotRows, n_after: int) -> None:
        self._grow(n_after)
        for name in _NAMES:
            _flat(self._room[name])[placed.rows] = _flat(getattr(placed.dots, name))
        for name in (_EDITED, _SEEN):
            self._room[name][placed.rows] = 0
        ids = placed.dots.id
        if len(ids):
            self._row_of.put(ids, placed.rows)
            self.next_id = max(self.next_id, int(ids.max()) + 1)
        self._use(n_after)

    def _grow(self, n: int) -> None:
        if n <= len(self._room["id"]):
            return
        size = n + n // 4 + _SPARE
        larger: dict[str, NDArray[Any]] = {}  # all or none: memory may run out
        for name, room in self._room.items():
            larger[name] = np.empty((size, *room.shape[1:]), room.dtype)
            larger[name][: len(room)] = room
        self._room = larger

    def _use(self, n: int) -> None:
        """Look at the first n rows from now on."""
        self.n_layouts += 1
        self.dots = Dots(**{name: self._room[name][:n] for name in _NAMES})  # type: ignore[arg-type]
        self.edited: NDArray[np.int32] = self._room[_EDITED][:n]  # type: ignore[assignment]
        self.seen: NDArray[np.uint16] = self._room[_SEEN][:n]  # type: ignore[assignment]


def _flat(values: NDArray[np.generic]) -> NDArray[Any]:
    """Look at pairs as single values, which numpy copies faster."""
    if values.ndim == 1:
        return values
    return np.ascontiguousarray(values).view(np.complex128).reshape(-1)


def union(parts: list[Rows], n: int) -> Rows:
    """Return the rows below n that are in any part; sorted, each once."""
    mask = np.zeros(n, np.bool_)
    for rows in parts:
        mask[rows] = True
    return np.flatnonzero(mask)
