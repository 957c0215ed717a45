"""Dots of a crowd's node that lie along a line or an arc, bounded more closely than by a box.

A box around dots on a slanted curve leans over it to both sides, and into the circles about the
corners of cells beside the curve. Dots on a circle lie all but on one through a common corner of
their cells: no box tells that they do not lie within.

Here a node's dots are bounded by a rectangle along the curve, and by how they lie to a circle: for
an offset o from the middle, ``|o|² >= (ax, ay) . o + least``. Row k of `arc` is of row k of the
nodes (see `cell_trees`): the middle's x and y, half the rectangle's length as a vector, its width
by its length, ax, ay, and least. The width is -1 where there is nothing of the kind.
"""

from __future__ import annotations

import math

from stippler.kernels.cells.tables import F8
from stippler.kernels.machine.jit import inline, inner

_THIN = 0.125
"""Widest rectangle, by its length, that says more than a box."""

_STRAIGHT = 1e-14
"""Square of a rectangle's width, by its length, below which only rounding would tell a bend."""


@inline
def lies_on_curve(node: F8, tree: int, depth: int) -> bool:
    """Whether a tree's leaves cover little enough of the whole for dots that lie on a curve."""
    leaves = 0.0
    for k in range(tree + (1 << depth), tree + (2 << depth)):
        leaves += (node[k, 2] - node[k, 0]) * (node[k, 3] - node[k, 1])
    k = tree + 1
    share = min(0.25, 6.0 / (1 << depth))  # on a slanted line it is one by the number of leaves
    return bool(leaves <= share * (node[k, 2] - node[k, 0]) * (node[k, 3] - node[k, 1]))


@inner
def bound_arc(arc: F8, k: int, x: F8, y: F8, low: int, high: int) -> None:
    """Write row k of `arc` for the dots low..high."""
    n, cx, cy = high - low, 0.0, 0.0
    for s in range(low, high):
        cx, cy = cx + x[s], cy + y[s]
    cx, cy = cx / n, cy / n
    xx = xy = yy = 0.0
    for s in range(low, high):
        dx, dy = x[s] - cx, y[s] - cy
        xx, xy, yy = xx + dx * dx, xy + dx * dy, yy + dy * dy
    arc[k, 4] = -1.0
    if 4.0 * (xx * yy - xy * xy) > _THIN * _THIN * (xx + yy) * (xx + yy) or xx + yy == 0.0:
        return
    turn = 0.5 * math.atan2(2.0 * xy, xx - yy)
    tx, ty = math.cos(turn), math.sin(turn)
    tt = nn = ts = ns = 0.0
    length = width = 0.0
    for s in range(low, high):
        dx, dy = x[s] - cx, y[s] - cy
        t, n_ = dx * tx + dy * ty, dy * tx - dx * ty
        far2 = dx * dx + dy * dy
        length, width = max(length, abs(t)), max(width, abs(n_))
        tt, nn, ts, ns = tt + t * t, nn + n_ * n_, ts + t * far2, ns + n_ * far2
    along, across = ts / tt, ns / nn if nn > _STRAIGHT * tt else 0.0
    ax, ay = along * tx - across * ty, along * ty + across * tx
    least = math.inf
    for s in range(low, high):
        dx, dy = x[s] - cx, y[s] - cy
        least = min(least, dx * dx + dy * dy - ax * dx - ay * dy)
    if width > _THIN * length:
        return
    arc[k, 0], arc[k, 1], arc[k, 2], arc[k, 3] = cx, cy, length * tx, length * ty
    arc[k, 4], arc[k, 5], arc[k, 6], arc[k, 7] = width / length, ax, ay, least
