"""The chosen dots, by id, and what encloses them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.editor.events import NO_MODS, Mods

if TYPE_CHECKING:
    from stippler.drawing.document import Document

Ids = NDArray[np.int64]
Point = tuple[float, float]
Hull = tuple[Point, ...]

NO_IDS: Ids = np.empty(0, np.int64)
_DIRECTIONS = np.array(
    [(math.cos(a), math.sin(a)) for a in np.linspace(0.0, math.tau, 48, endpoint=False)]
)


class Selection:
    """Which dots are chosen.

    Attributes
    ----------
    ids : array
        Sorted; dots that are gone may be among them. Never changed, only replaced.
    revision : int
        Grows with every change.
    """

    def __init__(self) -> None:
        self.ids: Ids = NO_IDS
        self.revision = 0
        self._last: Ids = NO_IDS  # chosen before nothing was
        self._hull: tuple[object, Hull] = (None, ())

    def choose(self, ids: Ids, mods: Mods = NO_MODS) -> None:
        """Choose dots; Shift adds them, Alt takes them away."""
        if mods.shift:
            ids = np.union1d(self.ids, ids)
        elif mods.alt:
            ids = np.setdiff1d(self.ids, ids)
        if len(self.ids) and not len(ids):
            self._last = self.ids
        self.ids = np.sort(ids)
        self.revision += 1

    def again(self) -> None:
        """Choose what was chosen before nothing was."""
        if not len(self.ids):
            self.choose(self._last)

    @property
    def has_last(self) -> bool:
        """Whether `again` would choose something."""
        return not len(self.ids) and len(self._last) > 0

    def forget(self) -> None:
        """Choose nothing, and know of nothing chosen before."""
        self.choose(NO_IDS)
        self._last = NO_IDS

    def mask(self, document: Document) -> NDArray[np.bool_]:
        """Return which rows are chosen."""
        out = np.zeros(len(document.dots), np.bool_)
        rows = document.rows(self.ids)
        out[rows[rows >= 0]] = True
        return out

    # --- what encloses them -------------------------------------------------------------------

    def hull(self, document: Document) -> Hull:
        """Return the corners of a convex outline about the chosen dots' centres, in mm."""
        key = (id(document), document.revision, self.revision)
        if key != self._hull[0]:
            self._hull = (key, self._found_hull(document))
        return self._hull[1]

    def _found_hull(self, document: Document) -> Hull:
        rows = document.rows(self.ids)
        places = document.dots.position_mm[rows[rows >= 0]]
        if not len(places):
            return ()
        furthest = (places @ _DIRECTIONS.T).argmax(axis=0)
        corners = [(float(x), float(y)) for x, y in places[furthest]]
        return tuple(dict.fromkeys(corners))

    def box(self, document: Document) -> tuple[Point, Point] | None:
        """Return low and high corner of the box about their centres; None without any."""
        hull = self.hull(document)
        if not hull:
            return None
        x, y = zip(*hull, strict=True)
        return (min(x), min(y)), (max(x), max(y))

    def holds(self, document: Document, at: Point, pad_mm: float) -> bool:
        """Return whether a point lies within the outline, or as near as that."""
        hull = self.hull(document)
        if not hull:
            return False
        place = np.array(hull)
        reach = (place @ _DIRECTIONS.T).max(axis=0) + pad_mm
        return bool((np.array(at) @ _DIRECTIONS.T <= reach).all())
