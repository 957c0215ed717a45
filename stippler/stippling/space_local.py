"""The rules of even spacing for the few dots under a brush, all others holding still."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.kernels.cells.kept_cells import verify_stars
from stippler.kernels.cells.relaxation import INNER, RIM
from stippler.kernels.cells.spacing import HEXAGONAL
from stippler.kernels.cells.spacing_lanes import MASS, NEIGHBOUR, RADIUS
from stippler.kernels.cells.surroundings import mean_among_alike, ring_around
from stippler.kernels.cells.tables import Spacing, Stars
from stippler.kernels.machine.pool import parallel_for
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
    ink_mm2, per_ink : (k,) float64
        The ink that the dots' cells ask for, 0 without a picture; the square of the radius for
        each mm2 of it that was solved for the tone around here, 0 where a dot's was not.
    at_mm : (m, 2) float64
        Places of all dots that were measured: those asked for, then those around them.
    reach_mm : (m,) float64
        Distance of the farthest corner of their cells.
    """

    moved_mm: Floats
    ink_mm2: Floats
    per_ink: Floats
    at_mm: Floats
    reach_mm: Floats


class LocalSpacing(LocalRelaxation):
    """As `LocalRelaxation`, by the rules of even spacing (see `stippler.kernels.cells.spacing`).

    A step measures the cells of the dots asked for and of those around them, and then moves the
    former by the stars that it has found: what a dot and its neighbours want is known before any
    of them moves.
    """

    def space(self, dots: ArrayLike, rules: Rules, radius_mm: Floats | None = None) -> Spaced:
        """Return where a step of the rules would take dots; nothing moves.

        Parameters
        ----------
        dots : (k,) array_like of int
            Each once; leave fixed dots out.
        radius_mm : (n,) float64, optional
            Sizes of all dots, by number: dots are then to be as dense as the tone asks for with
            these. Without them dots are to be equally dense.
        """
        chosen = self._slot_of_dot[np.asarray(dots, np.int32)]
        n_slots = len(self._moves.x)
        cells = np.zeros((n_slots, 6))
        stars = Stars(np.zeros((n_slots, LANES), np.int32), np.zeros(n_slots, np.uint8), _NO_FLAGS)
        self._compute(chosen, cells, stars)
        kinds = self._moves.kind[chosen]
        is_known = np.zeros(n_slots, np.uint8)
        is_known[chosen] = 1
        ring = np.empty(n_slots, np.int32)
        ring = ring[: ring_around(chosen, stars.around, stars.n, is_known, ring)]
        measured = np.concatenate([chosen, ring])
        self._compute(ring, cells, stars)
        ink, per_ink = np.zeros((2, len(measured)))
        per_area, radii = np.ones(len(measured)), np.zeros(len(measured))
        if radius_mm is not None:
            ink, per_ink, per_area, radii = self._by_tone(measured, cells, stars, radius_mm)
        wants = self._wants(measured, cells[measured, 3] * per_area, per_area, radii)
        self._move_by(rules, chosen, kinds, stars, wants)
        return Spaced(
            np.column_stack([self._moves.x[chosen], self._moves.y[chosen]]),
            ink[: len(chosen)], per_ink[: len(chosen)],
            np.column_stack([self._xs[measured], self._ys[measured]]),
            np.sqrt(cells[measured, 5]),
        )  # fmt: skip

    def _by_tone(
        self, measured: Slots, cells: Floats, stars: Stars, radius_mm: Floats
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """Return what `Spaced` has of ink, dots per area, and how large dots of a tone are.

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

        def among_alike(values: Floats) -> Floats:
            mean = np.empty(len(measured))
            mean_among_alike(measured, stars.around, stars.n, place, darkness, _ALIKE, values, mean)
            return mean

        mean = among_alike(squared)
        per_ink = squared / np.maximum(ink, _FAR)
        is_solved = np.abs(np.sqrt(np.pi * per_ink) - 1.0) < SOLVED
        per_ink = among_alike(np.where(is_solved, per_ink, 1.0 / np.pi)) * is_solved
        squared = np.where(np.abs(squared - mean) < _OWN * mean, mean, squared)
        per_area = ink / np.maximum(area * np.pi * squared, _FAR)
        return ink, per_ink, per_area, np.sqrt(squared)

    def _wants(self, measured: Slots, mass: Floats, per_area: Floats, radii: Floats) -> Floats:
        """Return what dots want, by slot, made to fit how many of each compartment there are."""
        if len(self._parts) == 1:
            total = float(mass.sum())
            unit = np.array(len(mass) / total if total > 0.0 else 1.0)
        else:
            owner = self._compartment_of_slot[measured]
            count, sums = np.bincount(owner), np.bincount(owner, mass)
            unit = np.divide(count, sums, out=np.ones(len(sums)), where=sums > 0.0)[owner]
        wants = np.ones((len(self._moves.x), 3))
        wants[measured, MASS] = mass * unit
        wants[measured, NEIGHBOUR] = np.sqrt(HEXAGONAL / np.maximum(per_area * unit, _FAR))
        wants[measured, RADIUS] = radii
        return wants

    def _move_by(
        self, rules: Rules, chosen: Slots, kinds: NDArray[np.uint8], stars: Stars, wants: Floats
    ) -> None:
        """Move the chosen by what all want; those at a border from cells made once more."""
        n_parts, n_slots = len(self._parts), len(self._moves.x)
        of_part = np.tile(np.array([0.0, 1.0, 1.0, 1.0]), (n_parts, 1))
        spacing = Spacing(
            wants, np.empty((n_slots, 3)), _ONE_LEVEL, of_part, _NO_RADII, rules.array()
        )
        self._moves.kind[:] = RIM
        self._moves.kind[chosen] = np.where(kinds == INNER, INNER, RIM)
        todo = np.empty(n_slots, np.uint8)
        parallel_for(
            verify_stars, n_slots, self._dots._replace(fixed=np.zeros(n_slots, np.bool_)),
            self._table, self._grid.border, self._field, 1.0, self._moves, stars, spacing, todo,
            grain=1024, chunks=1,
        )  # fmt: skip
        left = chosen[todo[chosen] != 0]
        if len(left):
            self._compute(left, spacing=spacing)
