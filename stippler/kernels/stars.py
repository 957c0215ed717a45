"""Cells from the neighbours of the step before, verified instead of searched.

The star of a dot is the counter-clockwise list of dots its cell borders on. A cell cut by any dots
at all contains the true cell; so if all cells fit together, corner to corner, they are the true
ones. `verify_stars` checks that each star, at the new positions, still bounds a convex cell whose
sides all run forward (each is then locally Delaunay). Where one fails the cell is computed anew,
and where that changes a star, `check_stars` tells whether its neighbours agree with it. Once
all agree, every cell is exact. This is the Delaunay lemma: a triangulation that is locally
Delaunay everywhere is Delaunay.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.border import sum_field
from stippler.kernels.jit import ZERO, inner, kernel
from stippler.kernels.relaxation import INNER
from stippler.kernels.simd import (
    BUFFER,
    LANES,
    corners_of_star,
    get,
    moments_of,
    outside_box,
    put,
    reach2_of,
    stack_doubles,
)

F8 = NDArray[np.float64]
I4 = NDArray[np.int32]
U1 = NDArray[np.uint8]


@kernel
def verify_stars(
    start: int,
    stop: int,
    xs: F8,
    ys: F8,
    fixed: NDArray[np.bool_],
    compartment_of_dot: I4,
    grid_real: F8,
    mass: F8,
    moment: F8,
    frame: F8,
    over: float,
    star: I4,
    n_star: U1,
    kind_of_cell: U1,
    free_of_dot: F8,
    new_x: F8,
    new_y: F8,
    gone: F8,
    todo: U1,
) -> None:
    """Move the dots of cells bounded by dots alone whose stars still hold; set `todo` for others.

    Parameters are those of `relaxation.relax_dots`.
    """
    U, V = stack_doubles(BUFFER), stack_doubles(BUFFER)
    for k in range(BUFFER):
        put(U, k, 0.0)
        put(V, k, 0.0)
    out = np.empty((LANES, 4))
    for i in range(start, stop):
        m = ZERO + n_star[i]
        todo[i] = 1
        if kind_of_cell[i] != INNER or m < 3 or m + 2 > LANES:
            continue
        x, y = xs[i], ys[i]
        c = compartment_of_dot[i]
        x0, y0, x1, y1 = grid_real[c, 4], grid_real[c, 5], grid_real[c, 6], grid_real[c, 7]
        bad = corners_of_star(xs, ys, star, i, m, x, y, U, V)
        beyond = outside_box(U, V, x0 - x, y0 - y, x1 - x, y1 - y)
        if (bad | beyond) & ((1 << m) - 1):
            continue
        if free_of_dot[i] * abs(free_of_dot[i]) <= reach2_of(U, V, m):
            continue
        todo[i] = 0
        new_x[i], new_y[i], gone[i] = x, y, 0.0
        if fixed[i]:
            continue
        area, du, dv = moments_of(U, V, m)
        area, du, dv = 0.5 * area, du / 6.0, dv / 6.0
        if len(mass):
            for k in range(m):
                out[k, 0], out[k, 1] = get(U, k), get(V, k)
                out[k, 2], out[k, 3] = get(U, k + 1), get(V, k + 1)
            out[m - 1, 2], out[m - 1, 3] = get(U, 0), get(V, 0)
            area, du, dv = sum_field(out, m, x, y, mass, moment, frame)
        if not area > 0.0:
            continue
        du, dv = du / area, dv / area
        if over != 1.0:
            for k in range(m):
                a, b = xs[star[i, k]] - x, ys[star[i, k]] - y
                if over * (a * du + b * dv) > 0.5 * (a * a + b * b):
                    break
            else:
                du, dv = over * du, over * dv
        new_x[i] = min(max(x + du, x0), x1)
        new_y[i] = min(max(y + dv, y0), y1)
        gone[i] = math.sqrt(du * du + dv * dv)
        free_of_dot[i] -= gone[i]


@inner
def _has_pair(star: I4, n_star: U1, i: int, a: int, b: int) -> bool:
    """Whether dot i lists a and, right after it, b."""
    m = n_star[i]
    for k in range(m):
        if star[i, k] == a:
            return bool(star[i, k + 1 if k + 1 < m else 0] == b)
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
            if not (_has_pair(star, n_star, a, b, i) and _has_pair(star, n_star, b, i, a)):
                todo[i] = 1
                break


@kernel
def renumber_stars(start: int, stop: int, order: I4, new_row: I4, old_star: I4, star: I4) -> None:
    """Carry stars over to a new order of the dots: row i is the old row ``order[i]``."""
    for i in range(start, stop):
        for k in range(LANES):
            j = old_star[order[i], k]
            star[i, k] = new_row[j] if j >= 0 else j
