"""Cells at the border: the edges near them, their outlines, integrals, and moves kept inside.

An outline is a list of directed segments ``u0, v0, u1, v1, number, ring`` relative to the dot, the
cell on their left, ring after ring and each in order. `number` is the row of the dot beyond, or
``-1 - e`` for border edge e.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.kernels.cells.clip import outline_piece
from stippler.kernels.cells.field import COLUMNS, FIRST, ROWS, integrate_edge
from stippler.kernels.cells.field_lanes import walk_lanes, walk_sides
from stippler.kernels.cells.grid import column_of
from stippler.kernels.cells.tables import F8, I4, Border, Field, Pads, Spot
from stippler.kernels.cells.voronoi import cut_cell, reach2_of_cell
from stippler.kernels.machine.eight import AT_ONCE
from stippler.kernels.machine.jit import ZERO, inline, inner
from stippler.kernels.machine.processor import reads_lanes
from stippler.kernels.machine.simd import get, lowest_bit

NOWHERE = -(1 << 30)
"""Number of a side that is neither a dot's nor a border's: of what the search has seen so far."""

_CLOSE = 1e-13  # of a cell's reach: what is nearer to a line than this may be on either side of it
_ROUNDING = 1e-12  # of all that is added and taken away again in a sum


_IN_LANES = reads_lanes()


@inline
def gather_edges(border: Border, spot: Spot, ring: int, pads: Pads, stamp: int) -> int:
    """List the border edges in the grid cells up to `ring`, each once."""
    n = ZERO
    x0, x1 = max(spot.ix - ring, 0), min(spot.ix + ring, spot.nx - 1)
    for j in range(max(spot.iy - ring, 0), min(spot.iy + ring, spot.ny - 1) + 1):
        row = spot.first_cell + j * spot.nx
        for s in range(border.cell_start[row + x0], border.cell_start[row + x1 + 1]):
            e = border.edge_of_slot[s]
            if pads.seen[e] != stamp:
                pads.seen[e] = stamp
                pads.near[n] = e
                n += 1
    return int(n)


@inner
def gather_edges_in_cell(
    border: Border, spot: Spot, cell: F8, m: int, pads: Pads, stamp: int
) -> int:
    """List the border edges in the grid cells that a cell of m corners reaches into, each once."""
    n = ZERO
    low, high = math.inf, -math.inf
    for k in range(m):
        low, high = min(low, cell[1, k]), max(high, cell[1, k])
    inverse, slack = 1.0 / spot.h, 1e-6 * spot.h
    last_row = column_of(spot.y + high + slack, spot.gy, inverse, spot.ny)
    for j in range(column_of(spot.y + low - slack, spot.gy, inverse, spot.ny), last_row + 1):
        row = spot.first_cell + j * spot.nx
        if border.cell_start[row] == border.cell_start[row + spot.nx]:
            continue
        top = spot.gy + j * spot.h - spot.y
        left, right = _columns_between(cell, m, top - slack, top + spot.h + slack)
        x0 = column_of(spot.x + left - slack, spot.gx, inverse, spot.nx)
        x1 = column_of(spot.x + right + slack, spot.gx, inverse, spot.nx)
        for s in range(border.cell_start[row + x0], border.cell_start[row + x1 + 1]):
            e = border.edge_of_slot[s]
            if pads.seen[e] != stamp:
                pads.seen[e] = stamp
                pads.near[n] = e
                n += 1
    return int(n)


@inline
def _columns_between(cell: F8, m: int, below: float, above: float) -> tuple[float, float]:
    """Return from where to where, in x from the dot, a cell reaches with y in below..above."""
    left, right = math.inf, -math.inf
    for k in range(m):
        n = k + 1 if k + 1 < m else 0
        u, v, du, dv = cell[0, k], cell[1, k], cell[0, n] - cell[0, k], cell[1, n] - cell[1, k]
        if max(v, v + dv) < below or min(v, v + dv) > above:
            continue
        for y in (below, above):
            t = min(max((y - v) / dv, 0.0), 1.0) if dv != 0.0 else 0.0
            left, right = min(left, u + t * du), max(right, u + t * du)
        if dv == 0.0:
            left, right = min(left, u + du), max(right, u + du)
    return left, right


@inline
def border_distance(edge: F8, near: I4, n_near: int, x: float, y: float) -> float:
    """Return the distance of (x, y) from the nearest of the edges listed."""
    best = math.inf
    for s in range(n_near):
        e = near[s]
        au, av = x - edge[e, 0], y - edge[e, 1]
        eu, ev = edge[e, 2] - edge[e, 0], edge[e, 3] - edge[e, 1]
        t = min(max((au * eu + av * ev) / (eu * eu + ev * ev), 0.0), 1.0)
        au -= t * eu
        av -= t * ev
        best = min(best, au * au + av * av)
    return math.sqrt(best) * (1.0 - 1e-9)


@inline
def reach2_of_outline(out: F8, n: int) -> float:
    """Return the square of the largest distance of an outline's corner from the dot."""
    best = 0.0
    for s in range(n):
        best = max(best, out[s, 0] * out[s, 0] + out[s, 1] * out[s, 1])
    return best


@inner
def outline_within(
    m: int, border: Border, spot: Spot, ring: int, pads: Pads, n_near: int, stamp: int
) -> tuple[int, float]:
    """Outline the dot's piece of the cell within the rings seen; return its reach, squared, too.

    A piece that touches the outermost ring's walls reaches as far as they do, which tells the
    caller to look further.
    """
    cell2, nowhere = pads.cell2, float(NOWHERE)
    for k in range(m):
        for r in range(5):
            cell2[r, k] = pads.cell[r, k]
        cell2[5, k] = pads.cell[5, k] if pads.cell[5, k] >= 0.0 else nowhere
    n2 = m
    left, top = spot.gx - spot.x, spot.gy - spot.y
    if spot.ix - ring > 0:
        n2 = cut_cell(cell2, n2, -1.0, 0.0, -(left + (spot.ix - ring) * spot.h), nowhere)
    if spot.ix + ring < spot.nx - 1:
        n2 = cut_cell(cell2, n2, 1.0, 0.0, left + (spot.ix + ring + 1) * spot.h, nowhere)
    if spot.iy - ring > 0:
        n2 = cut_cell(cell2, n2, 0.0, -1.0, -(top + (spot.iy - ring) * spot.h), nowhere)
    if spot.iy + ring < spot.ny - 1:
        n2 = cut_cell(cell2, n2, 0.0, 1.0, top + (spot.iy + ring + 1) * spot.h, nowhere)
    margin = _CLOSE * math.sqrt(reach2_of_cell(cell2, n2)) + 1e-15 * (abs(spot.x) + abs(spot.y))
    for k in range(n2):
        cell2[6, k] = margin * math.hypot(cell2[2, k], cell2[3, k])
    n = outline_piece(n2, spot.x, spot.y, border, pads, n_near, stamp, margin)
    return n, reach2_of_outline(pads.out, n)


@inline
def outline_of_cell(cell: F8, m: int, out: F8) -> None:
    """Write the outline of a cell that no polygon's border cuts, without numbers."""
    for k in range(m):
        n = k + 1 if k + 1 < m else 0
        out[k, 0], out[k, 1], out[k, 2], out[k, 3] = cell[0, k], cell[1, k], cell[0, n], cell[1, n]


@inline
def outline_of_lanes(U: Any, V: Any, m: int, out: F8) -> None:
    """Write the outline of a cell in lanes that no polygon's border cuts, without numbers."""
    for k in range(m):
        n = k + 1 if k + 1 < m else 0
        out[k, 0], out[k, 1], out[k, 2], out[k, 3] = get(U, k), get(V, k), get(U, n), get(V, n)


@inline
def has_walls(out: F8, n: int) -> bool:
    """Whether something else than a dot lies beyond a side of an outline."""
    for s in range(n):  # noqa: SIM110 - a kernel
        if out[s, 4] < 0.0:
            return True
    return False


@inline
def put_numbers(N: Any, cell: F8, m: int, is_packed: bool, first_edge: int, out: F8) -> None:
    """Write the numbers of sides of a cell that no polygon cuts; a box's are border edges."""
    for k in range(m):
        j = get(N, k) if is_packed else int(cell[5, k])
        out[k, 4], out[k, 5] = float(j if j >= 0 else j - first_edge), 0.0


@inline
def sum_area(out: F8, n: int) -> tuple[float, float, float, float]:
    """Return area, both first moments and the second moment about the dot."""
    area = mu = mv = second = 0.0
    for s in range(n):
        au, av, bu, bv = out[s, 0], out[s, 1], out[s, 2], out[s, 3]
        cross = au * bv - bu * av
        area += cross
        mu += cross * (au + bu)
        mv += cross * (av + bv)
        second += cross * (au * au + au * bu + bu * bu + av * av + av * bv + bv * bv)
    return 0.5 * area, mu / 6.0, mv / 6.0, second / 12.0


@inner
def sum_field(
    out: F8, n: int, x: float, y: float, c: int, field: Field
) -> tuple[float, float, float]:
    """Return the mass over an outline in compartment c, and its first moments about the dot.

    A mass that rounding alone could make is none: its moments would lead anywhere.
    """
    frame, window = field.frame, field.window
    ku, kv = 1.0 / frame[c, 2], 1.0 / frame[c, 3]
    px, py = (x - frame[c, 0]) * ku, (y - frame[c, 1]) * kv
    start, h, w = window[c, FIRST], window[c, ROWS], window[c, COLUMNS]
    total = mu = mv = gross = 0.0
    if h == 0:
        return 0.0, 0.0, 0.0
    for first in range(0, n, AT_ONCE):
        left = (1 << min(n - first, AT_ONCE)) - 1
        if _IN_LANES:
            m, mx, my, size, left = walk_sides(
                out, ZERO + first, ZERO + n, ku, kv, field.sums, start, h, w, px, py
            )
            total += m
            gross += size
            mu += mx
            mv += my
        while left != 0:
            s = first + lowest_bit(left)
            left &= left - 1
            m, mx, my = integrate_edge(
                field.sums, start, h, w, px, py,
                out[s, 0] * ku, out[s, 1] * kv, out[s, 2] * ku, out[s, 3] * kv,
            )  # fmt: skip
            total += m
            gross += abs(m)
            mu += mx
            mv += my
    if total <= _ROUNDING * gross:
        return 0.0, 0.0, 0.0
    size = frame[c, 2] * frame[c, 3]
    return total * size, mu * size * frame[c, 2], mv * size * frame[c, 3]


@inline
def sum_field_in_lanes(
    U: Any, V: Any, m: int, x: float, y: float, c: int, field: Field, out: F8
) -> tuple[float, float, float]:
    """Return what `sum_field` does for a cell of m corners in lanes; `out` is scratch."""
    frame, window = field.frame, field.window
    if _IN_LANES and m <= AT_ONCE and window[c, ROWS] > 0:
        ku, kv = 1.0 / frame[c, 2], 1.0 / frame[c, 3]
        px, py = (x - frame[c, 0]) * ku, (y - frame[c, 1]) * kv
        mass, mu, mv, gross, left = walk_lanes(
            U, V, m, ku, kv, field.sums, window[c, FIRST], window[c, ROWS], window[c, COLUMNS],
            px, py,
        )  # fmt: skip
        if left == 0:
            if mass <= _ROUNDING * gross:
                return 0.0, 0.0, 0.0
            size = frame[c, 2] * frame[c, 3]
            return mass * size, mu * size * frame[c, 2], mv * size * frame[c, 3]
    outline_of_lanes(U, V, m, out)
    return sum_field(out, m, x, y, c, field)


@inline
def free_share(out: F8, n: int, du: float, dv: float) -> float:
    """Return the share of the move (du, dv) that stays within a convex outline of n sides.

    1 if the way ends inside; else half of the way to the first side met.
    """
    share = 1.0
    for s in range(n):
        au, av = out[s, 0], out[s, 1]
        eu, ev = out[s, 2] - au, out[s, 3] - av
        before = ev * au - eu * av  # left is positive
        after = before + eu * dv - ev * du
        if after < 0.0 and after < before:
            share = min(share, 0.5 * max(before / (before - after), 0.0))
    return share
