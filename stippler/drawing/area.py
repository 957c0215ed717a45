"""Areas: polygons with holes that own dots and have one style."""

from __future__ import annotations

from dataclasses import dataclass, field

from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.style import Style


@dataclass(frozen=True, slots=True)
class Area:
    """A part of the page with one style; its index in the drawing is its dots' `area`.

    Attributes
    ----------
    outline_mm : shapely Polygon or MultiPolygon
        On the page, in mm; holes allowed.
    """

    name: str
    outline_mm: Polygon | MultiPolygon
    style: Style = field(default_factory=Style)
