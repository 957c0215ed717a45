"""Pulse-density modulation within a polygon, whatever the picture's pixels are to it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.style import Style
from stippler.errors import GeometryError
from stippler.kernels.halftone.scan_order import outside_polygon
from stippler.stippling.compartments import polygon_of
from stippler.stippling.halftone import CELLS_PER_DOT, grown, reach_for, whole_dots
from stippler.stippling.page_raster import at_resolution
from stippler.stippling.tone import DotRule, rule_for

_MOST_CELLS = 60_000_000
_LEAST_PER_DOT = 3.0  # cells; with fewer no region has a shape


class _Cells(NamedTuple):
    """Cells over an area's box: their darkness, 0 outside the area; their side and corner in px."""

    darkness: NDArray[np.float32]
    side: float
    corner: NDArray[np.float64]


def pulses_inside(
    darkness: NDArray[np.float32], style: Style, area: Polygon | MultiPolygon
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Place as many dots as a style asks for in an area of a picture; return them and their radii.

    Lengths are pixels of the picture. The cells are as fine as the area asks for, and the rule for
    size and density is that of the darkness within it, so the number is met exactly.

    Raises
    ------
    GeometryError
        If so little of the area's box is the area's that the cells cannot be made so fine.
    """
    polygon_of(area, "area")
    n_dots = int(style.n_dots or 0)
    h, w = darkness.shape
    part = shapely.intersection(area, shapely.box(0.0, 0.0, w, h))
    if part.area <= 0.0:
        return np.empty((0, 2)), np.empty(0)
    cells = _cells_of(darkness, part, n_dots)
    inked = cells.darkness[cells.darkness > 0.0]
    if not inked.size:
        return np.empty((0, 2)), np.empty(0)
    if inked.size < _LEAST_PER_DOT * n_dots:
        raise GeometryError(
            f"is too narrow for {n_dots} dots by pulse-density", "area",
            "ask for fewer, or fill it at random",
        )  # fmt: skip
    rule = rule_for(inked[None, :], n_dots, None, inked[:0])
    points = _grown(cells.darkness, rule, style, float(inked.min()))
    x, y = points.astype(np.intp).T
    radii = rule.radius(cells.darkness[y, x])
    return points * cells.side + cells.corner, radii * cells.side


def _grown(
    darkness: NDArray[np.float32], rule: DotRule, style: Style, lightest: float
) -> NDArray[np.float64]:
    """Grow the dots of a rule; all lengths in cells."""
    levels = np.linspace(0.0, 1.0, 4097)
    charge = np.interp(darkness, levels, rule.density(levels)).astype(np.float32)
    charge[darkness == 0.0] = 0.0
    asked = float(charge.sum(dtype=np.float64))
    charge *= np.float32(whole_dots(asked))
    spacing = math.sqrt(np.count_nonzero(charge) / max(asked, 1.0))
    reach = reach_for(float(rule.density(np.array([lightest]))[0]))
    *_, (_, first) = grown(charge, asked, style.growth, style.start, style.seed, reach, spacing)
    return first.position_px


def _cells_of(darkness: NDArray[np.float32], part: Polygon | MultiPolygon, n_dots: int) -> _Cells:
    """Lay cells over the box of a part of the picture."""
    per_area = n_dots / part.area
    field, pixel = _averaged(darkness, per_area)
    x0, y0, x1, y1 = part.bounds
    side = 1.0 / math.sqrt(CELLS_PER_DOT * per_area)
    side = max(side, math.sqrt((x1 - x0) * (y1 - y0) / _MOST_CELLS))
    columns, rows = max(1, math.ceil((x1 - x0) / side)), max(1, math.ceil((y1 - y0) / side))
    x = np.minimum((x0 + (np.arange(columns) + 0.5) * side) / pixel, field.shape[1] - 1)
    y = np.minimum((y0 + (np.arange(rows) + 0.5) * side) / pixel, field.shape[0] - 1)
    cells = field[np.ix_(y.astype(np.intp), x.astype(np.intp))]
    outside_polygon((_edges(part) - (x0, y0, x0, y0)) / side, cells)
    return _Cells(cells, side, np.array([x0, y0]))


def _averaged(darkness: NDArray[np.float32], per_area: float) -> tuple[NDArray[np.float32], float]:
    """Average blocks of a picture that is finer than its dots can show; leave others alone."""
    if per_area * CELLS_PER_DOT > 0.25:
        return darkness, 1.0
    return at_resolution(darkness, max(int(per_area * darkness.size), 1))


def _edges(area: Polygon | MultiPolygon) -> NDArray[np.float64]:
    """Return the border of a polygon as (m, 4) edges."""
    parts = [part for part in shapely.get_parts(area) if isinstance(part, Polygon)]
    rings = [ring for part in parts for ring in (part.exterior, *part.interiors)]
    corners = [np.asarray(ring.coords)[:, :2] for ring in rings if not ring.is_empty]
    if not corners:
        return np.empty((0, 4))
    return np.concatenate([np.hstack((c[:-1], c[1:])) for c in corners])
