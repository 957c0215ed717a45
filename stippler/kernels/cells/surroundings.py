"""What lies around some cells, told from their stars (see `kept_cells`), and moves by it."""

from __future__ import annotations

import math

import numpy as np

from stippler.kernels.cells.border import free_share, outline_of_lanes
from stippler.kernels.cells.relaxation import INNER
from stippler.kernels.cells.spacing import blend, rules_of_star
from stippler.kernels.cells.tables import F8, I4, U1, Dots, Grid, Moves, Spacing, Stars
from stippler.kernels.machine.jit import ZERO, kernel
from stippler.kernels.machine.simd import (
    BUFFER,
    LANES,
    corners_of_star,
    get,
    load_lanes,
    moments_of,
    put,
    stack_doubles,
    stack_ints,
)


@kernel
def ring_around(chosen: I4, around: I4, n_star: U1, is_known: U1, ring: I4) -> int:
    """List the dots that some cells border on, but for those known; return how many.

    `is_known` by row: the chosen are to be marked in it, those listed get marked.
    """
    count = 0
    for w in range(len(chosen)):
        i = chosen[w]
        for k in range(n_star[i]):
            j = around[i, k]
            if j >= 0 and is_known[j] == 0:
                is_known[j] = 1
                ring[count] = j
                count += 1
    return count


@kernel
def mean_among_alike(
    rows: I4, around: I4, n_star: U1, place: I4, kind: F8, most: float, values: F8, mean: F8
) -> None:
    """Find the means of values over dots and those around them whose kind differs by less than so.

    Parameters
    ----------
    rows : (k,) int32
    place : int32 by row
        Of a row in `rows`; below 0 for those that are not in it, which do not count.
    kind, values, mean : (k,) float64
        By place; the last is the result.
    """
    for w in range(len(rows)):
        i = rows[w]
        total, count = values[w], 1.0
        for k in range(n_star[i]):
            j = around[i, k]
            if j < 0 or place[j] < 0:
                continue
            at = place[j]
            if abs(kind[at] - kind[w]) < most:
                total += values[at]
                count += 1.0
        mean[w] = total / count


@kernel
def move_by_rules(
    rows: I4, dots: Dots, grid: Grid, cells: F8, stars: Stars, spacing: Spacing, moves: Moves,
    todo: U1,
) -> None:  # fmt: skip
    """Move dots by the rules of even spacing, their cells being measured and their stars known.

    Parameters
    ----------
    rows : (k,) int32
    cells : by row
        As `relax_dots` measures them.
    moves
        Result; its `kind` is that of the cells.
    todo : (k,) uint8
        Result: set for cells at a border and of very many sides, which stay.
    """
    U, V, N = stack_doubles(BUFFER), stack_doubles(BUFFER), stack_ints(BUFFER)
    for k in range(BUFFER):
        put(U, k, 0.0)
        put(V, k, 0.0)
    A = stack_doubles(LANES)
    out = np.empty((LANES, 6))
    for w in range(len(rows)):
        i = ZERO + rows[w]
        m = ZERO + stars.n[i]
        todo[w] = 1
        if moves.kind[i] != INNER or m < 3 or m + 2 > LANES:
            continue
        x, y, c = dots.x[i], dots.y[i], dots.compartment[i]
        if corners_of_star(dots.x, dots.y, stars.around, i, m, x, y, U, V) & ((1 << m) - 1):
            continue
        todo[w] = 0
        moves.x[i], moves.y[i], moves.gone[i] = x, y, 0.0
        if not cells[i, 0] > 0.0:
            continue
        area, mu, mv = moments_of(U, V, m)
        area, mu, mv = 0.5 * area, mu / 6.0, mv / 6.0
        outline_of_lanes(U, V, m, out)
        share = free_share(out, m, cells[i, 1], cells[i, 2])
        load_lanes(N, stars.around, i)
        put(N, m, get(N, 0))  # corner k lies between the dots k and k + 1 of a star
        du, dv = rules_of_star(U, V, N, A, m, i, dots, spacing)
        du, dv = blend(
            spacing, i, area, share * cells[i, 1], share * cells[i, 2], mu / area, mv / area, du, dv
        )
        moves.x[i] = min(max(x + du, grid.real[c, 4]), grid.real[c, 6])
        moves.y[i] = min(max(y + dv, grid.real[c, 5]), grid.real[c, 7])
        moves.gone[i] = math.sqrt(du * du + dv * dv)
