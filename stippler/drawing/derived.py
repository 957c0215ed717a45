"""What follows from a drawing's areas and lines, found when it is asked for and kept until then."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.drawing import records
from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Partition
from stippler.drawing.run import Limits

if TYPE_CHECKING:
    from stippler.drawing.line_meetings import LineMeetings


class Derived:
    """Of one drawing; `note` tells it what has changed.

    Attributes
    ----------
    locked : (k,) int32 or None
        Locked areas, if there are any.
    """

    def __init__(self, drawing: Drawing) -> None:
        self._drawing = drawing
        self._partition: Partition | None = None
        self._meetings: LineMeetings | None = None
        self._areas_at = 0  # when they last changed
        self._line_at: dict[int, int] = {}  # the same of each line
        self.locked: NDArray[np.int32] | None = None
        self._note_locks()

    def note(self, kind: str, i: int, now: int) -> None:
        """Take note of a value that has changed."""
        if kind == records.AREA:
            self._partition, self._areas_at = None, now
            self._note_locks()
        elif kind == records.LINE:
            self._meetings, self._line_at[i] = None, now

    def _note_locks(self) -> None:
        locked = [k for k, area in self._drawing.areas.items() if area.locked]
        self.locked = np.array(locked, np.int32) if locked else None

    def are_unlocked(self, area: NDArray[np.int32]) -> NDArray[np.bool_]:
        """Tell which of some areas are not locked."""
        if self.locked is None:
            return np.ones(len(area), np.bool_)
        return ~np.isin(area, self.locked)

    @property
    def partition(self) -> Partition:
        """Which area owns which part of the page."""
        if self._partition is None:
            self._partition = Partition(self._drawing.outlines())
        return self._partition

    @property
    def meetings(self) -> LineMeetings | None:
        """What lines ask of dots that are laid or moved; None without lines."""
        if not self._drawing.lines:
            return None
        if self._meetings is None:
            from stippler.drawing.line_meetings import LineMeetings  # late: kernels

            self._meetings = LineMeetings.of(self._drawing.lines)
        return self._meetings

    def limits(self, base: int) -> Limits:
        """Return what a run may not do that began at a revision."""
        lines = [k for k, at in self._line_at.items() if at > base]
        return Limits(self.partition, self._areas_at > base, lines, self.locked)
