"""The kinds of values that a drawing holds beside its dots, each under an id of its own.

A value is a frozen dataclass, equal by what it holds, with `to_json` (plain JSON types) and
`from_json`. A new kind is one more line in `_readers`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import cache
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from stippler.drawing.reference import Picture

PAGE, REFERENCE, AREA, LINE, PATTERN, STYLE, BORDER = (
    "page",
    "reference",
    "area",
    "line",
    "pattern",
    "style",
    "border",
)
SINGLE = (PAGE, REFERENCE)
"""Kinds of which a drawing holds one value, under the id 0; the page is always there."""

DOT = "dot"
"""Not a kind of value: what `next_id` calls the ids of dots by."""


class Record(Protocol):
    """A value that a drawing holds."""

    def to_json(self) -> dict[str, Any]:
        """Return it in JSON's types."""
        ...


KINDS = (PAGE, REFERENCE, AREA, LINE, PATTERN, STYLE, BORDER)


@cache
def _readers() -> dict[str, Callable[[Mapping[str, Any]], Record]]:
    """Return what makes a value of each kind; a drawing that is only a page needs few of them."""
    from stippler.drawing.area import Area
    from stippler.drawing.line import Line
    from stippler.drawing.page import Page
    from stippler.drawing.pattern import Pattern
    from stippler.drawing.planar.planar_map import Arc
    from stippler.drawing.style import Style

    return {
        PAGE: Page.from_json,
        AREA: Area.from_json,
        STYLE: Style.from_json,
        LINE: Line.from_json,
        PATTERN: Pattern.from_json,
        BORDER: Arc.from_json,
    }


def fields_of(kind: str) -> frozenset[str]:
    """Return the names that a kind's `to_json` gives: the fields of its dataclass."""
    if kind == REFERENCE:
        return frozenset(("picture", "width_mm", "adjustment"))
    reader: Any = _readers().get(kind)
    return frozenset(f.name for f in fields(reader.__self__) if f.init) if reader else frozenset()


def value_from_json(kind: str, data: Mapping[str, Any], pictures: Mapping[str, Picture]) -> Record:
    """Make a value of what its `to_json` gave.

    Raises
    ------
    KeyError, TypeError, ValueError
        If the kind, a field or a picture is not known, or a value is out of range.
    """
    if kind == REFERENCE:
        from stippler.drawing.reference import Reference

        made: Record = Reference.from_json(data, pictures)
        _check_kinds(made.adjustment)  # type: ignore[attr-defined]
        return made
    made = _readers()[kind](data)
    _check_kinds(made)
    return made


_KINDS_OF_VALUE: dict[str, tuple[type, ...]] = {
    "str": (str,), "int": (int,), "float": (float, int), "bool": (bool,),
    "int | None": (int, type(None)),
}  # fmt: skip


def _check_kinds(value: Any) -> None:
    """Raise `TypeError` where a field holds another kind of value than it is declared to hold."""
    for f in fields(value):
        kinds = _KINDS_OF_VALUE.get(str(f.type))
        if kinds is not None and type(getattr(value, f.name)) not in kinds:
            raise TypeError(f"{f.name} is not of the kind {f.type}")
