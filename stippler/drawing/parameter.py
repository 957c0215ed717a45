"""Parameters declared once: checks, command line, Python, panels and files are made from them.

Importing it costs nothing.
"""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from stippler.drawing.validation import whole
from stippler.errors import ParameterError


class Kind(StrEnum):
    """What a value is."""

    WHOLE = "whole number"
    NUMBER = "number"
    RANGE = "range"
    CHOICE = "choice"
    FLAG = "flag"


@dataclass(frozen=True, slots=True)
class Choice:
    """One value that a choice may have, as an illustrator calls it."""

    value: str
    label: str
    help: str = ""


@dataclass(frozen=True, slots=True)
class Parameter:
    """One value of a style, a brush or a tool.

    Attributes
    ----------
    name : str
        Of the field that holds it.
    label : str
        As an illustrator says it.
    help : str
        What it does: a sentence.
    low, high : float
        Bounds, ends included; of a range, those of both its ends.
    may_lack : bool
        Whether None is a value, too.
    is_more : bool
        Whether a panel shows it only when asked for more.
    keyword : str
        As Python takes it; the command line, too, with hyphens. Empty: as `name`.
    flag : str
        What turns a flag that is on by default off on the command line, such as ``--unweighted``.
    only : (str, tuple of values) or None
        Counts only while another parameter has one of these values.
    """

    name: str
    kind: Kind
    default: Any
    label: str
    help: str
    low: float = -math.inf
    high: float = math.inf
    unit: str = ""
    choices: tuple[Choice, ...] = ()
    may_lack: bool = False
    is_more: bool = False
    keyword: str = ""
    flag: str = ""
    only: tuple[str, tuple[Any, ...]] | None = None

    @property
    def word(self) -> str:
        """What Python calls it by."""
        return self.keyword or self.name

    @property
    def option(self) -> str:
        """What the command line calls it by."""
        return self.flag or f"--{self.word.replace('_', '-')}"

    @property
    def values(self) -> tuple[str, ...]:
        """What a choice may be."""
        return tuple(choice.value for choice in self.choices)

    def counts(self, others: object) -> bool:
        """Return whether the value makes a difference beside the others of a style."""
        return self.only is None or getattr(others, self.only[0]) in self.only[1]

    def allows(self, value: object) -> bool:
        """Return whether it may have a value."""
        try:
            self.checked(value)
        except ParameterError:
            return False
        return True

    def checked(self, value: Any) -> Any:
        """Return a value as it is kept.

        Raises
        ------
        ParameterError
            If it cannot be one; it says which, and what to give.
        """
        if value is None and self.may_lack:
            return None
        return _CHECKS[self.kind](self, value)

    @property
    def is_dragged(self) -> bool:
        """Whether a number has bounds so near that one drags between them."""
        return math.isfinite(self.high) and math.isfinite(self.low) and self.high <= 100.0

    @property
    def decimals(self) -> int:
        """How many of a number's decimals mean something."""
        return 0 if self.high - self.low > 99 else 2

    @property
    def said_name(self) -> str:
        """What an error calls it by."""
        return self.word.replace("_", " ")

    def refused(self, what: str, do: str) -> ParameterError:
        """Return the error that a value deserves."""
        return ParameterError(what, self.said_name, do)

    @property
    def bounds(self) -> str:
        """What a number may be, in words."""
        unit = f" {self.unit}" if self.unit else ""
        if math.isinf(self.high):
            return f"{_said(self.low)} or more{unit}"
        return f"{_said(self.low)} to {_said(self.high)}{unit}"


def _said(number: float) -> str:
    return f"{number:,.0f}" if number == round(number) and abs(number) < 1e15 else f"{number:g}"


def _whole(about: Parameter, value: Any) -> int:
    number = whole(value, about.said_name)
    if isinstance(value, bool) or not about.low <= number <= about.high:
        raise about.refused(f"{value!r} is out of range", f"give {about.bounds}")
    return number


def _number(about: Parameter, value: Any) -> float:
    try:
        number = math.nan if isinstance(value, bool | str) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not (math.isfinite(number) and about.low <= number <= about.high):
        said = f"{number:g}" if math.isfinite(number) else f"{value!r}"
        raise about.refused(f"{said} is out of range", f"give {about.bounds}")
    return number


def _range(about: Parameter, value: Any) -> tuple[float, float]:
    try:
        low, high = (float(end) for end in value)
    except (TypeError, ValueError):
        low = high = math.nan
    if not (about.low < low <= high < about.high):
        text = f"{low:g}:{high:g}" if low == low else f"{value!r}"
        raise about.refused(
            f"{text} is no range of radii",
            f"give MIN:MAX in {about.unit} with {about.low:g} < MIN <= MAX",
        )
    return low, high


def _choice(about: Parameter, value: Any) -> str:
    if value not in about.values:
        raise about.refused(f"{value!r} is unknown", f"one of {', '.join(about.values)}")
    return str(value)


def _flag(about: Parameter, value: Any) -> bool:
    if type(value).__name__ not in ("bool", "bool_"):
        raise about.refused(f"{value!r} is no yes or no", "give True or False")
    return bool(value)


_CHECKS = {
    Kind.WHOLE: _whole,
    Kind.NUMBER: _number,
    Kind.RANGE: _range,
    Kind.CHOICE: _choice,
    Kind.FLAG: _flag,
}


def parameter(kind: Kind, default: Any, label: str, help: str, **more: Any) -> Any:
    """Declare a field of a dataclass and its `Parameter` in one."""
    about = {"kind": kind, "default": default, "label": label, "help": help, **more}
    return dataclasses.field(default=default, metadata={"parameter": about})


def parameters_of(cls: Any) -> tuple[Parameter, ...]:
    """Return the parameters of a dataclass, in their order."""
    return tuple(
        Parameter(name=field.name, **field.metadata["parameter"])
        for field in dataclasses.fields(cls)
        if "parameter" in field.metadata
    )


def by_default(
    name: str,
    label: str,
    default: Any,
    help: str,
    low: float = 0.0,
    high: float = 1.0,
    unit: str = "",
    options: tuple[str, ...] = (),
    only: tuple[str, tuple[Any, ...]] | None = None,
) -> Parameter:
    """Declare one as brushes and tools do: options make it a choice, a bool a yes or no."""
    kind = Kind.CHOICE if options else Kind.FLAG if isinstance(default, bool) else Kind.NUMBER
    choices = tuple(Choice(option, option.capitalize()) for option in options)
    return Parameter(name, kind, default, label, help, low, high, unit, choices, only=only)
