"""Dots for an area where there is no picture; importing it costs nothing."""

from __future__ import annotations

from dataclasses import dataclass

from stippler.drawing.page import MAX_PAGE_MM
from stippler.drawing.parameter import Choice, Kind, parameter, parameters_of
from stippler.drawing.style import MAX_DOTS

_LAYOUTS = (
    Choice("hexagonal", "In rows", "Rows of dots at equal distances."),
    Choice("random", "By chance", "Anywhere; relax them to even them out."),
)


@dataclass(frozen=True, slots=True)
class Filling:
    """How an area is filled; its fields are those of `PARAMETERS`."""

    n_dots: int = parameter(
        Kind.WHOLE, 2_000, "Fill with", "How many dots; a grid has about so many.",
        low=1, high=MAX_DOTS, keyword="dots",
    )  # fmt: skip
    arrangement: str = parameter(
        Kind.CHOICE, "hexagonal", "Layout", "How the dots lie.", choices=_LAYOUTS,
    )  # fmt: skip
    radius_mm: float = parameter(
        Kind.NUMBER, 0.3, "Dot radius", "Radius of the dots in mm.",
        low=1e-6, high=MAX_PAGE_MM, unit="mm", keyword="radius",
    )  # fmt: skip
    seed: int = parameter(
        Kind.WHOLE, 1, "Fill seed", "Chooses where dots by chance lie.",
        low=0, high=2**63 - 1, only=("arrangement", ("random",)),
    )  # fmt: skip

    def __post_init__(self) -> None:
        for about in PARAMETERS:
            object.__setattr__(self, about.name, about.checked(getattr(self, about.name)))


PARAMETERS = parameters_of(Filling)
ARRANGEMENTS = next(one for one in PARAMETERS if one.name == "arrangement").values
"""How an area is filled where there is no picture."""
