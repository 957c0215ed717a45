"""What vector and raster formats draw: a sheet of layers, painted one over another.

A layer has one colour: that of ink on paper, or of paper on a ground of ink (Deussen et al. 2000,
section 3). Its ground is painted first, in the other colour; then its shapes and lines; its dots
are last.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.polarity import Polarity, grounds_of, polarity_of

if TYPE_CHECKING:
    from shapely.geometry import MultiPolygon, Polygon

    from stippler.drawing.line import Line as DrawnLine

Points = NDArray[np.float64]
ROUGH = 1e-3
"""Dots of less roughness have smooth outlines."""


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A line with round ends and corners; of one point, a disc."""

    points_mm: Points
    width_mm: float
    closed: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """Closed rings, filled by the even-odd rule; the last point of a ring is not its first."""

    rings_mm: tuple[Points, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """What one pen draws in one go.

    Attributes
    ----------
    inverse : bool
        Paper on a ground of ink, instead of ink on paper.
    ground : tuple of Shape
        Painted first, where the layer is inverse.
    pen : str
        The style's; "" where that is not known, or where lines are drawn.
    """

    name: str
    dots: Dots = field(default_factory=Dots.none)
    inverse: bool = False
    ground: tuple[Shape, ...] = ()
    lines: tuple[Line, ...] = ()
    shapes: tuple[Shape, ...] = ()
    pen: str = ""

    @property
    def name_for_xml(self) -> str:
        """The name, without what no XML may hold."""
        return "".join(c for c in self.name if c in "\t\n\r" or _in_xml(ord(c)))

    @property
    def is_empty(self) -> bool:
        """Whether nothing is painted."""
        return not (len(self.dots) or self.ground or self.lines or self.shapes)


def _in_xml(code: int) -> bool:
    return 0x20 <= code <= 0xD7FF or 0xE000 <= code <= 0xFFFD or code >= 0x10000


@dataclass(frozen=True, slots=True, eq=False)
class Sheet:
    """Paper with layers, in painting order."""

    width_mm: float
    height_mm: float
    layers: tuple[Layer, ...]

    def scaled(self, by: float) -> Sheet:
        """Return the whole sheet enlarged or reduced."""
        return moved(self, by, (0.0, 0.0), (self.width_mm * by, self.height_mm * by))


def moved(
    sheet: Sheet, by: float, to_mm: tuple[float, float], size_mm: tuple[float, float]
) -> Sheet:
    """Scale a sheet, then lay its corner at `to_mm` of a sheet of another size."""
    if by == 1.0 and to_mm == (0.0, 0.0) and size_mm == (sheet.width_mm, sheet.height_mm):
        return sheet

    def lay(points: Points) -> Points:
        laid: Points = points * by + np.array(to_mm)
        return laid

    def shapes(those: tuple[Shape, ...]) -> tuple[Shape, ...]:
        return tuple(Shape(tuple(lay(ring) for ring in one.rings_mm)) for one in those)

    layers = []
    for layer in sheet.layers:
        dots = replace(
            layer.dots,
            position_mm=lay(layer.dots.position_mm),
            radius_mm=(layer.dots.radius_mm * by).astype(np.float32),
        )
        lines = tuple(
            Line(lay(line.points_mm), line.width_mm * by, line.closed) for line in layer.lines
        )
        layers.append(
            replace(
                layer,
                dots=dots,
                lines=lines,
                ground=shapes(layer.ground),
                shapes=shapes(layer.shapes),
            )
        )
    return Sheet(*size_mm, tuple(layers))


def sheet_of(drawing: Drawing) -> Sheet:
    """Return a drawing as a sheet of its page's size."""
    return Sheet(drawing.page.width_mm, drawing.page.height_mm, tuple(layers_of(drawing)))


def layers_of(drawing: Drawing) -> Iterator[Layer]:
    """Yield a layer for each area that has something to show; the one place that reads areas.

    Areas of white dots come first, so that black dots stay whole at their borders; those that touch
    are one layer, and their grounds one shape without a seam. Hidden areas are left out. Dots of an
    area that the drawing does not list have a layer of their own. Printed lines come last.
    """
    dots, polarity = drawing.dots, polarity_of(drawing)
    yield from _inverse_layers(drawing, polarity)
    listed = np.zeros(len(dots), np.bool_)
    for index, area in sorted(drawing.areas.items()):
        rows = np.flatnonzero(dots.area == index)
        listed[rows] = True
        if len(rows) and not area.hidden and index not in polarity.white:
            yield Layer(area.name, _taken(dots, rows), pen=_pen_of(drawing, index))
    if not listed.all():
        yield Layer("no area", _taken(dots, np.flatnonzero(~listed)))
    every: list[Any] = [line for _, line in sorted(drawing.lines.items())]
    printed = [line for line in every if line.is_inked]
    even = [line for line in printed if line.width_mm[0] == line.width_mm[1]]
    tapered = [line for line in printed if line.width_mm[0] != line.width_mm[1]]
    if even or tapered:
        lines = tuple(_line(one) for one in even)
        yield Layer("lines", lines=lines, shapes=tuple(shape_of(one.outline()) for one in tapered))


def _inverse_layers(drawing: Drawing, polarity: Polarity) -> Iterator[Layer]:
    grounds = grounds_of(drawing, polarity)
    for ids in _touching(grounds):
        import shapely

        names = ", ".join(drawing.areas[k].name for k in ids)
        ground = shape_of(shapely.union_all([grounds[k] for k in ids]))
        rows = np.flatnonzero(np.isin(drawing.dots.area, ids))
        pen = _pen_of(drawing, ids[0])
        yield Layer(names, drawing.dots.take(rows), inverse=True, ground=(ground,), pen=pen)


def _pen_of(drawing: Drawing, area: int) -> str:
    style = drawing.styles.get(drawing.areas[area].style)
    return "" if style is None else style.pen


def _touching(parts: Mapping[int, Polygon | MultiPolygon]) -> list[list[int]]:
    """Return the ids of parts in groups of those that touch, in order."""
    groups: list[list[int]] = []
    for k, part in parts.items():
        near = [g for g in groups if any(part.intersects(parts[i]) for i in g)]
        groups = [g for g in groups if g not in near]
        groups.append(sorted([k, *(i for g in near for i in g)]))
    return sorted(groups)


def _line(one: DrawnLine) -> Line:
    points = one.path.points_mm
    if one.is_closed and len(points) > 1 and (points[0] == points[-1]).all():
        points = points[:-1]
    return Line(points, one.width_mm[0], one.is_closed)


def _taken(dots: Dots, rows: NDArray[np.intp]) -> Dots:
    return dots if len(rows) == len(dots) else dots.take(rows)


def shape_of(outline: Polygon | MultiPolygon) -> Shape:
    """Return a polygon's rings."""
    parts: Any = getattr(outline, "geoms", [outline])
    rings = [ring for part in parts for ring in (part.exterior, *part.interiors)]
    return Shape(tuple(np.asarray(ring.coords, np.float64)[:-1, :2] for ring in rings))


def smallest_mm(sheet: Sheet) -> float:
    """Return the smallest radius on a sheet; infinite if there are no dots."""
    return min(
        (float(layer.dots.radius_mm.min()) for layer in sheet.layers if len(layer.dots)),
        default=math.inf,
    )


def kinds(dots: Dots) -> tuple[NDArray[np.intp], NDArray[np.intp], NDArray[np.intp]]:
    """Return the rows of round dots, of smooth ellipses, and of rough ones."""
    smooth = dots.roughness <= ROUGH
    is_round = smooth & (dots.elongation == 1)
    return (
        np.flatnonzero(is_round),
        np.flatnonzero(smooth & ~is_round),
        np.flatnonzero(~smooth),
    )
