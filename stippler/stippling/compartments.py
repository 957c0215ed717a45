"""The polygons that bound the movement of dots, as flat arrays for the kernels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.validation import floats
from stippler.errors import GeometryError, ParameterError

if TYPE_CHECKING:
    from stippler.stippling.border_edges import BorderEdges

Shape: TypeAlias = Polygon | MultiPolygon | NDArray[np.float64]

RECTANGLE, POLYGON = 0, 1

_LEAST, _MOST = 1e-60, 1e60
"""Sides and coordinates between which squares of areas are numbers."""


@dataclass(frozen=True, slots=True, eq=False)
class Compartments:
    """Compartments with their borders as directed edges, inside on the left (y up).

    Attributes
    ----------
    polygons : list of shapely Polygon
    shape_of : (c,) int32
        Which of the shapes given a compartment is part of.
    box : (c, 4) float64
        xmin, ymin, xmax, ymax.
    area : (c,) float64
    kind : (c,) int32
        `RECTANGLE`, whose box is its border, or `POLYGON`.
    edges : (e, 4) float64
        Straight runs are one edge each; those of a rectangle are the sides of least y, most x,
        most y and least x.
    next_edge, compartment_of_edge : (e,) int32
    first_edge : (c + 1,) int32
        Where the edges of each compartment begin.
    is_convex : (c,) bool
    """

    polygons: list[Polygon]
    shape_of: NDArray[np.int32]
    box: NDArray[np.float64]
    area: NDArray[np.float64]
    kind: NDArray[np.int32]
    edges: NDArray[np.float64]
    next_edge: NDArray[np.int32]
    compartment_of_edge: NDArray[np.int32]
    first_edge: NDArray[np.int32]
    is_convex: NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.polygons)

    @classmethod
    def of(cls, shapes: Shape | ArrayLike | Sequence[Shape]) -> Compartments:
        """Take apart one shape or a list of shapes; each polygon is one compartment.

        Raises
        ------
        GeometryError
            If a shape is empty, invalid or not finite; it names the compartment.
        """
        from stippler.stippling.border_edges import BorderEdges

        polygons: list[Polygon] = []
        shape_of: list[int] = []
        for i, shape in enumerate(_as_list(shapes)):
            parts = _polygons_of(shape, f"compartment {i}")
            polygons += parts
            shape_of += [i] * len(parts)
        if not polygons:
            raise GeometryError("there is no compartment", "polygon", "give at least one polygon")
        if len(polygons) == 1 and (one := _as_box(polygons[0])) is not None:
            return cls._of_rectangle(polygons[0], one)
        border = BorderEdges.of(polygons)
        first = np.searchsorted(border.compartment, np.arange(len(polygons) + 1)).astype(np.int32)
        box = np.array(shapely.bounds(polygons)).reshape(-1, 4)
        kind = np.full(len(polygons), POLYGON, np.int32)
        rectangles = _rectangles(border, first)
        kind[rectangles] = RECTANGLE
        for side, ends in enumerate(((0, 1, 2, 1), (2, 1, 2, 3), (2, 3, 0, 3), (0, 3, 0, 1))):
            border.edge[first[rectangles] + side] = box[rectangles][:, ends]
        return cls(
            polygons=polygons,
            shape_of=np.array(shape_of, np.int32),
            box=box,
            area=np.array(shapely.area(polygons)).reshape(-1),
            kind=kind,
            edges=border.edge,
            next_edge=border.next_edge,
            compartment_of_edge=border.compartment,
            first_edge=first,
            is_convex=_are_convex(border, len(polygons)),
        )

    @classmethod
    def _of_rectangle(cls, polygon: Polygon, box: tuple[float, ...]) -> Compartments:
        """Make the one compartment of a rectangle: brushes ask for one with each stamp."""
        x0, y0, x1, y1 = box
        sides = [(x0, y0, x1, y0), (x1, y0, x1, y1), (x1, y1, x0, y1), (x0, y1, x0, y0)]
        return cls(
            polygons=[polygon],
            shape_of=np.zeros(1, np.int32),
            box=np.array([box]),
            area=np.array([(x1 - x0) * (y1 - y0)]),
            kind=np.full(1, RECTANGLE, np.int32),
            edges=np.array(sides),
            next_edge=np.array([1, 2, 3, 0], np.int32),
            compartment_of_edge=np.zeros(4, np.int32),
            first_edge=np.array([0, 4], np.int32),
            is_convex=np.ones(1, np.bool_),
        )

    def find(
        self, points: NDArray[np.float64], shape_of_dot: NDArray[np.int32] | None
    ) -> NDArray[np.int32]:
        """Return the compartment of each point; its border counts as inside.

        Raises
        ------
        GeometryError
            If a point lies outside all compartments, or outside the shape it is said to be in.
        ParameterError
            If there is no shape of that number.
        """
        if shape_of_dot is not None:
            self._check_numbers(shape_of_dot)
        found = self.at(points, shape_of_dot)
        outside = np.flatnonzero(found < 0)
        if len(outside):
            self._refuse(points, outside, shape_of_dot)
        return found

    def at(
        self, points: NDArray[np.float64], shape_of_dot: NDArray[np.int32] | None = None
    ) -> NDArray[np.int32]:
        """Return the compartment of each point, of its shape if that is given; -1 outside."""
        found = np.full(len(points), -1, np.int32)
        if len(self) == 1 and self.kind[0] == RECTANGLE:
            x0, y0, x1, y1 = self.box[0].tolist()
            x, y = points[:, 0], points[:, 1]
            if len(x) and x0 <= x.min() and x.max() <= x1 and y0 <= y.min() and y.max() <= y1:
                return np.zeros(len(points), np.int32)
            found[(x >= x0) & (x <= x1) & (y >= y0) & (y <= y1)] = 0
        elif len(self) == 1:
            shapely.prepare(self.polygons[0])
            found[shapely.intersects_xy(self.polygons[0], points[:, 0], points[:, 1])] = 0
        elif len(points):
            tree = shapely.STRtree(shapely.points(points))
            which, dot = tree.query(self.polygons, predicate="intersects")
            if shape_of_dot is not None:
                fits = self.shape_of[which] == shape_of_dot[dot]
                which, dot = which[fits], dot[fits]
            backwards = np.argsort(which, kind="stable")[::-1]  # the lowest is written last
            found[dot[backwards]] = which[backwards]
        return found

    def contain(
        self, points: NDArray[np.float64], compartment: NDArray[np.int32]
    ) -> NDArray[np.bool_]:
        """Tell which points lie in the compartment named for each, or on its border."""
        box = self.box[compartment]
        inside: NDArray[np.bool_] = np.logical_and.reduce(
            [*(points >= box[:, :2]).T, *(points <= box[:, 2:]).T]
        )
        asked = np.flatnonzero(inside & (self.kind[compartment] == POLYGON))
        for c in np.unique(compartment[asked]):
            mine = asked[compartment[asked] == c]
            shapely.prepare(self.polygons[c])
            inside[mine] = shapely.intersects_xy(self.polygons[c], *points[mine].T)
        return inside

    def _check_numbers(self, shape_of_dot: NDArray[np.int32]) -> None:
        last = int(self.shape_of[-1])
        bad = np.flatnonzero((shape_of_dot < 0) | (shape_of_dot > last))
        if len(bad):
            raise ParameterError(
                f"there is no compartment {shape_of_dot[bad[0]]}, named for dot {bad[0]}",
                "compartment_of_dot",
                f"give 0 to {last}",
            )

    def _refuse(
        self,
        points: NDArray[np.float64],
        outside: NDArray[np.intp],
        shape_of_dot: NDArray[np.int32] | None,
    ) -> None:
        i = int(outside[0])
        where = "every compartment"
        if shape_of_dot is not None:
            where = f"compartment {shape_of_dot[i]}"
        elif int(self.shape_of[-1]) == 0:
            where = "compartment 0"
        raise GeometryError(
            f"dot {i} at ({points[i, 0]:g}, {points[i, 1]:g}) lies outside"
            + (f", as do {len(outside) - 1} more" if len(outside) > 1 else ""),
            where,
            "move or drop the dots outside",
        )


def _as_list(shapes: object) -> Sequence[object]:
    if isinstance(shapes, Polygon | MultiPolygon | np.ndarray):
        return [shapes]
    if isinstance(shapes, list | tuple):
        return [floats(shapes, "polygon")] if _is_ring(shapes) else shapes
    raise GeometryError(f"a {type(shapes).__name__} is no polygon", "polygon")


def _is_ring(shapes: Sequence[object]) -> bool:
    """Whether a list holds the corners of one polygon rather than polygons."""
    first = shapes[0] if shapes else None
    if isinstance(first, Polygon | MultiPolygon) or not isinstance(first, Sequence | np.ndarray):
        return False
    return not any(np.ndim(number) for number in first)


def polygon_of(shape: object, name: str) -> Polygon | MultiPolygon:
    """Return a shape or (m, 2) corners as a polygon that has an inside.

    Raises
    ------
    GeometryError
        If it is none; the error calls it `name`.
    """
    if isinstance(shape, Polygon | MultiPolygon):
        geometry = shape
    else:
        ring = floats(shape, name)  # type: ignore[arg-type]
        if ring.ndim != 2 or ring.shape[1] != 2 or len(ring) < 3:
            raise GeometryError("a polygon needs at least three points (m, 2)", name)
        if not np.isfinite(ring).all():
            raise GeometryError("has a corner that is not finite", name)
        geometry = Polygon(ring)
    if geometry.is_empty:
        raise GeometryError("is empty", name, "give a polygon with an area")
    if not np.isfinite(shapely.get_coordinates(geometry)).all():
        raise GeometryError("has a corner that is not finite", name)
    if not geometry.is_valid:
        reason = shapely.is_valid_reason(geometry)
        raise GeometryError(f"is not valid ({reason})", name, "repair it with shapely.make_valid")
    x0, y0, x1, y1 = geometry.bounds
    if not max(-x0, -y0, x1, y1) <= _MOST:
        raise GeometryError(f"reaches beyond {_MOST:g}", name, "use a larger unit")
    if not (min(x1 - x0, y1 - y0) >= _LEAST and geometry.area > 0.0):
        raise GeometryError("has no area", name)
    return geometry


def _polygons_of(shape: object, name: str) -> list[Polygon]:
    geometry = polygon_of(shape, name)
    return list(geometry.geoms) if isinstance(geometry, MultiPolygon) else [geometry]


def _as_box(polygon: Polygon) -> tuple[float, ...] | None:
    """Return the box that a polygon of four corners is, if it is one."""
    if len(polygon.interiors):
        return None
    xy = shapely.get_coordinates(polygon)
    if len(xy) != 5 or not (xy[1:] == xy[:-1]).any(axis=1).all():
        return None
    x0, y0, x1, y1 = polygon.bounds
    return (x0, y0, x1, y1) if x0 < x1 and y0 < y1 else None


def _rectangles(border: BorderEdges, first: NDArray[np.int32]) -> NDArray[np.intp]:
    """Return the compartments whose border is four sides along the axes."""
    four = np.flatnonzero(np.diff(first) == 4)
    edge = border.edge[first[four][:, None] + np.arange(4)]
    along = (edge[:, :, :2] == edge[:, :, 2:]).any(axis=2).all(axis=1)
    found: NDArray[np.intp] = four[along]
    return found


def _are_convex(border: BorderEdges, n: int) -> NDArray[np.bool_]:
    """Tell which of n compartments have one ring that turns left all the way, once around."""
    along = border.edge[:, 2:] - border.edge[:, :2]
    onward = along[border.next_edge]
    cross = along[:, 0] * onward[:, 1] - along[:, 1] * onward[:, 0]
    turn = np.arctan2(cross, (along * onward).sum(axis=1))
    turns = np.bincount(border.compartment, turn, minlength=n)
    n_left = np.bincount(border.compartment, cross > 0.0, minlength=n)
    n_edges = np.bincount(border.compartment, minlength=n)
    convex: NDArray[np.bool_] = (n_left == n_edges) & (turns < 3.0 * np.pi)
    return convex
