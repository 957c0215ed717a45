"""Radii that go by the reference's tone."""

from __future__ import annotations

import numpy as np

from stippler.drawing.reference import Reference
from stippler.drawing.shape_change import MAX_RADIUS_MM, MIN_RADIUS_MM, Floats


def pulled(radius_mm: Floats, weight: Floats, target_mm: Floats, share: float) -> Floats:
    """Bring radii a share of the way to a target; with a weight and share of 1, to it exactly."""
    way = np.minimum(weight * share, 1.0)
    return np.where(way >= 1.0, target_mm, radius_mm + way * (target_mm - radius_mm))


def tone_radius(position_mm: Floats, cell_mm2: Floats, reference: Reference) -> Floats:
    """Return the radii whose dots cover as much of their cells as the reference is dark."""
    share = reference.at(position_mm)
    return np.clip(np.sqrt(share * cell_mm2 / np.pi), MIN_RADIUS_MM, MAX_RADIUS_MM)
