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

_MOST_SIDES = 64  # of a cell whose outline bounds its dot's ink


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
        n, n_sides = len(slots), outlines.n_sides
        last = np.cumsum(n_sides)
        dot = np.repeat(np.arange(n), n_sides)
        place = np.arange(len(dot)) - (last - n_sides)[dot]
        closes = outlines.following[: len(dot)] <= place
        fits = (n_sides <= _MOST_SIDES) & (np.bincount(dot[closes], minlength=n) == 1)
        corners = np.empty((n, min(int(n_sides.max(initial=0)), _MOST_SIDES), 2), np.float32)
        side = fits[dot]
        corners[dot[side], place[side]] = outlines.corner[: len(dot)][side]
        n_corners = np.where(fits, n_sides, 0).astype(np.uint8)
        asked, radius, left = np.ascontiguousarray(cells[slots, 0]), np.empty(n), np.empty(n)
        before = np.full(n, -1.0)
        fit_radii(0, n, corners, n_corners, asked, before, low_mm, high_mm, radius, left)
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
