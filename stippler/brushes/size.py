"""Dots made larger and smaller."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.reference import Reference

Floats = NDArray[np.float64]

SMALLEST_MM, LARGEST_MM = 0.005, 50.0


def scaled(radius_mm: Floats, weight: Floats, percent: float) -> Floats:
    """Enlarge (or, below 0, reduce) radii by a percentage, less where the weight is less.

    Growing and shrinking by the same percentage take each other back.
    """
    exponent = np.sign(percent) * weight
    return _held(radius_mm * (1.0 + abs(percent) / 100.0) ** exponent)


def pulled(radius_mm: Floats, weight: Floats, target_mm: Floats | float, share: float) -> Floats:
    """Bring radii a share of the way to a target; with a weight and share of 1, to it exactly."""
    way = np.minimum(weight * share, 1.0)
    return _held(np.where(way >= 1.0, target_mm, radius_mm + way * (target_mm - radius_mm)))


def tone_radius(
    position_mm: Floats, cell_mm2: Floats, reference: Reference, limits_mm: tuple[float, float]
) -> Floats:
    """Return the radii whose dots cover as much of their cells as the reference is dark."""
    share = sample(reference, position_mm)
    return np.clip(np.sqrt(share * cell_mm2 / np.pi), *limits_mm)


def sample(reference: Reference, position_mm: Floats) -> Floats:
    """Return the reference's darkness at points, between pixels by interpolation."""
    field = reference.darkness
    h, w = field.shape
    x = np.clip(position_mm[:, 0] / reference.pixel_mm - 0.5, 0.0, w - 1.0)
    y = np.clip(position_mm[:, 1] / reference.pixel_mm - 0.5, 0.0, h - 1.0)
    i, j = (
        np.minimum(x.astype(np.intp), max(w - 2, 0)),
        np.minimum(y.astype(np.intp), max(h - 2, 0)),
    )
    u, v = x - i, y - j
    i1, j1 = np.minimum(i + 1, w - 1), np.minimum(j + 1, h - 1)
    upper = field[j, i] * (1.0 - u) + field[j, i1] * u
    lower = field[j1, i] * (1.0 - u) + field[j1, i1] * u
    return np.asarray(upper * (1.0 - v) + lower * v, np.float64)


def _held(radius_mm: Floats) -> Floats:
    return np.clip(radius_mm, SMALLEST_MM, LARGEST_MM)
