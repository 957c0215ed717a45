"""Dots on lines while all others are relaxed: they spread along theirs, and free ones join them."""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Self

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.line import ADHERE
from stippler.drawing.line_index import LineIndex
from stippler.stippling.line_pieces import Measure, Pieces, evened
from stippler.stippling.lines import Tone, crossings
from stippler.stippling.task import MetLines

Points = NDArray[np.float64]
Flags = NDArray[np.bool_]
Ints = NDArray[np.int64]

_Found = tuple[Ints, Points, Points, Points]

_HEXAGONAL = 1.0745699318235419  # distance of neighbours, over the root of the area of each
_AROUND = 12  # dots by which the spacing beside a line is measured
_SAMPLES = 8  # of the tone, for each dot that a piece has room for
_LANDS = 0.5  # spacings from a line, at which a dot that is drawn comes onto it
_DRAWN = 0.5  # of the way to the line, a step
_IN_CROSSING_MM = 1e-6
_REFUSED_MM = 1e-9  # a dot that is so far from where it was sent has not gone there
_NEAR_CROSSING = 0.75  # mean distances along the line, at which a dot goes into a crossing
_MOST_PLACES = 512  # of a piece, where spacing is measured


class OnLines:
    """Chooses where a step of relaxation takes dots that lie on lines, or are drawn onto them.

    Dots on a line move along it, so that each has the same part of its tone, by arc length; where
    two lines cross, one dot lies in the crossing. As long as a line that dots adhere to has fewer
    dots than fit at the spacing around it, the nearest free ones within its reach are drawn to it.

    It is the `redirect` of `stippler.stippling.relax.Relaxation.step`, once for each step.

    Parameters
    ----------
    met : MetLines
    points : (n, 2) float64, mm
        All dots.
    parts : sequence of polygons
        What they do not leave.
    tone : callable, optional
        How dense they are to lie along lines; even if left out.
    stays : (n,) bool, optional
        Dots that do not move; others on their lines lie evenly between them.

    Attributes
    ----------
    line, along : (n,) int64 and float64
        The line that each dot lies on, or -1, and the arc length there.
    may_cross : (n,) bool
        Dots on lines, which may go from one compartment to another.
    drawn : (n,) bool
        Free dots that the last step drew to a line.
    """

    def __init__(
        self,
        met: MetLines,
        points: Points,
        parts: Sequence[shapely.Geometry],
        tone: Tone | None = None,
        stays: Flags | None = None,
    ) -> None:
        self._lines = met.lines
        self._stays = np.zeros(len(points), np.bool_) if stays is None else stays
        self._at = LineIndex(met.lines, 0.0)
        self._pieces = Pieces.within(met.lines, parts)
        self.line = met.line_of_dot.astype(np.int64)
        self.along = met.along_mm.astype(np.float64)
        self._start = np.cumsum(self._pieces.length + 1.0) - self._pieces.length
        self._piece, self._u = self._pieces.find(self.line, self.along)
        self._free = met.may_join & (self.line < 0)
        self.may_cross = self._piece >= 0
        self.drawn = np.zeros(len(points), np.bool_)
        self._sent: tuple[Ints, Points] = (np.empty(0, np.int64), np.empty((0, 2)))
        self._kept = (self.line, self.along, self._piece, self._u)
        self._drawing = np.array([k.meeting == ADHERE and not k.hidden for k in met.lines], bool)
        self._measure_room(points)
        n_samples = np.maximum(64, _SAMPLES * np.maximum(self._room, self._n_on()))
        self._measure = Measure(self._pieces, self._at.at, n_samples, tone)
        self._note_crossings()
        self._n_spread, self._is_even = -1, False
        self._members: tuple[Ints, Points] = (np.empty(0, np.int64), np.empty((0, 2)))
        self._close: tuple[Points, Ints] | None = None

    @property
    def is_idle(self) -> bool:
        """Whether no dot lies on a line, and none will."""
        return not ((self._piece >= 0).any() or (self._has_room() and self._free.any()))

    @property
    def on(self) -> Flags:
        """Which dots lie on lines, and may move along them."""
        return self._piece >= 0

    def copy(self) -> Self:
        """Return one that goes on from here by itself."""
        return copy.copy(self)  # arrays are replaced, never written

    def __call__(self, before: Points, wanted: Points) -> Points:
        """Return where dots shall go instead of where a step would take them."""
        self.take_back_refused(before)
        self._kept = (self.line, self.along, self._piece, self._u)
        self.may_cross = self._piece >= 0
        chosen = wanted
        self.drawn = np.zeros(len(before), np.bool_)
        if self._has_room():
            self._draw_near(before, chosen)
        if not self._is_even:
            self._spread()
        mine, places = self._members
        chosen[mine] = places
        self._sent = self._members
        return chosen

    def take_back_refused(self, points: Points) -> None:
        """Take note of where dots have come to lie: some may not have gone where they were sent."""
        mine, sent = self._sent
        back = mine[np.abs(points[mine] - sent).max(axis=1, initial=0.0) > _REFUSED_MM]
        self._sent = self._sent[0][:0], self._sent[1][:0]
        if not len(back):
            return
        names = ("line", "along", "_piece", "_u")
        for name, kept in zip(names, self._kept, strict=True):
            values = getattr(self, name).copy()
            values[back] = kept[back]
            setattr(self, name, values)
        free = self._free.copy()
        free[back] = False  # what could not join will not
        self._free, self._is_even = free, False

    # --- room -------------------------------------------------------------------------------

    def _n_on(self) -> Ints:
        return np.bincount(self._piece[self._piece >= 0], minlength=len(self._pieces))

    def _measure_room(self, points: Points) -> None:
        """Find how many dots fit on each piece at the spacing of those around it."""
        pieces = self._pieces
        self._room = np.zeros(len(pieces), np.int64)
        self._spacing = np.ones(len(pieces))
        drawing = np.flatnonzero(self._drawing[pieces.line]) if len(pieces) else pieces.line
        if not len(drawing) or not len(points) or not self._free.any():
            self._near: LineIndex | None = None
            return
        from scipy.spatial import KDTree

        typical = float(np.sqrt(np.prod(np.ptp(points, axis=0)) / len(points))) or 1.0
        length = pieces.length[drawing]
        n = np.clip(np.ceil(2.0 * length / typical), 4, _MOST_PLACES).astype(np.int64)
        owner = np.repeat(np.arange(len(drawing)), n)
        share = (np.arange(len(owner)) - (np.cumsum(n) - n)[owner] + 0.5) / n[owner]
        of_piece = drawing[owner]
        along = pieces.along(of_piece, share * pieces.length[of_piece])
        places = self._at.at(pieces.line[of_piece], along)
        k = min(_AROUND, len(points))
        far = np.asarray(KDTree(points).query(places, k=[k])[0])[:, 0]
        spacing = _HEXAGONAL * np.sqrt(np.pi / max(k - 0.5, 0.5)) * far
        per_mm = np.bincount(owner, 1.0 / np.maximum(spacing, 1e-9)) / n
        self._room[drawing] = np.rint(per_mm * length).astype(np.int64)
        self._spacing[drawing] = 1.0 / per_mm
        lines = [k for k, draws in enumerate(self._drawing) if draws]
        self._line_of_near = np.array(lines, np.int64)
        self._reach = np.array([self._lines[k].reach_mm for k in lines])
        self._slack = typical
        self._near = LineIndex([self._lines[k] for k in lines], (self._reach + typical).tolist())

    def _lacks(self) -> Ints:
        """Return how many dots more there is room for on each piece."""
        return np.asarray(np.maximum(self._room - self._n_on() - self._n_ghosts(), 0))

    def _has_room(self) -> bool:
        return self._near is not None and bool((self._lacks() > 0).any())

    def _draw_near(self, before: Points, chosen: Points) -> None:
        """Draw the nearest free dots to pieces that have room; those close by come onto them."""
        assert self._near is not None
        rows, found = self._within_reach(before)
        which, along, away, feet = found or self._near.nearest_feet(before[rows])
        close = (which >= 0) & (away <= self._reach[which])
        rows, which, along, feet = rows[close], which[close], along[close], feet[close]
        line = self._line_of_near[which]
        piece, u = self._pieces.find(line, along)
        off = np.hypot(*(feet - before[rows]).T)
        order = np.lexsort((rows, off, piece))
        order = order[piece[order] >= 0]
        n = np.bincount(piece[order], minlength=len(self._pieces))
        place = np.arange(len(order)) - (np.cumsum(n) - n)[piece[order]]
        some = order[place < self._lacks()[piece[order]]]
        chosen[rows[some]] = before[rows[some]] + _DRAWN * (feet[some] - before[rows[some]])
        self.drawn[rows[some]] = True
        lands = some[off[some] <= _LANDS * self._spacing[piece[some]]]
        if not len(lands):
            return
        self._is_even = False
        for name, values in (("line", line), ("along", along), ("_piece", piece), ("_u", u)):
            changed = getattr(self, name).copy()
            changed[rows[lands]] = values[lands]
            setattr(self, name, changed)

    def _within_reach(self, points: Points) -> tuple[Ints, _Found | None]:
        """Return the free dots that may be within reach; with their lines, if just looked for.

        Until dots have gone half the slack, no other can have come so near.
        """
        assert self._near is not None
        if self._close is not None and np.abs(points - self._close[0]).max() <= 0.5 * self._slack:
            rows = self._close[1]
            return rows[self._free[rows] & (self._piece[rows] < 0)], None
        rows = np.flatnonzero(self._free & (self._piece < 0))
        found = self._near.nearest_feet(points[rows])
        which, away = found[0], found[2]
        lacks = np.bincount(self._pieces.line, self._lacks(), len(self._lines)) > 0
        near = (which >= 0) & (away <= self._reach[which] + self._slack)
        near &= lacks[self._line_of_near[which]]
        self._close = points, rows[near]
        return rows[near], (which[near], found[1][near], away[near], found[3][near])

    # --- crossings --------------------------------------------------------------------------

    def _note_crossings(self) -> None:
        """Find where pieces cross: on each of the two, how far along."""
        used = np.unique(self._pieces.line).tolist()
        found = [
            (used[i], s, used[j], t) for i, s, j, t in crossings([self._lines[k] for k in used])
        ]
        table = np.array(found, np.float64).reshape(-1, 4)
        sides = [
            self._pieces.find(table[:, 2 * k].astype(np.int64), table[:, 2 * k + 1]) for k in (0, 1)
        ]
        both = (sides[0][0] >= 0) & (sides[1][0] >= 0)
        self._cross_piece = np.stack([sides[0][0][both], sides[1][0][both]])
        self._cross_u = np.stack([sides[0][1][both], sides[1][1][both]])
        n = int(both.sum())
        self._pinned, self._side = np.full(n, -1, np.int64), np.zeros(n, np.int64)

    def _n_ghosts(self) -> Ints:
        """Return how many crossings on each piece are taken by a dot of the other."""
        taken = np.flatnonzero(self._pinned >= 0)
        other = self._cross_piece[1 - self._side[taken], taken]
        return np.bincount(other, minlength=len(self._pieces))

    def _keep_pins(self, mine: Ints) -> bool:
        """Pin the dots that lie in crossings already; return whether there are any."""
        n_before = self._n_on()
        pinned, side = self._pinned.copy(), self._side.copy()
        for k in (0, 1):
            todo = np.flatnonzero(pinned < 0)
            if len(todo) and n_before.any():
                near, off = self._nearest_on(
                    mine, self._cross_piece[k, todo], self._cross_u[k, todo]
                )
                there = (near >= 0) & (off <= _IN_CROSSING_MM)
                pinned[todo[there]], side[todo[there]] = near[there], k
        self._pinned, self._side = pinned, side
        return bool((pinned >= 0).any())

    def _pin(self, mine: Ints) -> None:
        """Have a dot lie in each crossing that has none, if one is near enough on either line."""
        n = self._n_on()
        pinned, side = self._pinned.copy(), self._side.copy()
        for k in (0, 1):
            todo = np.flatnonzero(pinned < 0)
            free = mine[~(np.isin(mine, pinned) | self._stays[mine])]
            if not len(todo) or not len(free):
                break
            piece, u = self._cross_piece[k, todo], self._cross_u[k, todo]
            near, off = self._nearest_on(free, piece, u)
            fits = (near >= 0) & (
                off <= _NEAR_CROSSING * self._pieces.length[piece] / np.maximum(n[piece], 1)
            )
            todo, near, off = todo[fits], near[fits], off[fits]
            order = np.lexsort((todo, off))
            dots, first = np.unique(near[order], return_index=True)  # one dot, one crossing
            pinned[todo[order[first]]], side[todo[order[first]]] = dots, k
        self._pinned, self._side = pinned, side

    def _nearest_on(self, dots: Ints, piece: Ints, u: Points) -> tuple[Ints, Points]:
        """Return for places on pieces the nearest of some dots there, or -1, and how far it is."""
        keys = self._start[self._piece[dots]] + self._u[dots]
        by_place = np.argsort(keys, kind="stable")
        order, keys = dots[by_place], keys[by_place]
        k = np.searchsorted(keys, self._start[piece] + u)
        best, least = np.full(len(u), -1, np.int64), np.full(len(u), np.inf)
        for row in (k - 1, k):
            ok = (row >= 0) & (row < len(order))
            dot = order[np.clip(row, 0, len(order) - 1)]
            off = np.where(ok & (self._piece[dot] == piece), np.abs(self._u[dot] - u), np.inf)
            nearer = off < least
            best[nearer], least[nearer] = dot[nearer], off[nearer]
        return best, least

    # --- spreading --------------------------------------------------------------------------

    def _spread(self) -> None:
        """Spread the dots on all pieces evenly, in one dimension."""
        mine = np.flatnonzero(self._piece >= 0)
        if not len(mine):
            self._members = mine, np.empty((0, 2))
            return
        mine = mine[np.argsort(self._start[self._piece[mine]] + self._u[mine], kind="stable")]
        if len(self._pinned) and len(mine) != self._n_spread:
            if self._n_spread >= 0 or not self._keep_pins(mine):
                self._pinned = np.full(len(self._pinned), -1, np.int64)
                self._move_evenly(mine)  # so that as many as fit lie between crossings
            self._pin(mine)
        self._n_spread, self._is_even = len(mine), True
        self._move_evenly(mine)
        along = self.along.copy()
        along[mine] = self._pieces.along(self._piece[mine], self._u[mine])
        self.along = along
        self._members = mine, self._at.at(self.line[mine], along[mine])

    def _move_evenly(self, mine: Ints) -> None:
        """Move dots along pieces, to lie evenly between those in crossings."""
        taken = np.flatnonzero(self._pinned >= 0)
        dots, side = self._pinned[taken], self._side[taken]
        all_u = self._u.copy()
        all_u[dots] = self._cross_u[side, taken]
        is_pinned = np.zeros(len(all_u), np.bool_)
        is_pinned[dots] = True
        piece = np.concatenate([self._piece[mine], self._cross_piece[1 - side, taken]])
        u = np.concatenate([all_u[mine], self._cross_u[1 - side, taken]])
        is_pinned |= self._stays
        still = np.concatenate([is_pinned[mine], np.ones(len(taken), np.bool_)])
        mass = self._measure.mass(piece, u)
        goal = evened(piece, mass, still, self._measure.whole, self._pieces.is_ring)
        moves = np.flatnonzero(~still[: len(mine)])
        all_u[mine[moves]] = self._measure.place(piece[moves], goal[moves])
        self._u = all_u
