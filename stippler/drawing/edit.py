"""An edit: one undoable change of a drawing, in parts by kind."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dot_edit import DotEdit
from stippler.drawing.records import value_from_json
from stippler.drawing.reference import Picture, Reference

Values = Mapping[int, tuple[Any, Any]]
_VALUES = "values"


@dataclass(frozen=True, slots=True, eq=False)
class Edit:
    """One undoable change; its inverse takes it back to the bit.

    Attributes
    ----------
    label : str
        As the history shows it.
    dots : DotEdit
        What it does to the dots.
    values : mapping of kind to {id: (before, after)}
        What it does to records of other kinds, and to page and reference, whose id is 0; None
        is a value that is not there.
    next_id : mapping of kind to int
        Ids from these on have not been given when the edit ends; taking it back gives none back.
    """

    label: str
    dots: DotEdit = field(default_factory=DotEdit.none)
    values: Mapping[str, Values] = field(default_factory=dict)
    next_id: Mapping[str, int] = field(default_factory=dict)

    def inverse(self) -> Edit:
        """Return the edit that takes this one back."""
        values = {
            kind: {i: (after, before) for i, (before, after) in changed.items()}
            for kind, changed in self.values.items()
        }
        return Edit(self.label, self.dots.inverse(), values, self.next_id)

    def then(self, second: Edit) -> Edit:
        """Return the one edit that this and then `second` amount to."""
        values: dict[str, dict[int, tuple[Any, Any]]] = {}
        for kind in {**self.values, **second.values}:
            one, two = self.values.get(kind, {}), second.values.get(kind, {})
            both = {
                i: (one.get(i, two.get(i))[0], two.get(i, one.get(i))[1])  # type: ignore[index]
                for i in {**one, **two}
            }
            kept = {i: pair for i, pair in both.items() if pair[0] != pair[1]}
            if kept:
                values[kind] = kept
        next_id = {**self.next_id}
        for kind, i in second.next_id.items():
            next_id[kind] = max(i, next_id.get(kind, 0))
        return Edit(self.label, self.dots.then(second.dots), values, next_id)

    @property
    def is_empty(self) -> bool:
        """Whether it changes nothing."""
        return self.dots.is_empty and not self.values

    @property
    def n_dots(self) -> int:
        """How many dots it concerns, at most."""
        return self.dots.n_dots

    @property
    def n_bytes(self) -> int:
        """Memory its arrays take."""
        return self.dots.n_bytes

    @property
    def pictures(self) -> dict[str, Picture]:
        """The pictures that its references are made of, by their digests."""
        found = {}
        for pair in self.values.get("reference", {}).values():
            for value in pair:
                if isinstance(value, Reference):
                    found[value.source.digest] = value.source
        return found

    def arrays(self) -> Iterator[tuple[str, NDArray[np.generic]]]:
        """Name all its arrays, one of them JSON; `from_arrays` undoes it.

        Pictures are told by their digests: whoever writes edits keeps each of `pictures` once.
        """
        yield from self.dots.arrays()
        values = {
            kind: [[i, *(None if v is None else v.to_json() for v in pair)] for i, pair in some]
            for kind, some in ((k, v.items()) for k, v in self.values.items())
        }
        text = json.dumps({"label": self.label, "values": values, "next_id": dict(self.next_id)})
        yield _VALUES, np.frombuffer(text.encode(), np.uint8)

    @classmethod
    def from_arrays(
        cls,
        arrays: Mapping[str, NDArray[np.generic]],
        pictures: Mapping[str, Picture] | None = None,
    ) -> Edit:
        """Make an edit of the arrays that `arrays` named, and the pictures by their digests.

        Raises
        ------
        KeyError, ValueError
            If something is missing or is not what it should be.
        """
        head = json.loads(np.asarray(arrays[_VALUES], np.uint8).tobytes())
        values = {
            kind: {
                int(i): tuple(
                    None if v is None else value_from_json(kind, v, pictures or {}) for v in pair
                )
                for i, *pair in changed
            }
            for kind, changed in head["values"].items()
        }
        next_id = {kind: int(i) for kind, i in head["next_id"].items()}
        return cls(head["label"], DotEdit.from_arrays(arrays), values, next_id)  # type: ignore[arg-type]
