"""Finding dots by place, in a grid that follows every edit."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.store import Rows
from stippler.kernels.dots.list_grid import (
    keep_apart,
    link_all,
    nearest_distances,
    nearest_row,
    relink,
    rows_in_box,
)

DOTS_PER_CELL = 2.0
_MOST_CELLS = 4_000_000
_SPARE = 1024
_MOST_DRIFT = 1.0  # in cells; then it is cheaper to begin anew

Positions = NDArray[np.float64]


class DotIndex:
    """The rows of dots by place; queries cost what they find, updates what has changed.

    Parameters
    ----------
    position_mm : (n, 2) float64
        Not kept: every call is given the positions as they are now.
    size_mm : (width, height)
        Of the page; dots off it are found, too.
    """

    def __init__(self, position_mm: Positions, size_mm: tuple[float, float]) -> None:
        self._size_mm = size_mm
        self._links = np.empty((0, 3), np.int32)
        self._out = np.empty(_SPARE, np.int64)
        self._stale = False
        self._rebuild(position_mm)

    @property
    def n_bytes(self) -> int:
        """Memory it takes."""
        return self._links.nbytes + self._head.nbytes + self._out.nbytes

    def _rebuild(self, position_mm: Positions) -> None:
        """Begin anew with cells of a fitting size."""
        self._stale = False
        n = len(position_mm)
        width, height = self._size_mm
        side = math.sqrt(width * height * DOTS_PER_CELL / max(n, 64))
        side = max(side, math.sqrt(width * height / _MOST_CELLS), max(width, height) / 65536)
        columns, rows = math.ceil(width / side), math.ceil(height / side)
        self._frame = np.array([0.0, 0.0, 1.0 / side, columns, rows, 0.0])
        self._head = np.full(columns * rows, -1, np.int32)
        if n > len(self._links) or 4 * n + _SPARE < len(self._links):
            self._links = np.empty((n + n // 4 + _SPARE, 3), np.int32)
        self._links[:, 2] = -1
        self._n_built = n
        link_all(position_mm, self._frame, self._head, self._links)

    def update(self, rows: Rows, position_mm: Positions) -> None:
        """Take note of dots that moved, came (at the end) or went (rows beyond the end).

        After large changes the next query begins anew.
        """
        if self._stale:
            return
        n = len(position_mm)
        if (
            len(rows) > 0.3 * n + 64
            or not self._n_built <= 4 * n + 256 <= 16 * self._n_built + 1024
        ):
            self._stale = True
            return
        if n > len(self._links):
            more = np.full((n + n // 4 + _SPARE, 3), -1, np.int32)
            more[: len(self._links)] = self._links
            self._links = more
        relink(rows, position_mm, self._frame, self._head, self._links)

    def lose(self) -> None:
        """Take note that any dots may be anywhere; the next query begins anew."""
        self._stale = True

    def drift(self, most_mm: float) -> None:
        """Take note that any dots may have moved, each by so much at most."""
        self._frame[5] += most_mm
        if self._frame[5] * self._frame[2] > _MOST_DRIFT:
            self._stale = True

    def in_box(self, box: tuple[float, float, float, float], position_mm: Positions) -> Rows:
        """Return the rows of the dots in a closed box x0, y0, x1, y1; sorted."""
        lists = self._lists(position_mm)
        x0, y0, x1, y1 = map(float, box)  # of a whole number numba makes another kernel
        n = rows_in_box(x0, y0, x1, y1, *lists, self._out)
        if n > len(self._out):
            self._out = np.empty(2 * n, np.int64)
            rows_in_box(x0, y0, x1, y1, *lists, self._out)
        return np.sort(self._out[:n])

    def nearest(self, x: float, y: float, reach_mm: float, position_mm: Positions) -> int | None:
        """Return the row of the dot nearest to a point within a reach."""
        row = nearest_row(float(x), float(y), float(reach_mm), *self._lists(position_mm))
        return None if row < 0 else row

    def nearest_distances(
        self, rows: Rows, reach_mm: float, position_mm: Positions
    ) -> NDArray[np.float64]:
        """Return how far each row's nearest neighbour is; `reach_mm` where none is nearer."""
        out = np.empty(len(rows))
        nearest_distances(rows, float(reach_mm), *self._lists(position_mm), out)
        return out

    def apart(
        self, points: NDArray[np.float64], distance_mm: float, position_mm: Positions
    ) -> NDArray[np.bool_]:
        """Return which points keep a distance to all dots and to the points kept before them."""
        kept = np.empty(len(points), np.bool_)
        keep_apart(points, float(distance_mm), *self._lists(position_mm), kept)
        return kept

    def _lists(
        self, position_mm: Positions
    ) -> tuple[Positions, NDArray[np.float64], NDArray[np.int32], NDArray[np.int32]]:
        """Return what the kernels ask, up to date."""
        if self._stale:
            self._rebuild(position_mm)
        return position_mm, self._frame, self._head, self._links
