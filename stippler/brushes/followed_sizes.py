"""Sizes that were solved for the tone follow their dots."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.brushes.evening_out import Evened
from stippler.brushes.local_cells import box_around, lacks, places_of, tone_in, wider
from stippler.drawing.document import Document
from stippler.drawing.shape_change import MIN_RADIUS_MM
from stippler.drawing.store import Rows
from stippler.stippling.size_local import LocalSizes

Floats = NDArray[np.float64]

LARGER = 1.1
"""So much larger than the largest dot may one get whose cell grows."""

_NOT_NOTED, _STAYS, _FOLLOWS = 0, 1, 2


class FollowedSizes:
    """Sizes that were solved for the tone before their dots moved, to be solved once more after.

    While dots neither come nor go.
    """

    def __init__(self) -> None:
        self._noted = np.empty(0, np.uint8)  # by row

    def note(self, document: Document, rows: Rows, evened: Evened) -> None:
        """Take note of sizes before dots move; what was noted first counts."""
        if not len(self._noted):
            self._noted = np.full(len(document.dots), _NOT_NOTED, np.uint8)
        fresh = self._noted[rows] == _NOT_NOTED
        self._noted[rows[fresh]] = np.where(evened.is_solved[fresh], _FOLLOWS, _STAYS)

    def solve(self, document: Document) -> None:
        """Give them the sizes that the ink of their cells asks for now."""
        rows = np.flatnonzero(self._noted == _FOLLOWS)
        if not len(rows):
            return
        radius = solved_sizes(document, rows).astype(np.float32)
        known = np.isfinite(radius)
        document.change("radius_mm", rows[known], radius[known])


def solved_sizes(document: Document, rows: Rows) -> Floats:
    """Return radii at which dots lay down what their cells ask for; NaN where that is nothing.

    No dot gets much larger than the largest of the drawing. Rows are sorted.
    """
    dots = document.dots
    low, high = MIN_RADIUS_MM, LARGER * float(dots.radius_mm.max())
    radius, reach = np.full(len(rows), np.nan), np.zeros(len(rows))
    left, around = np.arange(len(rows)), None
    while len(left):
        at = dots.position_mm[rows[left]]
        around = box_around(document, at, around)
        for place in places_of(document, rows[left], around):
            field = tone_in(document, place.area, around)
            if field is None:
                continue
            engine = LocalSizes(
                dots.position_mm[place.rows], place.outlines, density=field, movable=place.movable
            )
            sized = engine.solve(place.mine, low, high)
            mine = left[place.which]
            radius[mine], reach[mine] = sized.radius_mm, sized.reach_mm
        lacking = lacks(document, at, reach[left], around)
        around = wider(at[lacking], reach[left][lacking])
        left = left[lacking]
    return radius
