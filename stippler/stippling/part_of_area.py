"""Where an area's dots may lie: what it owns, cut by its pattern and by lines."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import TypeAlias

import numpy as np
import shapely
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.drawing import Drawing
from stippler.drawing.line import DISTANCE, Line
from stippler.drawing.pattern import Pattern
from stippler.errors import GeometryError
from stippler.stippling.patterns import cells_of

Shape: TypeAlias = Polygon | MultiPolygon

_QUARTER = 16  # edges of a quarter turn
_OUT = 1.0 / math.cos(math.pi / (4 * _QUARTER))
"""A polygon around a circle, not in it: no dot comes nearer than it may."""

_LONG, _CHUNK = 2000, 8  # points of a line that crosses itself, and of a piece of it

_APART_MM = 2e-5
"""Polygons of a pattern that share an edge are parted by this; each bounds its own dots."""

_LEAST_MM2 = 1e-4

FEW = 20
"""Dots to a polygon: fewer are spaced by Lloyd's method; they have no room for rows."""


def pattern_of(drawing: Drawing, area: int) -> tuple[int, Pattern] | None:
    """Return the pattern of an area, with its id: the last one laid over it."""
    found = [(k, p) for k, p in drawing.patterns.items() if getattr(p, "area", None) == area]
    return found[-1] if found else None  # type: ignore[return-value]


def part_for_dots(drawing: Drawing, area: int, part: Shape) -> Shape:
    """Return where the dots of an area may lie; each polygon of it is a compartment.

    Parameters
    ----------
    part : Polygon or MultiPolygon
        What the area owns. It is returned as it is where nothing cuts it.

    Raises
    ------
    GeometryError
        If the area's pattern does not meet it, or lines leave no room in it.
    """
    shape = part
    if (laid := pattern_of(drawing, area)) is not None:
        cells = cells_of(part, laid[1]).compartments
        shape = _joined(shapely.buffer(cells, -_APART_MM, join_style="mitre"))
    zones = [zone_of(line) for line in _keeping_off(drawing) if _may_meet(line, shape)]
    if zones:
        shape = _joined([shapely.difference(shape, shapely.union_all(zones))])
        if shape.is_empty:
            name = drawing.areas[area].name if area in drawing.areas else str(area)
            raise GeometryError("leave it no room", f"lines in area {name}", "keep off by less")
    return shape


def parts_met(
    drawing: Drawing, parts: Mapping[int, Shape]
) -> tuple[dict[int, Shape], tuple[str, ...]]:
    """Return where the dots of areas may lie, and what there is to say of areas left out.

    Parameters
    ----------
    parts : mapping of polygon by id
        What the areas own. One whose pattern misses it is left out, so that the rest can go on.

    Raises
    ------
    GeometryError
        If none is left.
    """
    found, missed = met_and_missed(drawing, parts)
    if missed and not found:
        raise none_left(missed.values())
    return found, tuple(left_out(drawing, (k,), error) for k, error in missed.items())


def met_and_missed(
    drawing: Drawing, parts: Mapping[int, Shape]
) -> tuple[dict[int, Shape], dict[int, GeometryError]]:
    """Return where the dots of areas may lie, and what keeps others from having any."""
    found, missed = dict[int, Shape](), dict[int, GeometryError]()
    for k, part in parts.items():
        try:
            found[k] = part_for_dots(drawing, k, part)
        except GeometryError as error:
            missed[k] = error
    return found, missed


def left_out(drawing: Drawing, areas: Iterable[int], why: GeometryError) -> str:
    """Return the words that tell of areas that are left out."""
    names = [repr(drawing.areas[k].name if k in drawing.areas else str(k)) for k in areas]
    if len(names) == 1:
        return f"area {names[0]} was left out: {why}"
    return f"areas {' and '.join(names)} were left out: {why}"


def none_left(reasons: Iterable[GeometryError]) -> GeometryError:
    """Return what to raise where each area that was asked for is left out."""
    first, *more = reasons
    return GeometryError("can hold no dots", "the areas", str(first)) if more else first


def zone_of(line: Line) -> Shape:
    """Return what no dot may lie in: all within a line's distance of its edge, or a little more."""
    reach = (np.array(line.width_mm) / 2 + line.distance_mm) * _OUT
    if reach[0] == reach[1]:
        at, axis = line.path.points_mm, shapely.linestrings(line.path.points_mm)
        if len(at) <= _LONG or shapely.is_simple(axis):
            return shapely.buffer(axis, float(reach[0]), quad_segs=_QUARTER)
        starts = range(0, len(at) - 1, _CHUNK)  # a long scribble at once would take minutes
        axes = [shapely.linestrings(at[k : k + _CHUNK + 1]) for k in starts]
        return shapely.union_all(shapely.buffer(axes, float(reach[0]), quad_segs=_QUARTER))
    wide = (float(2 * reach[0]), float(2 * reach[1]))
    return Line(line.name, line.path, wide).outline()


def _keeping_off(drawing: Drawing) -> list[Line]:
    lines = [line for line in drawing.lines.values() if isinstance(line, Line)]
    return [line for line in lines if line.meeting == DISTANCE and not line.hidden]


def _may_meet(line: Line, shape: Shape) -> bool:
    x0, y0, x1, y1 = shape.bounds
    far = max(line.width_mm) / 2 + line.distance_mm + 1.0
    low, high = line.path.points_mm.min(axis=0) - far, line.path.points_mm.max(axis=0) + far
    return bool((low <= (x1, y1)).all() and (high >= (x0, y0)).all())


def _joined(shapes: object) -> Shape:
    """Return all polygons of some shapes as one, without what has no extent."""
    parts = shapely.get_parts(shapes)
    parts = parts[(shapely.get_type_id(parts) == 3) & (shapely.area(parts) > _LEAST_MM2)]
    return parts[0] if len(parts) == 1 else MultiPolygon(parts.tolist())
