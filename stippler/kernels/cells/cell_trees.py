"""Grid cells that hold many dots, split further.

A uniform grid is right for dots spread evenly; in a tight cluster a cell of it holds hundreds. The
dots of such a *crowd* are split into two halves across its longer side, and each half again, until
`LEAF` or fewer are left, which is what one vector instruction tests. The n dots of a crowd stay
together; node v of level l, both counted from 0, holds those from ``n v >> l`` to before
``n (v + 1) >> l``.

`node` holds the boxes of all crowds' nodes, ``xmin, ymin, xmax, ymax``, by levels: node v of level
l is row ``first + 2^l + v``, where `first` is the grid cell's entry of `tree_of_cell`. In row
`first` is 1 where `arc` tells more, see `crowd_arcs`, else 0. A grid cell that is no crowd has the
entry -1, and -1 - k if it is the first of k without dots.

`link` holds by the same rows the two nodes below a node; below a leaf is none, and it holds
``-1 - first, end`` of its dots. So grid cells' trees can be joined, see `curve_trees`.
"""

from __future__ import annotations

import math

from stippler.kernels.cells.crowd_arcs import bound_arc, lies_on_curve
from stippler.kernels.cells.tables import F8, I4
from stippler.kernels.machine.jit import ZERO, inline, kernel

CROWD = 24
"""Dots in a grid cell from which on it is split."""

LEAF = 8


@inline
def levels_of(n: int) -> int:
    """Return how many times a crowd of n dots is halved."""
    level = ZERO
    while n > LEAF << level:
        level += 1
    return int(level)


@inline
def part_rows(key: F8, row: I4, start: int, stop: int, middle: int) -> None:
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
                part_rows(x if x1 - x0 >= y1 - y0 else y, order, low, high, middle)


@kernel
def link_crowds(
    start: int, stop: int, crowd: I4, tree_of_cell: I4, cell_start: I4, link: I4
) -> None:
    """Write what lies below the nodes of the trees of grid cells ``crowd[start:stop]``."""
    for w in range(start, stop):
        first = cell_start[crowd[w]]
        n = cell_start[crowd[w] + 1] - first
        tree = tree_of_cell[crowd[w]]
        depth = levels_of(n)
        for v in range(1, 1 << depth):
            link[tree + v, 0], link[tree + v, 1] = tree + 2 * v, tree + 2 * v + 1
        for v in range(1 << depth):
            k = tree + (1 << depth) + v
            link[k, 0] = -1 - (first + ((n * v) >> depth))
            link[k, 1] = first + ((n * (v + 1)) >> depth)


@kernel
def bound_crowds(
    start: int, stop: int, crowd: I4, tree_of_cell: I4, cell_start: I4, x: F8, y: F8, node: F8,
    arc: F8,
) -> None:  # fmt: skip
    """Write the boxes of the trees of grid cells ``crowd[start:stop]`` around where dots are.

    Where dots lie along curves, `arc` tells more; elsewhere it says that it does not.
    """
    for w in range(start, stop):
        first = cell_start[crowd[w]]
        n = cell_start[crowd[w] + 1] - first
        tree = tree_of_cell[crowd[w]]
        depth = levels_of(n)
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
        node[tree, 0] = 0.0
        if lies_on_curve(node, tree, depth):
            node[tree, 0] = 1.0
            for level in range(depth + 1):
                for v in range(1 << level):
                    low, high = first + ((n * v) >> level), first + ((n * (v + 1)) >> level)
                    bound_arc(arc, tree + (1 << level) + v, x, y, low, high)
        else:
            for k in range(tree, tree + (2 << depth)):
                arc[k, 4] = -1.0
