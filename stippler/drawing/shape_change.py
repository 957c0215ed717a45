"""A change of size and shape: what a pen makes of dots, what a brush or a slider does to them.

A change is previewed by the shaders (`shaders/lib/deformation.glsl`) and made here; both follow
the same formulas, so what is seen beforehand is what is left.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import MAX_ELONGATION, Dots
from stippler.drawing.reference import Reference
from stippler.errors import ParameterError
from stippler.kernels.shapes.dot_shape import hash_unit

Floats = NDArray[np.float64]

MIN_RADIUS_MM, MAX_RADIUS_MM = 0.005, 50.0
FLAT = 1.0 / 512.0
"""Least sum of differences of darkness that makes an edge."""

_ANGLE, _ELONGATION, _ROUGHNESS = 0x5BD1E995, 0x27D4EB2F, 0x165667B1  # salts
_N_AROUND = 8  # places around a dot where darkness is looked at
_LONGER_WAY = 0.45  # of a half turn; no angle that anyone sets lies just there


class LinearChange(NamedTuple):
    """A value becomes ``factor * old + addend``, and up to ``spread`` more by the dot's dice."""

    factor: float = 1.0
    addend: float = 0.0
    spread: float = 0.0


KEEP = LinearChange()


def to(value: float, spread: float = 0.0) -> LinearChange:
    """Set a value, or one between it and so much more."""
    return LinearChange(0.0, value, spread)


@dataclass(frozen=True, slots=True)
class Edges:
    """Directions along a reference's edges.

    Attributes
    ----------
    reach_mm : float
        How far around a dot the slope is measured.
    """

    reference: Reference
    reach_mm: float

    def directions(self, position_mm: Floats) -> Floats:
        """Return the direction across the steepest slope at points; NaN where there is none."""
        x, y = np.zeros((2, len(position_mm)))
        for k in range(_N_AROUND):
            turn = math.tau * k / _N_AROUND
            c, s = math.cos(turn), math.sin(turn)
            darkness = self.reference.at(position_mm + self.reach_mm * np.array([c, s]))
            x += c * darkness
            y += s * darkness
        return np.where(np.hypot(x, y) > FLAT, np.arctan2(y, x) + math.pi / 2, math.nan)


@dataclass(frozen=True, slots=True)
class ShapeChange:
    """What happens to size and shape.

    Attributes
    ----------
    radius : LinearChange
        Its addend is in mm; it has no spread.
    elongation, roughness : LinearChange
    angle_rad : float or None
        The direction dots turn to, the shorter way; None keeps their own.
    edges : Edges or None
        Turn dots along these instead, but for those on flat ground.
    scatter_rad : float
        Each dot turns away by its own amount of up to so much; pi / 2 is any direction.
    stretch : float
        Elongation that is added along the direction above: dots turn towards it as far as they
        are stretched, and not otherwise.
    """

    radius: LinearChange = KEEP
    elongation: LinearChange = KEEP
    roughness: LinearChange = KEEP
    angle_rad: float | None = None
    edges: Edges | None = None
    scatter_rad: float = 0.0
    stretch: float = 0.0

    def __post_init__(self) -> None:
        values = (*self.radius, *self.elongation, *self.roughness, self.angle_rad or 0.0)
        if not all(math.isfinite(v) for v in (*values, self.scatter_rad, self.stretch)):
            raise ParameterError("a change of shape has to be finite", "shape")

    @property
    def elongates(self) -> bool:
        """Whether round dots may be round no longer."""
        return self.stretch != 0.0 or (self.elongation != KEEP and self.elongation != to(1.0))

    @property
    def roughens(self) -> bool:
        """Whether smooth dots may be smooth no longer."""
        return self.roughness.addend > 0.0 or self.roughness.spread > 0.0

    @property
    def turns(self) -> bool:
        """Whether directions change."""
        return self.angle_rad is not None or self.edges is not None or self.scatter_rad != 0.0

    def of(self, dots: Dots, weight: float | Floats = 1.0) -> Mapping[str, NDArray[np.float32]]:
        """Return the new values of dots, by the names of those fields that change.

        Parameters
        ----------
        weight : float or (n,) array
            How far each dot follows, 0 to 1.
        """
        w = np.broadcast_to(np.asarray(weight, np.float64), (len(dots),))
        new: dict[str, Floats] = {}
        if self.radius != KEEP:
            old = dots.radius_mm.astype(np.float64)
            goal = np.maximum(old * self.radius.factor + self.radius.addend, MIN_RADIUS_MM)
            # by ratio, so that growing and shrinking take each other back under a soft tip too
            new["radius_mm"] = np.clip(old * (goal / old) ** w, MIN_RADIUS_MM, MAX_RADIUS_MM)
        if self.elongation != KEEP:
            new["elongation"] = _stepped(
                dots.elongation, dots.seed, self.elongation, w, (1.0, MAX_ELONGATION), _ELONGATION
            )
        if self.roughness != KEEP:
            new["roughness"] = _stepped(
                dots.roughness, dots.seed, self.roughness, w, (0.0, 1.0), _ROUGHNESS
            )
        if self.turns or self.stretch:
            new |= self._turned(dots, w, new.get("elongation"))
        return {name: values.astype(np.float32) for name, values in new.items()}

    def _turned(self, dots: Dots, w: Floats, elongation: Floats | None) -> dict[str, Floats]:
        angle = dots.angle_rad.astype(np.float64)
        goal = self._directions(dots, angle)
        if not self.stretch:
            return {"angle_rad": angle + w * _shorter(goal - angle)}
        long = (dots.elongation if elongation is None else elongation) - 1.0
        u = long * np.cos(2.0 * angle) + self.stretch * w * np.cos(2.0 * goal)
        v = long * np.sin(2.0 * angle) + self.stretch * w * np.sin(2.0 * goal)
        length = np.hypot(u, v)
        turn = np.where(length > 1e-6, _shorter(0.5 * np.arctan2(v, u) - angle), 0.0)
        return {
            "elongation": np.clip(1.0 + length, 1.0, MAX_ELONGATION),
            "angle_rad": angle + turn,
        }

    def _directions(self, dots: Dots, angle: Floats) -> Floats:
        if self.edges is not None:
            found = self.edges.directions(dots.position_mm)
            goal = np.where(np.isnan(found), angle, found)
        else:
            goal = angle if self.angle_rad is None else np.full(len(angle), self.angle_rad)
        return goal + (2.0 * hash_unit(dots.seed, _ANGLE) - 1.0) * self.scatter_rad


def _stepped(
    old: NDArray[np.float32],
    seed: NDArray[np.uint32],
    step: LinearChange,
    weight: Floats,
    limits: tuple[float, float],
    salt: int,
) -> Floats:
    goal = old.astype(np.float64) * step.factor + step.addend
    if step.spread:
        goal += step.spread * hash_unit(seed, salt)
    return np.clip(old + weight * (goal - old), *limits)


def _shorter(turn: Floats) -> Floats:
    """Return turns that lead to the same axis; the cut lies where exact angles do not."""
    return turn - math.pi * np.floor(turn / math.pi + _LONGER_WAY)
