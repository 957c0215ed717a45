"""One tree over all dots of a compartment in which some lie along curves.

Beside a void cells reach across it, and each would ask every grid cell along its rim. So grid cells
that hold dots are joined by a tree of their own: they are split into two halves across their longer
side, and each half again, until one is left. That is a crowd, whose own tree goes on below, or
a leaf (see `cell_trees`).

Of the n grid cells of a compartment joined, in the order of the tree, number r from its `first`
row on is a leaf, unless it is a crowd; the node that parts cell r from the one before it is row
``first + n + r - 1``.
"""

from __future__ import annotations

import math

import numpy as np

from stippler.kernels.cells.cell_trees import part_rows
from stippler.kernels.cells.crowd_arcs import bound_arc
from stippler.kernels.cells.tables import F8, I4
from stippler.kernels.machine.jit import ZERO, inline, kernel
from stippler.kernels.machine.simd import get, put, stack_ints

_ROOM = 128
"""For two ends of each node not yet parted: one a level, and both halves of the last."""


@inline
def _row_of(low: int, high: int, first: int, n: int, crowd_row: int) -> int:
    """Return the row of the node over grid cells low..high, the first one's tree if it has one."""
    if high - low > 1:
        return int(first + n + ((low + high) >> 1) - 1)
    return int(crowd_row if crowd_row > 0 else first + low)


@kernel
def join_cells(
    start: int, stop: int, end_of_part: I4, order: I4, x: F8, y: F8, cell: I4, tree_of_cell: I4,
    cell_start: I4, base: int, link: I4, root: I4, span: I4, dot: I4, first_dot: I4,
) -> None:  # fmt: skip
    """Join the grid cells of some compartments by a tree each.

    Parameters
    ----------
    end_of_part
        By compartment joined, from the second on: the end of its grid cells in the arrays by those.
    order, x, y, cell
        By grid cell: 0, 1, …, which gets the order of the tree; where it lies; its number.
    base
        The first compartment's first row in `link`; each has two rows for a grid cell.
    link, root
        Results, `root` by compartment joined.
    span
        Result, by row from `base` on: the dots below it, in the order of the tree; the same twice
        for what is no node.
    dot, first_dot
        Result, the dots in that order; by compartment joined, where its own begin.
    """
    todo = stack_ints(_ROOM)
    for q in range(start, stop):
        a = ZERO + end_of_part[q]
        n = ZERO + end_of_part[q + 1] - a
        first, at = base + 2 * a, ZERO + first_dot[q]
        put(todo, 0, np.int32(0))
        put(todo, 1, np.int32(n))
        n_todo = ZERO + 2
        while n_todo > 0:
            n_todo -= 2
            low, high = ZERO + get(todo, n_todo), ZERO + get(todo, n_todo + 1)
            if high - low < 2:
                continue
            x0 = y0 = math.inf
            x1 = y1 = -math.inf
            for r in range(a + low, a + high):
                x0, x1 = min(x0, x[order[r]]), max(x1, x[order[r]])
                y0, y1 = min(y0, y[order[r]]), max(y1, y[order[r]])
            middle = (low + high) >> 1
            part_rows(x if x1 - x0 >= y1 - y0 else y, order, a + low, a + high, a + middle)
            k = 2 * a + n + middle - 1
            span[k, 0], span[k, 1] = low, high
            for end in (low, middle, middle, high):
                put(todo, n_todo, np.int32(end))
                n_todo += 1
        for r in range(n):
            c = cell[order[a + r]]
            k = 2 * a + r
            span[k, 0] = at
            for s in range(cell_start[c], cell_start[c + 1]):
                dot[at] = s
                at += 1
            span[k, 1] = at
            link[base + k, 0], link[base + k, 1] = -1 - cell_start[c], cell_start[c + 1]
        for middle in range(1, n):
            k = 2 * a + n + middle - 1
            low, high = span[k, 0], span[k, 1]
            below = tree_of_cell[cell[order[a + low]]] + 1
            link[base + k, 0] = _row_of(low, middle, first, n, below)
            below = tree_of_cell[cell[order[a + middle]]] + 1
            link[base + k, 1] = _row_of(middle, high, first, n, below)
            span[k, 0], span[k, 1] = span[2 * a + low, 0], span[2 * a + high - 1, 1]
        root[q] = _row_of(0, n, first, n, tree_of_cell[cell[order[a]]] + 1)
        for r in range(n):
            k = 2 * a + r
            if tree_of_cell[cell[order[a + r]]] >= 0:
                span[k, 1] = span[k, 0]


@kernel
def bound_joined(
    start: int, stop: int, base: int, span: I4, x: F8, y: F8, node: F8, arc: F8
) -> None:
    """Write the boxes of nodes that join grid cells, and what tells more of dots along curves.

    `x` and `y` are the dots' in the order of the tree.
    """
    for w in range(start, stop):
        low, high = span[w, 0], span[w, 1]
        if low == high:
            continue
        x0 = y0 = math.inf
        x1 = y1 = -math.inf
        for s in range(low, high):
            x0, x1 = min(x0, x[s]), max(x1, x[s])
            y0, y1 = min(y0, y[s]), max(y1, y[s])
        k = base + w
        node[k, 0], node[k, 1], node[k, 2], node[k, 3] = x0, y0, x1, y1
        bound_arc(arc, k, x, y, low, high)
