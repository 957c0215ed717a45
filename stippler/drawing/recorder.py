"""What a stroke has changed so far, kept so that it ends as one edit however long it was."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.drawing.edit import FIELDS, Change, DotRows, Edit, Shift
from stippler.drawing.store import GONE, DotStore, Rows

_BIT = {name: 1 << k for k, name in enumerate(FIELDS)}
_ROW, _NEW = 1 << len(FIELDS), 1 << len(FIELDS) + 1
_ALL = _NEW - 1 | _NEW

_Pair = tuple[NDArray[np.int64], NDArray[np.generic]]


class Recorder:
    """Changes a store and remembers what was there when each value was first touched.

    Each change costs what it touches; nothing is kept twice for a dot that is touched again.
    """

    def __init__(self, store: DotStore, label: str) -> None:
        self._store, self.label = store, label
        self._seen = np.zeros(store.next_id + 1024, np.uint16)  # by id: fields, row, new
        self._before: dict[str, list[_Pair]] = {name: [] for name in FIELDS}
        self._removed: list[DotRows] = []
        self._inserted: list[NDArray[np.int64]] = []
        self._rows: list[_Pair] = []

    def change(self, field: str, rows: Rows, values: NDArray[np.generic]) -> None:
        """Set one field of some rows."""
        ids = self._store.dots.id[rows]
        bit = _BIT[field]
        fresh = (self._seen[ids] & bit) == 0
        if fresh.any():
            new = ids[fresh]
            self._seen[new] |= bit
            self._before[field].append((new, getattr(self._store.dots, field)[rows[fresh]]))
        self._store.write(field, rows, values)

    def insert(self, dots: Dots) -> Rows:
        """Add dots, whose ids the store has given; return their rows."""
        if self._store.next_id > len(self._seen):
            more = np.zeros(2 * self._store.next_id, np.uint16)
            more[: len(self._seen)] = self._seen
            self._seen = more
        self._seen[dots.id] = _ALL
        self._inserted.append(dots.id)
        return self._store.append(dots)

    def remove(self, rows: Rows) -> Rows:
        """Remove rows, sorted and each once; return all rows that have changed."""
        ids = self._store.dots.id[rows]
        old = (self._seen[ids] & _NEW) == 0
        gone = DotRows(self._store.dots.take(rows[old]), rows[old].astype(np.int64))
        shift = self._store.remove(rows)
        self._removed.append(gone)
        self._note_rows(gone.dots.id, gone.rows)
        self._note_rows(shift.ids, shift.before)
        return np.concatenate([rows, shift.before])

    def finish(self) -> Edit:
        """Return the edit that all changes so far amount to."""
        dots = self._store.dots
        changes: dict[str, Change] = {}
        lost: dict[str, _Pair] = {}
        for name in FIELDS:
            ids, before = _joined(self._before[name], getattr(dots, name))
            rows = self._store.rows(ids)
            gone = rows == GONE
            lost[name] = ids[gone], before[gone]
            ids, before, rows = ids[~gone], before[~gone], rows[~gone]
            after = getattr(dots, name)[rows]
            differs = before != after
            differs = differs.any(axis=1) if differs.ndim == 2 else differs
            if differs.any():
                changes[name] = Change(ids[differs], before[differs], after[differs])
        first_ids, first_rows = _joined(self._rows, np.empty(0, np.int64))
        return Edit(
            self.label,
            changes,
            self._all_removed(lost, first_ids, first_rows.astype(np.int64)),
            self._all_inserted(),
            self._all_shifted(first_ids, first_rows.astype(np.int64)),
        )

    def _note_rows(self, ids: NDArray[np.int64], rows: Rows) -> None:
        fresh = (self._seen[ids] & _ROW) == 0
        self._seen[ids[fresh]] |= _ROW
        self._rows.append((ids[fresh], rows[fresh]))

    def _all_removed(
        self, lost: dict[str, _Pair], first_ids: NDArray[np.int64], first_rows: Rows
    ) -> DotRows:
        """Join the removed dots, with the values and rows they had at the beginning."""
        if not any(len(part) for part in self._removed):
            return DotRows.none()
        dots = Dots(
            **{
                f.name: np.concatenate([getattr(part.dots, f.name) for part in self._removed])
                for f in fields(Dots)
            }
        )
        order = np.argsort(dots.id)
        dots = dots.take(order)
        for name, (ids, before) in lost.items():
            getattr(dots, name)[np.searchsorted(dots.id, ids)] = before
        known = np.argsort(first_ids)
        rows = first_rows[known][np.searchsorted(first_ids[known], dots.id)]
        return DotRows(dots, rows)

    def _all_inserted(self) -> DotRows:
        if not self._inserted:
            return DotRows.none()
        rows = self._store.rows(np.concatenate(self._inserted))
        rows = rows[rows != GONE]
        return DotRows(self._store.dots.take(rows), rows)

    def _all_shifted(self, ids: NDArray[np.int64], before: Rows) -> Shift:
        after = self._store.rows(ids)
        moved = (after != GONE) & (after != before)
        return Shift(ids[moved], before[moved], after[moved])


def _joined(pairs: list[_Pair], like: NDArray[np.generic]) -> _Pair:
    if not pairs:
        return np.empty(0, np.int64), like[:0]
    return np.concatenate([a for a, _ in pairs]), np.concatenate([b for _, b in pairs])
