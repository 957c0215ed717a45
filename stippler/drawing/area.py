"""Areas: polygons with holes that own dots and have one style."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.planar.path import REACH_MM
from stippler.drawing.style import AS_STYLE, BORDERS
from stippler.errors import GeometryError, ParameterError

PAGE_AREA = 0
"""Id of the area that a new drawing has: the page."""

_COLOUR = re.compile("#[0-9a-f]{6}")


@dataclass(frozen=True, slots=True)
class Area:
    """A part of the page with one style; its id is its dots' `area`.

    Attributes
    ----------
    outline_mm : shapely Polygon or MultiPolygon
        On the page, in mm; holes allowed. Where areas overlap, the one of the higher id owns what
        both have.
    style : int
        Id of its style.
    colour : str
        In the list of areas, as ``#rrggbb``.
    locked : bool
        Neither brushes nor work change its dots, and its outline stays.
    hidden : bool
        Its dots are neither drawn nor exported.
    rank : int
        Its place in the list: the largest is at the top; of equal ones the newest.
    border : str
        What its border is to its dots, as `BORDERS` has it; `AS_STYLE` leaves that to its style.
    """

    name: str
    outline_mm: Polygon | MultiPolygon
    style: int = 0
    colour: str = "#808080"
    locked: bool = False
    hidden: bool = False
    rank: int = 0
    border: str = AS_STYLE

    def __post_init__(self) -> None:
        checked_colour(self.colour, "area")
        if self.border not in (AS_STYLE, *BORDERS):
            raise ParameterError(
                f"{self.border!r} is unknown", "border of an area", f"of {', '.join(BORDERS)}"
            )

    def to_json(self) -> dict[str, Any]:
        """Return it in JSON's types."""
        data = {name: getattr(self, name) for name in self.__slots__}
        return data | {"outline_mm": shapely.to_wkt(self.outline_mm, rounding_precision=-1)}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make an area of what `to_json` gave."""
        try:
            with np.errstate(invalid="ignore"):  # of NaN, which is refused below
                outline = shapely.from_wkt(data["outline_mm"])
        except shapely.errors.GEOSException as error:
            raise GeometryError(str(error), "outline of an area") from None
        if not isinstance(outline, Polygon | MultiPolygon):
            raise GeometryError("is no polygon", "outline of an area")
        if not (np.abs(shapely.get_coordinates(outline)) <= REACH_MM).all():
            raise GeometryError("is far off the page", "outline of an area")
        return cls(**{**data, "outline_mm": outline})


def checked_colour(colour: str, of: str) -> None:
    """Refuse what is no colour of a list."""
    if not _COLOUR.fullmatch(colour):
        raise ParameterError(f"{colour!r} is no colour", of, "give #rrggbb")
