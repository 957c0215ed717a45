"""What each pen makes of a dot's shape."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from stippler.drawing.dots import MAX_ELONGATION, Dots
from stippler.drawing.shape_change import ShapeChange, to
from stippler.errors import ParameterError

_ROUND = (1.0, 1.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Pen:
    """A pen's character: the shapes of the dots it makes.

    Attributes
    ----------
    name : str
        As the command line takes it.
    elongation, roughness : (low, high)
        The range that its dots take, evenly.
    angle_rad : float
        Direction of the long axis, from x towards y.
    spread_rad : float
        Dots turn away from that direction by up to so much; pi / 2 is any direction.
    """

    name: str
    elongation: tuple[float, float] = (1.0, 1.0)
    roughness: tuple[float, float] = (0.0, 0.0)
    angle_rad: float = 0.0
    spread_rad: float = 0.0

    def __post_init__(self) -> None:
        _check_range("elongation", self.elongation, 1.0, MAX_ELONGATION)
        _check_range("roughness", self.roughness, 0.0, 1.0)
        _check_range("spread", (0.0, self.spread_rad), 0.0, math.pi / 2)
        _check_range("angle", (self.angle_rad, self.angle_rad), -math.inf, math.inf)

    @property
    def label(self) -> str:
        """As a person reads it."""
        return self.name.replace("-", " ").capitalize()

    @property
    def change(self) -> ShapeChange:
        """What it does to dots, by their seeds; sizes stay."""
        (thin, long), (even, rough) = self.elongation, self.roughness
        return ShapeChange(
            elongation=to(thin, long - thin),
            roughness=to(even, rough - even),
            angle_rad=self.angle_rad,
            scatter_rad=self.spread_rad,
        )

    @property
    def _leaves_round(self) -> bool:
        return (*self.elongation, *self.roughness, self.angle_rad, self.spread_rad) == _ROUND

    def drawn(self, dots: Dots) -> Dots:
        """Return dots as this pen draws them; they share the arrays that stay."""
        if self._leaves_round and not dots.angle_rad.any() and _are_round(dots):
            return dots
        return replace(dots, **self.change.of(dots))  # type: ignore[arg-type]


def _are_round(dots: Dots) -> bool:
    return bool((dots.elongation == 1.0).all()) and not dots.roughness.any()


def _check_range(name: str, limits: tuple[float, float], low: float, high: float) -> None:
    a, b = limits
    if not (math.isfinite(a) and math.isfinite(b) and low <= a <= b <= high):
        raise ParameterError(
            f"{a:g} to {b:g} is out of range", name, f"keep it within {low:g} to {high:g}"
        )


PENS = (
    Pen("technical-pen"),
    Pen("quill", (1.15, 1.7), (0.10, 0.25), math.radians(-38), math.radians(14)),
    Pen("brush", (1.7, 3.2), (0.12, 0.35), math.radians(-62), math.radians(26)),
    Pen("rough-paper", (1.0, 1.25), (0.45, 0.85), 0.0, math.pi / 2),
    Pen("stick", (1.1, 1.9), (0.6, 1.0), math.radians(-20), math.pi / 2),
)
"""Pen characters, from the most even to the coarsest."""


def pen_named(name: str) -> Pen:
    """Find a pen.

    Raises
    ------
    ParameterError
        If there is none of that name.
    """
    for pen in PENS:
        if pen.name == name:
            return pen
    known = ", ".join(pen.name for pen in PENS)
    raise ParameterError(f"{name!r} is unknown", "pen", f"one of {known}")
