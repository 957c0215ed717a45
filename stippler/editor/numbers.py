"""Numbers as people type them: units, sums, thousands, decimal commas; or why they are none."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping

from stippler.errors import ParameterError

_LENGTHS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, '"': 25.4, "pt": 25.4 / 72.0}
_ANGLES = {"°": 1.0, "deg": 1.0, "rad": 180.0 / math.pi, "turn": 360.0}
_UNITS = {"mm": _LENGTHS, "°": _ANGLES, "%": {"%": 1.0}, "px": {"px": 1.0}}
_FACTORS = {"k": 1e3, "K": 1e3, "M": 1e6}
_TOKEN = re.compile(r"\s*(?:(\d[\d.,]*(?:[eE][+-]?\d+)?|[.,]\d+)|([^\W\d_]+|[°%\"])|([-+*/()×−]))")
_SIGNS = {"×": "*", "−": "-"}
_LONGEST, _DEEPEST = 200, 20


def parse_number(text: str, unit: str = "", more: Mapping[str, float] | None = None) -> float:
    """Return the number that a text tells, in the unit of its field.

    ``21 cm``, ``8.5 in``, ``2*15000``, ``50k``, ``(3 + 4) / 2``, ``12,5``; a number without a unit
    has the field's.

    Parameters
    ----------
    unit : {"", "mm", "°", "%", "px", "×"}
    more : mapping, optional
        Further units, each as a number of the field's.

    Raises
    ------
    ParameterError
        If it tells none, or one that could be meant in two ways.
    """
    if len(text) > _LONGEST:
        raise _refused(text[:20] + "…", "is too long")
    reader = _Reader(text, unit, more or {})
    value = reader.sum(0)
    if reader.left:
        raise _refused(text, f"{reader.left[0][1]!r} cannot stand there")
    if not math.isfinite(value):
        raise _refused(text, "is no finite number")
    return value


class _Reader:
    """Reads tokens from the left; a method for each rank of operators."""

    def __init__(self, text: str, unit: str, more: Mapping[str, float]) -> None:
        self._text, self._unit = text, unit
        self._units = {**_UNITS.get(unit, {}), **more}
        self.left = _tokens(text)

    def sum(self, depth: int) -> float:
        """Read terms, added up."""
        value = self._product(depth)
        while self._next() in ("+", "-"):
            sign = self._take()
            term = self._product(depth)
            value = value + term if sign == "+" else value - term
        return value

    def _product(self, depth: int) -> float:
        value = self._factor(depth)
        while self._next() in ("*", "/"):
            if self._take() == "*":
                value *= self._factor(depth)
            else:
                divisor = self._factor(depth)
                if divisor == 0.0:
                    raise _refused(self._text, "divides by nothing")
                value /= divisor
        return value

    def _factor(self, depth: int) -> float:
        if depth > _DEEPEST:
            raise _refused(self._text, "has too many brackets")
        sign = self._next()
        if sign in ("-", "+"):
            self._take()
            value = self._factor(depth + 1)
            return -value if sign == "-" else value
        if sign == "(":
            self._take()
            value = self.sum(depth + 1)
            if self._next() != ")":
                raise _refused(self._text, "lacks a bracket")
            self._take()
            return value * self._scale()
        if not self.left or self.left[0][0] != "number":
            raise _refused(self._text, "is no number")
        return _plain(self._take(), self._text, whole=self._unit == "") * self._scale()

    def _scale(self) -> float:
        """Read thousands and a unit behind a number; return what they multiply it by."""
        scale = 1.0
        while self.left and self.left[0][0] == "word":
            word = self._take()
            units = self._units
            if word in units:
                return scale * units[word]
            if word in _FACTORS and scale == 1.0:
                scale = _FACTORS[word]
                continue
            known = ", ".join(units) or "none"
            raise _refused(self._text, f"{word!r} is no unit here ({known})")
        return scale

    def _next(self) -> str:
        return self.left[0][1] if self.left and self.left[0][0] == "sign" else ""

    def _take(self) -> str:
        return self.left.pop(0)[1]


def _tokens(text: str) -> list[tuple[str, str]]:
    found, at = [], 0
    stripped = text.rstrip()
    while at < len(stripped):
        match = _TOKEN.match(stripped, at)
        if match is None:
            raise _refused(text, f"{stripped[at]!r} is not understood")
        kind = ("number", "word", "sign")[(match.lastindex or 1) - 1]
        word = match.group(match.lastindex or 1)
        found.append((kind, _SIGNS.get(word, word)))
        at = match.end()
    return found


def _plain(digits: str, text: str, *, whole: bool) -> float:
    """Return a number of digits, points and commas."""
    head, mark, exponent = digits.lower().partition("e")
    commas, points = head.count(","), head.count(".")
    groups = re.fullmatch(r"\d{1,3}(,\d{3})+(\.\d*)?", head)
    if groups and (whole or commas > 1 or points):
        head = head.replace(",", "")
    elif groups:
        raise _refused(text, f"could be {head.replace(',', '')} or {head.replace(',', '.')}")
    elif commas == 1 and not points:
        head = head.replace(",", ".")
    elif commas or points > 1:
        raise _refused(text, "has points and commas that cannot be told apart")
    return float(head + mark + exponent)


def _refused(text: str, why: str) -> ParameterError:
    return ParameterError(
        f"{text.strip() or 'nothing'!r} {why}", "number", "write 21 cm, 2*15000 or 50k"
    )
