"""The tip of a brush: its outline, and how its effect falls off towards it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, get_args

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.preview import MOST_CORNERS, Footprint, Outline
from stippler.errors import ParameterError

Points = NDArray[np.float64]
TipShape = Literal["circle", "ellipse", "square", "polygon"]
TIP_SHAPES: tuple[TipShape, ...] = get_args(TipShape)

_MOST_TRIES = 64
_OUTLINES: dict[TipShape, Outline] = {
    "circle": "round",
    "ellipse": "round",
    "square": "square",
    "polygon": "polygon",
}


@dataclass(frozen=True, slots=True)
class Tip:
    """An outline of radius 1, scaled by the brush's radius.

    Attributes
    ----------
    shape : {"circle", "ellipse", "square", "polygon"}
        A square's radius is half its side.
    hardness : float
        Share of the way from the middle to the outline with full effect; 1 is a hard tip.
    aspect : float
        Short axis over long axis, of an ellipse.
    angle_rad : float
        Turns the tip, from x towards y.
    corners : tuple of (x, y)
        Of a polygon, in 1 / radius about the middle.
    """

    shape: TipShape = "circle"
    hardness: float = 0.5
    aspect: float = 0.5
    angle_rad: float = 0.0
    corners: tuple[tuple[float, float], ...] = ()

    def __post_init__(self) -> None:
        if self.shape not in TIP_SHAPES:
            raise ParameterError(f"{self.shape!r} is no tip", "tip", f"one of {TIP_SHAPES}")
        if not 0.0 <= self.hardness <= 1.0:
            raise ParameterError(f"{self.hardness:g} is out of range", "hardness", "give 0 to 1")
        if not 0.05 <= self.aspect <= 1.0:
            raise ParameterError(f"{self.aspect:g} is out of range", "aspect", "give 0.05 to 1")
        if not math.isfinite(self.angle_rad):
            raise ParameterError("has to be finite", "tip angle")
        if self.shape == "polygon":
            flat = [abs(v) for corner in self.corners for v in corner]
            if len(self.corners) < 3 or not all(v <= 1.0 for v in flat):
                raise ParameterError("needs three corners or more, within its radius", "tip")

    def weight(self, offset_mm: Points, radius_mm: float) -> NDArray[np.float64]:
        """Return the share of the effect at offsets from the middle, 0 outside the outline."""
        level = self._level(self._turned_back(offset_mm) / radius_mm)
        if self.hardness >= 1.0:
            return (level <= 1.0).astype(np.float64)
        rest = np.clip((1.0 - level) / (1.0 - self.hardness), 0.0, 1.0)
        return np.asarray(rest * rest * (3.0 - 2.0 * rest))

    def outline(self, radius_mm: float, n: int = 48) -> Points:
        """Return points along the outline, about the middle."""
        if self.shape == "polygon":
            points = np.array(self.corners)
        elif self.shape == "square":
            points = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
        else:
            angle = np.linspace(0.0, math.tau, n, endpoint=False)
            squeeze = self.aspect if self.shape == "ellipse" else 1.0
            points = np.column_stack([np.cos(angle), squeeze * np.sin(angle)])
        c, s = math.cos(self.angle_rad), math.sin(self.angle_rad)
        return np.asarray(points @ np.array([(c, s), (-s, c)]) * radius_mm)

    def footprint(
        self, center_mm: tuple[float, float], radius_mm: float, strength: float
    ) -> Footprint | None:
        """Return what `weight` needs as plain numbers; None for a polygon of many corners."""
        if len(self.corners) > MOST_CORNERS:
            return None
        c, s = math.cos(self.angle_rad) / radius_mm, math.sin(self.angle_rad) / radius_mm
        squeeze = self.aspect if self.shape == "ellipse" else 1.0
        return Footprint(
            center_mm,
            (c, s, -s / squeeze, c / squeeze),
            self.reach(radius_mm),
            _OUTLINES[self.shape],
            self.hardness,
            strength,
            self.corners if self.shape == "polygon" else (),
            _depth_of(self.corners) if self.shape == "polygon" else 1.0,
        )

    def reach(self, radius_mm: float) -> float:
        """Return a distance from the middle that no part of the tip goes beyond."""
        return radius_mm * (math.sqrt(2.0) if self.shape in ("square", "polygon") else 1.0)

    def spread(self, n: int, radius_mm: float, rng: np.random.Generator) -> Points:
        """Return n random points, evenly over the tip."""
        if self.shape in ("circle", "ellipse"):
            distance, angle = np.sqrt(rng.random(n)), math.tau * rng.random(n)
            squeeze = self.aspect if self.shape == "ellipse" else 1.0
            points = np.column_stack([np.cos(angle), squeeze * np.sin(angle)])
            return self._turned(points * distance[:, None]) * radius_mm
        points = np.empty((0, 2))
        for _ in range(_MOST_TRIES):
            if len(points) >= n:
                break
            tried = rng.uniform(-1.0, 1.0, (2 * n + 8, 2))
            points = np.concatenate([points, tried[self._level(tried) <= 1.0]])
        return self._turned(points[:n]) * radius_mm

    def _turned(self, points: Points) -> Points:
        c, s = math.cos(self.angle_rad), math.sin(self.angle_rad)
        return np.asarray(points @ np.array([(c, s), (-s, c)]))

    def _turned_back(self, points: Points) -> Points:
        if self.angle_rad == 0.0:
            return points
        c, s = math.cos(self.angle_rad), math.sin(self.angle_rad)
        return np.asarray(points @ np.array([(c, -s), (s, c)]))

    def _level(self, unit: Points) -> NDArray[np.float64]:
        """Return 0 in the middle, 1 on the outline and more outside."""
        x, y = unit[:, 0], unit[:, 1]
        if self.shape == "circle":
            return np.hypot(x, y)
        if self.shape == "ellipse":
            return np.hypot(x, y / self.aspect)
        if self.shape == "square":
            return np.maximum(np.abs(x), np.abs(y))
        return np.asarray(1.0 - _depth(unit, np.array(self.corners)) / _depth_of(self.corners))


def _depth(points: Points, corners: Points) -> NDArray[np.float64]:
    """Return the distance to a polygon's border, negative outside it."""
    from stippler.kernels.cells.polygon import (
        find_depths,  # late: the first frame waits for no numba
    )

    out = np.empty(len(points))
    find_depths(np.ascontiguousarray(points), corners, out)
    return out


@lru_cache(16)
def _depth_of(corners: tuple[tuple[float, float], ...]) -> float:
    """Return about how far the middle of a polygon is from its border."""
    side = np.linspace(-1.0, 1.0, 41)
    grid = np.array(np.meshgrid(side, side)).reshape(2, -1).T
    return max(float(_depth(grid, np.array(corners)).max()), 1e-3)
