"""The search for the dots around a dot: rings of grid cells, the nearest first."""

from __future__ import annotations

from typing import Any

from stippler.kernels.cells.grid import distance2_to_span, ring_span
from stippler.kernels.cells.tables import F8, Dots, Grid, Spot
from stippler.kernels.cells.tree_search import APART, cut_cell_by_tree, cut_lanes_by_span
from stippler.kernels.cells.voronoi import OVERFLOW, cut_cell, reach2_of_cell
from stippler.kernels.machine.jit import ZERO, inner, merged
from stippler.kernels.machine.simd import reach2_of

NEAR = 0.65
"""Squared distance, in grid cells, of the dots that cut first: fewer cuts are wasted."""


@merged
def cut_lanes_by_ring(
    U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, spot: Spot, ring: int, crowd: int
) -> int:
    """Cut a cell by the dots of a ring of grid cells; return its corners, or `OVERFLOW`.

    `crowd` is the dot's own grid cell if the cell has been cut by it before, or -1.
    """
    near2 = NEAR * spot.h * spot.h
    n_spans = 4 * ring if ring > 1 else 6 if crowd < 0 else 3
    for s in range(ZERO, n_spans):
        is_second = ring == 1 and s >= 3
        row, first, last = ring_span(ring, s - 3 if is_second else s, spot)
        if last < first:
            continue
        least, limit = APART, near2
        if ring > 1 or s >= 3 or crowd >= 0:
            limit = 4.0 * reach2_of(U, V, m)
            if is_second:
                least = near2
            elif distance2_to_span(spot, row, first, last, grid.slack) >= limit:
                continue
        m = cut_lanes_by_span(U, V, N, m, dots, grid, spot, row, first, last, least, limit, crowd)
        if m == OVERFLOW:
            break
    return m


@inner
def _cut_cell_by_run(
    cell: F8, m: int, dots: Dots, grid: Grid, spot: Spot, first: int, last: int
) -> int:
    """Cut a cell in plain arrays by the dots of grid cells first..last."""
    reach2 = reach2_of_cell(cell, m)
    for j in range(grid.cell_start[first], grid.cell_start[last + 1]):
        a, b = dots.x[j] - spot.x, dots.y[j] - spot.y
        d2 = a * a + b * b
        if d2 >= 4.0 * reach2 or d2 == 0.0:
            continue
        m = cut_cell(cell, m, a, b, 0.5 * d2, float(j))
        if m == OVERFLOW:
            break
        reach2 = reach2_of_cell(cell, m)
    return m


@inner
def cut_cell_by_ring(cell: F8, m: int, dots: Dots, grid: Grid, spot: Spot, ring: int) -> int:
    """Cut a cell in plain arrays by the dots of a ring of grid cells."""
    for s in range(3 if ring == 1 else 4 * ring):
        row, first, last = ring_span(ring, s, spot)
        if last < first:
            continue
        start = spot.first_cell + row * spot.nx
        if len(grid.tree_of_cell) > 0:
            for k in range(start + first, start + last + 1):
                tree = grid.tree_of_cell[k]
                if tree >= 0:
                    m = cut_cell_by_tree(
                        cell, m, dots, grid, spot.x, spot.y, ZERO + tree + 1,
                        grid.node[tree, 0] != 0.0, False,
                    )  # fmt: skip
                elif tree == -1:
                    m = _cut_cell_by_run(cell, m, dots, grid, spot, k, k)
                if m == OVERFLOW:
                    return m
        else:
            m = _cut_cell_by_run(cell, m, dots, grid, spot, start + first, start + last)
        if m == OVERFLOW:
            return m
    return m
