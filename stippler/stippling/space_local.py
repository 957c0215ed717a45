"""The rules of even spacing for the few dots under a brush, all others holding still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.kernels.cells.spacing import HEXAGONAL
from stippler.kernels.cells.spacing_lanes import MASS, NEIGHBOUR, RADIUS
from stippler.kernels.cells.surroundings import mean_among_alike, move_by_rules, ring_around
from stippler.kernels.cells.tables import Spacing, Stars
from stippler.kernels.machine.simd import LANES
from stippler.stippling.relax_local import LocalRelaxation
from stippler.stippling.spacing import Rules
from stippler.stippling.tone import ink_for

Floats = NDArray[np.float64]
Slots = NDArray[np.int32]

SOLVED = 0.1
"""A size nearer to what its cell's ink asks for than this share of it was solved for the tone."""

_ALIKE = 0.08  # darkness; dots whose tones differ by less have sizes in common
_OWN = 0.7  # of a dot's area; what differs by more from that of the dots around is meant
_FAR = 1e-30
_NO_FLAGS = np.empty(0, np.uint8)
_ONE_LEVEL = np.array([[1.0, 0.0]])  # any table: what dots want is not asked of it
_NO_RADII = np.empty(0)


@dataclass(frozen=True, slots=True, eq=False)
class Spaced:
    """Where the rules take some dots, and what is known of their cells and of those around.

    Attributes
    ----------
    moved_mm : (k, 2) float64
    apart_mm : (k,) float64
        How far the dots are to be from their neighbours.
    is_solved : (k,) bool
        Whether the dots have the sizes that their cells' tone asks for.
    at_mm : (m, 2) float64
        Places of all dots that were measured: those asked for, then those around them.
    reach_mm : (m,) float64
        Distance of the farthest corner of their cells.
    """

    moved_mm: Floats
    apart_mm: Floats
    is_solved: NDArray[np.bool_]
    at_mm: Floats
    reach_mm: Floats


class LocalSpacing(LocalRelaxation):
    """As `LocalRelaxation`, by the rules of even spacing (see `stippler.kernels.cells.spacing`).

    A step measures the cells of the dots asked for and of those around them, and then moves the
    former by the stars that it has found: what a dot and its neighbours want is known before any
    of them moves.
    """

    def space(
        self,
        dots: ArrayLike,
        rules: Rules,
        radius_mm: Floats | None = None,
        is_met: NDArray[np.bool_] | None = None,
    ) -> Spaced:
        """Return where a step of the rules would take dots; nothing moves.

        Parameters
        ----------
        dots : (k,) array_like of int
            Each once; leave fixed dots out.
        radius_mm : (n,) float64, optional
            Sizes of all dots, by number: dots are then to be as dense as the tone asks for with
            these. Without them dots are to be equally dense.
        is_met : (n,) bool, optional
            Dots, by number, whose mass counts as what they want: nothing is known of all of it.
        """
        chosen = self._slot_of_dot[np.asarray(dots, np.int32)]
        n_slots = len(self._moves.x)
        cells = np.zeros((n_slots, 6))
        stars = Stars(np.zeros((n_slots, LANES), np.int32), np.zeros(n_slots, np.uint8), _NO_FLAGS)
        self._compute(chosen, cells, stars)
        is_known = np.zeros(n_slots, np.uint8)
        is_known[chosen] = 1
        ring = np.empty(n_slots, np.int32)
        ring = ring[: ring_around(chosen, stars.around, stars.n, is_known, ring)]
        measured = np.concatenate([chosen, ring])
        self._compute(ring, cells, stars)
        is_solved = np.zeros(len(measured), np.bool_)
        per_area, radii = np.ones(len(measured)), np.zeros(len(measured))
        if radius_mm is not None:
            is_solved, per_area, radii = self._by_tone(measured, cells, stars, radius_mm)
        mass = cells[measured, 3] * per_area
        met = None if is_met is None else is_met[self._dot_of_slot[measured]]
        wants = self._wants(measured, mass, per_area, radii, met)
        self._move_by(rules, chosen, cells, stars, wants)
        return Spaced(
            np.column_stack([self._moves.x[chosen], self._moves.y[chosen]]),
            wants[chosen, NEIGHBOUR], is_solved[: len(chosen)],
            np.column_stack([self._xs[measured], self._ys[measured]]),
            np.sqrt(cells[measured, 5]),
        )  # fmt: skip

    def _by_tone(
        self, measured: Slots, cells: Floats, stars: Stars, radius_mm: Floats
    ) -> tuple[NDArray[np.bool_], Floats, Floats]:
        """Return which sizes are solved, dots per area, and how large dots of a tone are.

        Sizes solved for the tone follow their cells, whatever the spacing; so what counts is their
        mean among neighbours of about the same tone. Dots that stand out among these have a size
        of their own.
        """
        mass, area = cells[measured, 0], cells[measured, 3]
        darkness = mass / np.maximum(area, _FAR)
        ink = area * ink_for(darkness)
        own = radius_mm[self._dot_of_slot[measured]]
        squared = own * own
        place = np.full(len(self._moves.x), -1, np.int32)
        place[measured] = np.arange(len(measured), dtype=np.int32)
        mean = np.empty(len(measured))
        mean_among_alike(measured, stars.around, stars.n, place, darkness, _ALIKE, squared, mean)
        asked = np.sqrt(ink * (1.0 / np.pi))
        is_solved = np.abs(own - asked) < SOLVED * asked
        squared = np.where(np.abs(squared - mean) < _OWN * mean, mean, squared)
        per_area = ink / np.maximum(area * np.pi * squared, _FAR)
        return is_solved, per_area, np.sqrt(squared)

    def _wants(
        self,
        measured: Slots,
        mass: Floats,
        per_area: Floats,
        radii: Floats,
        is_met: NDArray[np.bool_] | None,
    ) -> Floats:
        """Return what dots want, by slot, made to fit how many of each compartment there are.

        Dots that were not measured, beyond cells of very many sides, want what others do on
        average.
        """
        count, total = len(mass), float(mass.sum())
        unit = np.array(count / total if total > 0.0 else 1.0)
        if len(self._parts) > 1:
            owner = self._compartment_of_slot[measured]
            counts, sums = np.bincount(owner), np.bincount(owner, mass)
            unit = np.divide(counts, sums, out=np.ones(len(sums)), where=sums > 0.0)[owner]
        apart = np.sqrt(HEXAGONAL / np.maximum(per_area * unit, _FAR))
        wants = np.empty((len(self._moves.x), 3))
        wants[:] = (1.0, apart.mean(), radii.mean()) if count else 1.0
        mass = mass * unit
        wants[measured, MASS] = mass if is_met is None else np.where(is_met, 1.0, mass)
        wants[measured, NEIGHBOUR] = apart
        wants[measured, RADIUS] = radii
        return wants

    def _move_by(
        self, rules: Rules, chosen: Slots, cells: Floats, stars: Stars, wants: Floats
    ) -> None:
        """Move the chosen by what all want; those at a border from cells made once more."""
        of_part = np.array([(0.0, 1.0, 1.0, 1.0)] * len(self._parts))
        spacing = Spacing(
            wants, np.empty_like(wants), _ONE_LEVEL, of_part, _NO_RADII, rules.array()
        )  # fmt: skip
        todo = np.empty(len(chosen), np.uint8)
        move_by_rules(chosen, self._dots, self._table, cells, stars, spacing, self._moves, todo)
        left = chosen[todo != 0]
        if len(left):
            self._compute(left, spacing=spacing)
