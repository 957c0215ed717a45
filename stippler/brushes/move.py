"""Dots dragged, pushed and combed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def push(position_mm: Floats, weight: Floats, step_mm: tuple[float, float]) -> Floats:
    """Take dots along with the stroke."""
    return np.asarray(position_mm + weight[:, None] * np.array(step_mm))


def comb(
    position_mm: Floats,
    weight: Floats,
    at_mm: tuple[float, float],
    direction_rad: float,
    teeth_mm: float,
    share: float,
) -> Floats:
    """Draw dots sideways onto the lines that the comb's teeth leave along the stroke."""
    across = np.array([-math.sin(direction_rad), math.cos(direction_rad)])
    offset = (position_mm - at_mm) @ across
    wanted = np.round(offset / teeth_mm) * teeth_mm
    return np.asarray(position_mm + (weight * share * (wanted - offset))[:, None] * across)
