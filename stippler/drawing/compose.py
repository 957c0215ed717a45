"""Two changes of the dots, one after the other, as one."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dot_edit import FIELDS, Change, DotEdit, DotRows, Ids, Shift, differs
from stippler.drawing.dots import Dots


def joined(first: DotEdit, second: DotEdit) -> DotEdit:
    """Return what `first` and then `second` amount to.

    Dots that come and go leave no trace; those that go and come back have changed, where they
    differ; what ends as it was is left out.
    """
    gone = second.removed.of(~_is_in(second.removed.dots.id, first.inserted.dots.id))
    _set_back(gone, first)
    came = first.inserted.of(~_is_in(first.inserted.dots.id, second.removed.dots.id))
    _bring_on(came, second)
    removed, inserted = _both(first.removed, gone), _both(came, second.inserted)
    back = _is_in(removed.dots.id, inserted.dots.id)
    again = _is_in(inserted.dots.id, removed.dots.id)
    old, new = _by_id(removed.of(back)), _by_id(inserted.of(again))
    changes = {name: _changed(name, first, second, old, new) for name in FIELDS}
    moved = _shifted(first, second, np.concatenate([removed.dots.id, inserted.dots.id]))
    returned = old.rows != new.rows
    return DotEdit(
        {name: change for name, change in changes.items() if len(change.ids)},
        removed.of(~back),
        inserted.of(~again),
        Shift(
            np.concatenate([moved.ids, old.dots.id[returned]]),
            np.concatenate([moved.before, old.rows[returned]]),
            np.concatenate([moved.after, new.rows[returned]]),
        ),
    )


def _set_back(placed: DotRows, edit: DotEdit) -> None:
    """Give dots the values and rows that they had before an edit."""
    for name, change in edit.changes.items():
        _put(getattr(placed.dots, name), placed.dots.id, change.ids, change.before)
    _put(placed.rows, placed.dots.id, edit.shifted.ids, edit.shifted.before)


def _bring_on(placed: DotRows, edit: DotEdit) -> None:
    """Give dots the values and rows that they have after an edit."""
    for name, change in edit.changes.items():
        _put(getattr(placed.dots, name), placed.dots.id, change.ids, change.after)
    _put(placed.rows, placed.dots.id, edit.shifted.ids, edit.shifted.after)


def _put(values: NDArray[np.generic], at: Ids, ids: Ids, new: NDArray[np.generic]) -> None:
    found = _find(ids, at)
    values[found >= 0] = new[found[found >= 0]]


def _changed(name: str, first: DotEdit, second: DotEdit, old: DotRows, new: DotRows) -> Change:
    """Return what becomes of one field of the dots that are there before and after."""
    nothing = np.empty(0, np.int64)
    like = getattr(old.dots, name)[:0]
    none = Change(nothing, like, like)
    a, b = first.changes.get(name, none), second.changes.get(name, none)
    a = a.of(~_is_in(a.ids, second.removed.dots.id))
    b = b.of(~_is_in(b.ids, first.inserted.dots.id))
    ids = np.union1d(a.ids, b.ids)
    at_a, at_b = _find(a.ids, ids), _find(b.ids, ids)
    before = _either(a.before, at_a, b.before, at_b)
    after = _either(b.after, at_b, a.after, at_a)
    ids = np.concatenate([ids, old.dots.id])
    before = np.concatenate([before, getattr(old.dots, name)])
    after = np.concatenate([after, getattr(new.dots, name)])
    return Change(ids, before, after).of(differs(before, after))


def _shifted(first: DotEdit, second: DotEdit, but: Ids) -> Shift:
    a, b = first.shifted, second.shifted
    ids = np.union1d(a.ids, b.ids)
    ids = ids[~_is_in(ids, but)]
    at_a, at_b = _find(a.ids, ids), _find(b.ids, ids)
    before = _either(a.before, at_a, b.before, at_b)
    after = _either(b.after, at_b, a.after, at_a)
    moved = before != after
    return Shift(ids[moved], before[moved], after[moved])


def _either(
    values: NDArray[np.generic],
    at: NDArray[np.int64],
    others: NDArray[np.generic],
    at_other: NDArray[np.int64],
) -> NDArray[Any]:
    """Return for each dot the one value, or the other where it has none."""
    out = np.empty((len(at), *values.shape[1:]), values.dtype)
    out[at >= 0] = values[at[at >= 0]]
    out[at < 0] = others[at_other[at < 0]]
    return out


def _both(a: DotRows, b: DotRows) -> DotRows:
    if not len(a) or not len(b):
        return a if len(a) else b
    columns = (
        (f.name, np.concatenate([getattr(a.dots, f.name), getattr(b.dots, f.name)]))
        for f in fields(Dots)
    )
    return DotRows(Dots(**dict(columns)), np.concatenate([a.rows, b.rows]))


def _by_id(placed: DotRows) -> DotRows:
    order = np.argsort(placed.dots.id)
    return DotRows(placed.dots.take(order), placed.rows[order])


def _is_in(ids: Ids, others: Ids) -> NDArray[np.bool_]:
    return np.isin(ids, others) if len(others) else np.zeros(len(ids), np.bool_)


def _find(ids: Ids, wanted: Ids) -> NDArray[np.int64]:
    """Return where ids stand among others, in any order; -1 where they do not."""
    if not len(ids):
        return np.full(len(wanted), -1, np.int64)
    order = np.argsort(ids)
    at = order[np.minimum(np.searchsorted(ids, wanted, sorter=order), len(ids) - 1)]
    return np.where(ids[at] == wanted, at, -1)
