"""Dots of a tree (see `cell_trees`) that may cut a cell, found without looking at the others."""

from __future__ import annotations

from typing import Any

from stippler.kernels.cells.cell_trees import CROWD
from stippler.kernels.cells.grid import distance2_to_span
from stippler.kernels.cells.tables import F8, Dots, Grid, Spot
from stippler.kernels.cells.voronoi import (
    OVERFLOW,
    TOLERANCE,
    cut_cell,
    cut_lanes_by_run,
    reach2_of_cell,
)
from stippler.kernels.machine.jit import ZERO, inline, inner
from stippler.kernels.machine.simd import (
    FRONT,
    LANES,
    SCAN,
    data_of,
    get,
    holds,
    lowest_bit,
    may_cut_from_arc,
    may_cut_from_box,
    near_mask,
    out_mask,
    put,
    reach2_of,
    stack_doubles,
    stack_ints,
)

APART = 1e-300
"""Least squared distance of dots that count as two."""

_TIE = 2e-11
"""Twice how far beyond a bisector, of its distance, a corner may lie that nodes on arcs do not cut.

So far apart do corners lie, by rounding, in which all cells of a ring of 100,000 dots meet.
"""

_DEPTH = 96
"""Nodes not yet visited: one a level of a tree, and of the one that joins trees."""

_MOST_NODES = 256
"""Nodes looked into for a near dot; fewer than there are ways down cost far more, in cuts."""


@inline
def _distance2_to_box(node: F8, k: int, x: float, y: float) -> float:
    dx = max(max(node[k, 0] - x, x - node[k, 2]), 0.0)
    dy = max(max(node[k, 1] - y, y - node[k, 3]), 0.0)
    return float(dx * dx + dy * dy)


@inline
def _is_second_nearer(grid: Grid, k: int, x: float, y: float) -> bool:
    """Whether of the two nodes below node k the second one is nearer to a place."""
    node, link = grid.node, grid.link
    first = _distance2_to_box(node, link[k, 0], x, y)
    return bool(_distance2_to_box(node, link[k, 1], x, y) < first)


@inline
def _may_cut(
    U: Any, V: Any, at: int, m: int, grid: Grid, k: int, is_curve: bool, x: float, y: float
) -> bool:
    """Whether node k may hold a dot that takes one of the corners from `at` on off a cell."""
    node, arc = grid.node, grid.arc
    x0, y0, x1, y1 = node[k, 0] - x, node[k, 1] - y, node[k, 2] - x, node[k, 3] - y
    if not may_cut_from_box(U, V, at, m, x0, y0, x1, y1):
        return False
    if not is_curve or arc[k, 4] < 0.0:
        return True
    slack = _TIE * max(max(max(x0, -x1), max(y0, -y1)), 0.0)
    return bool(may_cut_from_arc(U, V, at, m, arc[k, 0] - x, arc[k, 1] - y, arc, k, slack))


@inline
def _next_leaf(
    U: Any, V: Any, at: int, m: int, grid: Grid, is_curve: bool, x: float, y: float, todo: Any,
    n_todo: int,
) -> tuple[int, int]:  # fmt: skip
    """Return the next leaf that may cut a cell, the nearest first, or -1, and how many are to do.

    Nodes that reach into none of the circles about the corners, through (x, y), hold no dot that
    could cut. `todo` holds nodes not yet visited. In lanes corners stand from `FRONT` on, in plain
    arrays from 0.
    """
    link = grid.link
    while n_todo > 0:
        n_todo -= 1
        k = ZERO + get(todo, n_todo)
        may, first = False, at
        while first < at + m and not may:
            may = _may_cut(U, V, first, min(m + at - first, LANES), grid, k, is_curve, x, y)
            first += LANES
        if not may:
            continue
        if link[k, 0] < 0:
            return k, n_todo
        second = 1 if _is_second_nearer(grid, k, x, y) else 0
        put(todo, n_todo, link[k, 1 - second])
        put(todo, n_todo + 1, link[k, second])
        n_todo += 2
    return ZERO - 1, n_todo


@inner
def _cut_lanes(
    U: Any, V: Any, N: Any, m: int, dots: Dots, x: float, y: float, first: int, end: int
) -> int:
    """Cut a rough cell by the dots first..end."""
    limit = 4.0 * reach2_of(U, V, m)
    return cut_lanes_by_run(U, V, N, m, dots.x, dots.y, x, y, first, end, APART, limit, True)


@inner
def cut_lanes_by_crowd(
    U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, x: float, y: float, cell: int
) -> int:
    """Cut the cell of (x, y) by a crowd's dots, the nearest first; return its corners."""
    tree, link = grid.tree_of_cell[cell], grid.link
    is_curve = grid.node[tree, 0] != 0.0
    todo = stack_ints(_DEPTH)
    put(todo, 0, tree + 1)
    n_todo = 1
    while n_todo > 0:
        k, n_todo = _next_leaf(U, V, FRONT, m, grid, is_curve, x, y, todo, n_todo)
        if k < 0:
            break
        m = cut_lanes_by_run(
            U, V, N, m, dots.x, dots.y, x, y, -1 - link[k, 0], link[k, 1], APART,
            4.0 * reach2_of(U, V, m),
        )  # fmt: skip
        if m == OVERFLOW:
            break
    return m


@inline
def _least_distance2(grid: Grid, k: int, x: float, y: float) -> float:
    """Return a squared distance that no dot below node k is nearer to a place than."""
    arc = grid.arc
    least = _distance2_to_box(grid.node, k, x, y)
    if arc[k, 4] < 0.0:
        return least
    cx, cy, tx, ty = arc[k, 0] - x, arc[k, 1] - y, arc[k, 2], arc[k, 3]
    gx, gy = arc[k, 5] + 2.0 * cx, arc[k, 6] + 2.0 * cy
    spread = abs(gx * tx + gy * ty) + arc[k, 4] * abs(gy * tx - gx * ty)
    return float(max(least, cx * cx + cy * cy + arc[k, 7] - spread))


@inner
def _nearer_dot(
    dots: Dots, grid: Grid, root: int, x: float, y: float, best: int, best2: float
) -> int:
    """Return a dot below a node that is nearer to a place than `best2`, squared, or `best`.

    In most cases it is the nearest; but where very many are about as near it is not looked for on.
    """
    link = grid.link
    todo, least = stack_ints(_DEPTH), stack_doubles(_DEPTH)
    put(todo, 0, root)
    put(least, 0, 0.0)
    n_todo, looks = 1, 0
    while n_todo > 0 and looks < _MOST_NODES:
        n_todo -= 1
        if get(least, n_todo) >= best2:
            continue
        looks += 1
        k = ZERO + get(todo, n_todo)
        a, b = ZERO + link[k, 0], ZERO + link[k, 1]
        if a < 0:
            for j in range(-1 - a, b):
                far2 = (dots.x[j] - x) ** 2 + (dots.y[j] - y) ** 2
                if far2 < best2:
                    best, best2 = j, far2
            continue
        of_a, of_b = _least_distance2(grid, a, x, y), _least_distance2(grid, b, x, y)
        if of_b > of_a:
            a, b, of_a, of_b = b, a, of_b, of_a
        put(todo, n_todo, a)
        put(least, n_todo, of_a)
        put(todo, n_todo + 1, b)
        put(least, n_todo + 1, of_b)
        n_todo += 2
    return int(best)


@inner
def _cut_lanes_by_leaf(
    U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, spot: Spot, root: int, leaf: int
) -> int:
    """Cut a rough cell by the dots of a leaf, and before each by a better one below a node.

    Better is a dot that is nearer to the corner that the one of the leaf takes away.
    """
    link, x, y = grid.link, spot.x, spot.y
    j, end = ZERO - 1 - link[leaf, 0], ZERO + link[leaf, 1]
    while j < end and m != OVERFLOW:
        near = near_mask(dots.x, dots.y, j, x, y, APART, 4.0 * reach2_of(U, V, m))
        if end - j < SCAN:
            near &= (1 << (end - j)) - 1
        while near != 0 and m != OVERFLOW:
            k = j + lowest_bit(near)
            near &= near - 1
            a, b = dots.x[k] - x, dots.y[k] - y
            limit = 0.5 * (a * a + b * b) * (1.0 + TOLERANCE)
            mask = out_mask(U, V, a, b, limit) & ((1 << m) - 1)
            if mask == 0 or holds(N, m, k):
                continue
            corner = lowest_bit(mask)
            u, v = get(U, corner), get(V, corner)
            better = _nearer_dot(dots, grid, root, x + u, y + v, k, (a - u) ** 2 + (b - v) ** 2)
            if better != k:
                m = _cut_lanes(U, V, N, m, dots, x, y, better, better + 1)
            if m != OVERFLOW:
                m = _cut_lanes(U, V, N, m, dots, x, y, k, k + 1)
        j += SCAN
    return m


@inner
def cut_lanes_by_tree(
    U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, spot: Spot, root: int
) -> tuple[int, int]:
    """Cut a dot's cell by all dots below a node.

    Returns its corners, or `OVERFLOW`, and how many leaves were looked into.

    Along the rim of a void each dot further on takes a little from the cell, a new corner each
    time, until one across the void takes all that away. So after the dots next to its own those
    nearest to corners that are to go cut it; few are left then that all others are left out by.
    """
    link, k = grid.link, ZERO + root
    while link[k, 0] >= 0:
        k = ZERO + (link[k, 1] if _is_second_nearer(grid, k, spot.x, spot.y) else link[k, 0])
    m = _cut_lanes(U, V, N, m, dots, spot.x, spot.y, -1 - link[k, 0], link[k, 1])
    todo = stack_ints(_DEPTH)
    put(todo, 0, root)
    n_todo, n_leaves = 1, ZERO + 1
    while m != OVERFLOW:
        k, n_todo = _next_leaf(U, V, FRONT, m, grid, True, spot.x, spot.y, todo, n_todo)
        if k < 0:
            break
        m = _cut_lanes_by_leaf(U, V, N, m, dots, grid, spot, root, k)
        n_leaves += 1
    return m, n_leaves


@inline
def _is_side(cell: F8, m: int, number: int) -> bool:
    for k in range(m):  # noqa: SIM110 - a kernel
        if cell[5, k] == number:
            return True
    return False


@inline
def _cut_cell(cell: F8, m: int, dots: Dots, x: float, y: float, j: int) -> int:
    a, b = dots.x[j] - x, dots.y[j] - y
    return int(cut_cell(cell, m, a, b, 0.5 * (a * a + b * b), float(j)))


@inline
def _corner_beyond(cell: F8, m: int, a: float, b: float) -> int:
    """Return the corner farthest beyond the bisector of a dot at (a, b), or -1."""
    best, most = ZERO - 1, 0.5 * (a * a + b * b) * (1.0 + TOLERANCE)
    for k in range(m):
        if cell[0, k] * a + cell[1, k] * b > most:
            best, most = k, cell[0, k] * a + cell[1, k] * b
    return int(best)


@inner
def _cut_cell_by_leaf(
    cell: F8, m: int, dots: Dots, grid: Grid, x: float, y: float, root: int, leaf: int
) -> int:
    """Cut a rough cell in a plain array as `_cut_lanes_by_leaf` does one in lanes."""
    for k in range(-1 - grid.link[leaf, 0], grid.link[leaf, 1]):
        a, b = dots.x[k] - x, dots.y[k] - y
        corner = _corner_beyond(cell, m, a, b)
        if corner < 0 or a * a + b * b < APART or _is_side(cell, m, k):
            continue
        u, v = cell[0, corner], cell[1, corner]
        better = _nearer_dot(dots, grid, root, x + u, y + v, k, (a - u) ** 2 + (b - v) ** 2)
        if better != k and not _is_side(cell, m, better):
            m = _cut_cell(cell, m, dots, x, y, better)
        if m != OVERFLOW:
            m = _cut_cell(cell, m, dots, x, y, k)
        if m == OVERFLOW:
            break
    return m


@inner
def cut_cell_by_tree(
    cell: F8, m: int, dots: Dots, grid: Grid, x: float, y: float, root: int, is_curve: bool,
    is_rough: bool,
) -> int:  # fmt: skip
    """Cut a cell in a plain array by all dots below a node, the nearest first.

    A rough one, which some of them may have cut before, is not cut by them again.
    """
    link = grid.link
    todo = stack_ints(_DEPTH)
    put(todo, 0, root)
    n_todo = 1
    while m != OVERFLOW:
        U, V = data_of(cell[0]), data_of(cell[1])
        k, n_todo = _next_leaf(U, V, ZERO, m, grid, is_curve, x, y, todo, n_todo)
        if k < 0:
            break
        if is_rough:
            m = _cut_cell_by_leaf(cell, m, dots, grid, x, y, root, k)
            continue
        reach2 = reach2_of_cell(cell, m)
        for j in range(-1 - link[k, 0], link[k, 1]):
            a, b = dots.x[j] - x, dots.y[j] - y
            if 0.0 < a * a + b * b < 4.0 * reach2:
                m = _cut_cell(cell, m, dots, x, y, j)
                if m == OVERFLOW:
                    break
    return m


@inner
def _cut_lanes_by_cells(
    U: Any, V: Any, N: Any, m: int, dots: Dots, grid: Grid, spot: Spot, row: int, first: int,
    last: int, least: float, limit: float, skip: int,
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
                m = cut_lanes_by_crowd(U, V, N, m, dots, grid, spot.x, spot.y, cell)
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
    last: int, least: float, limit: float, skip: int,
) -> int:  # fmt: skip
    """Cut a cell by the dots of grid cells first..last of a row; return its corners.

    Only dots with ``least <= distance² < limit`` count; but a crowd is cut by as a whole if `least`
    leaves out none, and else not at all. Grid cell `skip` is left out.
    """
    a = spot.first_cell + row * spot.nx
    start, end = grid.cell_start[a + first], grid.cell_start[a + last + 1]
    if end - start > CROWD and len(grid.tree_of_cell) > 0:
        return _cut_lanes_by_cells(
            U, V, N, m, dots, grid, spot, row, first, last, least, limit, skip
        )
    return cut_lanes_by_run(U, V, N, m, dots.x, dots.y, spot.x, spot.y, start, end, least, limit)
