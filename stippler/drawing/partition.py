"""Which area a point lies in, and moves that do not leave it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

Points = NDArray[np.float64]

NOWHERE = -1
_HALVINGS = 4


class Partition:
    """The areas of a drawing, ready to be asked; areas do not overlap but for the page's.

    Where another area lies on the page's, it owns its dots.
    """

    def __init__(self, outlines: Mapping[int, Polygon | MultiPolygon]) -> None:
        self._outlines = dict(outlines)
        for outline in self._outlines.values():
            shapely.prepare(outline)
        self._boxes = {
            k: outline.bounds if outline.equals(shapely.box(*outline.bounds)) else None
            for k, outline in self._outlines.items()
        }

    def box_of(self, k: int) -> tuple[float, float, float, float] | None:
        """Return the box x0, y0, x1, y1 that an area is; None where it is something else."""
        return self._boxes[k]

    def area_at(self, points: Points) -> NDArray[np.int32]:
        """Return the area of each point; `NOWHERE` off the page."""
        found = np.full(len(points), NOWHERE, np.int32)
        for k in self._outlines:
            found[self._holds(k, points)] = k
        return found

    def confine(self, old: Points, new: Points, area: NDArray[np.int32]) -> Points:
        """Return moves cut short so that they end in the dots' areas.

        A move that would end outside is halved until it does not, and else not made. Where dots
        lie outside their area already they stay.
        """
        outside = ~self._own(new, area)
        if not outside.any():
            return new
        out = new.copy()
        which = np.flatnonzero(outside)
        share = 1.0
        for _ in range(_HALVINGS):
            share *= 0.5
            tried = old[which] + share * (new[which] - old[which])
            fine = self._own(tried, area[which])
            out[which[fine]] = tried[fine]
            which = which[~fine]
            if not len(which):
                return out
        out[which] = old[which]
        return out

    def _own(self, points: Points, area: NDArray[np.int32]) -> NDArray[np.bool_]:
        """Return whether points lie in the areas given."""
        if len(self._outlines) == 1:
            (k,) = self._outlines
            return np.asarray(self._holds(k, points) & (area == k))
        same: NDArray[np.bool_] = self.area_at(points) == area
        return same

    def _holds(self, k: int, points: Points) -> NDArray[np.bool_]:
        box = self._boxes[k]
        x, y = points[:, 0], points[:, 1]
        if box is not None:
            return np.asarray((x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3]))
        return np.asarray(shapely.intersects_xy(self._outlines[k], x, y))
