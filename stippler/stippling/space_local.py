"""The rules of even spacing for the few dots under a brush, all others holding still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.kernels.cells.spacing_lanes import NEIGHBOUR
from stippler.kernels.cells.surroundings import move_by_rules, ring_around
from stippler.kernels.cells.tables import Spacing, Stars
from stippler.kernels.cells.tone_wants import find_wants
from stippler.kernels.machine.simd import LANES
from stippler.stippling.relax_local import LocalRelaxation
from stippler.stippling.spacing import Rules
from stippler.stippling.tone import INK_TABLE

Floats = NDArray[np.float64]
Slots = NDArray[np.int32]

_NO_FLAGS = np.empty(0, np.uint8)
_ONE_LEVEL = np.array([[1.0, 0.0]])  # any table: what dots want is not asked of it
_NO_RADII = np.empty(0)
_NO_DOTS = np.empty(0, np.bool_)


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
        cells = np.empty((n_slots, 6))
        stars = Stars(np.empty((n_slots, LANES), np.int32), np.zeros(n_slots, np.uint8), _NO_FLAGS)
        self._compute(chosen, cells, stars)
        is_known = np.zeros(n_slots, np.uint8)
        is_known[chosen] = 1
        ring = np.empty(n_slots, np.int32)
        ring = ring[: ring_around(chosen, stars.around, stars.n, is_known, ring)]
        measured = np.concatenate([chosen, ring])
        self._compute(ring, cells, stars)
        number = self._dot_of_slot[measured]
        wants, is_solved = np.empty((n_slots, 3)), np.empty(len(measured), np.bool_)
        find_wants(
            measured, self._compartment_of_slot, len(self._parts), stars.around, stars.n, cells,
            _NO_RADII if radius_mm is None else radius_mm[number],
            _NO_DOTS if is_met is None else is_met[number], INK_TABLE, wants, is_solved,
        )  # fmt: skip
        self._move_by(rules, chosen, cells, stars, wants)
        return Spaced(
            np.column_stack([self._moves.x[chosen], self._moves.y[chosen]]),
            wants[chosen, NEIGHBOUR], is_solved[: len(chosen)],
            np.column_stack([self._xs[measured], self._ys[measured]]),
            np.sqrt(cells[measured, 5]),
        )  # fmt: skip

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
