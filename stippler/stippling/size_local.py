"""Sizes solved for the tone, of the few dots under a brush."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.kernels.cells.relaxation import TOO_MANY_CORNERS, relax_dots
from stippler.kernels.cells.tables import Outlines
from stippler.kernels.tone.radii import fit_radii
from stippler.stippling.cells import CORNER_CAP, LLOYD
from stippler.stippling.relax_local import NO_STARS, LocalRelaxation

Floats = NDArray[np.float64]
Slots = NDArray[np.int32]


@dataclass(frozen=True, slots=True, eq=False)
class Sized:
    """The sizes of some dots, (k,) each, mm.

    Attributes
    ----------
    radius_mm
        NaN where no ink is asked for.
    reach_mm
        Distance of the farthest corner of their cells.
    """

    radius_mm: Floats
    reach_mm: Floats


class LocalSizes(LocalRelaxation):
    """As `LocalRelaxation`; a dot's disc lays down within its cell the ink that the cell asks for.

    The density is the darkness. What a dot's range does not allow is not passed on, as
    `stippler.stippling.radii` does for whole drawings.
    """

    def solve(self, dots: ArrayLike, low_mm: float, high_mm: float) -> Sized:
        """Find the radii of dots, each number once, within a range."""
        slots = self._slot_of_dot[np.asarray(dots, np.int32)]
        outlines, cells = self._outlines(slots)
        n = len(slots)
        start = np.zeros(n + 1, np.int32)
        np.cumsum(outlines.n_sides, out=start[1:])
        corner, following = outlines.corner[: start[-1]], outlines.following[: start[-1]]
        for array in (start, corner, following):
            array.flags.writeable = False  # kernels compile for one kind
        asked, radius, left = np.ascontiguousarray(cells[slots, 0]), np.empty(n), np.empty(n)
        before = np.full(n, -1.0)
        fit_radii(0, n, start, corner, following, asked, before, low_mm, high_mm, radius, left)
        radius[~(asked > 0.0)] = np.nan
        return Sized(radius, np.sqrt(cells[slots, 5]))

    def _outlines(self, slots: Slots) -> tuple[Outlines, Floats]:
        """Return the outlines of cells, in the order asked for, and what was measured, by slot."""
        room, cap, n = 8 * len(slots) + 64, CORNER_CAP, len(slots)
        cells = np.zeros((len(self._moves.x), 6))
        while True:
            out = Outlines(
                np.empty((room, 2)), np.empty(room, np.int32), np.empty(room, np.int32),
                np.zeros(n, np.int32), np.zeros(1, np.int64),
            )  # fmt: skip
            relax_dots(
                0, n, cap, slots, False, self._dots, self._table, self._grid.border, self._field,
                1.0, self._moves, cells, NO_STARS, out, LLOYD,
            )  # fmt: skip
            if (self._moves.kind[slots] == TOO_MANY_CORNERS).any():
                cap *= 16
            elif out.used[0] > room:
                room = int(out.used[0])
            else:
                return out, cells
