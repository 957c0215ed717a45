"""Cells from the neighbours of the step before, verified instead of searched.

The star of a dot is the counter-clockwise list of what its cell borders on: dots and, at the
border, edges. A cell cut by any dots at all contains the true cell; so if all cells of a
compartment fit together, corner to corner, they are the true ones. `verify_stars` checks that each
star, at the new positions, still bounds a convex cell whose sides all run forward (each is then
locally Delaunay). Where one fails the cell is computed anew, and where that changes a star,
`check_stars` tells whether its neighbours agree with it. Once all agree, every cell is exact. This
is the Delaunay lemma: a triangulation that is locally Delaunay everywhere is Delaunay.

Cells at the border are kept as well, see `kept_borders`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stippler.kernels.cells.border import free_share, outline_of_lanes, sum_field_in_lanes
from stippler.kernels.cells.kept_borders import move_by_lines
from stippler.kernels.cells.relaxation import INNER, KEPT
from stippler.kernels.cells.spacing import ask, blend, rules_of_star
from stippler.kernels.cells.tables import (
    F8,
    I4,
    U1,
    Border,
    Dots,
    Field,
    Grid,
    Moves,
    Spacing,
    Stars,
)
from stippler.kernels.machine.jit import ZERO, inline, inner, kernel
from stippler.kernels.machine.simd import (
    BUFFER,
    LANES,
    corners_of_star,
    moments_of,
    outside_box,
    pair_mask,
    put,
    reach2_of,
    sides_before,
    stack_doubles,
    stack_ints,
)


@kernel
def verify_stars(
    start: int,
    stop: int,
    dots: Dots,
    grid: Grid,
    border: Border,
    field: Field,
    over: float,
    moves: Moves,
    stars: Stars,
    spacing: Spacing,
    todo: U1,
) -> None:
    """Move the dots whose stars still hold; set `todo` for others.

    ``moves.kind`` and ``moves.free`` are those of the step before.
    """
    U, V, N = stack_doubles(BUFFER), stack_doubles(BUFFER), stack_ints(BUFFER)
    for k in range(BUFFER):
        put(U, k, 0.0)
        put(V, k, 0.0)
    A, B, C = stack_doubles(LANES), stack_doubles(LANES), stack_doubles(LANES)
    for k in range(LANES):
        put(A, k, 0.0)
        put(B, k, 0.0)
        put(C, k, 0.0)
    out = np.empty((LANES, 6))
    for i in range(start, stop):
        m = ZERO + stars.n[i]
        todo[i] = 1
        if moves.kind[i] == KEPT:
            todo[i] = not move_by_lines(
                U, V, N, A, B, C, m, i, dots, grid, border, field, over, moves, stars, spacing, out
            )
            continue
        if moves.kind[i] != INNER or m < 3 or m + 2 > LANES:
            continue
        x, y = dots.x[i], dots.y[i]
        c = dots.compartment[i]
        x0, y0, x1, y1 = grid.real[c, 4], grid.real[c, 5], grid.real[c, 6], grid.real[c, 7]
        bad = corners_of_star(dots.x, dots.y, stars.around, i, m, x, y, U, V)
        beyond = outside_box(U, V, x0 - x, y0 - y, x1 - x, y1 - y)
        if (bad | beyond) & ((1 << m) - 1):
            continue
        if moves.free[i] * abs(moves.free[i]) <= reach2_of(U, V, m):
            continue
        todo[i] = 0
        moves.x[i], moves.y[i], moves.gone[i] = x, y, 0.0
        if dots.fixed[i] and len(spacing.table) == 0:
            continue
        area, mu, mv = moments_of(U, V, m)
        area, mu, mv = 0.5 * area, mu / 6.0, mv / 6.0
        mass, du, dv = _way_to_centroid(
            U, V, m, i, x, y, area, mu, mv, dots, field, over, stars, out
        )
        if len(spacing.table):
            ask(spacing, i, c, area, mass)
            ru, rv = rules_of_star(U, V, stars.around, m, i, dots, spacing)
            if mass > 0.0:
                du, dv = blend(spacing, i, area, du, dv, mu / area, mv / area, ru, rv)
        if dots.fixed[i]:
            continue
        moves.x[i] = min(max(x + du, x0), x1)
        moves.y[i] = min(max(y + dv, y0), y1)
        moves.gone[i] = math.sqrt(du * du + dv * dv)
        moves.free[i] -= moves.gone[i]


@inline
def _way_to_centroid(
    U: Any, V: Any, m: int, i: int, x: float, y: float, area: float, mu: float, mv: float,
    dots: Dots, field: Field, over: float, stars: Stars, out: F8,
) -> tuple[float, float, float]:  # fmt: skip
    """Return a cell's mass and the way to its centroid, (over-)relaxed; 0 without mass.

    `area`, `mu` and `mv` are the cell's own, without a field.
    """
    mass, du, dv = area, mu, mv
    if len(field.sums):
        mass, du, dv = sum_field_in_lanes(U, V, m, x, y, dots.compartment[i], field, out)
    if not mass > 0.0:
        return 0.0, 0.0, 0.0
    du, dv = du / mass, dv / mass
    if len(field.sums) and sides_before(U, V, m, du, dv) != 0:
        # next to nothing can have its centroid anywhere, by rounding
        outline_of_lanes(U, V, m, out)
        share = free_share(out, m, du, dv)
        du, dv = share * du, share * dv
    if over != 1.0:
        for k in range(m):
            a, b = dots.x[stars.around[i, k]] - x, dots.y[stars.around[i, k]] - y
            if over * (a * du + b * dv) > 0.5 * (a * a + b * b):
                return mass, du, dv
        return mass, over * du, over * dv
    return mass, du, dv


@inner
def _has_pair(star: I4, n_star: U1, i: int, a: int, b: int) -> bool:
    """Whether dot i lists a and, right after it, b; an edge in its place says nothing."""
    m = ZERO + n_star[i]
    if m < LANES:  # behind the last the first is listed once more
        return bool(pair_mask(star, i, a, b) & ((1 << m) - 1))
    for k in range(m):  # noqa: SIM110 - a kernel
        if star[i, k] == a and star[i, k + 1 if k + 1 < m else 0] == b:
            return True
    return False


@kernel
def check_stars(start: int, stop: int, which: I4, star: I4, n_star: U1, todo: U1) -> None:
    """Set `todo` for the dots of a list one of whose corners is not confirmed by both others."""
    for w in range(start, stop):
        i = which[w]
        m = n_star[i]
        todo[i] = 0
        for k in range(m):
            a, b = star[i, k], star[i, k + 1 if k + 1 < m else 0]
            if (a >= 0 and not _has_pair(star, n_star, a, b, i)) or (
                b >= 0 and not _has_pair(star, n_star, b, i, a)
            ):
                todo[i] = 1
                break


@kernel
def renumber_stars(start: int, stop: int, order: I4, new_row: I4, old_star: I4, star: I4) -> None:
    """Carry stars over to a new order of the dots: row i is the old row ``order[i]``."""
    for i in range(start, stop):
        for k in range(LANES):
            j = old_star[order[i], k]
            star[i, k] = new_row[j] if j >= 0 else j
