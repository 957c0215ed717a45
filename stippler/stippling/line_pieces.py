"""The pieces of lines that dots may lie on, and dots spread evenly along all of them at once."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.line import Line

Points: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
Tone: TypeAlias = Callable[[Points], Points]
"""From places to how many dots they want, relatively."""

_JOINED_MM = 1e-3  # polygons of a pattern that share an edge are parted by less
_LEAST_MM = 1e-6
_MOST_SAMPLES = 4096
_LEAST_TONE = 1e-6  # of the largest


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """Stretches of lines that lie within some polygons; arc lengths in mm.

    Attributes
    ----------
    line : (p,) int64
        Which line each is of; ascending.
    begin, length : (p,) float64
        On a closed line, one may go on past the line's start.
    is_ring : (p,) bool
        Whether it is the whole of a closed line.
    turn : (p,) float64
        The whole length of a closed line; 0 of others.
    """

    line: Ints
    begin: Points
    length: Points
    is_ring: NDArray[np.bool_]
    turn: Points

    def __len__(self) -> int:
        return len(self.line)

    @classmethod
    def within(cls, lines: Sequence[Line], parts: Sequence[shapely.Geometry]) -> Pieces:
        """Return what of each line lies in some polygons; pieces that all but meet are one."""
        whole = shapely.union_all(list(parts))
        shapely.prepare(whole)
        rows = [
            (k, begin, length, ring, line.length_mm if line.is_closed else 0.0)
            for k, line in enumerate(lines)
            for begin, length, ring in _stretches(line, whole)
        ]
        table = np.array(rows, np.float64).reshape(-1, 5)
        return cls(table[:, 0].astype(np.int64), table[:, 1], table[:, 2], table[:, 3] > 0.0,
                   table[:, 4])  # fmt: skip

    def along(self, piece: Ints, u: Points) -> Points:
        """Return arc lengths along the lines of places along pieces."""
        s, turn = self.begin[piece] + u, self.turn[piece]
        return np.where(turn > 0.0, s % np.where(turn > 0.0, turn, 1.0), s)

    def find(self, line: Ints, along: Points) -> tuple[Ints, Points]:
        """Return the piece that each place of a line is on, or -1, and how far along it is."""
        piece, u = np.full(len(line), -1, np.int64), np.zeros(len(line))
        if not len(self):
            return piece, u
        first = np.searchsorted(self.line, line)
        n_tries = int(np.bincount(self.line).max())
        for k in range(n_tries):
            p = np.minimum(first + k, len(self) - 1)
            off, turn = along - self.begin[p], self.turn[p]
            off = np.where(turn > 0.0, off % np.where(turn > 0.0, turn, 1.0), off)
            fits = (self.line[p] == line) & (piece < 0)
            fits &= (off >= -_LEAST_MM) & (off <= self.length[p] + _LEAST_MM)
            piece[fits] = p[fits]
            u[fits] = np.clip(off, 0.0, self.length[p])[fits]
        return piece, u


def _stretches(line: Line, whole: shapely.Geometry) -> list[tuple[float, float, bool]]:
    """Return begin and length of each stretch of a line within a polygon; whether it is a ring."""
    at, s = line.path.points_mm, line.arc_lengths()
    if shapely.covers(whole, shapely.linestrings(at)):
        return [(0.0, float(s[-1]), line.is_closed)]
    segments = shapely.linestrings(np.stack([at[:-1], at[1:]], axis=1))
    meets = np.flatnonzero(shapely.intersects(whole, segments))
    cut, which = shapely.get_parts(shapely.intersection(segments[meets], whole), return_index=True)
    is_line = shapely.get_type_id(cut) == 1
    cut, which = cut[is_line], meets[which[is_line]]
    if not len(cut):
        return []
    ends = shapely.get_coordinates(cut).reshape(-1, 2, 2)
    along = s[which, None] + np.hypot(*np.moveaxis(ends - at[which, None], 2, 0))
    along = np.sort(along, axis=1)
    along = along[np.argsort(along[:, 0], kind="stable")]
    return _joined(along, float(s[-1]), line.is_closed)


def _joined(along: Points, length: float, closed: bool) -> list[tuple[float, float, bool]]:
    """Join intervals that all but meet; on a closed line the last and the first, too."""
    found: list[list[float]] = []
    for begin, end in along.tolist():
        if found and begin <= found[-1][1] + _JOINED_MM:
            found[-1][1] = max(found[-1][1], end)
        else:
            found.append([begin, end])
    if closed and found[0][0] <= _JOINED_MM and found[-1][1] >= length - _JOINED_MM:
        if len(found) == 1:
            return [(0.0, length, True)]
        first = found.pop(0)
        found[-1][1] = length + first[1]
    return [(b, e - b, False) for b, e in found if e - b > _LEAST_MM]


class Measure:
    """The tone's integral along pieces: in it, dots that are evenly apart are as dense as it says.

    Parameters
    ----------
    pieces : Pieces
    at : callable
        From lines and arc lengths to places, mm.
    n_samples : (p,) int64
        In how many steps the tone is looked at; at least one.
    tone : callable, optional
        Even if left out.
    """

    def __init__(
        self,
        pieces: Pieces,
        at: Callable[[Ints, Points], Points],
        n_samples: Ints,
        tone: Tone | None = None,
    ) -> None:
        n = np.ones(len(pieces), np.int64) if tone is None else np.minimum(n_samples, _MOST_SAMPLES)
        owner = np.repeat(np.arange(len(pieces)), n)
        start = np.cumsum(n) - n
        share = (np.arange(len(owner)) - start[owner] + 0.5) / n[owner]
        wanted = np.ones(len(owner))
        if tone is not None and len(owner):
            middles = pieces.along(owner, share * pieces.length[owner])
            wanted = np.maximum(tone(at(pieces.line[owner], middles)), 0.0)
            top = np.maximum.reduceat(wanted, start)
            wanted = np.maximum(wanted, _LEAST_TONE * np.maximum(top, 1e-300)[owner])
        step = (pieces.length / n)[owner]
        mass = wanted * step
        self.whole: Points = np.bincount(owner, mass, len(pieces)).astype(np.float64)
        self._first_u = np.cumsum(pieces.length + 1.0) - pieces.length
        self._first_m = np.cumsum(self.whole + 1.0) - self.whole
        u, m = (np.empty(len(owner) + len(pieces)) for _ in range(2))
        row = np.arange(len(owner)) + owner  # the ends of steps, after each piece's own start
        summed = np.cumsum(mass)
        u[row + 1] = self._first_u[owner] + (share + 0.5 / n[owner]) * pieces.length[owner]
        m[row + 1] = self._first_m[owner] + summed - (summed[start] - mass[start])[owner]
        first = start + np.arange(len(pieces))
        u[first], m[first] = self._first_u, self._first_m
        self._u, self._m = u, m

    def mass(self, piece: Ints, u: Points) -> Points:
        """Return the tone's integral up to places along pieces."""
        return np.interp(self._first_u[piece] + u, self._u, self._m) - self._first_m[piece]

    def place(self, piece: Ints, mass: Points) -> Points:
        """Return the places along pieces up to which the integral is so much."""
        return np.interp(self._first_m[piece] + mass, self._m, self._u) - self._first_u[piece]


def evened(
    piece: Ints, mass: Points, still: NDArray[np.bool_], whole: Points, ring: NDArray[np.bool_]
) -> Points:
    """Return where dots on pieces lie evenly between those that stay, in their measure.

    Parameters
    ----------
    piece : (n,) int64
    mass : (n,) float64
        Where each is; their order along a piece is kept.
    still : (n,) bool
    whole, ring : (p,)
        Of each piece: its measure, and whether it is closed.

    Notes
    -----
    Between dots that stay all gaps are alike; half a gap lies beyond the first and last dot of an
    open piece. There the energy of Lloyd's relaxation in one dimension is least, and it is convex.
    """
    start_of = np.cumsum(whole + 1.0) - whole
    order = np.argsort(start_of[piece] + mass, kind="stable")  # quick where it is sorted already
    owner, m = piece[order], mass[order]
    n = np.bincount(owner, minlength=len(whole))
    start = np.cumsum(n) - n
    rank = np.arange(len(owner)) - start[owner]
    rank_0 = np.cumsum(3.0 * n + 4.0) - n - 2.0  # pieces end to end, with room before and after
    mass_0 = np.cumsum(3.0 * whole + 1.0) - whole
    anchors = np.flatnonzero(still[order])
    has = np.flatnonzero(n)
    first, last = _first_and_last(anchors, owner, len(whole))
    held = first[has] >= 0
    is_ring, is_open = ring[has], ~ring[has]
    off = np.bincount(owner, m - rank * (whole / np.maximum(n, 1))[owner], len(whole))[has] / n[has]
    a, z = np.maximum(first[has], 0), np.maximum(last[has], 0)
    around = is_ring & held
    low_rank = np.where(is_open, -0.5, np.where(around, rank[z] - n[has], 0.0))
    low_mass = np.where(is_open, 0.0, np.where(around, m[z] - whole[has], off))
    high_rank = np.where(is_open, n[has] - 0.5, np.where(around, rank[a] + n[has], n[has] + 0.0))
    once_more = np.where(around, m[a], off) + whole[has]
    high_mass = np.where(is_open, whole[has], once_more)
    x = np.concatenate([low_rank + rank_0[has], high_rank + rank_0[has],
                        (rank + rank_0[owner])[anchors]])  # fmt: skip
    y = np.concatenate([low_mass + mass_0[has], high_mass + mass_0[has],
                        (m + mass_0[owner])[anchors]])  # fmt: skip
    by_rank = np.argsort(x, kind="stable")
    goal = np.interp(rank + rank_0[owner], x[by_rank], y[by_rank]) - mass_0[owner]
    goal[anchors] = m[anchors]
    out = np.empty(len(mass))
    out[order] = np.where(ring[owner], goal % np.maximum(whole[owner], 1e-300), goal)
    return out


def _first_and_last(anchors: NDArray[np.intp], owner: Ints, n: int) -> tuple[Ints, Ints]:
    """Return the first and the last anchor of each piece, -1 where there is none."""
    first, last = np.full(n, -1, np.int64), np.full(n, -1, np.int64)
    last[owner[anchors]] = anchors
    first[owner[anchors[::-1]]] = anchors[::-1]
    return first, last
