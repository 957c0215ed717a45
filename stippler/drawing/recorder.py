"""What a stroke has changed so far, kept so that it ends as one edit however long it was."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dot_edit import FIELDS, Change, DotEdit, DotRows, Shift, differs
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.edit import Edit
from stippler.drawing.records import DOT
from stippler.drawing.reference import Reference
from stippler.drawing.store import GONE, DotStore, Rows

_BIT = {name: 1 << k for k, name in enumerate(FIELDS)}
_ROW, _NEW = 1 << len(FIELDS), 1 << len(FIELDS) + 1
_ALL = _NEW - 1 | _NEW

_Pair = tuple[NDArray[np.int64], NDArray[np.generic]]


class Recorder:
    """Changes a drawing and remembers what was there when each value was first touched.

    Each change costs what it touches; nothing is kept twice for a dot that is touched again.
    """

    def __init__(self, drawing: Drawing, store: DotStore, label: str) -> None:
        self._drawing, self._store, self.label = drawing, store, label
        store.seen[:] = 0  # fields, row, new
        self._values: dict[str, dict[int, Any]] = {}  # before
        self._before: dict[str, list[_Pair]] = {name: [] for name in FIELDS}
        self._removed: list[DotRows] = []
        self._inserted: list[NDArray[np.int64]] = []
        self._rows: list[_Pair] = []

    def change(self, field: str, rows: Rows, values: NDArray[np.generic]) -> None:
        """Set one field of some rows."""
        bit = _BIT[field]
        fresh = rows[(self._store.seen[rows] & bit) == 0]
        if len(fresh):
            dots = self._store.dots
            self._store.seen[fresh] |= bit
            self._before[field].append((dots.id[fresh], getattr(dots, field)[fresh]))
        self._store.write(field, rows, values)

    def insert(self, dots: Dots) -> Rows:
        """Add dots, whose ids the store has given; return their rows."""
        self.note_inserted(dots.id)
        rows = self._store.append(dots)
        self._store.seen[rows] = _ALL
        return rows

    def note_inserted(self, ids: NDArray[np.int64]) -> None:
        """Take note of dots that the store has got."""
        self._inserted.append(ids)

    def remove(self, rows: Rows) -> Rows:
        """Remove rows, sorted and each once; return all rows that have changed."""
        seen = self._store.seen
        old = rows[(seen[rows] & _NEW) == 0].astype(np.int64)
        gone = DotRows(self._store.dots.take(old), old)
        first = (seen[old] & _ROW) == 0
        self._rows.append((gone.dots.id[first], old[first]))
        shift = self._store.remove(rows)
        self._removed.append(gone)
        first = (self._store.seen[shift.after] & _ROW) == 0
        self._store.seen[shift.after[first]] |= _ROW
        self._rows.append((shift.ids[first], shift.before[first]))
        return np.concatenate([rows, shift.before])

    def set(self, kind: str, i: int, value: Any) -> None:
        """Set a value of another kind; None takes it out."""
        self._values.setdefault(kind, {}).setdefault(i, self._drawing.get(kind, i))
        self._drawing.put(kind, i, value)

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
            change = Change(ids, before, after).of(differs(before, after))
            if len(change.ids):
                changes[name] = change
        first_ids, first_rows = _joined(self._rows, np.empty(0, np.int64))
        dots_edit = DotEdit(
            changes,
            self._all_removed(lost, first_ids, first_rows.astype(np.int64)),
            self._all_inserted(),
            self._all_shifted(first_ids, first_rows.astype(np.int64)),
        )
        next_id = {**self._drawing.next_id, DOT: self._store.next_id}
        return Edit(self.label, dots_edit, self._all_values(), next_id)

    def _all_values(self) -> dict[str, dict[int, tuple[Any, Any]]]:
        """Return what has become of values; references without the darkness they can work out."""
        changed: dict[str, dict[int, tuple[Any, Any]]] = {}
        for kind, olds in self._values.items():
            for i, before in olds.items():
                after = self._drawing.get(kind, i)
                if before != after:
                    pair = (_light(before), _light(after))
                    changed.setdefault(kind, {})[i] = pair
        return changed

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


def _light(value: Any) -> Any:
    return value.light() if isinstance(value, Reference) else value
