"""The dots of an open drawing: found by id, changed in time proportional to what changes."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.drawing.edit import DotRows, Edit, Shift
from stippler.errors import GeometryError

Rows = NDArray[np.int64]

GONE = -1
_SPARE = 1024
_NAMES = tuple(f.name for f in fields(Dots))
_MOST_IDS = 2**31 - 1


class DotStore:
    """Arrays with room to grow, and the row of each id.

    Removing closes gaps with the last rows, so dots change rows; ids stay.

    Parameters
    ----------
    dots : Dots
        Copied. Ids unique and not below 0.

    Attributes
    ----------
    dots : Dots
        Views of the rows in use; renewed whenever dots come or go. Only the store writes to them.
    next_id : int
        The first id no dot has used.
    """

    def __init__(self, dots: Dots) -> None:
        n = len(dots)
        ids = dots.id
        if n and (int(ids.min()) < 0 or int(ids.max()) > _MOST_IDS or len(np.unique(ids)) != n):
            raise GeometryError("ids have to be unique and not below 0", "dots")
        self._room: dict[str, NDArray[np.generic]] = {}
        self.next_id = int(ids.max()) + 1 if n else 0
        self._row_of = np.full(self.next_id + _SPARE, GONE, np.int32)
        self._row_of[ids] = np.arange(n, dtype=np.int32)
        for name in _NAMES:
            given = getattr(dots, name)
            room = np.empty((n + _SPARE, *given.shape[1:]), given.dtype)
            room[:n] = given
            self._room[name] = room
        self.dots = self._views(n)

    def __len__(self) -> int:
        return len(self.dots)

    @property
    def n_bytes(self) -> int:
        """Memory it takes, spare room included."""
        return sum(room.nbytes for room in self._room.values()) + self._row_of.nbytes

    @property
    def row_of_id(self) -> NDArray[np.int32]:
        """The row of each id, `GONE` where it is not there; to be read only."""
        return self._row_of

    def rows(self, ids: NDArray[np.int64]) -> Rows:
        """Return the rows of ids; `GONE` for dots that are not there."""
        out = np.full(len(ids), GONE, np.int64)
        known = ids < len(self._row_of)
        if known.all():
            return self._row_of[ids].astype(np.int64)
        out[known] = self._row_of[ids[known]]
        return out

    def new_ids(self, n: int) -> NDArray[np.int64]:
        """Return ids that no dot has used, and use them."""
        ids = np.arange(self.next_id, self.next_id + n, dtype=np.int64)
        self.next_id += n
        return ids

    def write(self, field: str, rows: Rows, values: NDArray[np.generic]) -> None:
        """Set one field of some rows."""
        getattr(self.dots, field)[rows] = values

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
        self._row_of[self.dots.id[rows]] = GONE
        self._move(shift)
        self.dots = self._views(n_after)
        return shift

    def apply(self, edit: Edit) -> Rows:
        """Apply an edit to the state it was made for; return the rows that have changed.

        Rows at and beyond the new number of dots are among them.
        """
        touched: list[Rows] = []
        most = len(self)
        if len(edit.removed) or len(edit.inserted) or len(edit.shifted.ids):
            n_after = len(self) - len(edit.removed) + len(edit.inserted)
            most = max(n_after, most)
            self._row_of[edit.removed.dots.id] = GONE
            if n_after > len(self):
                self._grow(n_after)
            self._move(edit.shifted)
            self._put(edit.inserted, n_after)
            touched += [edit.removed.rows, edit.inserted.rows]
            touched += [edit.shifted.before, edit.shifted.after]
        for name, change in edit.changes.items():
            rows = self.rows(change.ids)
            self.write(name, rows, change.after)
            touched.append(rows)
        return union(touched, most)

    def _move(self, shift: Shift) -> None:
        if not len(shift.ids):
            return
        for room in self._room.values():
            room[shift.after] = room[shift.before]
        self._row_of[shift.ids] = shift.after

    def _put(self, placed: DotRows, n_after: int) -> None:
        self._grow(n_after)
        for name in _NAMES:
            self._room[name][placed.rows] = getattr(placed.dots, name)
        ids = placed.dots.id
        if len(ids):
            last = int(ids.max())
            if last >= len(self._row_of):
                more = np.full(max(last + 1, 2 * len(self._row_of)), GONE, np.int32)
                more[: len(self._row_of)] = self._row_of
                self._row_of = more
            self._row_of[ids] = placed.rows
            self.next_id = max(self.next_id, last + 1)
        self.dots = self._views(n_after)

    def _grow(self, n: int) -> None:
        if n <= len(self._room["id"]):
            return
        size = n + n // 4 + _SPARE
        for name, room in self._room.items():
            more = np.empty((size, *room.shape[1:]), room.dtype)
            more[: len(room)] = room
            self._room[name] = more

    def _views(self, n: int) -> Dots:
        return Dots(**{name: room[:n] for name, room in self._room.items()})  # type: ignore[arg-type]


def union(parts: list[Rows], n: int) -> Rows:
    """Return the rows below n that are in any part; sorted, each once."""
    mask = np.zeros(n, np.bool_)
    for rows in parts:
        mask[rows] = True
    return np.flatnonzero(mask)
