"""Outlines from GeoJSON: polygons and lines in mm on the page, y down."""

from __future__ import annotations

import collections
import json
from collections.abc import Iterator
from pathlib import Path as FilePath
from typing import Any

import numpy as np

from stippler.drawing.planar.path import Path
from stippler.errors import GeometryError
from stippler.files.read.outlines import (
    MOST_SHAPES,
    MOST_VERTICES,
    OutlineError,
    Outlines,
    Shape,
)

_LINES = {"LineString": 1, "MultiLineString": 2}
_POLYGONS = {"Polygon": 2, "MultiPolygon": 3}
_MOST_DEPTH = 50


def outlines_of_geojson(data: bytes, where: FilePath) -> Outlines:
    """Read polygons and lines; coordinates are mm on the page, as our own export writes them.

    Raises
    ------
    OutlineError
        If it is no GeoJSON, too large, or holds no polygon or line.
    """
    try:
        document = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise OutlineError("is no GeoJSON", where, str(error)[:100]) from error
    left_out: collections.Counter[str] = collections.Counter()
    shapes: list[Shape] = []
    n_vertices = 0
    for name, geometry in _geometries(document, "", left_out, 0):
        shape = _shape(name, geometry, left_out)
        if shape is None:
            continue
        shapes.append(shape)
        n_vertices += sum(len(p) for p in shape.paths)
        if len(shapes) > MOST_SHAPES or n_vertices > MOST_VERTICES:
            raise OutlineError(f"has more than {MOST_VERTICES:,} vertices", where, "simplify it")
    notes = [f"left out: {n} x {what}" for what, n in sorted(left_out.items())]
    if not shapes:
        raise OutlineError("holds no polygon or line", where, "; ".join(notes))
    return Outlines(tuple(shapes), None, tuple(notes))


def _geometries(
    item: Any, name: str, left_out: collections.Counter[str], depth: int
) -> Iterator[tuple[str, dict[str, Any]]]:
    """Yield named geometries of features and collections."""
    if not isinstance(item, dict) or depth > _MOST_DEPTH:
        left_out["what is no object of GeoJSON"] += 1
        return
    kind = item.get("type")
    if kind == "FeatureCollection":
        features = item.get("features")
        for feature in features if isinstance(features, list) else []:
            yield from _geometries(feature, name, left_out, depth + 1)
    elif kind == "Feature":
        given = item.get("properties")
        given = given if isinstance(given, dict) else {}
        label = given.get("name", item.get("id", name))
        if item.get("geometry") is not None:
            yield from _geometries(item["geometry"], str(label), left_out, depth + 1)
    elif kind == "GeometryCollection":
        parts = item.get("geometries")
        for part in parts if isinstance(parts, list) else []:
            yield from _geometries(part, name, left_out, depth + 1)
    elif isinstance(kind, str) and (kind in _LINES or kind in _POLYGONS):
        yield name, item
    else:
        left_out[str(kind)[:40]] += 1


def _shape(name: str, geometry: dict[str, Any], left_out: collections.Counter[str]) -> Shape | None:
    kind = geometry["type"]
    closed = kind in _POLYGONS
    paths = []
    for line in _flat(geometry.get("coordinates"), (_POLYGONS if closed else _LINES)[kind]):
        try:
            points = np.array([point[:2] for point in line], np.float64)
            path = Path.polyline(points, closed=closed)
        except (TypeError, ValueError, GeometryError):
            left_out["lines with coordinates that are none"] += 1
            continue
        if len(path) < (4 if closed else 2):
            left_out["lines without extent"] += 1
            continue
        paths.append(path)
    return Shape(name, tuple(paths), "even-odd", closed) if paths else None


def _flat(values: Any, depth: int) -> Iterator[list[Any]]:
    """Yield the lists of points that lie under some levels of lists."""
    if not isinstance(values, list):
        return
    if depth == 1:
        yield values
        return
    for value in values:
        yield from _flat(value, depth - 1)
