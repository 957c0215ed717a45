"""Trees of crowded grid cells, and those that join them where dots lie along curves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.cells.cell_trees import (
    CROWD,
    LEAF,
    bound_crowds,
    link_crowds,
    split_crowds,
)
from stippler.kernels.cells.curve_trees import bound_joined, join_cells
from stippler.kernels.machine.pool import parallel_for

Floats = NDArray[np.float64]
Rows = NDArray[np.int32]

_NO_ROWS = np.empty(0, np.int32)
_NO_LINKS = np.empty((0, 2), np.int32)
_NO_BOXES = np.empty((0, 4))


@dataclass(slots=True, eq=False)
class Crowds:
    """The trees of `stippler.kernels.cells.cell_trees`; all arrays are empty where none is needed.

    Attributes
    ----------
    cell
        Crowded grid cells.
    tree_of_cell, node, arc, link
        See `cell_trees`.
    root
        By compartment, the node that all its dots lie below, or -1: see `curve_trees`.
    """

    cell: Rows
    tree_of_cell: Rows
    node: Floats
    arc: Floats
    link: Rows
    root: Rows
    _cell_start: Rows
    _span: Rows
    _dot: Rows

    @classmethod
    def none(cls) -> Crowds:
        """Return none."""
        arc = np.empty((0, 8))
        return cls(
            _NO_ROWS, _NO_ROWS, _NO_BOXES, arc, _NO_LINKS, _NO_ROWS, _NO_ROWS, _NO_LINKS, _NO_ROWS
        )

    @property
    def tables(self) -> tuple[Rows, Floats, Floats, Rows, Rows]:
        """What kernels search in: the last fields of their `Grid`."""
        return self.tree_of_cell, self.node, self.arc, self.link, self.root

    @classmethod
    def split(cls, cell_start: Rows, order: Rows, xs: Floats, ys: Floats) -> Crowds:
        """Find grid cells that are crowded, and order their dots by trees.

        `order` holds dots by grid cell; `xs` and `ys` are not yet in that order.
        """
        n_dots = np.diff(cell_start)
        cell = np.flatnonzero(n_dots > CROWD).astype(np.int32)
        if not len(cell):
            return cls.none()
        parallel_for(split_crowds, len(cell), cell, cell_start, xs, ys, order, grain=1, chunks=16)
        halvings = np.ceil(np.log2(n_dots[cell] / LEAF)).astype(np.int64)
        ends = np.cumsum(2 << halvings)
        number = np.arange(len(n_dots))
        filled = np.where(n_dots > 0, number, len(n_dots))
        tree_of_cell = (number - np.minimum.accumulate(filled[::-1])[::-1] - 1).astype(np.int32)
        tree_of_cell[cell] = np.concatenate([[0], ends[:-1]])
        n_nodes = int(ends[-1])
        link = np.empty((n_nodes, 2), np.int32)
        parallel_for(link_crowds, len(cell), cell, tree_of_cell, cell_start, link, grain=64)
        return cls(
            cell, tree_of_cell, np.empty((n_nodes, 4)), np.empty((n_nodes, 8)), link, _NO_ROWS,
            cell_start, _NO_LINKS, _NO_ROWS,
        )  # fmt: skip

    def bound(self, xs: Floats, ys: Floats) -> None:
        """Fit the trees to where the dots are now."""
        if not len(self.cell):
            return
        parallel_for(
            bound_crowds, len(self.cell), self.cell, self.tree_of_cell, self._cell_start, xs, ys,
            self.node, self.arc, grain=1, chunks=16,
        )  # fmt: skip
        if len(self.root):
            self._bound_joined(xs, ys)

    def join(self, grid: Rows, xs: Floats, ys: Floats) -> None:
        """Join the grid cells of compartments in which dots lie along curves.

        `grid` is whole numbers of each compartment's grid; the trees are bounded.
        """
        curves = self.cell[self.node[self.tree_of_cell[self.cell], 0] != 0.0]
        if not len(curves):
            return
        parts = np.unique(np.searchsorted(grid[:, 2], curves, "right") - 1)
        n_dots = np.diff(self._cell_start)
        cell = np.flatnonzero(n_dots > 0)
        part = np.searchsorted(grid[:, 2], cell, "right") - 1
        is_joined = np.isin(part, parts)
        cell, part = cell[is_joined], part[is_joined]
        place, nx = cell - grid[part, 2], grid[part, 0]
        x, y = (place % nx).astype(np.float64), (place // nx).astype(np.float64)
        end_of_part = np.searchsorted(part, np.append(parts, len(grid))).astype(np.int32)
        n, base = len(cell), len(self.node)
        ends = np.concatenate([[0], np.cumsum(n_dots[cell])])
        first_dot = ends[end_of_part[:-1]].astype(np.int32)
        self._dot = np.empty(int(ends[-1]), np.int32)
        self._span = np.zeros((2 * n, 2), np.int32)
        self.link = np.concatenate([self.link, np.full((2 * n, 2), -1, np.int32)])
        self.node = np.concatenate([self.node, np.empty((2 * n, 4))])
        self.arc = np.concatenate([self.arc, np.empty((2 * n, 8))])
        root = np.empty(len(parts), np.int32)
        parallel_for(
            join_cells, len(parts), end_of_part, np.arange(n, dtype=np.int32), x, y,
            cell.astype(np.int32), self.tree_of_cell, self._cell_start, base, self.link, root,
            self._span, self._dot, first_dot, grain=1,
        )  # fmt: skip
        self.root = np.full(len(grid), -1, np.int32)
        self.root[parts] = root
        self._bound_joined(xs, ys)

    def _bound_joined(self, xs: Floats, ys: Floats) -> None:
        n = len(self._span)
        parallel_for(
            bound_joined, n, len(self.node) - n, self._span, xs[self._dot], ys[self._dot],
            self.node, self.arc, grain=16, chunks=16,
        )  # fmt: skip
