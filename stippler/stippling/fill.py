"""Dots for an area where there is no picture; importing it costs nothing."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from stippler.drawing.drawing import MAX_PAGE_MM
from stippler.errors import ParameterError
from stippler.stippling.plan import ARRANGEMENTS, MAX_DOTS

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing


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


def fill_drawing(drawing: Drawing, document: Document, filling: Filling, area: int = 0) -> int:
    """Fill an area of a drawing, as one edit; return how many dots were added."""
    from stippler.drawing.dots import Dots
    from stippler.stippling.initial_points import fill_area

    outline = drawing.areas[area].outline_mm
    points = fill_area(outline, filling.n_dots, filling.arrangement, filling.seed)
    document.begin("Fill")
    document.insert(Dots.round(points, filling.radius_mm, area=area))
    document.commit()
    return len(points)
