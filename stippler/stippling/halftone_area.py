"""Pulse-density modulation within a polygon, whatever the picture's pixels are to it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.levels import Curve
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import GeometryError
from stippler.kernels.halftone.scan_order import outside_polygon
from stippler.stippling.compartments import polygon_of
from stippler.stippling.halftone import CELLS_PER_DOT, grown, reach_for, whole_dots
from stippler.stippling.tone import DotRule, rule_for
from stippler.stippling.window import Window

_MOST_CELLS = 60_000_000
_LEAST_PER_DOT = 3.0  # cells; with fewer no region has a shape


@dataclass(frozen=True, slots=True, eq=False)
class AreaDots:
    """First dots of an area, and the rule that they follow.

    Attributes
    ----------
    position_mm : (n, 2) float64
    radius_mm : (n,) float64
        By the rule; not solved for the tone.
    rule : DotRule
        In mm.
    """

    position_mm: NDArray[np.float64]
    radius_mm: NDArray[np.float64]
    rule: DotRule


class _Cells(NamedTuple):
    """Cells over an area's box: their darkness, 0 outside the area; their side and corner in mm."""

    darkness: NDArray[np.float32]
    side: float
    corner: NDArray[np.float64]


def pulses_inside(
    reference: Reference, style: Style, area: Polygon | MultiPolygon, *curves: Curve
) -> AreaDots:
    """Place as many dots as a style asks for in an area of a page, at a cost that follows the area.

    The cells are as fine as the area asks for, and the rule for size and density is that of the
    darkness within it, so the number is met exactly. Where only a range of sizes is asked for, the
    number follows from it.

    Parameters
    ----------
    reference : Reference
    style : Style
    area : polygon, mm
    curves : callables
        What darkness goes through, as a style's tone curve.

    Raises
    ------
    GeometryError
        If so little of the area's box is the area's that the cells cannot be made so fine.
    """
    polygon_of(area, "area")
    page = shapely.box(0.0, 0.0, reference.width_mm, reference.height_mm)
    part = shapely.intersection(area, page)
    nothing = AreaDots(np.empty((0, 2)), np.empty(0), DotRule(1.0, 2.0))
    if part.area <= 0.0:
        return nothing
    n_dots = style.n_dots or _number_for(reference, style.size_range_mm, part, curves)
    cells = _cells_of(reference, part, n_dots, curves)
    inked = cells.darkness[cells.darkness > 0.0]
    if not inked.size:
        return nothing
    if inked.size < _LEAST_PER_DOT * n_dots:
        raise GeometryError(
            f"is too narrow for {n_dots} dots by pulse-density", "area",
            "ask for fewer, or fill it at random",
        )  # fmt: skip
    sizes, side = style.size_range_mm, cells.side
    in_cells = None if sizes is None else (sizes[0] / side, sizes[1] / side)
    n_wanted = style.n_dots if sizes is not None else n_dots
    rule = rule_for(inked[None, :], n_wanted, in_cells, inked[:0])
    points = _grown(cells.darkness, rule, style, float(inked.min()))
    x, y = points.astype(np.intp).T
    radii = rule.radius(cells.darkness[y, x])
    in_mm = replace(rule, radius_min=rule.radius_min * side, radius_max=rule.radius_max * side)
    return AreaDots(points * side + cells.corner, radii * side, in_mm)


def _number_for(
    reference: Reference,
    size_range_mm: tuple[float, float] | None,
    part: Polygon | MultiPolygon,
    curves: tuple[Curve, ...],
) -> int:
    """Return how many dots of these sizes an area takes, about."""
    low, high = size_range_mm or (1.0, 1.0)
    ink = float(Window.of(reference, part.bounds, 1000, *curves).darkness.mean(dtype=np.float64))
    return max(1, int(ink * part.area / (math.pi * (0.5 * (low + high)) ** 2)))


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


def _cells_of(
    reference: Reference, part: Polygon | MultiPolygon, n_dots: int, curves: tuple[Curve, ...]
) -> _Cells:
    """Lay cells over the box of a part of the page."""
    per_area = n_dots / part.area
    x0, y0, x1, y1 = part.bounds
    n_in_box = math.ceil(per_area * (x1 - x0) * (y1 - y0))
    window = Window.of(reference, part.bounds, n_in_box, *curves)
    side = 1.0 / math.sqrt(CELLS_PER_DOT * per_area)
    side = max(side, math.sqrt((x1 - x0) * (y1 - y0) / _MOST_CELLS))
    columns, rows = max(1, math.ceil((x1 - x0) / side)), max(1, math.ceil((y1 - y0) / side))
    x = (x0 - window.origin_mm[0] + (np.arange(columns) + 0.5) * side) / window.pixel_mm
    y = (y0 - window.origin_mm[1] + (np.arange(rows) + 0.5) * side) / window.pixel_mm
    h, w = window.darkness.shape
    at = np.ix_(np.clip(y.astype(np.intp), 0, h - 1), np.clip(x.astype(np.intp), 0, w - 1))
    cells = window.darkness[at]
    outside_polygon((edges_of(part) - (x0, y0, x0, y0)) / side, cells)
    return _Cells(cells, side, np.array([x0, y0]))


def edges_of(area: Polygon | MultiPolygon) -> NDArray[np.float64]:
    """Return the border of a polygon as (m, 4) edges."""
    parts = [part for part in shapely.get_parts(area) if isinstance(part, Polygon)]
    rings = [ring for part in parts for ring in (part.exterior, *part.interiors)]
    corners = [np.asarray(ring.coords)[:, :2] for ring in rings if not ring.is_empty]
    if not corners:
        return np.empty((0, 4))
    return np.concatenate([np.hstack((c[:-1], c[1:])) for c in corners])
