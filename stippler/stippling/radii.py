"""Solving the radii: the union of the discs, overlaps included, meets the darkness."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tone.radii import (
    compare_sizes,
    even_sizes,
    find_room,
    fit_radii,
    pass_on,
    sum_room,
)
from stippler.stippling.tessellation import Tessellation
from stippler.stippling.tone import DotRule

Floats = NDArray[np.float64]

_ROUNDS = 4  # of passing on ink that a dot cannot lay down
_ENOUGH = 2e-4  # share of all ink that need not be passed on
_GAIN = 0.11  # share of the oddity of its size that a dot hands to each neighbour
_CONTRAST = 0.7  # between cells whose tones differ by so much no ink goes


def solve_radii(cells: Tessellation, rule: DotRule) -> Floats:
    """Return radii (n,) at which the union of the discs meets the darkness, see `Sizes`."""
    sizes = Sizes(cells, rule)
    for _share in sizes.solve():
        pass
    return sizes.radii


class Sizes:
    """The sizes of dots whose cells are known: solved once, or anew for other ink.

    Every dot lays down the ink that its Voronoi cell asks for; what the range of the rule does
    not allow is passed on to its neighbours, as far as `_ROUNDS` cells away. O(n); the same bits
    for any number of threads.

    Parameters
    ----------
    cells : Tessellation
        With the darkness as density: the ink that a cell asks for is its mass.
    rule : DotRule
        Its range of radii, in the cells' unit.

    Attributes
    ----------
    radii : (n,) float64
        Of the last `solve`.
    asked : (n,) float64
        Ink that each dot is asked for by now.
    left : (n,) float64
        Of it, what the range did not allow: above 0 missing, below 0 too much.
    """

    def __init__(self, cells: Tessellation, rule: DotRule) -> None:
        self._cells, self._rule = cells, rule
        n = len(cells)
        self.asked, self._before = np.array(cells.mass), np.full(n, -1.0)
        self.radii, self.left = np.empty(n), np.empty(n)

    def solve(self, gain: Floats | None = None) -> Iterator[float]:
        """Find the radii; yield the share done.

        Parameters
        ----------
        gain : (n,) float64, optional
            What the ink that each cell asks for is multiplied with.
        """
        low, high = self._rule.radius_min, self._rule.radius_max
        mass = self._cells.mass
        self.asked, self._before = mass * (1.0 if gain is None else gain), np.full(len(mass), -1.0)
        yield 0.0
        self.fit(low, high)
        if low < high:
            yield 0.0
            self.even_sizes()
            self.fit(low, high)
        for k in range(_ROUNDS):
            if np.abs(self.left).sum() <= _ENOUGH * self.asked.sum():
                break
            yield 0.5 * k / _ROUNDS
            self.pass_on(low, high)
            self.fit(low, high)
        yield 1.0

    def fit(self, low: float, high: float) -> None:
        """Find radii within a range, and the ink `left` that it does not allow."""
        cells = self._cells
        parallel_for(
            fit_radii, len(cells), cells.start, cells.corner, cells.following, self.asked,
            self._before, low, high, self.radii, self.left,
        )  # fmt: skip
        self._before = self.asked

    def even_sizes(self) -> None:
        """Let neighbours of like tone even out their sizes."""
        cells, n = self._cells, len(self._cells)
        start, beyond = cells.start, cells.beyond
        odd, tone, new = np.empty(n), np.empty(n), np.empty(n)
        asked, radii = self.asked, self.radii
        parallel_for(compare_sizes, n, start, beyond, cells.area, asked, radii, odd, tone)
        parallel_for(even_sizes, n, start, beyond, radii, odd, tone, _GAIN, _CONTRAST, asked, new)
        self.asked = new

    def pass_on(self, low: float, high: float) -> None:
        """Ask neighbours for the ink that a dot's range does not allow."""
        cells, n = self._cells, len(self._cells)
        start, beyond = cells.start, cells.beyond
        room, given, new = np.empty((n, 2)), np.empty(n), np.empty(n)
        parallel_for(
            find_room, n, start, cells.corner, cells.following, beyond, low, high, self.radii,
            self.left, room,
        )  # fmt: skip
        parallel_for(sum_room, n, start, beyond, self.left, room, given)
        parallel_for(pass_on, n, start, beyond, room, given, self.asked, new)
        self.asked = new
