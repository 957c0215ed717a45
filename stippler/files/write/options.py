"""Options of formats, declared once: CLI, Python and dialog are made from the same values."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from stippler.errors import ParameterError

Value = float | int | bool | str | None


@dataclass(frozen=True, slots=True)
class Option:
    """One value that a format can be given.

    Attributes
    ----------
    name : str
        As Python takes it; the command line has hyphens.
    default : value
        Tells the kind, too: bool, int, float or str.
    help : str
        A short clause, capital first.
    unit : str
        Of a number, for a person.
    low, high : float
        Range of a number, ends included.
    choices : tuple of str
        What a text may be; empty: anything.
    kind : type, optional
        Where the default is None.
    label : str
        In dialogs, where the name is not to be it.
    """

    name: str
    default: Value
    help: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    choices: tuple[str, ...] = ()
    kind: type | None = None
    label: str = ""

    @property
    def title(self) -> str:
        """What stands before it in a dialog."""
        return self.label or self.name.replace("_", " ").capitalize()

    @property
    def type(self) -> type:
        """The kind of its values."""
        return self.kind or type(self.default)

    @property
    def flag(self) -> str:
        """As the command line has it."""
        return "--" + self.name.replace("_", "-")

    def check(self, value: Any) -> Value:
        """Return a value of the option's kind, or raise `ParameterError` that says what may be."""
        if value is None and self.default is None:
            return None
        if self.type is bool:
            if not isinstance(value, bool):
                raise self._wrong(value, "give True or False")
            return value
        if self.type is str:
            text = str(value)
            if self.choices and text not in self.choices:
                raise self._wrong(repr(text), f"one of {', '.join(self.choices)}")
            return text
        return self._number(value)

    def _number(self, value: Any) -> Value:
        do = f"give {self.low:g} to {self.high:g}"
        try:
            number = float(value)
        except (TypeError, ValueError):
            raise self._wrong(repr(value), do) from None
        if not (math.isfinite(number) and self.low <= number <= self.high):
            raise self._wrong(f"{number:g}", do)
        if self.type is int:
            if number != int(number):
                raise self._wrong(f"{number:g}", "give a whole number")
            return int(number)
        return number

    def _wrong(self, value: object, do: str) -> ParameterError:
        unit = f" {self.unit}" if self.unit else ""
        return ParameterError(f"{value}{unit} cannot be used", self.name.replace("_", " "), do)


def checked(options: Iterable[Option], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return all values, defaults for those not given.

    Raises
    ------
    ParameterError
        If a value is out of its range, or there is no option of a name.
    """
    known = {option.name: option for option in options}
    for name in given:
        if name not in known:
            raise ParameterError(
                "is no option of this format", name, f"of {', '.join(known) or 'none'}"
            )
    return {
        name: option.check(given[name]) if name in given else option.default
        for name, option in known.items()
    }
