"""Grid cells that hold many dots, split further.

A uniform grid is right for dots spread evenly; in a tight cluster a cell of it holds hundreds. The
dots of such a *crowd* are split into two halves across its longer side, and each half again, until
`LEAF` or fewer are left, which is what one vector instruction tests. The n dots of a crowd stay
together; node v of level l, both counted from 0, holds those from ``n v >> l`` to before
``n (v + 1) >> l``.

`node` holds the boxes of all crowds' nodes, ``xmin, ymin, xmax, ymax``, by levels: node v of level
l is row ``first + 2^l + v``, where `first` is the grid cell's entry of `tree_of_cell`. Row `first`
holds the number of levels below the top, and whether `arc` tells more, see `crowd_arcs`. A grid
cell that is no crowd has the entry -1, and -1 - k if it is the first of k without dots.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.kernels.cells.crowd_arcs import bound_arc, lies_on_curve
from stippler.kernels.cells.grid import distance2_to_span
from stippler.kernels.cells.tables import F8, I4, Dots, Grid, Spot
from stippler.kernels.cells.voronoi import (
    OVERFLOW,
    cut_cell,
    cut_lanes_by_run,
    reach2_of_cell,
)
from stippler.kernels.machine.jit import ZERO, inline, inner, kernel
from stippler.kernels.machine.simd import (
    get,
    may_cut_from_arc,
    may_cut_from_box,
    put,
    reach2_of,
    stack_ints,
)

CROWD = 24
"""Dots in a grid cell from which on it is split."""

LEAF = 8

ALL = ZERO + (1 << 62)
"""As many leaves as there are."""

APART = 1e-300
"""Least squared distance of dots that count as two."""

_TIE = 2e-11
"""Twice how far beyond a bisector, of its distance, a corner may lie that nodes on arcs do not cut.

So far apart do corners lie, by rounding, in which all cells of a ring of 100,000 dots meet.
"""

_DEPTH = 64


@inline
def levels_of(n: int) -> int:
    """Return how many times a crowd of n dots is halved."""
    level = ZERO
    while n > LEAF << level:
        level += 1
    return int(level)


@inline
def _part(key: F8, row: I4, start: int, stop: int, middle: int) -> None:
    """Sort rows start..stop so far that none before `middle` has a greater key than one after."""
    low, high = start, stop - 1
    while low < high:
        pivot = key[row[(low + high) >> 1]]
        i, j = low, high
        while i <= j:
            while key[row[i]] < pivot:
                i += 1
            while key[row[j]] > pivot:
                j -= 1
            if i <= j:
                row[i], row[j] = row[j], row[i]
                i += 1
                j -= 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            break


@kernel
def split_crowds(start: int, stop: int, crowd: I4, cell_start: I4, x: F8, y: F8, order: I4) -> None:
    """Bring the dots of grid cells ``crowd[start:stop]`` into the order of their trees.

    `order` holds the dots by grid cell; `x` and `y` are theirs, not yet in that order.
    """
    for w in range(start, stop):
        first = cell_start[crowd[w]]
        n = cell_start[crowd[w] + 1] - first
        for level in range(levels_of(n)):
            for v in range(1 << level):
                low, high = first + ((n * v) >> level), first + ((n * (v + 1)) >> level)
                x0 = y0 = math.inf
                x1 = y1 = -math.inf
                for s in range(low, high):
                    x0, x1 = min(x0, x[order[s]]), max(x1, x[order[s]])
                    y0, y1 = min(y0, y[order[s]]), max(y1, y[order[s]])
                middle = first + ((n * (2 * v + 1)) >> (level + 1))
                _part(x if x1 - x0 >= y1 - y0 else y, order, low, high, middle)


@kernel
def bound_crowds(
    start: int, stop: int, crowd: I4, tree_of_cell: I4, cell_start: I4, x: F8, y: F8, node: F8,
    arc: F8,
) -> None:  # fmt: skip
    """Write the boxes of the trees of grid cells ``crowd[start:stop]`` around where dots are.

    Where dots lie along curves, `arc` is written, too.
    """
    for w in range(start, stop):
        first = cell_start[crowd[w]]
        n = cell_start[crowd[w] + 1] - first
        tree = tree_of_cell[crowd[w]]
        depth = levels_of(n)
        node[tree, 0] = depth
        for v in range(1 << depth):
            x0 = y0 = math.inf
            x1 = y1 = -math.inf
            for s in range(first + ((n * v) >> depth), first + ((n * (v + 1)) >> depth)):
                x0, x1 = min(x0, x[s]), max(x1, x[s])
                y0, y1 = min(y0, y[s]), max(y1, y[s])
            k = tree + (1 << depth) + v
            node[k, 0], node[k, 1], node[k, 2], node[k, 3] = x0, y0, x1, y1
        for v in range((1 << depth) - 1, 0, -1):
            a, b = tree + 2 * v, tree + 2 * v + 1
            for r in range(2):
                node[tree + v, r] = min(node[a, r], node[b, r])
                node[tree + v, r + 2] = max(node[a, r + 2], node[b, r + 2])
        node[tree, 1] = 0.0
        if lies_on_curve(node, tree, depth):
            node[tree, 1] = 1.0
            for level in range(depth + 1):
                for v in range(1 << level):
                    low, high = first + ((n * v) >> level), first + ((n * (v + 1)) >> level)
                    bound_arc(arc, tree + (1 << level) + v, x, y, low, high)


@inline
def _distance2_to_box(node: F8, k: int, x: float, y: float) -> float:
    dx = max(max(node[k, 0] - x, x - node[k, 2]), 0.0)
    dy = max(max(node[k, 1] - y, y - node[k, 3]), 0.0)
    return float(dx * dx + dy * dy)


@inline
def _may_cut_from_arc(U: Any, V: Any, m: int, grid: Grid, k: int, x: float, y: float) -> bool:
    """Whether the dots of node k may lie in the circle about a corner, as far as `arc` tells."""
    arc, node = grid.arc, grid.node
    if arc[k, 4] < 0.0:
        return True
    dx = max(node[k, 0] - x, x - node[k, 2])
    dy = max(node[k, 1] - y, y - node[k, 3])
    slack = _TIE * max(max(dx, dy), 0.0)
    return bool(may_cut_from_arc(U, V, m, arc[k, 0] - x, arc[k, 1] - y, arc, k, slack))


@inner
def cut_lanes_by_crowd(
    U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, x: float, y: float, cell: int,
    leaves: int = ALL,
) -> int:  # fmt: skip
    """Cut the cell of (x, y) by a crowd's dots, the nearest first; return its corners.

    Halves of the crowd that reach into none of the circles about the corners, through (x, y),
    hold no dot that could cut. No more than some leaves are looked into.
    """
    node, tree = grid.node, grid.tree_of_cell[cell]
    first = grid.cell_start[cell]
    n = grid.cell_start[cell + 1] - first
    depth, is_curve = int(node[tree, 0]), node[tree, 1] != 0.0
    todo = stack_ints(_DEPTH)  # nodes not yet visited, one a level at most
    put(todo, 0, 1)
    n_todo = 1
    while n_todo > 0 and leaves > 0:
        n_todo -= 1
        v = ZERO + get(todo, n_todo)
        k = tree + v
        if not may_cut_from_box(
            U, V, m, node[k, 0] - x, node[k, 1] - y, node[k, 2] - x, node[k, 3] - y
        ):
            continue
        if is_curve and not _may_cut_from_arc(U, V, m, grid, k, x, y):
            continue
        while v < 1 << depth:
            v = 2 * v
            if _distance2_to_box(node, tree + v, x, y) > _distance2_to_box(
                node, tree + v + 1, x, y
            ):
                v += 1
            put(todo, n_todo, v ^ 1)
            n_todo += 1
        v -= 1 << depth
        leaves -= 1
        m = cut_lanes_by_run(
            U, V, N, m, dots.x, dots.y, x, y, first + ((n * v) >> depth),
            first + ((n * (v + 1)) >> depth), APART, 4.0 * reach2_of(U, V, m),
        )  # fmt: skip
        if m == OVERFLOW:
            break
    return m


@inner
def _may_cut_corner(
    cell: F8, m: int, grid: Grid, k: int, is_curve: bool, x: float, y: float
) -> bool:
    """Whether node k may hold a dot that cuts a cell in a plain array, as its lanes are asked."""
    node, arc = grid.node, grid.arc
    x0, y0, x1, y1 = node[k, 0] - x, node[k, 1] - y, node[k, 2] - x, node[k, 3] - y
    slack = _TIE * max(max(max(x0, -x1), max(y0, -y1)), 0.0)
    for corner in range(m):
        u, v = cell[0, corner], cell[1, corner]
        du, dv = max(max(x0 - u, u - x1), 0.0), max(max(y0 - v, v - y1), 0.0)
        if du * du + dv * dv > (u * u + v * v) * (1.0 + 1e-9):
            continue
        if not is_curve or arc[k, 4] < 0.0:
            return True
        cx, cy, tx, ty = arc[k, 0] - x, arc[k, 1] - y, arc[k, 2], arc[k, 3]
        gx, gy = arc[k, 5] + 2.0 * (cx - u), arc[k, 6] + 2.0 * (cy - v)
        off = cx * cx + cy * cy - 2.0 * (u * cx + v * cy) + arc[k, 7]
        off -= abs(gx * tx + gy * ty) + arc[k, 4] * abs(gy * tx - gx * ty)
        if off + slack * max(abs(u), abs(v)) < 0.0:
            return True
    return False


@inner
def cut_cell_by_crowd(
    cell: F8, m: int, dots: Dots, grid: Grid, x: float, y: float, number: int
) -> int:
    """Cut a cell in a plain array by the dots of grid cell `number`, a crowd, the nearest first."""
    node, tree = grid.node, grid.tree_of_cell[number]
    first = grid.cell_start[number]
    n = grid.cell_start[number + 1] - first
    depth, is_curve = int(node[tree, 0]), node[tree, 1] != 0.0
    todo = stack_ints(_DEPTH)
    put(todo, 0, 1)
    n_todo = 1
    while n_todo > 0:
        n_todo -= 1
        v = ZERO + get(todo, n_todo)
        if not _may_cut_corner(cell, m, grid, tree + v, is_curve, x, y):
            continue
        while v < 1 << depth:
            v = 2 * v
            if _distance2_to_box(node, tree + v, x, y) > _distance2_to_box(
                node, tree + v + 1, x, y
            ):
                v += 1
            put(todo, n_todo, v ^ 1)
            n_todo += 1
        v -= 1 << depth
        reach2 = reach2_of_cell(cell, m)
        for j in range(first + ((n * v) >> depth), first + ((n * (v + 1)) >> depth)):
            a, b = dots.x[j] - x, dots.y[j] - y
            d2 = a * a + b * b
            if 0.0 < d2 < 4.0 * reach2:
                m = cut_cell(cell, m, a, b, 0.5 * d2, float(j))
                if m == OVERFLOW:
                    return m
    return m


@inner
def _cut_lanes_by_cells(
    U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, spot: Spot, row: int, first: int,
    last: int, least: float, limit: float, skip: int, leaves: int,
) -> int:  # fmt: skip
    """Cut a cell by the dots of a run of grid cells of which some are crowds."""
    column = ZERO + first - 1
    while column < last:
        column += 1
        cell = spot.first_cell + row * spot.nx + column
        tree = grid.tree_of_cell[cell]
        if tree < -1:
            column -= tree + 2
            continue
        if cell == skip:
            continue
        if tree >= 0:
            if least <= APART:
                m = cut_lanes_by_crowd(U, V, N, m, dots, grid, spot.x, spot.y, cell, leaves)
        elif distance2_to_span(spot, row, column, column, grid.slack) < limit:
            start, end = grid.cell_start[cell], grid.cell_start[cell + 1]
            m = cut_lanes_by_run(
                U, V, N, m, dots.x, dots.y, spot.x, spot.y, start, end, least, limit
            )
        if m == OVERFLOW:
            break
    return m


@inline
def cut_lanes_by_span(
    U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, spot: Spot, row: int, first: int,
    last: int, least: float, limit: float, skip: int, leaves: int = ALL,
) -> int:  # fmt: skip
    """Cut a cell by the dots of grid cells first..last of a row; return its corners.

    Only dots with ``least <= distance² < limit`` count; but a crowd is cut by as a whole, or by the
    nearest of its leaves, if `least` leaves out none, and else not at all. Grid cell `skip` is left
    out.
    """
    a = spot.first_cell + row * spot.nx
    start, end = grid.cell_start[a + first], grid.cell_start[a + last + 1]
    if end - start > CROWD and len(grid.tree_of_cell) > 0:
        return _cut_lanes_by_cells(
            U, V, N, m, dots, grid, spot, row, first, last, least, limit, skip, leaves
        )
    return cut_lanes_by_run(U, V, N, m, dots.x, dots.y, spot.x, spot.y, start, end, least, limit)
