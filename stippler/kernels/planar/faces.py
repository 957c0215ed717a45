"""Faces between edges of a planar graph: which sides of edges face the same place."""

from __future__ import annotations

from typing import Any

import numpy as np

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.planar.contacts import cross

UNKNOWN = -2
"""The area beside an edge, where the edge itself does not tell."""


@inline
def _half(dx, dy):
    return 0 if dy > 0 or (dy == 0 and dx > 0) else 1


@inline
def _comes_before(ax, ay, bx, by):
    """Return whether direction a comes before b, turning from x towards y."""
    ha, hb = _half(ax, ay), _half(bx, by)
    if ha != hb:
        return ha < hb
    return ax * by - ay * bx > 0


@kernel
def sort_around(nodes, a, b, start, around) -> None:
    """List the half-edges that leave each node, by direction.

    Half-edge 2 i leaves a[i] along edge i, 2 i + 1 leaves b[i]. `start` holds counts at first.
    """
    for i in range(len(a)):
        for k in range(2):
            node = a[i] if k == 0 else b[i]
            other = b[i] if k == 0 else a[i]
            dx, dy = nodes[other, 0] - nodes[node, 0], nodes[other, 1] - nodes[node, 1]
            slot = start[node]
            end = slot
            while around[end] >= 0:
                end += 1
            while end > slot:
                h = around[end - 1]
                far = b[h // 2] if h % 2 == 0 else a[h // 2]
                fx, fy = nodes[far, 0] - nodes[node, 0], nodes[far, 1] - nodes[node, 1]
                if not _comes_before(dx, dy, fx, fy):
                    break
                around[end] = h
                end -= 1
            around[end] = 2 * i + k


@inline
def _root(parent, k):
    while parent[k] != k:
        parent[k] = parent[parent[k]]
        k = parent[k]
    return k


@inline
def _join(parent, i, j):
    i, j = _root(parent, i), _root(parent, j)
    if i != j:
        parent[max(i, j)] = min(i, j)


@kernel
def join_sides(start, around, whole, parent) -> None:
    """Join the sides of edges that face the same sector of a node.

    Side 2 i is left of edge i (towards y, seen along x), 2 i + 1 right of it. A half-edge's left
    side is its edge's left if it leaves from a.
    """
    for node in range(len(start) - 1):
        if not whole[node]:
            continue
        first, last = start[node], start[node + 1]
        for k in range(first, last):
            h = around[k]
            g = around[k + 1] if k + 1 < last else around[first]
            before_g = g + 1 if g % 2 == 0 else g - 1
            _join(parent, h, before_g)  # left of a->b is 2 i; left of b->a is 2 i + 1


@kernel
def join_through(see_through, parent) -> None:
    """Join both sides of edges that do not part what is asked for."""
    for i in range(len(see_through)):
        if see_through[i]:
            _join(parent, 2 * i, 2 * i + 1)


@kernel
def find_roots(parent) -> None:
    """Let every member of a class point at its root."""
    for k in range(len(parent)):
        parent[k] = _root(parent, k)


@kernel
def spread_windings(root, net, winding, known) -> bool:
    """Carry winding numbers across edges until all that can be known are; False on a conflict.

    `net` is the winding left of an edge less that right of it. `winding`, `known`: by root.
    """
    changed = True
    while changed:
        changed = False
        for i in range(len(net)):
            left, right = root[2 * i], root[2 * i + 1]
            if known[left] and known[right]:
                if winding[left] - winding[right] != net[i]:
                    return False
            elif known[left]:
                winding[right], known[right] = winding[left] - net[i], True
                changed = True
            elif known[right]:
                winding[left], known[left] = winding[right] + net[i], True
                changed = True
    return True


@kernel
def winding_around(x, y, s, jump, skip, component) -> Any:
    """Return the sum of jumps from far right to a point, without one component's segments."""
    total = np.int64(0)
    for i in range(len(s)):
        if component[i] == skip or jump[i] == 0:
            continue
        x0, y0, x1, y1 = s[i, 0], s[i, 1], s[i, 2], s[i, 3]
        if (y0 <= y) == (y1 <= y):
            continue
        c = cross(x0, y0, x1, y1, x, y)
        if (c > 0) == (y1 > y0):
            total += jump[i] if y1 > y0 else -jump[i]
    return total


@kernel
def chain_edges(a, b, left, right, is_break, order, forward, start) -> int:
    """Chain edges into arcs from break to break, or around; return how many arcs.

    Parameters
    ----------
    a, b : (m,) int64
        Nodes of the edges.
    left, right : (m,) int64
        What lies beside them; turned about with them.
    is_break : (n,) bool
        Nodes where arcs end; all others have two edges.
    order, forward : (m,) int64, (m,) bool
        Are filled: the edges arc by arc, and whether each runs from a to b.
    start : (m + 1,) int64
        Is filled: where each arc begins in `order`.
    """
    m, n = len(a), len(is_break)
    at = np.full((n, 2), -1, np.int64)
    for i in range(m):
        for node in (a[i], b[i]):
            if not is_break[node]:
                at[node, 0 if at[node, 0] < 0 else 1] = i
    used = np.zeros(m, np.bool_)
    n_arcs, filled = 0, 0
    for turn in range(2):  # first those with ends, then rings
        for i in range(m):
            if used[i]:
                continue
            runs = is_break[a[i]]
            if turn == 0 and not (runs or is_break[b[i]]):
                continue
            runs = runs or turn == 1
            start[n_arcs] = filled
            n_arcs += 1
            e = i
            while True:
                used[e] = True
                order[filled], forward[filled] = e, runs
                filled += 1
                node = b[e] if runs else a[e]
                if is_break[node]:
                    break
                e = at[node, 0] if at[node, 1] == e else at[node, 1]
                if used[e]:
                    break
                runs = a[e] == node
    start[n_arcs] = filled
    return n_arcs


@kernel
def clear_slack(a, b, is_slack, degree, gone) -> None:
    """Mark slack edges that hang by one end, and what then hangs, as gone."""
    changed = True
    while changed:
        changed = False
        for i in range(len(a)):
            if is_slack[i] and not gone[i] and (degree[a[i]] == 1 or degree[b[i]] == 1):
                gone[i] = True
                degree[a[i]] -= 1
                degree[b[i]] -= 1
                changed = True
