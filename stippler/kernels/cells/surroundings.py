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
    moments_of,
    put,
    stack_doubles,
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
    U, V = stack_doubles(BUFFER), stack_doubles(BUFFER)
    for k in range(BUFFER):
        put(U, k, 0.0)
        put(V, k, 0.0)
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
        du, dv = rules_of_star(U, V, stars.around, m, i, dots, spacing)
        du, dv = blend(
            spacing, i, area, share * cells[i, 1], share * cells[i, 2], mu / area, mv / area, du, dv
        )
        moves.x[i] = min(max(x + du, grid.real[c, 4]), grid.real[c, 6])
        moves.y[i] = min(max(y + dv, grid.real[c, 5]), grid.real[c, 7])
        moves.gone[i] = math.sqrt(du * du + dv * dv)
