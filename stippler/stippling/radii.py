"""Solving the radii: the union of the discs, overlaps included, meets the darkness."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.cells.grid import sort_by_grid_cell
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tone.cell_ink import MAX_CORNERS, build_cells, sum_darkness
from stippler.kernels.tone.ink_of_areas import ink_in_cells
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

_DOTS_AT_ONCE = 8_000
_ROUNDS = 4  # of passing on ink that a dot cannot lay down
_ENOUGH = 2e-4  # share of all ink that need not be passed on
_GAIN = 0.11  # share of the oddity of its size that a dot hands to each neighbour
_CONTRAST = 0.7  # between cells whose tones differ by so much no ink goes
_MOST_SIDES = 255  # of a cell whose sides are looked at
_REACH = 7.0  # mean spacings; a cell reaches no farther from its dot to any side


def solve_radii(
    points: NDArray[np.float64],
    darkness: NDArray[np.float32],
    rule: DotRule,
    n_dots: int | None = None,
    tessellation: Tessellation | None = None,
) -> Iterator[tuple[float, NDArray[np.float64]]]:
    """Find radii at which the union of the discs meets the darkness.

    Every dot lays down the ink that its Voronoi cell asks for; what the range of the rule does
    not allow is passed on to its neighbours, as far as `_ROUNDS` cells away.

    Parameters
    ----------
    points : (n, 2) float64, pixels of `darkness`
    darkness : (h, w) float32, read-only
    rule : DotRule
        Its range of radii, in pixels.
    n_dots : int, optional
        How many dots there are, where `points` are only those of a part of the page.
    tessellation : Tessellation, optional
        The dots' cells in their compartments, in pixels, with the ink they ask for as `mass`: for
        areas and patterns. Else the cells are those of the page, and ask for what it is dark.

    Yields
    ------
    share : float
        Of the work done.
    radii : (n,) float64, pixels
        Found once the share is 1.

    Notes
    -----
    O(n); the same bits for any number of threads.
    """
    if len(points) == 0:
        yield 1.0, np.empty(0)
        return
    sizes = Sizes(points, darkness, rule, n_dots, tessellation)
    for share in sizes.prepare():
        yield 0.8 * share, sizes.radii
    for share in sizes.solve():
        yield 0.8 + 0.2 * share, sizes.radii


class Sizes:
    """The sizes of dots whose cells are known: solved once, or anew for other ink.

    Parameters are those of `solve_radii`; call `prepare` before `solve`.

    Attributes
    ----------
    radii : (n,) float64, pixels
        Of the last `solve`.
    """

    def __init__(
        self,
        points: NDArray[np.float64],
        darkness: NDArray[np.float32],
        rule: DotRule,
        n_dots: int | None = None,
        tessellation: Tessellation | None = None,
    ) -> None:
        self._points, self._darkness, self._rule = points, darkness, rule
        self._n_dots, self._tessellation = n_dots or len(points), tessellation
        self.radii = np.empty(len(points))

    def prepare(self) -> Iterator[float]:
        """Find the cells, and the ink that they ask for; yield the share done."""
        n, given = len(self._points), self._tessellation
        if given is not None:
            self._order = np.arange(n, dtype=np.int32)
            self._cells = _Cells(n, min(int(given.n_sides.max()) + 8, _MOST_SIDES))
            self._cells.read(given)
        else:
            points, darkness = self._points, self._darkness
            self._order, cell_start, frame = sorted_by_place(points, darkness, self._n_dots)
            self._cells = _Cells(n, MAX_CORNERS)
            yield from self._cells.build(points[self._order], cell_start, frame, darkness)
        self._asked = self._cells.asked
        yield 1.0

    def solve(self, gain: NDArray[np.float64] | None = None) -> Iterator[float]:
        """Find the radii; yield the share done.

        Parameters
        ----------
        gain : (n,) float64, optional
            What the ink that each cell asks for is multiplied with.
        """
        cells, (low, high) = self._cells, (self._rule.radius_min, self._rule.radius_max)
        cells.ask(self._asked if gain is None else self._asked * gain[self._order])
        yield 0.0
        cells.fit(low, high)
        if low < high:
            yield 0.0
            cells.even_sizes()
            cells.fit(low, high)
        for k in range(_ROUNDS):
            if np.abs(cells.left).sum() <= _ENOUGH * cells.asked.sum():
                break
            yield 0.5 * k / _ROUNDS
            cells.pass_on(low, high)
            cells.fit(low, high)
        self.radii[self._order] = cells.radii
        yield 1.0

    def ink(self, radii: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return what dots of these sizes lay down within their cells, in square pixels."""
        cells, n = self._cells, len(radii)
        laid, found = np.empty(n), np.empty(n)
        parallel_for(ink_in_cells, n, cells.corners, cells.n_corners, radii[self._order], laid)
        found[self._order] = laid
        return found


class _Cells:
    """The cells of sorted dots, and the ink that each asks for."""

    def __init__(self, n: int, most_sides: int) -> None:
        self.corners = np.empty((n, most_sides, 2), np.float32)
        self.beyond = np.empty((n, most_sides), np.int32)
        self.n_corners = np.empty(n, np.uint8)
        self.asked, self.before = np.empty(n), np.full(n, -1.0)
        self.radii, self.left = np.empty(n), np.empty(n)

    def ask(self, ink: NDArray[np.float64]) -> None:
        """Ask each dot for so much ink."""
        self.asked, self.before = ink, np.full(len(ink), -1.0)

    def read(self, cells: Tessellation) -> None:
        """Take over the cells of a tessellation; one of very many sides is solved as a free disc.

        Rings are joined into one: there and back between their first corners, which cancels out.
        """
        n_sides, dot = cells.n_sides.astype(np.int64), cells.dot_of_side
        closes = np.flatnonzero(cells.following <= np.arange(len(dot)))
        is_inner = cells.following[closes] > cells.start[dot[closes]]
        has_rings = np.zeros(len(cells), np.bool_)
        has_rings[dot[closes[is_inner]]] = True
        fits = (n_sides <= self.corners.shape[1]) & (n_sides <= _MOST_SIDES) & ~has_rings
        self.n_corners[:] = np.where(fits, n_sides, 0)
        side = np.flatnonzero(fits[dot])
        place = side - cells.start[dot[side]]
        self.corners[dot[side], place] = cells.corner[side]
        self.beyond[dot[side], place] = np.maximum(cells.beyond[side], -1)
        for i in np.flatnonzero(has_rings):
            self._join_rings(cells, int(i))
        self.asked = np.array(cells.mass)

    def _join_rings(self, cells: Tessellation, i: int) -> None:
        corner: list[NDArray[np.float64]] = []
        beyond: list[int] = []
        first, start, stop = 0, int(cells.start[i]), int(cells.start[i + 1])
        for k in range(start, stop):
            corner.append(cells.corner[k])
            beyond.append(max(int(cells.beyond[k]), -1))
            if cells.following[k] <= k:
                corner.append(cells.corner[cells.following[k]])
                beyond.append(-1)
                if first:
                    corner.append(cells.corner[start])
                    beyond.append(-1)
                first = k
        if len(corner) <= self.corners.shape[1]:
            self.corners[i, : len(corner)] = corner
            self.beyond[i, : len(corner)] = beyond
            self.n_corners[i] = len(corner)

    def build(
        self,
        xy: NDArray[np.float64],
        cell_start: NDArray[np.int32],
        frame: NDArray[np.float64],
        darkness: NDArray[np.float32],
    ) -> Iterator[float]:
        """Build the cells of dots sorted by grid cell; yield the share done."""
        n, (h, w) = len(xy), darkness.shape
        sums = np.empty((h, w + 1, 2))
        parallel_for(sum_darkness, h, darkness, sums, grain=64)
        yield 0.0
        results = self.corners, self.beyond, self.n_corners, self.asked
        for first in range(0, n, _DOTS_AT_ONCE):
            last = min(first + _DOTS_AT_ONCE, n)

            def part(start: int, stop: int, first: int = first) -> None:
                build_cells(first + start, first + stop, xy, cell_start, frame, sums, *results)

            parallel_for(part, last - first)
            yield last / n

    def fit(self, low: float, high: float) -> None:
        """Find radii within a range, and the ink `left` that it does not allow."""
        parallel_for(
            fit_radii,
            len(self.asked),
            self.corners,
            self.n_corners,
            self.asked,
            self.before,
            low,
            high,
            self.radii,
            self.left,
        )
        self.before = self.asked

    def even_sizes(self) -> None:
        """Let neighbours of like tone even out their sizes."""
        n, beyond, count = len(self.asked), self.beyond, self.n_corners
        odd, tone, new = np.empty(n), np.empty(n), np.empty(n)
        parallel_for(
            compare_sizes, n, self.corners, beyond, count, self.asked, self.radii, odd, tone
        )
        parallel_for(
            even_sizes, n, beyond, count, self.radii, odd, tone, _GAIN, _CONTRAST, self.asked, new
        )
        self.asked = new

    def pass_on(self, low: float, high: float) -> None:
        """Ask neighbours for the ink that a dot's range does not allow."""
        n, corners, beyond, count = len(self.asked), self.corners, self.beyond, self.n_corners
        room, given, new = np.empty((n, 2)), np.empty(n), np.empty(n)
        parallel_for(find_room, n, corners, beyond, count, low, high, self.radii, self.left, room)
        parallel_for(sum_room, n, beyond, count, self.left, room, given)
        parallel_for(pass_on, n, beyond, count, room, given, self.asked, new)
        self.asked = new


def sorted_by_place(
    points: NDArray[np.float64], darkness: NDArray[np.float32], n_dots: int
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.float64]]:
    """Sort dots into a uniform grid; return the order, each grid cell's start, and the frame."""
    n, (h, w) = n_dots, darkness.shape
    inked = max(float(np.count_nonzero(darkness[::4, ::4])) * 16.0, 0.05 * h * w)
    side = max(math.sqrt(1.2 * min(inked, h * w) / n), max(h, w) / 30_000)
    columns, rows = max(1, math.ceil(w / side)), max(1, math.ceil(h / side))
    column = np.clip((points[:, 0] / side).astype(np.int32), 0, columns - 1)
    row = np.clip((points[:, 1] / side).astype(np.int32), 0, rows - 1)
    cell_start = np.zeros(columns * rows + 1, np.int32)
    order = np.empty(len(points), np.int32)
    sort_by_grid_cell(row * np.int32(columns) + column, cell_start, order)
    half = _REACH * math.sqrt(h * w / n)
    return order, cell_start, np.array([w, h, side, columns, rows, half], np.float64)
