"""Lines: drawn in ink or guides only, and how dots meet them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.area import checked_colour
from stippler.drawing.deformation import Deformation
from stippler.drawing.planar.path import Path, path_of_cubics, pieces_of
from stippler.errors import GeometryError, ParameterError

Points = NDArray[np.float64]

IGNORE, DISTANCE, ADHERE = "ignore", "distance", "adhere"
MEETINGS = (IGNORE, DISTANCE, ADHERE)
"""How dots meet a line: not at all; they keep a distance from its edge; they line up on it."""

MOST_WIDTH_MM = 100.0
MOST_VERTICES = 1_000_000


@dataclass(frozen=True, slots=True)
class Line:
    """A line or curve; closed if its path is.

    Attributes
    ----------
    name : str
    path : Path
        Nodes and handles, as borders of areas have them.
    width_mm : (start, end)
        Of the ink; tapered if they differ.
    printed : bool
        False: a guide that only dots see.
    meeting : {"ignore", "distance", "adhere"}
    distance_mm : float
        What dots keep from its edge.
    reach_mm : float
        From how far dots line up on it.
    colour : str
        In the list and of its nodes, as ``#rrggbb``; ink is ink.
    locked, hidden : bool
        A locked line is not changed by hand; a hidden one is neither seen nor written.
    """

    name: str
    path: Path
    width_mm: tuple[float, float] = (0.2, 0.2)
    printed: bool = True
    meeting: str = IGNORE
    distance_mm: float = 0.3
    reach_mm: float = 1.0
    colour: str = "#2f6f78"
    locked: bool = False
    hidden: bool = False

    def __post_init__(self) -> None:
        if len(self.path) < 2 or self.length_mm <= 0.0:
            raise GeometryError("has no length", f"line {self.name}", "draw two points or more")
        if len(self.path) > MOST_VERTICES:
            raise GeometryError(f"has more than {MOST_VERTICES:,} points", f"line {self.name}")
        values = (*self.width_mm, self.distance_mm, self.reach_mm)
        if not all(math.isfinite(v) and 0.0 <= v <= MOST_WIDTH_MM for v in values):
            raise ParameterError(
                "width, distance and reach have to be 0 to 100 mm", f"line {self.name}"
            )
        if self.meeting not in MEETINGS:
            raise ParameterError(
                f"{self.meeting!r} is unknown", "line", f"of {', '.join(MEETINGS)}"
            )
        checked_colour(self.colour, "line")

    @property
    def is_inked(self) -> bool:
        """Whether it is drawn in ink."""
        return self.printed and not self.hidden and max(self.width_mm) > 0.0

    @property
    def is_closed(self) -> bool:
        """Whether it ends where it begins."""
        return self.path.is_closed

    @property
    def length_mm(self) -> float:
        """Arc length."""
        return float(self.arc_lengths()[-1])

    def arc_lengths(self) -> Points:
        """Return the arc length at each vertex."""
        steps = np.hypot(*np.diff(self.path.points_mm, axis=0).T)
        return np.asarray(np.r_[0.0, np.cumsum(steps)])

    def at(self, s_mm: Points) -> Points:
        """Return the places at arc lengths; beyond the ends, the ends; closed lines go around."""
        lengths, points = self.arc_lengths(), self.path.points_mm
        s = np.asarray(s_mm, np.float64)
        if self.is_closed:
            s = s % lengths[-1]
        return np.column_stack([np.interp(s, lengths, points[:, k]) for k in (0, 1)])

    def directions(self, s_mm: Points) -> Points:
        """Return unit vectors along the line at arc lengths."""
        lengths = self.arc_lengths()
        s = np.asarray(s_mm, np.float64)
        s = s % lengths[-1] if self.is_closed else s
        k = np.clip(np.searchsorted(lengths, s, side="right") - 1, 0, len(lengths) - 2)
        d = np.diff(self.path.points_mm, axis=0)[k]
        return np.asarray(d / np.hypot(*d.T)[:, None])

    def half_widths(self) -> Points:
        """Return half the ink's width at each vertex."""
        lengths = self.arc_lengths()
        return np.interp(lengths, (0.0, lengths[-1]), self.width_mm) / 2

    def segments(self) -> Points:
        """Return (n, 8): ends, half widths and arc lengths of each segment; see `nearest`."""
        at, w, s = self.path.points_mm, self.half_widths(), self.arc_lengths()
        return np.column_stack([at[:-1], at[1:], w[:-1], w[1:], s[:-1], s[1:]])

    def outline(self) -> Polygon | MultiPolygon:
        """Return the ink: all discs of half the width along the line."""
        if self.width_mm[0] == self.width_mm[1]:
            return shapely.buffer(
                shapely.linestrings(self.path.points_mm), self.width_mm[0] / 2, quad_segs=16
            )
        discs = shapely.buffer(
            shapely.points(self.path.points_mm), self.half_widths(), quad_segs=16
        )
        pairs = [shapely.union(a, b) for a, b in itertools.pairwise(discs)]
        return shapely.union_all(shapely.convex_hull(np.array(pairs)))

    def edges(self) -> tuple[Line, ...]:
        """Return the lines along its edges: two, or the rings of a closed one."""
        half = max(self.width_mm) / 2
        if half <= 0.0:
            return (self,)
        if self.is_closed:
            return tuple(
                replace(
                    self, path=Path.polyline(shapely.get_coordinates(ring)), width_mm=(0.0, 0.0)
                )
                for ring in _rings(self.outline())
            )
        s = self.arc_lengths()
        d = self.directions(s)
        normal = np.column_stack([-d[:, 1], d[:, 0]]) * self.half_widths()[:, None]
        sides = (self.path.points_mm + normal, self.path.points_mm - normal)
        return tuple(replace(self, path=Path.polyline(p), width_mm=(0.0, 0.0)) for p in sides)

    def deformed(self, by: Deformation) -> Line:
        """Return the line bent; curves are bent by their handles."""
        moved = [by.apply(piece) for piece in pieces_of(self.path)]
        return replace(self, path=path_of_cubics(moved))

    def to_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        return {
            "name": self.name, "path": self.path.to_json(), "width_mm": list(self.width_mm),
            "printed": self.printed, "meeting": self.meeting, "distance_mm": self.distance_mm,
            "reach_mm": self.reach_mm, "colour": self.colour, "locked": self.locked,
            "hidden": self.hidden,
        }  # fmt: skip

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make it of plain values."""
        start, end = map(float, data["width_mm"])
        return cls(**{**data, "path": Path.from_json(data["path"]), "width_mm": (start, end)})


def _rings(shape: Polygon | MultiPolygon) -> list[Any]:
    polygons = list(shape.geoms) if isinstance(shape, MultiPolygon) else [shape]
    return [ring for p in polygons for ring in (p.exterior, *p.interiors)]
