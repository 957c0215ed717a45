"""Small random offsets."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def jitter(
    position_mm: NDArray[np.float64],
    weight: NDArray[np.float64],
    scale_mm: NDArray[np.float64] | float,
    rng: np.random.Generator,
) -> NDArray[np.float64]:
    """Move dots by random offsets, evenly over a disc of radius `scale_mm` times the weight.

    `scale_mm` is a share of the mean dot distance (Deussen et al. 2000, section 4.1), or of the
    root of each dot's cell area, so that dense regions move less (section 5.1).
    """
    n = len(position_mm)
    distance = np.sqrt(rng.random(n)) * weight * scale_mm
    angle = np.pi * 2.0 * rng.random(n)
    offset = np.column_stack([np.cos(angle), np.sin(angle)]) * distance[:, None]
    return np.asarray(position_mm + offset)
