"""The cells of all dots, computed from nothing or carried over from the step before."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.grid import find_grid_cells, sort_by_grid_cell
from stippler.kernels.pool import run_ranges
from stippler.kernels.relaxation import TOO_MANY_CORNERS, relax_dots
from stippler.kernels.simd import LANES, SCAN
from stippler.kernels.stars import check_stars, renumber_stars, verify_stars
from stippler.stippling.compartments import Compartments
from stippler.stippling.density import DensityField, running_sums
from stippler.stippling.dotgrid import DotGrid

Floats = NDArray[np.float64]
Rows = NDArray[np.int32]
Question = Callable[[], bool] | None

CORNER_CAP = 64
GRAIN = 4096
FEW = 256
"""Smallest share of a thread where cells are computed one by one, and of a list of them."""

KEEP_BELOW = 0.25
"""Mean move, in spacings, below which stars are worth keeping."""

MOST_TODO = 0.5
"""Share of stars that fail from which on all cells are computed from nothing."""

SLACK = 0.5
"""How far, in grid cells, dots may go before they are sorted anew."""

_NO_ROWS = np.empty(0, np.int32)
_NO_STARS = np.empty((0, LANES), np.int32)
_NO_CELLS = np.empty((0, 4))
_NO_FLAGS = np.empty(0, np.uint8)


class Cells:
    """Dots sorted into grids, and the stars of their cells.

    Row arrays are in the order of the grid; ``order[row]`` is the dot's place in what was given.
    """

    def __init__(
        self,
        xy: Floats,
        fixed: NDArray[np.bool_],
        compartment_of_dot: Rows,
        parts: Compartments,
        density: DensityField | None,
        over: float,
    ) -> None:
        n = len(xy)
        self.n, self.over = n, over
        self.xs, self.ys = np.zeros(n + SCAN), np.zeros(n + SCAN)
        self.xs[:n], self.ys[:n] = xy.T
        self.fixed, self.compartment_of_dot = fixed, compartment_of_dot
        self.order = np.arange(n, dtype=np.int32)
        self.parts = parts
        self.grid = DotGrid.over(parts, np.bincount(compartment_of_dot, minlength=len(parts)))
        self.spacing = float(np.sqrt(parts.area.sum() / max(n, 1)))
        self._cell_start = np.zeros(self.grid.n_cells + 1, np.int32)
        self._mass, self._moment, self._frame = running_sums(density)
        self._slack = np.inf
        self._keep = False
        self._star = np.zeros((n, LANES), np.int32)
        self._n_star = np.zeros(n, np.uint8)
        self._kind_of_cell = np.zeros(n, np.uint8)
        self._free_of_dot = np.zeros(n)
        self._has_stars = False
        self.n_failed = n  # stars of the step before that did not hold

    @property
    def keeps_stars(self) -> bool:
        """Whether the next step starts from this step's stars."""
        return self._has_stars and self._keep

    @property
    def xy(self) -> Floats:
        """Positions in the order given, fresh."""
        out = np.empty((self.n, 2))
        out[self.order, 0] = self.xs[: self.n]
        out[self.order, 1] = self.ys[: self.n]
        return out

    def step(self, cancel: Question = None) -> Floats | None:
        """Move every free dot once; return how far each row went, or None if cancelled."""
        new = np.zeros(self.n + SCAN), np.zeros(self.n + SCAN), np.empty(self.n)
        done = self.keeps_stars and self._step_from_stars(new, cancel)
        if not done:
            self._has_stars, self.n_failed = False, self.n
            done = self._sort(cancel=cancel) and self._relax(_NO_ROWS, True, new, cancel=cancel)
            self._has_stars = done
        if not done:
            return None
        self.xs, self.ys, gone = new
        if self.n:
            self._slack += float(gone.max())
            self._keep = float(gone.mean()) < KEEP_BELOW * self.spacing
        return gone

    def measure(self, weighted: bool) -> Floats:
        """Return mass, centroid from the dot and second moment of cells, in the order given."""
        self._sort(self._has_stars)
        cells = np.zeros((self.n, 4))
        new = np.zeros(self.n + SCAN), np.zeros(self.n + SCAN), np.empty(self.n)
        rows = np.arange(self.n, dtype=np.int32)
        self._relax(rows, False, new, cells=cells, weighted=weighted, has_stars=False)
        out = np.empty_like(cells)
        out[self.order] = cells
        return out

    def _relax(
        self,
        which: Rows,
        is_all: bool,
        new: tuple[Floats, Floats, Floats],
        cells: Floats = _NO_CELLS,
        weighted: bool = True,
        has_stars: bool = True,
        suspect: NDArray[np.uint8] = _NO_FLAGS,
        cancel: Question = None,
    ) -> bool:
        """Compute cells from nothing; once more, with more room, those of very many corners."""
        grid, parts = self.grid, self.parts
        mass, moment = (self._mass, self._moment) if weighted else (_NO_CELLS, _NO_CELLS)
        fixed = self.fixed if not len(cells) else np.empty(0, np.bool_)
        cap, n = CORNER_CAP, self.n if is_all else len(which)
        while n:
            done = run_ranges(
                relax_dots, n, which, is_all, self.xs, self.ys, fixed,
                self.compartment_of_dot, self._cell_start, self._slack, grid.real, grid.whole,
                parts.edges, parts.next_edge, grid.edge_start, grid.edge_of_slot, grid.clear,
                mass, moment, self._frame, cap, grid.most_edges, self.over,
                *new, cells, self._kind_of_cell, self._free_of_dot,
                self._star if has_stars else _NO_STARS, self._n_star, suspect,
                grain=GRAIN if is_all else FEW, chunks=8, cancel=cancel,
            )  # fmt: skip
            if not done:
                return False
            rows = np.flatnonzero(self._kind_of_cell == TOO_MANY_CORNERS).astype(np.int32)
            which = rows if is_all else np.intersect1d(which, rows).astype(np.int32)
            is_all, n, cap = False, len(which), 16 * cap
        return True

    def _step_from_stars(self, new: tuple[Floats, Floats, Floats], cancel: Question) -> bool:
        """Move dots by verified stars; False if that is not worth it now, or cancelled."""
        has_run = self._slack > SLACK * float(self.grid.real[:, 2].min())
        if has_run and not self._sort(True, cancel):
            return False
        todo = np.empty(self.n, np.uint8)
        grid = self.grid
        done = run_ranges(
            verify_stars, self.n, self.xs, self.ys, self.fixed, self.compartment_of_dot,
            grid.real, self._mass, self._moment, self._frame, self.over,
            self._star, self._n_star, self._kind_of_cell, self._free_of_dot, *new, todo,
            grain=GRAIN, cancel=cancel,
        )  # fmt: skip
        which = np.flatnonzero(todo).astype(np.int32)
        self.n_failed = len(which)
        if self.n_failed > MOST_TODO * self.n:
            return False
        suspect = np.zeros(self.n, np.uint8)
        settled = np.zeros(self.n, np.bool_)
        while done and len(which):
            settled[which] = True
            done = self._relax(which, False, new, suspect=suspect, cancel=cancel)
            rows = np.flatnonzero((suspect != 0) & ~settled).astype(np.int32)
            suspect[:] = 0
            run_ranges(check_stars, len(rows), rows, self._star, self._n_star, todo, grain=1024)
            which = rows[todo[rows] != 0]
        return done

    def _sort(self, with_stars: bool = False, cancel: Question = None) -> bool:
        """Bring the dots into the order of the grid; False, and nothing done, if cancelled."""
        if self._slack == 0.0:
            return True
        n = self.n
        cell_of_dot, order = np.empty(n, np.int32), np.empty(n, np.int32)
        cell_start = np.empty_like(self._cell_start)
        run_ranges(
            find_grid_cells, n, self.xs, self.ys, self.compartment_of_dot, self.grid.real,
            self.grid.whole, cell_of_dot, grain=GRAIN,
        )  # fmt: skip
        sort_by_grid_cell(cell_of_dot, cell_start, order)
        names = ["fixed", "compartment_of_dot", "order"]
        sorted_rows: dict[str, Any] = {"_cell_start": cell_start}
        if with_stars:
            names += ["_n_star", "_kind_of_cell", "_free_of_dot"]
            new_row = np.empty(n, np.int32)
            new_row[order] = np.arange(n, dtype=np.int32)
            star = sorted_rows["_star"] = np.empty_like(self._star)
            args = (renumber_stars, n, order, new_row, self._star, star)
            if not run_ranges(*args, grain=GRAIN, cancel=cancel):
                return False
        for name in names:
            if cancel is not None and cancel():
                return False
            sorted_rows[name] = getattr(self, name)[order]
        for name, rows in sorted_rows.items():
            setattr(self, name, rows)
        self.xs[:n], self.ys[:n] = self.xs[order], self.ys[order]
        self._slack = 0.0
        self._has_stars = self._has_stars and with_stars
        return True
