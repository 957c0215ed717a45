"""Outlines to SVG and GeoJSON, so that other programs draw areas as we do."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence

import numpy as np
import shapely

from stippler.drawing.planar.path import Path, pieces_of
from stippler.drawing.planar.planar_map import PlanarMap
from stippler.drawing.planar.rings import HalfEdge
from stippler.files.write.xml_text import quoted


def path_data(paths: Sequence[Path]) -> str:
    """Return SVG's path data of paths, curves as curves."""
    out: list[str] = []
    for path in paths:
        pieces = pieces_of(path)
        out.append(f"M{_xy(pieces[0][0])}")
        for k, piece in enumerate(pieces):
            if len(piece) == 4:
                out.append("C" + " ".join(_xy(p) for p in piece[1:]))
            elif not (path.is_closed and k == len(pieces) - 1):
                out.append(f"L{_xy(piece[1])}")
        if path.is_closed:
            out.append("Z")
    return "".join(out)


def svg_of_areas(
    areas: PlanarMap, size_mm: tuple[float, float], names: Mapping[int, str] | None = None
) -> str:
    """Return an SVG with one path an area, in mm; what `read_outlines` reads back."""
    w, h = size_mm
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{w:.9g}mm" height="{h:.9g}mm"'
        f' viewBox="0 0 {w:.9g} {h:.9g}" fill="none" stroke="black" stroke-width="0.1">'
    ]
    for k in areas.areas:
        label = quoted((names or {}).get(k, f"area {k}"))
        rings = [ring_path(areas, ring) for part in areas.parts(k) for ring in part.rings]
        lines.append(f'<path id={label} fill-rule="evenodd" d="{path_data(rings)}"/>')
    return "\n".join([*lines, "</svg>\n"])


def ring_path(areas: PlanarMap, ring: Sequence[HalfEdge]) -> Path:
    """Return a ring of half-edges as one closed path, its curves kept."""
    from stippler.drawing.planar.path import shifted

    vertices, curves, n = [], [], 0
    for k, forward in ring:
        path = areas.arcs[k].path if forward else areas.arcs[k].path.reversed()
        curves += [shifted(c, n) for c in path.curves]
        vertices.append(path.vertices[:-1])
        n += len(path) - 1
    vertices.append(vertices[0][:1])
    return Path(np.concatenate(vertices), tuple(curves))


def geojson_of_areas(areas: PlanarMap, names: Mapping[int, str] | None = None) -> str:
    """Return GeoJSON with one feature an area; coordinates are mm on the page, y down."""
    features = [
        {
            "type": "Feature",
            "id": k,
            "properties": {"name": (names or {}).get(k, f"area {k}")},
            "geometry": json.loads(shapely.to_geojson(areas.outline(k))),
        }
        for k in areas.areas
    ]
    return json.dumps({"type": "FeatureCollection", "features": features})


def _xy(point: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> str:
    return f"{point[0]:.9g},{point[1]:.9g}"
