"""What an edit changes of the dots, as arrays: inverts exactly, and joins with what comes after."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cache

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.drawing.ids import Rows

FIELDS = tuple(f.name for f in fields(Dots) if f.name != "id")
"""What an edit may change of a dot; its id never changes."""

Ids = NDArray[np.int64]


@dataclass(frozen=True, slots=True, eq=False)
class Change:
    """One field of some dots that are there before and after."""

    ids: Ids
    before: NDArray[np.generic]
    after: NDArray[np.generic]

    def inverse(self) -> Change:
        """Return the change that takes this one back."""
        return Change(self.ids, self.after, self.before)

    def of(self, which: NDArray[np.bool_]) -> Change:
        """Return the part that concerns some of the dots."""
        return Change(self.ids[which], self.before[which], self.after[which])


@dataclass(frozen=True, slots=True, eq=False)
class DotRows:
    """Whole dots, and the rows they stand in."""

    dots: Dots
    rows: Rows

    @classmethod
    @cache
    def none(cls) -> DotRows:
        """Return the empty set; always the same one."""
        return cls(Dots.none(), np.empty(0, np.int64))

    def __len__(self) -> int:
        return len(self.rows)

    def of(self, which: NDArray[np.bool_]) -> DotRows:
        """Return copies of some of them."""
        return DotRows(self.dots.take(which), self.rows[which])


@dataclass(frozen=True, slots=True, eq=False)
class Shift:
    """Dots that stay but stand in other rows, because others came or went."""

    ids: Ids
    before: Rows
    after: Rows

    @classmethod
    @cache
    def none(cls) -> Shift:
        """Return the empty set; always the same one."""
        nothing = np.empty(0, np.int64)
        return cls(nothing, nothing, nothing)

    def inverse(self) -> Shift:
        """Return the shift that takes this one back."""
        return Shift(self.ids, self.after, self.before)


@dataclass(frozen=True, slots=True, eq=False)
class DotEdit:
    """One change of the dots; its inverse takes it back to the bit.

    Attributes
    ----------
    changes : mapping of field to Change
        Only of dots that are there before and after.
    removed, inserted : DotRows
        With their rows before and after.
    shifted : Shift
        Rows of the dots that moved to close gaps; so undoing restores the order, too.
    """

    changes: Mapping[str, Change]
    removed: DotRows
    inserted: DotRows
    shifted: Shift

    @classmethod
    @cache
    def none(cls) -> DotEdit:
        """Return the change of nothing; always the same one."""
        return cls({}, DotRows.none(), DotRows.none(), Shift.none())

    def inverse(self) -> DotEdit:
        """Return the change that takes this one back."""
        changes = {name: change.inverse() for name, change in self.changes.items()}
        return DotEdit(changes, self.inserted, self.removed, self.shifted.inverse())

    def then(self, second: DotEdit) -> DotEdit:
        """Return the one change that both amount to; see `stippler.drawing.compose`."""
        from stippler.drawing.compose import joined

        return joined(self, second)

    @property
    def is_empty(self) -> bool:
        """Whether it changes nothing."""
        return not (self.changes or len(self.removed) or len(self.inserted))

    @property
    def n_dots(self) -> int:
        """How many dots it concerns, at most."""
        changed = max((len(change.ids) for change in self.changes.values()), default=0)
        return changed + len(self.removed) + len(self.inserted)

    @property
    def n_bytes(self) -> int:
        """Memory it takes."""
        return sum(array.nbytes for _, array in self.arrays())

    def arrays(self) -> Iterator[tuple[str, NDArray[np.generic]]]:
        """Name all its arrays; `from_arrays` undoes it."""
        for name, change in self.changes.items():
            yield f"change.{name}.ids", change.ids
            yield f"change.{name}.before", change.before
            yield f"change.{name}.after", change.after
        for kind, placed in (("removed", self.removed), ("inserted", self.inserted)):
            if len(placed):
                yield f"{kind}.rows", placed.rows
                for f in fields(Dots):
                    yield f"{kind}.{f.name}", getattr(placed.dots, f.name)
        if len(self.shifted.ids):
            for part in ("ids", "before", "after"):
                yield f"shifted.{part}", getattr(self.shifted, part)

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, NDArray[np.generic]]) -> DotEdit:
        """Make a change of the arrays that `arrays` named.

        Raises
        ------
        KeyError
            If an array is missing.
        """
        names = [key.split(".")[1] for key in arrays if key.startswith("change.")][::3]

        def part(kind: str, name: str) -> NDArray[np.generic]:
            return arrays[f"{kind}.{name}"]

        changes = {
            name: Change(*(part(f"change.{name}", p) for p in ("ids", "before", "after")))  # type: ignore[arg-type]
            for name in names
        }
        removed, inserted = (
            DotRows(
                Dots(**{f.name: part(kind, f.name) for f in fields(Dots)}),  # type: ignore[arg-type]
                part(kind, "rows"),  # type: ignore[arg-type]
            )
            if f"{kind}.rows" in arrays
            else DotRows.none()
            for kind in ("removed", "inserted")
        )
        shifted = Shift.none()
        if "shifted.ids" in arrays:
            shifted = Shift(*(part("shifted", p) for p in ("ids", "before", "after")))  # type: ignore[arg-type]
        return cls(changes, removed, inserted, shifted)


def differs(a: NDArray[np.generic], b: NDArray[np.generic]) -> NDArray[np.bool_]:
    """Return in which rows two arrays of one type differ in any bit."""
    bits = np.dtype(f"u{a.dtype.itemsize}")
    unequal = np.ascontiguousarray(a).view(bits) != np.ascontiguousarray(b).view(bits)
    return np.asarray(unequal.any(axis=1) if unequal.ndim == 2 else unequal)
