"""An edit: one undoable change of the dots, as values before and after."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots

FIELDS = tuple(f.name for f in fields(Dots) if f.name != "id")
"""What an edit may change of a dot; its id never changes."""


@dataclass(frozen=True, slots=True, eq=False)
class Change:
    """One field of some dots that are there before and after."""

    ids: NDArray[np.int64]
    before: NDArray[np.generic]
    after: NDArray[np.generic]

    def inverse(self) -> Change:
        """Return the change that takes this one back."""
        return Change(self.ids, self.after, self.before)


@dataclass(frozen=True, slots=True, eq=False)
class DotRows:
    """Whole dots, and the rows they stand in."""

    dots: Dots
    rows: NDArray[np.int64]

    @classmethod
    def none(cls) -> DotRows:
        """Make an empty set."""
        return cls(Dots.none(), np.empty(0, np.int64))

    def __len__(self) -> int:
        return len(self.rows)


@dataclass(frozen=True, slots=True, eq=False)
class Shift:
    """Dots that stay but stand in other rows, because others came or went."""

    ids: NDArray[np.int64]
    before: NDArray[np.int64]
    after: NDArray[np.int64]

    @classmethod
    def none(cls) -> Shift:
        """Make an empty set."""
        nothing = np.empty(0, np.int64)
        return cls(nothing, nothing, nothing)

    def inverse(self) -> Shift:
        """Return the shift that takes this one back."""
        return Shift(self.ids, self.after, self.before)


@dataclass(frozen=True, slots=True, eq=False)
class Edit:
    """One undoable change of the dots; its inverse takes it back to the bit.

    Attributes
    ----------
    label : str
        As the history shows it.
    changes : mapping of field to Change
        Only of dots that are there before and after.
    removed, inserted : DotRows
        With their rows before and after.
    shifted : Shift
        Rows of the dots that moved to close gaps; so undoing restores the order, too.
    """

    label: str
    changes: Mapping[str, Change]
    removed: DotRows
    inserted: DotRows
    shifted: Shift

    def inverse(self) -> Edit:
        """Return the edit that takes this one back."""
        changes = {name: change.inverse() for name, change in self.changes.items()}
        return Edit(self.label, changes, self.inserted, self.removed, self.shifted.inverse())

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
            yield f"{kind}.rows", placed.rows
            for f in fields(Dots):
                yield f"{kind}.{f.name}", getattr(placed.dots, f.name)
        for part in ("ids", "before", "after"):
            yield f"shifted.{part}", getattr(self.shifted, part)

    @classmethod
    def from_arrays(cls, label: str, arrays: Mapping[str, NDArray[np.generic]]) -> Edit:
        """Make an edit of the arrays that `arrays` named."""
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
            for kind in ("removed", "inserted")
        )
        shifted = Shift(*(part("shifted", p) for p in ("ids", "before", "after")))  # type: ignore[arg-type]
        return cls(label, changes, removed, inserted, shifted)
