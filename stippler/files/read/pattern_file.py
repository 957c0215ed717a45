"""Sets of polygons for patterns, from files of closed paths."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from stippler.drawing.pattern import MOST_POLYGONS, PolygonSet
from stippler.errors import GeometryError
from stippler.files.read.outlines import read_outlines
from stippler.stippling.patterns import set_of_rings


def read_pattern(path: Path) -> tuple[PolygonSet, tuple[str, ...]]:
    """Read an SVG or GeoJSON of paths as a set of polygons; return it, and what was changed.

    Open paths are closed, and that is said; what overlaps is cut when the set is laid over an area.

    Raises
    ------
    OutlineError, GeometryError
        If there is no path with an extent, or more than `MOST_POLYGONS`.
    """
    found = read_outlines(path)
    rings, n_open = [], 0
    for shape in found.shapes:
        for one in shape.paths:
            points = one.points_mm
            if one.is_closed:
                points = points[:-1]
            elif len(points) > 2:
                n_open += 1
            rings.append(np.asarray(points))
    if len(rings) > MOST_POLYGONS:
        raise GeometryError(
            f"has {len(rings):,} paths", path.name, f"give {MOST_POLYGONS:,} at most"
        )
    made, notes = set_of_rings(path.stem[:60], rings)
    if n_open:
        notes.insert(0, f"{n_open:,} open paths were closed")
    return made, (*found.notes, *notes)
