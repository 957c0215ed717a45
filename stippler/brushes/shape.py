"""Dots deformed and made round again."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.brushes.size import sample
from stippler.drawing.dots import MAX_ELONGATION
from stippler.drawing.reference import Reference

Floats = NDArray[np.float64]


def elongated(
    elongation: Floats, angle_rad: Floats, weight: Floats, amount: float, direction_rad: Floats
) -> tuple[Floats, Floats]:
    """Stretch dots along a direction (or, below 0, take stretch away in any); return both fields.

    A dot that is stretched another way already turns towards the direction as it takes on more:
    its stretch is a vector at twice its angle, and vectors are added.
    """
    if amount < 0.0:
        return np.maximum(elongation + amount * weight, 1.0), angle_rad
    u = (elongation - 1.0) * np.cos(2.0 * angle_rad) + amount * weight * np.cos(2.0 * direction_rad)
    v = (elongation - 1.0) * np.sin(2.0 * angle_rad) + amount * weight * np.sin(2.0 * direction_rad)
    length = np.hypot(u, v)
    turned = np.where(length > 1e-9, 0.5 * np.arctan2(v, u), angle_rad)
    return np.minimum(1.0 + length, MAX_ELONGATION), turned


def roughened(roughness: Floats, weight: Floats, amount: float) -> Floats:
    """Make outlines rougher, or smoother below 0."""
    return np.clip(roughness + amount * weight, 0.0, 1.0)


def random_directions(seed: NDArray[np.uint32]) -> Floats:
    """Return each dot's own direction, the same at every stamp."""
    mixed = (seed.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)) >> np.uint64(40)
    return np.asarray(mixed.astype(np.float64) * (np.pi / 2.0**24))


def edge_directions(reference: Reference, position_mm: Floats, reach_mm: float) -> Floats:
    """Return the direction along the reference's edge at points: across its steepest slope."""
    reach = max(reach_mm, reference.pixel_mm)
    slope = [
        sample(reference, position_mm + step) - sample(reference, position_mm - step)
        for step in (np.array([reach, 0.0]), np.array([0.0, reach]))
    ]
    return np.arctan2(slope[1], slope[0]) + np.pi / 2.0
