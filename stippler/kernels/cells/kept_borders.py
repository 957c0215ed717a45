"""Cells at a border from the dots and edges they had in the step before.

In a convex compartment a dot sees all others, so cells that fit together along the whole border are
the true ones (see `kept_cells`). In a concave one a dot may come near from beyond a wall, and an
edge from anywhere, which no corner tells. There a cell is verified by itself: its corners lie
within all its bisectors, no other edge comes between them, and no other dot is nearer to one of
them. Cells that a border cuts apart fail this, and are computed anew in each step.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.kernels.cells.border import free_share, has_walls, outline_of_lanes, sum_field
from stippler.kernels.cells.cell_trees import CROWD
from stippler.kernels.cells.grid import (
    column_of,
    distance2_to_span,
    ring_span,
    seen_distance,
    spot_of,
)
from stippler.kernels.cells.moves import move_in_piece
from stippler.kernels.cells.spacing import ask, blend, rules_at_border, rules_in_lanes
from stippler.kernels.cells.tables import (
    F8,
    Border,
    Dots,
    Field,
    Grid,
    Moves,
    Spacing,
    Spot,
    Stars,
)
from stippler.kernels.cells.tree_search import APART
from stippler.kernels.machine.jit import ZERO, inline, inner
from stippler.kernels.machine.simd import (
    FRONT,
    SCAN,
    backward_sides,
    corners_of_lines,
    get,
    load_lanes,
    lowest_bit,
    moments_of,
    near_mask,
    out_mask,
    put,
    reach2_of,
)

_RINGS = 3
"""Rings of grid cells that are searched for dots that might cut a cell."""

_CLOSE = 1e-12
"""Share of a bisector's distance that a corner may lie beyond it by rounding."""


@inline
def _lines_of_star(
    A: Any, B: Any, C: Any, m: int, i: int, dots: Dots, border: Border, stars: Stars
) -> int:
    """Put the lines of a star's sides into A, B, C; return bits for the corners of two edges."""
    x, y = dots.x[i], dots.y[i]
    edge, is_edge = border.edge, 0
    for k in range(m):
        j = stars.around[i, k]
        if j >= 0:
            a, b = dots.x[j] - x, dots.y[j] - y
            put(C, k, 0.5 * (a * a + b * b))
        else:
            e = -1 - j
            is_edge |= 1 << k
            a, b = edge[e, 3] - edge[e, 1], edge[e, 0] - edge[e, 2]
            put(C, k, a * (edge[e, 0] - x) + b * (edge[e, 1] - y))
        put(A, k, a)
        put(B, k, b)
    for k in range(2):
        put(A, m + k, get(A, k))
        put(B, m + k, get(B, k))
        put(C, m + k, get(C, k))
    return is_edge & ((is_edge >> 1) | (is_edge << (m - 1)))


@inline
def _is_clear(C: Any, A: Any, B: Any, m: int, i: int, stars: Stars, du: float, dv: float) -> bool:
    """Whether a place is inside all edges of a star, by more than rounding."""
    for k in range(m):
        if stars.around[i, k] < 0:
            a, b, c = get(A, k), get(B, k), get(C, k)
            if a * du + b * dv > c - 1e-9 * abs(c) - 1e-12 * (a * a + b * b):
                return False
    return True


@inline
def _put_vertices(
    U: Any, V: Any, m: int, pairs: int, i: int, dots: Dots, border: Border, stars: Stars
) -> None:
    """Put the border's own corners where two of its edges meet."""
    while pairs != 0:
        k = lowest_bit(pairs)
        pairs &= pairs - 1
        e = -1 - stars.around[i, k]
        u, v = border.edge[e, 2] - dots.x[i], border.edge[e, 3] - dots.y[i]
        put(U, k, u)
        put(V, k, v)
        put(U, FRONT + k, u)
        put(V, FRONT + k, v)
        if k == 0:
            put(U, m, u)
            put(V, m, v)


@inner
def _is_on_edges(
    U: Any, V: Any, A: Any, B: Any, C: Any, m: int, i: int, dots: Dots, border: Border, stars: Stars
) -> bool:
    """Whether corners lie on the edges they are said to, and within all bisectors."""
    all_corners = (1 << m) - 1
    for k in range(m):
        j = stars.around[i, k]
        a, b = get(A, k), get(B, k)
        if j >= 0:
            if out_mask(U, V, a, b, get(C, k) * (1.0 + _CLOSE)) & all_corners:
                return False
            continue
        e = -1 - j
        before = k - 1 if k > 0 else m - 1
        eu, ev = -b, a  # along the edge
        u, v = border.edge[e, 0] - dots.x[i], border.edge[e, 1] - dots.y[i]
        slack = -_CLOSE * (eu * eu + ev * ev)
        if (get(U, before) - u) * eu + (get(V, before) - v) * ev < slack:
            return False
        if (u + eu - get(U, k)) * eu + (v + ev - get(V, k)) * ev < slack:
            return False
    return True


@inline
def _supporting_edges(U: Any, V: Any, A: Any, B: Any, C: Any, m: int, i: int, stars: Stars) -> int:
    """Return bits for the sides that have the whole cell on their left."""
    bits = 0
    for k in range(m):
        c = get(C, k)
        slack = 1e-9 * (abs(c) + get(A, k) * get(A, k) + get(B, k) * get(B, k))
        if stars.around[i, k] >= 0 or not (
            out_mask(U, V, get(A, k), get(B, k), c + slack) & ((1 << m) - 1)
        ):
            bits |= 1 << k
    return bits


@inner
def _meets_other_edge(
    U: Any, V: Any, A: Any, B: Any, C: Any, m: int, i: int, spot: Spot, reach2: float,
    border: Border, stars: Stars,
) -> bool:  # fmt: skip
    """Whether an edge that is none of the cell's own may come into it."""
    bits = _supporting_edges(U, V, A, B, C, m, i, stars)
    reach, inverse = math.sqrt(reach2), 1.0 / spot.h
    x0 = column_of(spot.x - reach, spot.gx, inverse, spot.nx)
    x1 = column_of(spot.x + reach, spot.gx, inverse, spot.nx)
    y0 = column_of(spot.y - reach, spot.gy, inverse, spot.ny)
    y1 = column_of(spot.y + reach, spot.gy, inverse, spot.ny)
    for row in range(y0, y1 + 1):
        first = spot.first_cell + row * spot.nx
        for s in range(border.cell_start[first + x0], border.cell_start[first + x1 + 1]):
            e = border.edge_of_slot[s]
            au, av = border.edge[e, 0] - spot.x, border.edge[e, 1] - spot.y
            bu, bv = border.edge[e, 2] - spot.x, border.edge[e, 3] - spot.y
            is_off = False
            for k in range(m):
                if stars.around[i, k] == -1 - e:
                    is_off = True
                    break
                if (bits >> k) & 1:
                    a, b, c = get(A, k), get(B, k), get(C, k)
                    c -= _CLOSE * (abs(c) + a * a + b * b)
                    if a * au + b * av >= c and a * bu + b * bv >= c:
                        is_off = True
                        break
            if is_off:
                continue
            eu, ev = bu - au, bv - av
            t = min(max(-(au * eu + av * ev) / (eu * eu + ev * ev), 0.0), 1.0)
            au += t * eu
            av += t * ev
            if au * au + av * av <= reach2 * (1.0 + 1e-9):
                return True
    return False


@inner
def _is_cut_by_run(
    U: Any, V: Any, m: int, spot: Spot, limit: float, dots: Dots, start: int, end: int
) -> bool:
    """Whether one of the dots start..end takes a corner from the cell."""
    j = start
    while j < end:
        near = near_mask(dots.x, dots.y, j, spot.x, spot.y, APART, limit)
        if end - j < SCAN:
            near &= (1 << (end - j)) - 1
        while near != 0:
            k = j + lowest_bit(near)
            near &= near - 1
            a, b = dots.x[k] - spot.x, dots.y[k] - spot.y
            c = 0.5 * (a * a + b * b)
            if out_mask(U, V, a, b, c * (1.0 + _CLOSE)) & ((1 << m) - 1):
                return True
        j += SCAN
    return False


@inner
def _is_cut_by_other_dot(
    U: Any, V: Any, m: int, spot: Spot, reach2: float, dots: Dots, grid: Grid
) -> bool:
    """Whether a dot takes a corner from the cell, or one might that is too far off to look for."""
    limit = 4.0 * reach2
    for ring in range(ZERO + 1, _RINGS + 1):
        for s in range(ZERO, 3 if ring == 1 else 4 * ring):
            row, first, last = ring_span(ring, s, spot)
            if last < first or distance2_to_span(spot, row, first, last, grid.slack) >= limit:
                continue
            at = spot.first_cell + row * spot.nx
            start, end = grid.cell_start[at + first], grid.cell_start[at + last + 1]
            if end - start > 5 * CROWD or _is_cut_by_run(U, V, m, spot, limit, dots, start, end):
                return True
        far = seen_distance(spot, ring, grid.slack)
        if limit <= far * far:
            return False
    return True


@inner
def _is_verified(
    U: Any, V: Any, A: Any, B: Any, C: Any, m: int, i: int, dots: Dots, grid: Grid,
    border: Border, stars: Stars,
) -> bool:  # fmt: skip
    """Whether a cell of a concave compartment is the true one, whatever others are."""
    if not _is_on_edges(U, V, A, B, C, m, i, dots, border, stars):
        return False
    reach2 = reach2_of(U, V, m)
    spot = spot_of(dots.x[i], dots.y[i], dots.compartment[i], grid)
    if _is_cut_by_other_dot(U, V, m, spot, reach2, dots, grid):
        return False
    return not _meets_other_edge(U, V, A, B, C, m, i, spot, reach2, border, stars)


@inline
def _move_in_convex(
    A: Any, B: Any, C: Any, m: int, i: int, stars: Stars, du: float, dv: float, over: float
) -> tuple[bool, float, float]:
    """Return whether a centroid can be trusted to lie in a convex cell, and the way there."""
    share = over
    for k in range(m):
        there = get(A, k) * du + get(B, k) * dv
        if there > get(C, k):
            return False, du, dv
        if over * there > get(C, k):
            share = 1.0
    if not _is_clear(C, A, B, m, i, stars, share * du, share * dv):
        return False, du, dv
    return True, share * du, share * dv


@inner
def _way_by_rules(
    U: Any, V: Any, N: Any, m: int, i: int, is_whole: bool, area: float, mass: float, mu: float,
    mv: float, du: float, dv: float, dots: Dots, stars: Stars, spacing: Spacing, out: F8,
) -> tuple[float, float]:  # fmt: skip
    """Return the way that the rules of spacing take from (du, dv), that to the centre of mass.

    (mu, mv) are the area's first moments; side k of `out` runs from corner k to corner k + 1. Cells
    without walls, or in a box, count as whole, see `relaxation`.
    """
    ask(spacing, i, dots.compartment[i], area, mass)
    if not mass > 0.0:
        return 0.0, 0.0
    if is_whole:
        load_lanes(N, stars.around, i)
        put(N, m, get(N, 0))
        ru, rv = rules_in_lanes(U, V, N, ZERO + 1, m, i, dots.x[i], dots.y[i], dots, spacing)
    else:
        ru, rv = rules_at_border(out, m, i, dots.x[i], dots.y[i], dots, spacing)
    return blend(spacing, i, area, du, dv, mu / area, mv / area, ru, rv)


@inner
def move_by_lines(
    U: Any, V: Any, N: Any, A: Any, B: Any, C: Any, m: int, i: int, dots: Dots, grid: Grid,
    border: Border, field: Field, over: float, moves: Moves, stars: Stars, spacing: Spacing,
    out: F8,
) -> bool:  # fmt: skip
    """Move a dot at a border by its star; False if that does not hold any more."""
    x, y, c = dots.x[i], dots.y[i], dots.compartment[i]
    is_convex, by_rules = grid.whole[c, 5] == 1, len(spacing.table) > 0
    pairs = _lines_of_star(A, B, C, m, i, dots, border, stars)
    turned = corners_of_lines(A, B, C, m, U, V)
    if turned & ~pairs or (is_convex and turned):
        return False
    _put_vertices(U, V, m, pairs, i, dots, border, stars)
    if backward_sides(A, B, m, U, V):
        return False
    if not is_convex and not _is_verified(U, V, A, B, C, m, i, dots, grid, border, stars):
        return False
    area, mu, mv = moments_of(U, V, m)
    area, mu, mv = 0.5 * area, mu / 6.0, mv / 6.0
    mass, du, dv = area, mu, mv
    if len(field.sums) or not is_convex or by_rules:
        outline_of_lanes(U, V, m, out)
        for k in range(m):
            out[k, 4] = float(stars.around[i, k + 1 if k + 1 < m else 0])
    if len(field.sums):
        mass, du, dv = sum_field(out, m, x, y, c, field)
    is_box = by_rules and grid.whole[c, 3] == 0
    is_whole = is_box or (by_rules and not has_walls(out, m))
    if mass > 0.0:
        du, dv = du / mass, dv / mass
    else:
        mass = du = dv = 0.0
    if by_rules:
        if is_whole and len(field.sums):
            share = free_share(out, m, du, dv)
            du, dv = share * du, share * dv
        du, dv = _way_by_rules(
            U, V, N, m, i, is_whole, area, mass, mu, mv, du, dv, dots, stars, spacing, out
        )
    if not mass > 0.0 or dots.fixed[i]:
        du = dv = 0.0
    elif (is_whole and not is_box) or (is_convex and not by_rules):
        # where rules send a dot out of its cell the distance of walls counts, which is not known
        is_sure, du, dv = _move_in_convex(A, B, C, m, i, stars, du, dv, over)
        if not is_sure:
            return False
    elif not is_box:
        margin = 1e-10 * math.sqrt(reach2_of(U, V, m)) + 1e-15 * (abs(x) + abs(y))
        du, dv = move_in_piece(out, m, area, du, dv, over, margin)
    moves.x[i], moves.y[i] = x + du, y + dv
    if is_box:
        moves.x[i] = min(max(x + du, grid.real[c, 4]), grid.real[c, 6])
        moves.y[i] = min(max(y + dv, grid.real[c, 5]), grid.real[c, 7])
    moves.gone[i] = math.sqrt(du * du + dv * dv)
    return True
