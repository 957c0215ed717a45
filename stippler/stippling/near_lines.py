"""Where on some lines dots are nearest, all at once: lines as areas' borders have them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString

from stippler.kernels.lines.nearest import find_nearest, list_segments
from stippler.kernels.machine.pool import parallel_for

Floats = NDArray[np.float64]

Grid: TypeAlias = tuple[float, float, float, int, int, NDArray[np.int64], NDArray[np.int64]]
"""x and y of its corner, side of a cell, columns, rows; where each cell's list begins, and it."""

_MOST_CELLS = 250_000
_LEAST = 1e-300


@dataclass(frozen=True, slots=True, eq=False)
class Nearest:
    """The nearest places on lines.

    Attributes
    ----------
    line : (n,) int
        Which one; -1 where none is within reach.
    along, away : (n,) float64
        Arc length there, and how far it is; inf where none is within reach.
    feet, direction : (n, 2) float64
        The places, and the unit vector along the line there.
    """

    line: NDArray[np.int64]
    along: Floats
    away: Floats
    feet: Floats
    direction: Floats


class NearLines:
    """Lines in a grid that they are found by.

    Parameters
    ----------
    lines : sequence of LineString
    reach : float
        How far from them anything is looked at.
    """

    def __init__(self, lines: Sequence[LineString], reach: float) -> None:
        corners = [shapely.get_coordinates(line) for line in lines]
        parts = [_segments(at) for at in corners]
        self._segments = np.ascontiguousarray(np.concatenate([np.empty((0, 8)), *parts]))
        self._line_of = np.repeat(np.arange(len(parts)), [len(p) for p in parts])
        step = self._segments[:, 2:4] - self._segments[:, :2]
        length2 = np.maximum((step * step).sum(axis=1), _LEAST)
        self._inverse, self._direction = 1.0 / length2, step / np.sqrt(length2)[:, None]
        self.reach = reach
        self._grid = (self._segments, *_listed(self._segments, reach))

    def nearest(self, points: Floats) -> Nearest:
        """Return the place nearest to each point."""
        at = np.ascontiguousarray(points, np.float64)
        n = len(at)
        which, along, away, feet = np.empty(n, np.int64), np.empty(n), np.empty(n), at.copy()
        parallel_for(
            find_nearest, n, at, *self._grid, self._inverse, 0.0, which, along, away, feet
        )  # fmt: skip
        near = (which >= 0) & (away <= self.reach)
        line, direction = np.full(n, -1), np.zeros((n, 2))
        line[near] = self._line_of[which[near]]
        direction[near] = self._direction[which[near]]
        return Nearest(line, along, np.where(near, away, np.inf), feet, direction)


def in_grid(edges: Floats, reach: float) -> Grid:
    """List edges (m, 4) by the cells of a grid that they come within reach of."""
    return _listed(np.hstack([edges, np.zeros_like(edges)]), reach)


def _listed(segments: Floats, reach: float) -> Grid:
    ends = segments[:, :4].reshape(-1, 2)
    low = ends.min(axis=0, initial=0.0 if not len(ends) else np.inf) - reach
    high = ends.max(axis=0, initial=0.0 if not len(ends) else -np.inf) + reach
    width, height = (high - low).tolist()
    cell = max(0.5 * reach, math.sqrt(width * height / _MOST_CELLS), _LEAST)
    columns, rows = int(width // cell) + 1, int(height // cell) + 1
    grid = (float(low[0]), float(low[1]), cell, columns, rows)
    far, start = np.full(len(segments), reach), np.zeros(columns * rows + 1, np.int64)
    list_segments(segments, far, *grid, start, np.empty(0, np.int64), True)
    start = np.cumsum(start)
    listed = np.empty(start[-1], np.int64)
    list_segments(segments, far, *grid, start.copy(), listed, False)
    return (*grid, start, listed)


def _segments(at: Floats) -> Floats:
    """Return a line's segments as kernels take them, without a width."""
    step = np.hypot(*np.diff(at, axis=0).T)
    s = np.concatenate(([0.0], np.cumsum(step)))
    nothing = np.zeros((len(step), 2))
    return np.hstack([at[:-1], at[1:], nothing, s[:-1, None], s[1:, None]])
