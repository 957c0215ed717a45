"""How a number is shown, and by how much arrows and the wheel change it."""

from __future__ import annotations

import math
from dataclasses import dataclass

MANY = 10
"""Shift steps so many times as far."""


@dataclass(frozen=True, slots=True)
class Scale:
    """What a control's numbers are.

    Attributes
    ----------
    unit : str
        "mm", "%", "°", "px", "×" or nothing.
    decimals : int or None
        As many as mean something; None goes by the unit and the value.
    step : float
        Of arrows and the wheel; 0 goes by the value.
    low, high : float
        Within which it lies.
    """

    unit: str = ""
    decimals: int | None = None
    step: float = 0.0
    low: float = -math.inf
    high: float = math.inf

    def decimals_of(self, value: float) -> int:
        """Return how many decimals of a value mean something."""
        if self.decimals is not None:
            return self.decimals
        if self.unit in ("%", "°", "px"):
            return 0
        size = abs(value)
        return 3 if 0.0 < size < 0.1 else 2 if size < 10.0 else 1 if size < 1000.0 else 0

    def text(self, value: float) -> str:
        """Return a value with its unit: no zeros behind that mean nothing."""
        return f"{self._written(value, ',').replace('-', '−')}{_space(self.unit)}{self.unit}"

    def plain(self, value: float) -> str:
        """Return a value as it is typed, without a unit."""
        return self._written(value, "")

    def _written(self, value: float, comma: str) -> str:
        decimals = self.decimals_of(value)
        if self.unit in ("%", "°") and round(value, decimals) != round(value, decimals + 2):
            decimals += 2  # it was typed; slides and steps end at whole ones
        number = f"{value:{comma}.{decimals}f}"
        number = number.rstrip("0").rstrip(".") if "." in number else number
        return "0" if number == "-0" else number

    def rounded(self, value: float) -> float:
        """Return a value as it is shown."""
        return round(value, self.decimals_of(value))

    def step_of(self, value: float) -> float:
        """Return by how much an arrow changes a value: about a twentieth of it, a round number."""
        if self.step:
            return self.step
        if self.unit in ("%", "°") and self.high <= 1000.0:
            return 1.0
        least = 10.0 ** -self.decimals_of(value)
        return max(_round_number(abs(value) / 20.0), least) if value else least

    def stepped(self, value: float, n: int, *, far: bool = False) -> float:
        """Return a value so many steps on, a multiple of the step, within its bounds."""
        step = self.step_of(value) * (MANY if far else 1)
        at = value / step
        near = math.floor(at + 1e-9) if n > 0 else math.ceil(at - 1e-9)
        return self.held(round((near + n) * step, 9))

    def held(self, value: float) -> float:
        """Return the nearest value within the bounds."""
        return min(max(value, self.low), self.high)

    def refusal(self, value: float) -> str:
        """Return what a value is out of; nothing where it is within the bounds."""
        if value < self.low:
            return f"at least {self.text(self.low)}"
        return f"at most {self.text(self.high)}" if value > self.high else ""


def _space(unit: str) -> str:
    return "" if unit in ("", "°", "×") else " "


def _round_number(value: float) -> float:
    """Return the largest 1, 2 or 5 times a power of ten that is no larger than a value."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(m for m in (5.0, 2.0, 1.0) if m * power <= value * (1 + 1e-9)) * power
