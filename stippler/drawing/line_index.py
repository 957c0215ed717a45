"""Lines in a grid: the nearest to a point, and points that keep their distances."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.line import ADHERE, DISTANCE, Line
from stippler.kernels.lines.nearest import find_nearest, list_segments, push_out
from stippler.kernels.machine.pool import parallel_for

Points = NDArray[np.float64]
Ints = NDArray[np.int64]

_TURNS = 64
_MOST_CELLS = 1_000_000


class LineIndex:
    """Lines in a grid, to find the nearest by.

    Parameters
    ----------
    lines : sequence of Line
    reach_mm : float or sequence of float
        How far from each line's edge points are looked at.
    """

    def __init__(self, lines: Sequence[Line], reach_mm: float | Sequence[float]) -> None:
        self.lines = tuple(lines)
        parts = [line.segments() for line in lines]
        counts = [len(p) for p in parts]
        self.segments = np.ascontiguousarray(np.concatenate(parts)) if parts else np.empty((0, 8))
        self.line_of = np.repeat(np.arange(len(parts)), counts)
        lengths = [line.arc_lengths() for line in lines]
        self.lengths = np.array([s[-1] for s in lengths])
        self.closed = np.array([line.is_closed for line in lines], np.bool_)
        self._first = np.r_[0.0, np.cumsum(self.lengths + 1.0)][: len(lengths)]
        self._s = np.concatenate([s + f for s, f in zip(lengths, self._first, strict=True)] or [[]])
        self._at = np.concatenate([k.path.points_mm for k in lines] or [np.empty((0, 2))])
        reach = np.broadcast_to(np.asarray(reach_mm, np.float64), len(parts))
        far = reach[self.line_of] + self.segments[:, 4:6].max(axis=1, initial=0.0)
        low, high = _bounds(self.segments, float(far.max(initial=1.0)))
        size = high - low
        self._cell = max(
            0.5 * float(np.median(far)) if len(far) else 1.0,
            math.sqrt(size[0] * size[1] / _MOST_CELLS),
        )
        self._low = low
        self._columns, self._rows = (int(v // self._cell) + 1 for v in size)
        self._fill(far)

    def _fill(self, far: Points) -> None:
        start = np.zeros(self._columns * self._rows + 1, np.int64)
        x0, y0 = map(float, self._low)
        grid = (x0, y0, self._cell, self._columns, self._rows)
        nothing = np.empty(0, np.int64)
        list_segments(self.segments, far, *grid, start, nothing, True)
        start = np.cumsum(start)
        listed = np.empty(start[-1], np.int64)
        list_segments(self.segments, far, *grid, start.copy(), listed, False)
        d = self.segments[:, 2:4] - self.segments[:, :2]
        self._inverse = 1.0 / np.maximum((d * d).sum(axis=1), 1e-300)
        self._widest = float(self.segments[:, 4:6].max(initial=0.0))
        self._grid = (self.segments, *grid, start, listed)

    def at(self, line: Ints, along: Points) -> Points:
        """Return the places at arc lengths along lines, many lines at once."""
        s = self._first[line] + np.where(self.closed[line], along % self.lengths[line], along)
        k = np.clip(np.searchsorted(self._s, s, side="right") - 1, 0, len(self._s) - 2)
        t = np.clip((s - self._s[k]) / np.maximum(self._s[k + 1] - self._s[k], 1e-300), 0.0, 1.0)
        return np.asarray(self._at[k] + t[:, None] * (self._at[k + 1] - self._at[k]))

    def whole(self, line: Ints, along: Points) -> Points:
        """Return arc lengths along all lines laid end to end."""
        return np.asarray(self._first[line] + along)

    def nearest(self, points: Points) -> tuple[Ints, Points, Points]:
        """Return for each point its line or -1, arc length along it, distance to its edge."""
        return self.nearest_feet(points)[:3]

    def nearest_feet(self, points: Points) -> tuple[Ints, Points, Points, Points]:
        """Return what `nearest` does, and the nearest place on the line's axis."""
        at = np.ascontiguousarray(points, np.float64)
        n = len(at)
        which, along, away, feet = np.empty(n, np.int64), np.empty(n), np.empty(n), at.copy()
        parallel_for(
            find_nearest, n, at, *self._grid, self._inverse, self._widest, which, along, away, feet
        )
        line = np.where(which >= 0, self.line_of[which] if len(self.line_of) else -1, -1)
        return line, along, np.where(which >= 0, away, np.inf), feet

    def keep_distance(self, points: Points) -> tuple[Points, NDArray[np.bool_]]:
        """Return points moved so that each keeps its lines' distances, and whether it does.

        A point that finds no such place, between lines too close together, is told by False.
        """
        gap = np.array([k.distance_mm for k in self.lines])[self.line_of]
        out = np.array(points, np.float64)
        held = np.empty(len(out), np.bool_)
        parallel_for(push_out, len(out), out, gap, *self._grid, _TURNS, held)
        return out, held


def _bounds(segments: Points, far: float) -> tuple[Points, Points]:
    at = segments[:, :4].reshape(-1, 2)
    if not len(at):
        return np.zeros(2), np.ones(2)
    return at.min(axis=0) - far, at.max(axis=0) + far


def keeping_distance(lines: Sequence[Line]) -> LineIndex:
    """Return the index for the lines that dots keep a distance from."""
    chosen = [line for line in lines if line.meeting == DISTANCE]
    return LineIndex(chosen, [line.distance_mm for line in chosen])


def adhering(lines: Sequence[Line]) -> LineIndex:
    """Return the index for the lines that dots adhere to."""
    chosen = [line for line in lines if line.meeting == ADHERE]
    return LineIndex(chosen, [line.reach_mm for line in chosen])
