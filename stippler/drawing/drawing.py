"""The whole document."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Self

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import box

from stippler.drawing.area import Area
from stippler.drawing.dots import Dots
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import ParameterError

MAX_PAGE_MM = 10_000.0


@dataclass(frozen=True, slots=True)
class Page:
    """The paper: origin top left, x right, y down."""

    width_mm: float
    height_mm: float

    def __post_init__(self) -> None:
        for name, value in (("width", self.width_mm), ("height", self.height_mm)):
            if not (math.isfinite(value) and 0 < value <= MAX_PAGE_MM):
                raise ParameterError(
                    f"a {name} of {value:g} mm is no paper",
                    "page",
                    f"give more than 0 and at most {MAX_PAGE_MM:g} mm",
                )


@dataclass(slots=True, eq=False)
class Drawing:
    """Page, areas, dots and reference.

    Attributes
    ----------
    areas : list of Area
        The page itself is the first.
    reference : Reference or None
        What tone is taken from.
    """

    page: Page
    areas: list[Area]
    dots: Dots = field(default_factory=Dots.none)
    reference: Reference | None = None

    @classmethod
    def blank(cls, page: Page, style: Style | None = None) -> Self:
        """Make an empty drawing whose one area is the page."""
        outline = box(0.0, 0.0, page.width_mm, page.height_mm)
        return cls(page, [Area("page", outline, style or Style())])

    @classmethod
    def from_reference(
        cls,
        reference: Reference,
        position_mm: NDArray[np.float64],
        radius_mm: NDArray[np.float32],
        style: Style | None = None,
    ) -> Self:
        """Make a drawing on a page of the reference's size; the style's pen gives dots shapes."""
        drawing = cls.blank(Page(reference.width_mm, reference.height_mm), style)
        drawing.dots = drawing.areas[0].style.pen.drawn(Dots.round(position_mm, radius_mm))
        drawing.reference = reference
        return drawing

    @property
    def next_id(self) -> int:
        """The first id no dot has used."""
        return int(self.dots.id.max()) + 1 if len(self.dots) else 0
