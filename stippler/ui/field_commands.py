"""Commands that reach the controls of panels: values, options, fields."""

from __future__ import annotations

import re
from collections.abc import Callable

from stippler.editor.commands import Command
from stippler.editor.fuzzy import match
from stippler.editor.numbers import parse_number
from stippler.errors import ParameterError
from stippler.ui.fields import CHECK, CHOICE, NUMBER, Field, Fields

_TYPED = re.compile(r"(.*?[^\W\d].*?)\s*[=: ]\s*([-−+]?[\d.,(].*)")
_MOST = 3


class FieldCommands:
    """Makes commands of what is known of the panels.

    Parameters
    ----------
    show : callable
        Brings a panel to the front, where the name is one of a panel's.
    """

    def __init__(self, fields: Fields, show: Callable[[str], None]) -> None:
        self._fields, self._show = fields, show

    def all(self) -> list[Command]:
        """Return what opens each number, turns each switch, and chooses each option."""
        found = []
        for field in self._fields.known:
            if field.kind == NUMBER:
                found.append(self._command(field, f"{field.label}…", ""))
            elif field.kind == CHECK:
                told = "off" if field.chosen else "on"
                found.append(self._command(field, f"{field.label}: {told}", 1 - field.chosen))
            elif field.kind == CHOICE:
                found += [
                    self._command(field, f"{field.label}: {option}", k)
                    for k, option in enumerate(field.options)
                    if k != field.chosen
                ]
        return found

    def values(self, typed: str) -> list[Command]:
        """Return what a text with a value at its end may mean."""
        told = _TYPED.fullmatch(typed.strip())
        if told is None:
            return []
        scored = []
        for field in self._fields.known:
            score = match(told[1], field.label) if field.kind == NUMBER else None
            if score is not None and _is_number(told[2], field.unit):
                scored.append((score, field))
        scored.sort(key=lambda fit: -fit[0])
        return [
            self._command(field, f"{field.label}: {told[2]}", told[2])
            for _, field in scored[:_MOST]
        ]

    def _command(self, field: Field, label: str, value: str | int) -> Command:
        def run() -> None:
            self._fields.wish(field, value)
            self._show(field.panel)

        return Command(f"field.{field.panel}.{label}", label, run, detail=field.panel)


def _is_number(text: str, unit: str) -> bool:
    try:
        parse_number(text, unit)
    except ParameterError:
        return False
    return True
