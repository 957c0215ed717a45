"""What dots that are relaxed see through the borders of their areas."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Outline, Partition
from stippler.stippling.beyond import Beyond, seen_of
from stippler.stippling.border_policies import BorderPolicies

_WIDTH = 3.0  # spacings beyond a border within which others are seen

Rows = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """Areas whose dots see each other, and what else they see.

    Attributes
    ----------
    areas : tuple of int
    outline : polygon, mm
        What they own, with strips of what is seen beyond; walls are slits in it.
    beyond : rows
        The dots in the strips.
    """

    areas: tuple[int, ...]
    outline: Outline
    beyond: Rows


def views_of(
    drawing: Drawing, partition: Partition, moved: Sequence[int], mine: NDArray[np.bool_]
) -> Iterator[View]:
    """Yield what areas see whose dots are moved; nothing of those that see none but themselves.

    Parameters
    ----------
    moved : sequence of area ids
    mine : (n,) bool
        Which dots are moved, or hold still among them.
    """
    policies = BorderPolicies(drawing, partition)
    if not policies.may_see_through:
        return
    area, at = drawing.dots.area, drawing.dots.position_mm
    for group in policies.linked(moved):
        around = policies.seen_from(group)
        if len(group) == 1 and not around:
            continue
        outline = policies.part_of_all(group)
        n_dots = np.count_nonzero(mine & np.isin(area, group))
        spacing = math.sqrt(outline.area / max(n_dots, 1))
        near = np.flatnonzero(np.isin(area, list(around)))
        beyond = Beyond.of(
            seen_of(policies, group, bleeds=False),
            outline,
            at[near],
            _WIDTH * spacing,
            n_dots / outline.area,
        )
        if len(group) > 1 or beyond.strips:
            outline = beyond.seen_with(outline)
            rows = near[beyond.rows]
            rows = rows[shapely.intersects_xy(outline, at[rows, 0], at[rows, 1])]
            yield View(group, outline, rows)
