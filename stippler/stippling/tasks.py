"""Tasks of drawings: what of a drawing a task is to be given."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Partition
from stippler.drawing.style import Style
from stippler.stippling.task import RELAX, Standing, Task

Rows = NDArray[np.intp]


def relaxing(
    drawing: Drawing, style: Style, steps: int, areas: Collection[int] | None = None
) -> tuple[Task, Rows]:
    """Return the task of relaxing a drawing's dots, and the rows of the dots that it moves.

    Parameters
    ----------
    areas : collection of int, optional
        Whose dots are moved; all, if left out. Dots that lie in another area's part stay.
    """
    dots, partition = drawing.dots, Partition(drawing.outlines())
    mine = partition.area_at(dots.position_mm) == dots.area
    if areas is not None:
        mine &= np.isin(dots.area, list(areas))
    rows = np.flatnonzero(mine)
    some = dots if len(rows) == len(dots) else dots.take(rows)
    used, part_of_dot = np.unique(some.area, return_inverse=True)
    standing = Standing(some.position_mm, some.radius_mm, some.fixed, part_of_dot)
    parts = tuple(partition.part_of(int(k)) for k in used)
    return Task(style, drawing.reference, RELAX, parts, standing, steps=steps), rows
