"""The chosen dots, by id."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.editor.events import NO_MODS, Mods

if TYPE_CHECKING:
    from stippler.drawing.document import Document

Ids = NDArray[np.int64]
NO_IDS: Ids = np.empty(0, np.int64)


class Selection:
    """Which dots are chosen.

    Attributes
    ----------
    ids : array
        Sorted; dots that are gone may be among them.
    revision : int
        Grows with every change.
    """

    def __init__(self) -> None:
        self.ids: Ids = NO_IDS
        self.revision = 0
        self._last: Ids = NO_IDS  # chosen before nothing was

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
