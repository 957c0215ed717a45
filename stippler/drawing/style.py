"""How an area's dots look and are spaced."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stippler.drawing.pens import PENS, Pen
from stippler.errors import ParameterError


@dataclass(frozen=True, slots=True)
class Style:
    """The look of one area.

    Attributes
    ----------
    radius_min_mm, radius_max_mm : float
        Range of dot radii; artists use 1:2 (Deussen et al. 2000, section 3).
    pen : Pen
        Gives dots their shapes.
    """

    radius_min_mm: float = 0.15
    radius_max_mm: float = 0.30
    pen: Pen = PENS[0]

    def __post_init__(self) -> None:
        low, high = self.radius_min_mm, self.radius_max_mm
        if not (math.isfinite(low) and math.isfinite(high) and 0 < low <= high):
            raise ParameterError(
                f"{low:g}:{high:g} is no range of radii",
                "size range",
                "give MIN:MAX in mm with 0 < MIN <= MAX",
            )
