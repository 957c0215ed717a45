"""What a pen makes of a dot's shape, and how a brush would change it.

A change is previewed by the shaders (`shaders/lib/deformation.glsl`) and made here; both follow
the same formulas, so what is seen while a brush hovers is what letting go leaves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import MAX_ELONGATION, Dots
from stippler.errors import ParameterError

MIN_RADIUS_MM = 1e-3
MAX_RADIUS_MM = 1e3

_ANGLE, _ELONGATION, _ROUGHNESS = 0x5BD1E995, 0x27D4EB2F, 0x165667B1  # salts


def dice(seed: NDArray[np.uint32], salt: int) -> NDArray[np.float64]:
    """Return a number in [0, 1) for each seed; other salts give other numbers."""
    x = np.asarray(seed, np.uint32) ^ np.uint32(salt)
    for shift, factor in ((16, 0x7FEB352D), (15, 0x846CA68B)):
        x = (x ^ (x >> np.uint32(shift))) * np.uint32(factor)
    x ^= x >> np.uint32(16)
    return np.asarray(x >> np.uint32(8), np.float64) / 2**24


@dataclass(frozen=True, slots=True)
class Shapes:
    """Sizes and shapes for a number of dots."""

    radius_mm: NDArray[np.float32]
    elongation: NDArray[np.float32]
    angle_rad: NDArray[np.float32]
    roughness: NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Pen:
    """A pen's character: the shapes of the dots it makes.

    Attributes
    ----------
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

    def shapes(self, dots: Dots) -> Shapes:
        """Return the shapes this pen gives dots, by their seeds; sizes stay."""
        seed = dots.seed
        turn = (2.0 * dice(seed, _ANGLE) - 1.0) * self.spread_rad
        return Shapes(
            dots.radius_mm.copy(),
            _between(self.elongation, dice(seed, _ELONGATION)),
            (self.angle_rad + turn).astype(np.float32),
            _between(self.roughness, dice(seed, _ROUGHNESS)),
        )


def _between(limits: tuple[float, float], part: NDArray[np.float64]) -> NDArray[np.float32]:
    low, high = limits
    return (low + (high - low) * part).astype(np.float32)


def _check_range(name: str, limits: tuple[float, float], low: float, high: float) -> None:
    a, b = limits
    if not (math.isfinite(a) and math.isfinite(b) and low <= a <= b <= high):
        raise ParameterError(
            f"{a:g} to {b:g} is out of range", name, f"keep it within {low:g} to {high:g}"
        )


PENS = (
    Pen("technical pen"),
    Pen("quill", (1.15, 1.7), (0.10, 0.25), math.radians(-38), math.radians(14)),
    Pen("brush", (1.7, 3.2), (0.12, 0.35), math.radians(-62), math.radians(26)),
    Pen("rough paper", (1.0, 1.25), (0.45, 0.85), 0.0, math.pi / 2),
    Pen("stick", (1.1, 1.9), (0.6, 1.0), math.radians(-20), math.pi / 2),
)
"""Pen characters, from the most even to the coarsest."""


Step = tuple[float, float]
_KEEP: Step = (1.0, 0.0)


@dataclass(frozen=True, slots=True)
class ShapeChange:
    """What happens to size and shape: each becomes ``factor * old + addend``, within its range.

    (factor, 0) scales, (0, value) sets, (1, step) adds; (1, 0) keeps.

    Attributes
    ----------
    radius, elongation, roughness : (factor, addend)
        The addend of the radius is in mm.
    angle_rad : float or None
        The direction dots turn to, the shorter way; None keeps their own.
    scatter_rad : float
        Each dot turns by its own amount of up to so much; pi / 2 is any direction.
    """

    radius: Step = _KEEP
    elongation: Step = _KEEP
    roughness: Step = _KEEP
    angle_rad: float | None = None
    scatter_rad: float = 0.0

    def __post_init__(self) -> None:
        steps = (*self.radius, *self.elongation, *self.roughness)
        if not all(math.isfinite(v) for v in (*steps, self.angle_rad or 0.0, self.scatter_rad)):
            raise ParameterError("a change of shape has to be finite", "shape")

    @property
    def deforms(self) -> bool:
        """Whether round dots may be round no longer."""
        return self.elongation != _KEEP or self.roughness != _KEEP

    def of(self, dots: Dots, weight: float | NDArray[np.float64] = 1.0) -> Shapes:
        """Return the new shapes of dots.

        Parameters
        ----------
        weight : float or (n,) array
            How far each dot follows, 0 to 1.
        """
        w = np.asarray(weight, np.float64)
        angle = dots.angle_rad.astype(np.float64)
        goal = angle if self.angle_rad is None else np.full(len(angle), self.angle_rad)
        goal = goal + (2.0 * dice(dots.seed, _ANGLE) - 1.0) * self.scatter_rad
        turn = goal - angle
        turn -= math.pi * np.floor(turn / math.pi + 0.5)
        return Shapes(
            _step(dots.radius_mm, self.radius, w, MIN_RADIUS_MM, MAX_RADIUS_MM),
            _step(dots.elongation, self.elongation, w, 1.0, MAX_ELONGATION),
            (angle + w * turn).astype(np.float32),
            _step(dots.roughness, self.roughness, w, 0.0, 1.0),
        )


def _step(
    old: NDArray[np.float32], step: Step, weight: NDArray[np.float64], low: float, high: float
) -> NDArray[np.float32]:
    new = np.clip(old * step[0] + step[1], low, high)
    return np.asarray(old + weight * (new - old), np.float32)


@dataclass(frozen=True, slots=True)
class Preview:
    """A change shown before it is made.

    Attributes
    ----------
    which : "all", "selected" or "tip"
    center_mm, radius_mm, hardness
        The tip's circle; the change fades out between `hardness` times the radius and the radius.
    """

    change: ShapeChange
    which: Literal["all", "selected", "tip"] = "all"
    center_mm: tuple[float, float] = (0.0, 0.0)
    radius_mm: float = 1.0
    hardness: float = 1.0

    def weights(
        self, position_mm: NDArray[np.float64], selected: NDArray[np.bool_]
    ) -> NDArray[np.float64]:
        """Return how far each dot follows the change, 0 to 1."""
        if self.which == "all":
            return np.ones(len(position_mm))
        if self.which == "selected":
            return selected.astype(np.float64)
        away = np.hypot(*(position_mm - self.center_mm).T) / self.radius_mm
        soft = max(1.0 - self.hardness, 1e-3)
        t = np.clip((1.0 - away) / soft, 0.0, 1.0)
        return np.asarray(t * t * (3.0 - 2.0 * t))
