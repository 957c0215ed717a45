"""The areas of a page: a value of arcs, each between two areas, stored once."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import Any, Self

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.planar.path import UNIT_MM, Path, Points
from stippler.drawing.planar.policies import Run, checked_runs
from stippler.drawing.planar.rings import HalfEdge, Part, parts_of
from stippler.errors import GeometryError

PAGE, OUTSIDE = 0, -1
"""What no other area takes is the page's; beyond the page is nothing."""

Box = tuple[int, int, int, int]


@dataclass(frozen=True, slots=True)
class Arc:
    """A border between two areas, from node to node, or around.

    Attributes
    ----------
    left, right : int
        The areas beside it: going along x, left is towards greater y.
    policies : tuple of (first vertex, last vertex, policy)
        Runs that are to dots something else than the areas beside them say; see `policies`.
    box, start, end
        Its box and its nodes, in units of the grid.
    """

    path: Path
    left: int
    right: int
    policies: tuple[Run, ...] = ()
    box: Box = field(init=False, compare=False, repr=False)
    start: tuple[int, int] = field(init=False, compare=False, repr=False)
    end: tuple[int, int] = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        at = self.path.vertices
        object.__setattr__(self, "box", self.path.box())
        object.__setattr__(self, "start", tuple(at[0].tolist()))
        object.__setattr__(self, "end", tuple(at[-1].tolist()))

    def to_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        data = {"path": self.path.to_json(), "left": self.left, "right": self.right}
        return data | ({"policies": [list(run) for run in self.policies]} if self.policies else {})

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make it of plain values."""
        path = Path.from_json(data["path"])
        runs = checked_runs(data.get("policies", ()), len(path))
        return cls(path, int(data["left"]), int(data["right"]), runs)


class PlanarMap:
    """All arcs of a page; a value: edits return another one that shares what they leave alone.

    Parameters
    ----------
    arcs : mapping of int to Arc
    next_arc, next_area : int
        The first ids that were never used.

    Notes
    -----
    Faces between arcs belong to the area beside the arcs. Every place of the page lies in exactly
    one face, so areas cannot overlap and leave no gap; `PAGE` owns what nobody else does.
    """

    def __init__(self, arcs: Mapping[int, Arc], next_arc: int, next_area: int) -> None:
        self.arcs: Mapping[int, Arc] = arcs
        self.next_arc, self.next_area = next_arc, next_area
        self._parts: dict[int, list[Part]] = {}

    @classmethod
    def of_page(cls, width_mm: float, height_mm: float) -> Self:
        """Make the map of a page without areas."""
        corners = [(0, 0), (width_mm, 0), (width_mm, height_mm), (0, height_mm)]
        border = Path.polyline(corners, closed=True)
        if len(border) != 5:
            raise GeometryError(f"{width_mm:g} x {height_mm:g} mm is no page", "page")
        return cls({0: Arc(border, PAGE, OUTSIDE)}, 1, 1)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, PlanarMap):
            return NotImplemented
        numbers = (self.next_arc, self.next_area) == (other.next_arc, other.next_area)
        return numbers and self.arcs == other.arcs

    __hash__ = None  # type: ignore[assignment]

    @property
    def areas(self) -> list[int]:
        """The ids of all areas that have a place, the page's among them, in order."""
        found = {a.left for a in self.arcs.values()} | {a.right for a in self.arcs.values()}
        return sorted(found - {OUTSIDE})

    def parts(self, area: int) -> list[Part]:
        """Return the polygons an area consists of, with the half-edges of their rings."""
        if area not in self._parts:
            self._parts[area] = parts_of(area, self.arcs)
        return self._parts[area]

    def outline(self, area: int) -> Polygon | MultiPolygon:
        """Return an area's outline in mm; empty if it has no place."""
        polygons = [part.polygon for part in self.parts(area)]
        return polygons[0] if len(polygons) == 1 else MultiPolygon(polygons)

    def arcs_of(self, area: int) -> list[int]:
        """Return the ids of the arcs along an area."""
        return [k for k, a in self.arcs.items() if area in (a.left, a.right)]

    def neighbours(self, area: int) -> list[int]:
        """Return the areas that share a border with an area."""
        found = {x for k in self.arcs_of(area) for x in (self.arcs[k].left, self.arcs[k].right)}
        return sorted(found - {area, OUTSIDE})

    def inherit(self, before: PlanarMap, touched: Iterable[int]) -> Self:
        """Take over the polygons of areas that an edit left alone."""
        gone = set(touched)
        self._parts = {k: v for k, v in before._parts.items() if k not in gone}
        return self

    def changes(self, before: PlanarMap) -> dict[int, tuple[Arc | None, Arc | None]]:
        """Return what differs from a map before: arc -> (before, after), None where absent."""
        mine, theirs = self.arcs, before.arcs
        out: dict[int, tuple[Arc | None, Arc | None]] = {
            k: (theirs.get(k), a) for k, a in mine.items() if theirs.get(k) is not a
        }
        out.update({k: (a, None) for k, a in theirs.items() if k not in mine})
        return out

    @cached_property
    def _index(self) -> AreaIndex:
        return AreaIndex(Segments.of(list(self.arcs.values())), OUTSIDE)

    @cached_property
    def groups(self) -> dict[int, int]:
        """For each arc one that stands for all that hang together with it."""
        parent: dict[int, int] = {}
        at: dict[tuple[int, int], int] = {}
        for k, a in self.arcs.items():
            parent[k] = k
            for node in (a.start, a.end):
                i, j = _root(parent, k), _root(parent, at.setdefault(node, k))
                parent[max(i, j)] = min(i, j)
        return {k: _root(parent, k) for k in parent}

    def area_at(self, points_mm: ArrayLike) -> NDArray[np.int64]:
        """Return the area each point lies in, `OUTSIDE` off the page; exact, one area a point."""
        return self._index.area_at(np.asarray(points_mm, np.float64).reshape(-1, 2))

    @cached_property
    def segments(self) -> Segments:
        """All segments with the areas beside them."""
        return self._index.segments

    def with_arcs(self, changed: Mapping[int, Arc | None], next_area: int | None = None) -> Self:
        """Return a map in which arcs are replaced, or gone where None."""
        arcs = dict(self.arcs)
        touched: set[int] = set()
        for k, arc in changed.items():
            for one in (arcs.get(k), arc):
                if one is not None:
                    touched |= {one.left, one.right}
            if arc is None:
                arcs.pop(k, None)
            else:
                arcs[k] = arc
        highest = max((k for k in changed), default=-1) + 1
        after = type(self)(
            arcs, max(self.next_arc, highest), self.next_area if next_area is None else next_area
        )
        return after.inherit(self, touched)

    def to_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        return {
            "unit_mm": UNIT_MM,
            "next_arc": self.next_arc,
            "next_area": self.next_area,
            "arcs": {str(k): arc.to_json() for k, arc in self.arcs.items()},
        }

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """Make it of plain values; refuse areas that overlap or leave gaps."""
        if data.get("unit_mm") != UNIT_MM:
            raise GeometryError("are on another grid", "areas", "open it with a newer version")
        try:
            arcs = {int(k): Arc.from_json(a) for k, a in data["arcs"].items()}
            made = cls(arcs, int(data["next_arc"]), int(data["next_area"]))
        except (KeyError, TypeError, ValueError, AttributeError) as error:
            raise GeometryError("cannot be read", "areas", "the file is damaged") from error
        if any(k >= made.next_arc for k in arcs) or any(k >= made.next_area for k in made.areas):
            raise GeometryError("have numbers not yet given", "areas", "the file is damaged")
        made.check()
        return made

    def check(self) -> None:
        """Raise GeometryError unless areas cover the page without gap or overlap.

        By shapely's judgement, independent of what edits check for themselves. Where areas touch
        themselves in the same node, `coverage_is_valid` (GEOS 3.13) may find fault with borders
        that match; there the interiors are compared pair by pair. It finds no gaps: sizes do.
        """
        outlines = np.array([self.outline(k) for k in self.areas])
        if not shapely.is_valid(outlines).all():
            raise GeometryError("cross themselves", "areas")
        page = shapely.box(*shapely.total_bounds(outlines))
        if abs(shapely.area(outlines).sum() - page.area) > 1e-9 * page.area:
            raise GeometryError("overlap or leave gaps", "areas")
        if shapely.coverage_is_valid(outlines):
            return
        odd = outlines[~shapely.is_empty(shapely.coverage_invalid_edges(outlines))]
        first, second = shapely.STRtree(outlines).query(odd, predicate="intersects")
        apart = shapely.relate_pattern(odd[first], outlines[second], "F********")
        apart |= odd[first] == outlines[second]
        if not apart.all():
            raise GeometryError("overlap or leave gaps", "areas")


@dataclass(frozen=True, slots=True, eq=False)
class Segments:
    """Segments of many arcs as flat arrays.

    Attributes
    ----------
    xy : (m, 4) int64
    left, right : (m,) int64
    """

    xy: NDArray[np.int64]
    left: NDArray[np.int64]
    right: NDArray[np.int64]

    @classmethod
    def of(cls, arcs: list[Arc]) -> Self:
        """Put the segments of arcs one after the other."""
        if not arcs:
            none = np.empty(0, np.int64)
            return cls(np.empty((0, 4), np.int64), none, none)
        counts = [len(a.path) - 1 for a in arcs]
        xy = np.concatenate([np.hstack([a.path.vertices[:-1], a.path.vertices[1:]]) for a in arcs])
        left = np.repeat(np.array([a.left for a in arcs], np.int64), counts)
        right = np.repeat(np.array([a.right for a in arcs], np.int64), counts)
        return cls(xy, left, right)


class AreaIndex:
    """Segments in horizontal bands, to find the area of points by; `outside` lies beyond all."""

    def __init__(self, segments: Segments, outside: int) -> None:
        from stippler.kernels.planar.locate import fill_bands

        self.segments, self._outside = segments, outside
        s = self.segments.xy
        ends = s[:, 1::2]
        self._low = int(ends.min(initial=0))
        n = max(1, min(4096, len(s)))
        self._height = max(1, -(-(int(ends.max(initial=1)) - self._low + 1) // n))
        start = np.zeros(n + 1, np.int64)
        fill_bands(s, self._low, self._height, start, start, True)
        start = np.cumsum(start)
        self._listed = np.empty(start[-1], np.int64)
        self._start = start
        fill_bands(s, self._low, self._height, start.copy(), self._listed, False)

    def area_at(self, points_mm: Points) -> NDArray[np.int64]:
        """Return the area of each point."""
        from stippler.kernels.machine.pool import parallel_for
        from stippler.kernels.planar.locate import UNSURE, find_areas_in

        s = self.segments
        points = np.ascontiguousarray(points_mm / UNIT_MM)
        found = np.empty(len(points), np.int64)
        parallel_for(
            find_areas_in, len(points), points, s.xy, s.left, s.right, self._low, self._height,
            self._start, self._listed, self._outside, found, grain=4096,
        )  # fmt: skip
        for k in np.flatnonzero(found == UNSURE):
            found[k] = self._exactly(points[k])
        return found

    def _exactly(self, point: Points) -> int:
        """Decide in fractions; a point on a border belongs to what lies right of it, or below."""
        x, y = Fraction(float(point[0])), Fraction(float(point[1]))
        s = self.segments
        lows, highs = np.minimum(s.xy[:, 1], s.xy[:, 3]), np.maximum(s.xy[:, 1], s.xy[:, 3])
        total = self._outside
        for i in np.flatnonzero((lows <= point[1]) & (highs > point[1])).tolist():
            x0, y0, x1, y1 = map(int, s.xy[i])
            c = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
            if c == 0 or (c > 0) != (y1 > y0):
                continue
            jump = int(s.left[i] - s.right[i])
            total += jump if y1 > y0 else -jump
        return total


def _root(parent: dict[int, int], k: int) -> int:
    while parent[k] != k:
        parent[k] = k = parent[parent[k]]
    return k


__all__ = ["OUTSIDE", "PAGE", "Arc", "AreaIndex", "HalfEdge", "PlanarMap", "Segments"]
