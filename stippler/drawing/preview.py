"""A change of shape shown before it is made: which dots it is for."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from stippler.drawing.shape_change import ShapeChange

Outline = Literal["round", "square", "polygon"]
Where = Literal["all", "selected"]
MOST_CORNERS = 32


@dataclass(frozen=True, slots=True)
class Footprint:
    """A brush's tip on the page, as numbers that a shader can take.

    Attributes
    ----------
    center_mm : (x, y)
    to_unit : (a, b, c, d)
        An offset (x, y) in mm from the centre is (a x + b y, c x + d y) in the tip's own
        coordinates, in which a round tip has a radius of 1 and a square one half sides of 1.
    reach_mm : float
        No dot whose centre lies further away is changed.
    outline : {"round", "square", "polygon"}
    hardness : float
        Share of the way to the outline with full effect.
    strength : float
        The full effect, 0 to 1.
    corners : tuple of (x, y)
        Of a polygon, at most `MOST_CORNERS`, in the tip's own coordinates.
    depth : float
        Distance of a polygon's middle from its sides.
    """

    center_mm: tuple[float, float]
    to_unit: tuple[float, float, float, float]
    reach_mm: float
    outline: Outline = "round"
    hardness: float = 1.0
    strength: float = 1.0
    corners: tuple[tuple[float, float], ...] = ()
    depth: float = 1.0


@dataclass(frozen=True, slots=True)
class Preview:
    """A change and the dots it is for: all, the selected ones, or those under a brush's tip."""

    change: ShapeChange
    where: Where | Footprint = "all"

    @property
    def footprint(self) -> Footprint | None:
        """The tip, if it is for the dots under one."""
        return self.where if isinstance(self.where, Footprint) else None
