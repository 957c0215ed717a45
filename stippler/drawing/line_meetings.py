"""What lines ask of dots that a hand lays or moves: to keep off, or to line up."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import ON_CURVE, Dots
from stippler.drawing.line import ADHERE, DISTANCE, Line
from stippler.drawing.line_index import LineIndex
from stippler.drawing.run import Holding

Points = NDArray[np.float64]
Flags = NDArray[np.bool_]

_MOST_PARTS = 32
_TOLERANCE_MM = 1e-8
_SAME_MM = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class LineMeetings:
    """The lines that dots keep off, and those that they line up on; hidden ones are neither.

    Attributes
    ----------
    zones : LineIndex or None
    half_mm : float
        Half the width of the narrowest zone: who goes no farther at once does not jump over it.
    adhering : LineIndex or None
    ids : (k,) int32
        What the drawing calls the latter.
    reach_mm : (k,) float64
    """

    zones: LineIndex | None
    half_mm: float
    adhering: LineIndex | None
    ids: NDArray[np.int32]
    reach_mm: Points

    @classmethod
    def of(cls, lines: Mapping[int, object]) -> LineMeetings:
        """Find them among a drawing's lines."""
        seen = {k: one for k, one in lines.items() if isinstance(one, Line) and not one.hidden}
        off = [one for one in seen.values() if one.meeting == DISTANCE]
        half = min((min(one.width_mm) / 2 + one.distance_mm for one in off), default=0.0)
        on = {k: one for k, one in seen.items() if one.meeting == ADHERE and one.reach_mm > 0.0}
        reach = [one.reach_mm for one in on.values()]
        return cls(
            LineIndex(off, [one.distance_mm for one in off]) if off else None, half,
            LineIndex(list(on.values()), reach) if on else None,
            np.array(list(on), np.int32), np.array(reach),
        )  # fmt: skip

    def keep_off(self, points: Points) -> tuple[Points, Flags]:
        """Return points put on the edges of the zones that they lie in, and who found a place."""
        if self.zones is None:
            return points, np.ones(len(points), np.bool_)
        return self.zones.keep_distance(points)

    def are_off(self, points: Points) -> Flags:
        """Tell which points lie in no zone."""
        if self.zones is None:
            return np.ones(len(points), np.bool_)
        moved, held = self.zones.keep_distance(points)
        return np.asarray(held & (np.abs(moved - points).max(axis=1, initial=0.0) <= _TOLERANCE_MM))

    def stopped(
        self, old: Points, new: Points, confine: Callable[[Points], Points], *, hops: bool = False
    ) -> Points:
        """Return moves that end in no zone, and cross none.

        Parameters
        ----------
        confine : callable
            Cuts moves short that leave their areas.
        hops : bool
            Whether a move may end beyond a line, as when a person takes a dot there.

        Notes
        -----
        A dot that comes to a zone slides along its edge. One that finds no place stays, and so does
        one that lies in a zone and would only go to another place in it.
        """
        if self.zones is None or not len(new):
            return new
        far = float(np.hypot(*(new - old).T).max())
        n = math.ceil(far / self.half_mm) if self.half_mm > 0.0 else 1
        n = 1 if hops else min(max(n, 1), _MOST_PARTS)
        step, at = (new - old) / n, old
        for _ in range(n):
            at, _held = self.zones.keep_distance(at + step)
        clear = np.abs(at - new).max(axis=1) < _TOLERANCE_MM  # has met none: goes there straight
        if clear.all():
            return new
        at[clear] = new[clear]
        at = confine(at)
        stays = ~self.are_off(at)
        at[stays] = old[stays]
        return at

    def line_up(self, dots: Dots, apart: Callable[[Points], Flags]) -> None:
        """Let lines hold those new dots that lie within their reach, where there is room for them.

        Parameters
        ----------
        dots : Dots
            Not in the drawing yet; changed.
        apart : callable
            Tells which of some places keep clear of all dots and of the places before them.
        """
        if self.adhering is None or not len(dots):
            return
        line, along, away, feet = self.adhering.nearest_feet(dots.position_mm)
        near = np.flatnonzero((line >= 0) & (away <= self.reach_mm[line]))
        near = near[np.argsort(away[near], kind="stable")]
        if not len(near):
            return
        near = near[apart(feet[near])]
        dots.position_mm[near] = feet[near]
        dots.constraint[near], dots.curve[near] = ON_CURVE, self.ids[line[near]]
        dots.parameter[near] = along[near]

    def hold(self, dots: Dots, holding: Holding) -> None:
        """Let lines hold new dots that lie on them; those whose lines were changed since do not."""
        for k, line in zip(
            self.ids.tolist(), self.adhering.lines if self.adhering else (), strict=True
        ):
            rows = np.flatnonzero(holding.curve == k)
            places = line.at(holding.along_mm[rows])
            fits = np.abs(places - dots.position_mm[rows]).max(axis=1, initial=0.0) < _SAME_MM
            rows, places = rows[fits], places[fits]
            dots.position_mm[rows] = places
            dots.constraint[rows], dots.curve[rows] = ON_CURVE, k
            dots.parameter[rows] = holding.along_mm[rows]
