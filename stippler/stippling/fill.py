"""Dots for an area where there is no picture; importing it costs nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass

from stippler.drawing.page import MAX_PAGE_MM
from stippler.errors import ParameterError
from stippler.stippling.plan import ARRANGEMENTS, MAX_DOTS


@dataclass(frozen=True, slots=True)
class Filling:
    """How an area is filled.

    Attributes
    ----------
    n_dots : int
        A hexagonal grid has about so many.
    arrangement : {"hexagonal", "random"}
    radius_mm : float
    seed : int
        Chooses where random dots lie.
    """

    n_dots: int = 2_000
    arrangement: str = ARRANGEMENTS[0]
    radius_mm: float = 0.3
    seed: int = 1

    def __post_init__(self) -> None:
        if not 1 <= self.n_dots <= MAX_DOTS:
            raise ParameterError(
                f"{self.n_dots} dots cannot be drawn", "fill", f"give 1 to {MAX_DOTS:,}"
            )
        if not (math.isfinite(self.radius_mm) and 0 < self.radius_mm <= MAX_PAGE_MM):
            raise ParameterError(
                f"{self.radius_mm:g} mm is no radius",
                "fill",
                f"give more than 0 and at most {MAX_PAGE_MM:,g}",
            )
        if not 0 <= self.seed < 2**63:
            raise ParameterError(f"{self.seed} is no seed", "fill", "give 0 or more")
