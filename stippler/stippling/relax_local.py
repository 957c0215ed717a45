"""Relaxation of the few dots under a brush, at a cost that depends on them alone."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.errors import ParameterError
from stippler.kernels.cells.relaxation import TOO_MANY_CORNERS, relax_dots
from stippler.kernels.cells.tables import Dots, Grid, Moves, Spacing, Stars
from stippler.kernels.dots.bucket_grid import place_dots
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.machine.simd import LANES, SCAN
from stippler.stippling.cells import CORNER_CAP, LLOYD, NO_OUTLINES
from stippler.stippling.coinciding import part_coinciding
from stippler.stippling.compartments import Compartments, Shape
from stippler.stippling.crowds import Crowds
from stippler.stippling.dotgrid import DotGrid
from stippler.stippling.field_sums import Weights, running_sums

_NO_FLAGS = np.empty(0, np.uint8)
NO_STARS = Stars(np.empty((0, LANES), np.int32), _NO_FLAGS, _NO_FLAGS)
_NO_CELLS = np.empty((0, 6))


class LocalRelaxation:
    """All dots of a drawing in a grid that follows every change, to relax some of them.

    Dots keep the number they were given in, or that `add` returned.

    Parameters
    ----------
    points, polygon, compartment_of_dot, density
        As for `stippler.stippling.relax.Relaxation`.
    movable : (n,) array_like of bool, optional
        Dots that may be parted from others at the same place; all if left out.

    Notes
    -----
    A step over k dots is O(k), whatever the size of the drawing.
    """

    def __init__(
        self,
        points: ArrayLike,
        polygon: Shape | Sequence[Shape] | ArrayLike,
        compartment_of_dot: ArrayLike | None = None,
        density: Weights | None = None,
        movable: ArrayLike | None = None,
    ) -> None:
        xy = np.array(points, np.float64).reshape(-1, 2)
        self._parts = Compartments.of(polygon)
        self._compartment = self._find(xy, compartment_of_dot)
        fixed = np.zeros(len(xy), np.bool_) if movable is None else ~np.asarray(movable, np.bool_)
        part_coinciding(xy, self._compartment, self._parts, fixed)
        self._slot_of_dot = np.full(len(xy), -1, np.int32)
        self._field = running_sums(density, self._parts)
        self._build(np.arange(len(xy), dtype=np.int32), xy)

    def __len__(self) -> int:
        """Return how many dots there are, without those removed."""
        return int(self._count.sum())

    def positions(self, dots: ArrayLike) -> NDArray[np.float64]:
        """Return the places of dots, (k, 2), mm; NaN for those removed."""
        slots = self._slot_of_dot[np.asarray(dots, np.int64)]
        out = np.column_stack([self._xs[slots], self._ys[slots]])
        out[slots < 0] = np.nan
        return out

    def relax(self, dots: ArrayLike, steps: int = 1) -> NDArray[np.float64]:
        """Move these dots to the centroids of their cells, all others holding still.

        Parameters
        ----------
        dots : (k,) array_like of int
            Each once; leave fixed dots out.
        steps : int

        Returns
        -------
        (k, 2) float64, mm
            Where they are now.
        """
        chosen = np.asarray(dots, np.int32)
        for _ in range(steps):
            slots = self._slot_of_dot[chosen]
            if len(slots) and slots.min() < 0:
                raise ParameterError("has been removed", f"dot {chosen[int(slots.argmin())]}")
            self._compute(slots)
            self._place(
                chosen, self._moves.x[slots], self._moves.y[slots], self._compartment[chosen]
            )
        return self.positions(chosen)

    def look(
        self, dots: ArrayLike
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
        """Return where a step would take dots, the areas of their cells and how far these reach.

        Nothing moves. In mm, mm² and mm; (k, 2), (k,) and (k,).
        """
        slots = self._slot_of_dot[np.asarray(dots, np.int32)]
        cells = np.zeros((len(self._moves.x), 6))
        self._compute(slots, cells)
        there = np.column_stack([self._moves.x[slots], self._moves.y[slots]])
        return there, np.array(cells[slots, 3]), np.sqrt(cells[slots, 5])

    def cell_areas(self, dots: ArrayLike) -> NDArray[np.float64]:
        """Return the areas of the cells of dots, (k,), mm²."""
        return self.look(dots)[1]

    def move(self, dots: ArrayLike, points: ArrayLike) -> None:
        """Put dots somewhere else, within a compartment.

        Raises
        ------
        GeometryError
            If a place lies outside; nothing has moved then.
        """
        chosen = np.asarray(dots, np.int32)
        xy = np.asarray(points, np.float64).reshape(-1, 2)
        self._compartment[chosen] = self._find(xy, None)
        self._place(chosen, xy[:, 0].copy(), xy[:, 1].copy(), self._compartment[chosen])

    def add(self, points: ArrayLike) -> NDArray[np.int32]:
        """Add dots; return their numbers."""
        xy = np.asarray(points, np.float64).reshape(-1, 2)
        owner = self._find(xy, None)
        before = len(self._slot_of_dot)
        dots = np.arange(before, before + len(xy), dtype=np.int32)
        self._slot_of_dot = np.append(self._slot_of_dot, np.full(len(xy), -1, np.int32))
        self._compartment = np.append(self._compartment, owner)
        self._place(dots, xy[:, 0].copy(), xy[:, 1].copy(), owner)
        return dots

    def remove(self, dots: ArrayLike) -> None:
        """Take dots out; their numbers are not used again."""
        chosen = np.asarray(dots, np.int32)
        gone = np.full(len(chosen), np.nan)
        self._place(chosen, gone, gone, self._compartment[chosen])

    def _find(
        self, xy: NDArray[np.float64], compartment_of_dot: ArrayLike | None
    ) -> NDArray[np.int32]:
        if not np.isfinite(xy).all():
            raise ParameterError("positions have to be finite", "dots")
        owner = None
        if compartment_of_dot is not None:
            owner = np.asarray(compartment_of_dot, np.int32)
        return self._parts.find(xy, owner)

    def _compute(
        self,
        slots: NDArray[np.int32],
        cells: NDArray[np.float64] = _NO_CELLS,
        stars: Stars = NO_STARS,
        spacing: Spacing = LLOYD,
    ) -> None:
        """Compute cells and where they take their dots; measure and note them if there is room."""
        field, cap = self._field, CORNER_CAP
        while len(slots):
            parallel_for(
                relax_dots, len(slots), cap, slots, False, self._dots, self._table,
                self._grid.border, field, 1.0, self._moves, cells, stars, NO_OUTLINES, spacing,
                grain=128, chunks=2,
            )  # fmt: skip
            slots = slots[self._moves.kind[slots] == TOO_MANY_CORNERS]
            cap *= 16

    def _place(
        self,
        dots: NDArray[np.int32],
        x: NDArray[np.float64],
        y: NDArray[np.float64],
        compartment: NDArray[np.int32],
    ) -> None:
        done = place_dots(
            dots, x, y, compartment, self._room, self._grid.real, self._grid.whole, self._count,
            self._xs, self._ys, self._compartment_of_slot, self._dot_of_slot, self._slot_of_dot,
        )  # fmt: skip
        if done == len(dots):
            return
        # a grid cell is full: lay the grid anew, with all dots where they are or should be
        everyone = np.arange(len(self._slot_of_dot), dtype=np.int32)
        xy = self.positions(everyone)
        xy[dots, 0], xy[dots, 1] = x, y
        there = np.isfinite(xy[:, 0])
        self._build(everyone[there], xy[there])

    def _build(self, dots: NDArray[np.int32], xy: NDArray[np.float64]) -> None:
        compartment = self._compartment[dots]
        n_dots = np.bincount(compartment, minlength=len(self._parts))
        self._grid = DotGrid.over(self._parts, n_dots)
        self._room = 4
        done = -1
        while done < len(dots):
            self._room += 4
            self._lay_out(self._grid.n_cells * self._room)
            self._slot_of_dot[:] = -1
            done = place_dots(
                dots, xy[:, 0].copy(), xy[:, 1].copy(), compartment, self._room, self._grid.real,
                self._grid.whole, self._count, self._xs, self._ys, self._compartment_of_slot,
                self._dot_of_slot, self._slot_of_dot,
            )  # fmt: skip

    def _lay_out(self, n_slots: int) -> None:
        n_cells = self._grid.n_cells
        self._count = np.zeros(n_cells, np.int32)
        self._xs = np.full(n_slots + SCAN, np.nan)
        self._ys = np.full(n_slots + SCAN, np.nan)
        self._compartment_of_slot = np.zeros(n_slots, np.int32)
        self._dot_of_slot = np.full(n_slots, -1, np.int32)
        self._dots = Dots(self._xs, self._ys, np.zeros(0, np.bool_), self._compartment_of_slot)
        cell_start = (np.arange(n_cells + 1) * self._room).astype(np.int32)
        self._table = Grid(
            self._grid.real, self._grid.whole, cell_start, 0.0, *Crowds.none().tables
        )
        self._moves = Moves(
            np.empty(n_slots), np.empty(n_slots), np.empty(n_slots), np.zeros(n_slots, np.uint8),
            np.empty(n_slots),
        )  # fmt: skip
