"""Tasks of drawings: what of a drawing a task is to be given."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Outline, Partition
from stippler.drawing.style import Style
from stippler.stippling.part_of_area import part_for_dots
from stippler.stippling.task import RELAX, Standing, Task

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
    mine = partition.area_at(dots.position_mm) == dots.area
    cut = _cut(drawing, partition, mine)
    if areas is not None:
        mine &= np.isin(dots.area, list(areas))
    rows = np.flatnonzero(mine)
    some = dots if len(rows) == len(dots) else dots.take(rows)
    used, part_of_dot = np.unique(some.area, return_inverse=True)
    standing = Standing(some.position_mm, some.radius_mm, some.fixed, part_of_dot)
    parts = tuple(cut.get(int(k)) or partition.part_of(int(k)) for k in used)
    return Task(style, drawing.reference, RELAX, parts, standing, steps=steps), rows


def _cut(drawing: Drawing, partition: Partition, mine: NDArray[np.bool_]) -> dict[int, Outline]:
    """Return the parts of areas that patterns or lines cut; dots outside them are not `mine`."""
    if not (drawing.patterns or drawing.lines):
        return {}
    dots, cut = drawing.dots, {}
    for k in np.unique(dots.area[mine]).tolist():
        whole = partition.part_of(k)
        part = part_for_dots(drawing, k, whole)
        if part is whole:
            continue
        cut[k] = part
        rows = np.flatnonzero(mine & (dots.area == k))
        mine[rows] = shapely.contains_xy(part, *dots.position_mm[rows].T)
    return cut
