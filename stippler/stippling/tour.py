"""The order in which a pen goes through dots, and one line through all of them."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tour import improve as moves
from stippler.kernels.tour.neighbours import HILBERT_BITS, hilbert_keys, nearest

Order = NDArray[np.int64]

# kernels have no types
_improve: Callable[..., int] = moves.improve
_disturb: Callable[..., None] = moves.disturb
_uncross: Callable[..., int] = moves.uncross

_NEAR = 8  # neighbours that a move looks at
_MOVES_AT_ONCE = 20_000
_TIMES_AT_ONCE = 4_000
_EPS = 1e-10  # of the largest side: less is no gain but rounding
_SEED = 88172645463325252
_MOST_UNCROSSINGS = 100
_PER_CELL = 2.0
_MOST_CELLS = 4_000_000


def tour(
    points: NDArray[np.float64],
    *,
    closed: bool = False,
    effort: float = 0.0,
    cancel: Callable[[], bool] | None = None,
    show: Callable[[float], None] | None = None,
) -> Order:
    """Find a short way through all points.

    Parameters
    ----------
    points : (n, 2) float64
    closed : bool
        Whether it returns to where it began; else it begins and ends where its longest step was.
    effort : float
        0: about 9 % longer than the shortest, in seconds for a million points. Above: it is
        disturbed and mended so many times a point; 1 leaves about 3 %, 5 about 2 %.
    cancel : callable, optional
        Asked now and then; if it returns True, the way found so far is returned.
    show : callable, optional
        Told the share done.

    Returns
    -------
    (n,) int64
        A permutation. With an effort no two of its steps cross each other.

    Notes
    -----
    O(n log n) and n effort; the same result on any machine. 2-opt and Or-opt with neighbour lists
    (Bentley 1992) from a Hilbert curve; then local double bridges (Martin, Otto, Felten 1992).
    """
    points = np.ascontiguousarray(points, np.float64)
    if len(points) < 5:
        return np.arange(len(points))
    by_curve = _along_hilbert(points)
    work = _Tour(points[by_curve], cancel or (lambda: False), show or (lambda share: None))
    work.improve()
    if effort > 0:
        work.disturb(round(effort * len(points)))
        work.uncross()
    found = by_curve[work.tour]
    return found if closed else _opened(found, points)


def length_of(points: NDArray[np.float64], order: Order, *, closed: bool = False) -> float:
    """Return how long a way through points is."""
    way = points[order]
    steps = np.diff(way, axis=0, append=way[:1]) if closed else np.diff(way, axis=0)
    return float(np.hypot(steps[:, 0], steps[:, 1]).sum())


def _frame(points: NDArray[np.float64]) -> tuple[float, float, float]:
    left, top = points.min(axis=0)
    side = float((points.max(axis=0) - (left, top)).max())
    return float(left), float(top), side if side > 0 else 1.0


def _along_hilbert(points: NDArray[np.float64]) -> Order:
    left, top, side = _frame(points)
    keys = np.empty(len(points), np.int64)
    per_mm = (2**HILBERT_BITS - 1) / side
    parallel_for(hilbert_keys, len(keys), points, left, top, per_mm, keys)
    return np.argsort(keys, kind="stable")


def neighbours(points: NDArray[np.float64], k: int = _NEAR) -> NDArray[np.int32]:
    """Return (n, k) nearest points of each, nearest first; -1 where there are fewer."""
    left, top, extent = _frame(points)
    height = float(points[:, 1].max()) - top
    width = float(points[:, 0].max()) - left
    side = math.sqrt(_PER_CELL * max(width * height, 1e-4 * extent**2) / len(points))
    side = max(side, extent / math.isqrt(_MOST_CELLS))
    columns, rows = int(width / side) + 1, int(height / side) + 1
    column = np.minimum(((points[:, 0] - left) / side).astype(np.int64), columns - 1)
    row = np.minimum(((points[:, 1] - top) / side).astype(np.int64), rows - 1)
    cell = row * columns + column
    order = np.argsort(cell, kind="stable").astype(np.int32)
    start = np.searchsorted(cell[order], np.arange(columns * rows + 1)).astype(np.int32)
    near = np.empty((len(points), k), np.int32)
    grid = order, start, left, top, side, columns, rows
    parallel_for(nearest, len(points), points, *grid, near, grain=512)
    return near


class _Tour:
    def __init__(
        self, xy: NDArray[np.float64], cancel: Callable[[], bool], show: Callable[[float], None]
    ) -> None:
        n = len(xy)
        self.xy, self.cancel, self.show = xy, cancel, show
        self.near = neighbours(xy)
        self.tour = np.arange(n, dtype=np.int32)
        self.place = self.tour.copy()
        self.queue = self.tour.copy()
        self.waiting = np.ones(n, np.bool_)
        self.eps = _EPS * _frame(xy)[2]

    def improve(self) -> None:
        state = np.array([0, len(self.tour)], np.int64)
        args = self.tour, self.place, self.xy, self.near, self.eps, self.queue, self.waiting
        while state[0] < state[1] and not self.cancel():
            _improve(*args, state, _MOVES_AT_ONCE)
        self.waiting[:] = False

    def disturb(self, n_times: int) -> None:
        random = np.array([_SEED], np.uint64)
        args = self.tour, self.place, self.xy, self.near, self.eps, self.queue, self.waiting
        for done in range(0, n_times, _TIMES_AT_ONCE):
            if self.cancel():
                return
            self.show(done / n_times)
            _disturb(*args, random, min(_TIMES_AT_ONCE, n_times - done))

    def uncross(self) -> None:
        for _ in range(_MOST_UNCROSSINGS):
            pairs = crossings(self.xy[self.tour])
            if not len(pairs) or self.cancel():
                return
            after = np.roll(self.tour, -1)
            ends = np.column_stack([self.tour[pairs], after[pairs]])[:, [0, 2, 1, 3]]
            if not _uncross(self.tour, self.place, np.ascontiguousarray(ends, np.int64)):
                return


def crossings(way: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return (m, 2) steps of a closed way that cross each other."""
    import shapely

    steps = shapely.linestrings(np.stack([way, np.roll(way, -1, axis=0)], axis=1))
    first, second = shapely.STRtree(steps).query(steps, predicate="crosses")
    pairs: NDArray[np.int64] = np.column_stack([first, second])[first < second]
    return pairs


def _opened(order: Order, points: NDArray[np.float64]) -> Order:
    way = points[order]
    steps = np.hypot(*(way - np.roll(way, 1, axis=0)).T)
    return np.roll(order, -int(np.argmax(steps)))
