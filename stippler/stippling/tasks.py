"""Tasks of drawings: what of a drawing a task is to be given."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.area import PAGE_AREA
from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Outline, Partition
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.errors import GeometryError, ParameterError
from stippler.stippling.part_of_area import FEW, part_for_dots
from stippler.stippling.style_tone import toned_by_area
from stippler.stippling.task import RELAX, Standing, Task

_LEAST_MARGIN_MM, _MARGIN = 1.0, 0.05  # around an area, of its side: there its neighbours lie
_COARSE, _FINE = 128, 64  # places a side that ink is looked at, of a page and of an area
_WHOLE = 1e-9  # of the page

Rows = NDArray[np.intp]


def relaxing(
    drawing: Drawing, style: Style, steps: int, areas: Collection[int] | None = None
) -> tuple[Task, Rows]:
    """Return the task of relaxing a drawing's dots, and the rows of the dots that it moves.

    Parameters
    ----------
    areas : collection of int, optional
        Whose dots are moved; all, if left out. Dots that lie in another area's part stay, and
        so do those between a pattern's polygons or nearer to a line than they may be.
    """
    dots, partition = drawing.dots, Partition(drawing.outlines())
    reference = drawing.reference
    if reference is not None:
        seen = {k: drawing.style_of(k) for k in drawing.areas}
        changed = {k: one for k, one in seen.items() if one.has_curve or one.is_inverse}
        reference = toned_by_area(
            reference, {k: (partition.part_of(k), one) for k, one in changed.items()}
        )
    mine = partition.area_at(dots.position_mm) == dots.area
    if areas is not None:
        mine &= np.isin(dots.area, list(areas))
    part_of_row, cut = _cut(drawing, partition, mine)
    rows = np.flatnonzero(mine)
    some = dots if len(rows) == len(dots) else dots.take(rows)
    used, part_of_dot = np.unique(part_of_row[rows], return_inverse=True)
    standing = Standing(some.position_mm, some.radius_mm, some.fixed, part_of_dot)
    parts = tuple(cut[-k] if k < 0 else partition.part_of(k) for k in used.tolist())
    if cut and reference is None and len(rows) < FEW * len(parts):
        style = replace(style, spacing="lloyd")
    return Task(style, reference, RELAX, parts, standing, steps=steps), rows


def _cut(
    drawing: Drawing, partition: Partition, mine: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], dict[int, Outline]]:
    """Return each dot's area, or below 0 which polygon of one that patterns or lines cut.

    Dots outside of all polygons are `mine` no longer.
    """
    dots, cut = drawing.dots, dict[int, Outline]()
    owner = dots.area.astype(np.int64)
    if not (drawing.patterns or drawing.lines):
        return owner, cut
    for k in np.unique(owner[mine]).tolist():
        whole = partition.part_of(k)
        part = part_for_dots(drawing, k, whole)
        if part is whole:
            continue
        polygons = shapely.get_parts(part)
        rows = np.flatnonzero(mine & (dots.area == k))
        found = shapely.STRtree(polygons).query(
            shapely.points(dots.position_mm[rows]), predicate="intersects"
        )
        mine[rows] = False
        mine[rows[found[0]]] = True
        owner[rows[found[0]]] = -(found[1] + len(cut) + 1)
        cut.update(enumerate(polygons.tolist(), start=len(cut) + 1))
    return owner, cut


@dataclass(frozen=True, slots=True, eq=False)
class AreaTask:
    """The task of stippling one area, and which areas the neighbours of its dots are in."""

    area: int
    task: Task
    neighbour_area: NDArray[np.int32]


def stippling(
    drawing: Drawing, area: int, partition: Partition | None = None, near: Rows | None = None
) -> AreaTask:
    """Return the task of stippling an area of a drawing anew, in its style.

    Its fixed dots stay, and new ones keep clear of those beyond its border. A number of dots is
    shared by all areas of the style, by their ink.

    Parameters
    ----------
    partition : Partition, optional
        Of the drawing, if it is known.
    near : rows, optional
        All dots that lie in the `box_around` the area.

    Raises
    ------
    ParameterError
        If there is no such area, or no picture.
    GeometryError
        If nothing of the page is the area's.
    """
    if area not in drawing.areas:
        raise ParameterError(f"there is no area {area}", "area", _known(drawing))
    reference = drawing.reference
    if reference is None:
        raise ParameterError("there is no picture to stipple from", "area", "fill it with dots")
    partition = partition or Partition(drawing.outlines())
    part = partition.part_of(area)
    if part.is_empty:
        raise GeometryError("lies under others", f"area {area}", "give it room of its own")
    dots = drawing.dots
    if near is None:
        x0, y0, x1, y1 = box_around(part)
        x, y = dots.position_mm.T
        near = np.flatnonzero((x >= x0) & (x <= x1) & (y >= y0) & (y <= y1))
    mine = dots.area[near] == area
    fixed, others = near[mine & dots.fixed[near]], near[~mine]
    standing = None
    if len(fixed):
        standing = Standing(dots.position_mm[fixed], dots.radius_mm[fixed])
    style = _with_own_number(drawing, partition, area, part, reference)
    whole = drawing.page.width_mm * drawing.page.height_mm
    cut = part_for_dots(drawing, area, part)
    is_page = area == PAGE_AREA and cut is part and part.area >= (1.0 - _WHOLE) * whole
    parts = () if is_page else (cut,)
    task = Task(style, reference, parts_mm=parts, standing=standing,
                neighbours_mm=dots.position_mm[others])  # fmt: skip
    return AreaTask(area, task, dots.area[others])


def box_around(part: Outline) -> tuple[float, float, float, float]:
    """Return the box in which an area's own dots and its neighbours lie."""
    margin = max(_LEAST_MARGIN_MM, _MARGIN * float(np.sqrt(part.area)))
    x0, y0, x1, y1 = part.bounds
    return x0 - margin, y0 - margin, x1 + margin, y1 + margin


def _known(drawing: Drawing) -> str:
    return "one of " + ", ".join(f"{k} ({a.name})" for k, a in sorted(drawing.areas.items())[:20])


def _with_own_number(
    drawing: Drawing, partition: Partition, area: int, part: Outline, reference: Reference
) -> Style:
    """Return an area's style with its own share of a number that several areas have together."""
    i = drawing.areas[area].style
    style = drawing.styles[i]
    sharing = [k for k, one in drawing.areas.items() if one.style == i]
    if style.n_dots is None or len(sharing) == 1:
        return style
    page = (0.0, 0.0, drawing.page.width_mm, drawing.page.height_mm)
    others = [k for k in sharing if k != area]
    rest = _ink(partition, reference, page, _COARSE, others)
    own = _ink(partition, reference, part.bounds, _FINE, [area])
    share = own / (own + rest) if own > 0.0 else 0.0
    return replace(style, n_dots=max(round(style.n_dots * share), 1))


def _ink(
    partition: Partition,
    reference: Reference,
    box: tuple[float, float, float, float],
    n: int,
    areas: list[int],
) -> float:
    """Return about how much of a box is inked in some areas, in mm2, by n x n places."""
    x0, y0, x1, y1 = box
    at = (np.arange(n) + 0.5) / n
    x, y = np.meshgrid(x0 + (x1 - x0) * at, y0 + (y1 - y0) * at)
    owner = partition.area_at(np.column_stack((x.ravel(), y.ravel())))
    levels = reference.source.darkness
    rows = np.clip((y / reference.pixel_mm).astype(np.intp), 0, levels.shape[0] - 1)
    columns = np.clip((x / reference.pixel_mm).astype(np.intp), 0, levels.shape[1] - 1)
    ink = reference.adjustment.apply(np.ascontiguousarray(levels[rows, columns])).ravel()
    cell = (x1 - x0) * (y1 - y0) / n**2
    return float(ink[np.isin(owner, areas)].sum(dtype=np.float64)) * cell
