"""One relaxation step over a list of dots: exact cells, their centroids, safe moves.

Dots come sorted by compartment and grid cell (see `grid`), so a row of grid cells is one run of
memory. A dot's cell is cut by the dots of growing rings of grid cells until no dot further out
can reach it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.border import (
    border_distance,
    free_share,
    gather_edges,
    outline_of_cell,
    outline_within,
    sum_area,
    sum_field,
)
from stippler.kernels.grid import column_of, distance2_to_span, ring_span, seen_distance
from stippler.kernels.jit import ZERO, inline, inner, kernel
from stippler.kernels.simd import (
    BUFFER,
    get,
    moments_of,
    put,
    reach2_of,
    stack_doubles,
    stack_ints,
    store_lanes,
)
from stippler.kernels.voronoi import (
    OVERFLOW,
    cut_cell,
    cut_lanes_by_run,
    reach2_of_cell,
    start_cell,
    start_lanes,
    unpack_lanes,
)

F8 = NDArray[np.float64]
I4 = NDArray[np.int32]
U1 = NDArray[np.uint8]

INNER, RIM, TOO_MANY_CORNERS = 0, 1, 2
"""What a cell is: bounded by dots alone; by a border as well; not computed."""

APART = 1e-300
"""Least squared distance of dots that count as two."""

NEAR = 1.1
"""Squared distance, in grid cells, of the dots that cut first: fewer cuts are wasted."""


@inner
def _cut_cell_by_ring(
    cell: F8,
    m: int,
    xs: F8,
    ys: F8,
    cell_start: I4,
    x: float,
    y: float,
    ring: int,
    ix: int,
    iy: int,
    nx: int,
    ny: int,
    first_cell: int,
) -> int:
    """Cut a cell in plain arrays by the dots of a ring of grid cells."""
    reach2 = reach2_of_cell(cell, m)
    for s in range(3 if ring == 1 else 4 * ring):
        row, first, last = ring_span(ring, s, ix, iy, nx, ny)
        if last < first:
            continue
        start = first_cell + row * nx
        for j in range(cell_start[start + first], cell_start[start + last + 1]):
            a, b = xs[j] - x, ys[j] - y
            d2 = a * a + b * b
            if d2 >= 4.0 * reach2 or d2 == 0.0:
                continue
            m = cut_cell(cell, m, a, b, 0.5 * d2, float(j))
            if m == OVERFLOW:
                return m
            reach2 = reach2_of_cell(cell, m)
    return m


@inline
def is_in_cell(N: Any, m: int, xs: F8, ys: F8, x: float, y: float, u: float, v: float) -> bool:
    """Whether a place is nearer to the dot than to the dots beyond its sides."""
    for k in range(m):
        j = get(N, k)
        if j >= 0:
            a, b = xs[j] - x, ys[j] - y
            if a * u + b * v > 0.5 * (a * a + b * b):
                return False
    return True


@inline
def _mark_if_changed(N: Any, m: int, i: int, star: I4, n_star: U1, suspect: U1) -> None:
    """Mark a dot's old and new neighbours if its ring of neighbours has changed."""
    before = n_star[i]
    same = before == m
    if same:
        turn = 0
        while turn < m and star[i, turn] != get(N, 0):
            turn += 1
        for k in range(m):
            w = k + turn if k + turn < m else k + turn - m
            if turn == m or star[i, w] != get(N, k):
                same = False
                break
    if same:
        return
    for k in range(before):
        if star[i, k] >= 0:
            suspect[star[i, k]] = 1
    for k in range(m):
        if get(N, k) >= 0:
            suspect[get(N, k)] = 1


@kernel
def relax_dots(
    start: int,
    stop: int,
    which: I4,
    is_all: bool,
    xs: F8,
    ys: F8,
    fixed: NDArray[np.bool_],
    compartment_of_dot: I4,
    cell_start: I4,
    slack: float,
    grid_real: F8,
    grid_int: I4,
    edges: F8,
    next_edge: I4,
    edge_start: I4,
    edge_of_slot: I4,
    clear: I4,
    mass: F8,
    moment: F8,
    frame: F8,
    corner_cap: int,
    most_edges: int,
    over: float,
    new_x: F8,
    new_y: F8,
    gone: F8,
    cells: F8,
    kind_of_cell: U1,
    free_of_dot: F8,
    star: I4,
    n_star: U1,
    suspect: U1,
) -> None:
    """Compute the cells of dots ``which[start:stop]`` and where relaxation takes the dots.

    Parameters
    ----------
    which, is_all
        Rows of the dots' arrays; if `is_all` the rows are start..stop themselves.
    xs, ys
        Positions, with `simd.SCAN` numbers of padding.
    fixed
        Dots that do not move; may be empty.
    slack
        How far a dot may have gone from the grid cell it is listed in.
    mass, moment, frame
        Running sums of the density (see `field`) and its origin and pixel sides;
        an empty `mass` means uniform density.
    corner_cap, most_edges
        Room for the corners of a cell and the border edges of a compartment.
    over
        Over-relaxation, 1 for plain Lloyd.
    new_x, new_y, gone
        Results, by row: position, distance moved.
    cells
        Result, by row, unless empty: mass, centroid relative to the dot, second moment of area.
    kind_of_cell
        Result, by row: `INNER`, `RIM` or `TOO_MANY_CORNERS`.
    free_of_dot
        Result, by row: a distance from the new position within which no border edge lies.
    star, n_star
        Result, by row, unless empty: the dots around each dot, counter-clockwise.
    suspect
        Unless empty, set to 1 for the old and new neighbours of dots whose star changes.
    """
    U, V, N = stack_doubles(BUFFER), stack_doubles(BUFFER), stack_ints(BUFFER)
    for k in range(BUFFER):
        put(U, k, 0.0)
        put(V, k, 0.0)
        put(N, k, np.int32(0))
    cell, cell2 = np.empty((7, corner_cap)), np.empty((7, corner_cap + 4))
    room = most_edges + 1
    near = np.empty(room, np.int32)
    seen = np.full(len(edges) + 1, -1, np.int64)
    chains = np.empty((room, 5))
    trace = np.empty((room, 4))
    out = np.empty((2 * room + 3 * corner_cap + 8, 4))
    stamp = ZERO
    for w in range(start, stop):
        i = w if is_all else which[w]
        x, y = xs[i], ys[i]
        is_fixed = len(fixed) > 0 and fixed[i]
        if is_fixed and len(star) == 0:
            new_x[i], new_y[i], gone[i] = x, y, 0.0
            continue
        c = compartment_of_dot[i]
        gx, gy, h = grid_real[c, 0], grid_real[c, 1], grid_real[c, 2]
        nx, ny, first_cell = grid_int[c, 0], grid_int[c, 1], grid_int[c, 2]
        ix = column_of(x, gx, grid_real[c, 3], nx)
        iy = column_of(y, gy, grid_real[c, 3], ny)
        x0, y0 = grid_real[c, 4] - x, grid_real[c, 5] - y
        x1, y1 = grid_real[c, 6] - x, grid_real[c, 7] - y
        free = math.inf
        if grid_int[c, 3] == 1:
            free = max(clear[first_cell + iy * nx + ix] - 1, 0) * h
        is_packed = True
        is_outlined = False
        n_border = n = ZERO
        m = start_lanes(U, V, N, x0, y0, x1, y1)
        ring = ZERO + 1
        while True:
            reach2, n_near = 0.0, ZERO
            if is_packed:
                for s in range(6 if ring == 1 else 4 * ring):
                    is_first = ring == 1 and s < 3
                    row, first, last = ring_span(
                        ring, s - 3 if ring == 1 and s >= 3 else s, ix, iy, nx, ny
                    )
                    if last < first:
                        continue
                    least, limit = APART, NEAR * h * h
                    if not is_first:
                        limit = 4.0 * reach2_of(U, V, m)
                        if ring == 1:
                            least = NEAR * h * h
                        elif distance2_to_span(x, y, row, first, last, gx, gy, h, slack) >= limit:
                            continue
                    a = first_cell + row * nx
                    m = cut_lanes_by_run(
                        U,
                        V,
                        N,
                        m,
                        xs,
                        ys,
                        x,
                        y,
                        cell_start[a + first],
                        cell_start[a + last + 1],
                        least,
                        limit,
                    )
                    if m == OVERFLOW:
                        break
                if m == OVERFLOW:
                    is_packed = False
                    m = start_cell(cell, x0, y0, x1, y1)
                    ring = ZERO + 1
                    continue
                reach2 = reach2_of(U, V, m)
            else:
                m = _cut_cell_by_ring(
                    cell, m, xs, ys, cell_start, x, y, ring, ix, iy, nx, ny, first_cell
                )
                if m == OVERFLOW:
                    break
                reach2 = reach2_of_cell(cell, m)
            far = seen_distance(x, y, ring, ix, iy, nx, ny, gx, gy, h, slack)
            is_last = 4.0 * reach2 <= far * far
            if free * free <= reach2 and (is_last or ring > 1):
                n_near = gather_edges(
                    edge_start, edge_of_slot, ring, ix, iy, nx, ny, first_cell, near, seen, stamp
                )
                seen_free = seen_distance(x, y, ring, ix, iy, nx, ny, gx, gy, h, 0.0)
                free = min(seen_free, border_distance(edges, near, n_near, x, y))
                stamp += 2
            if free * free <= reach2 and (is_last or ring > 1):
                # the cell may lean out of the compartment: only its piece counts
                if is_packed:
                    unpack_lanes(U, V, N, m, xs, ys, x, y, x0, y0, x1, y1, cell)
                n_border, n, r2 = outline_within(
                    cell,
                    cell2,
                    m,
                    x,
                    y,
                    ring,
                    ix,
                    iy,
                    nx,
                    ny,
                    gx,
                    gy,
                    h,
                    edges,
                    next_edge,
                    near,
                    n_near,
                    seen,
                    stamp - 2,
                    chains,
                    trace,
                    out,
                )
                is_outlined = True
                is_last = is_last or 4.0 * r2 <= far * far
            if is_last:
                break
            is_outlined = False
            ring += 1
        new_x[i], new_y[i], gone[i], free_of_dot[i] = x, y, 0.0, free
        if m == OVERFLOW:
            kind_of_cell[i] = TOO_MANY_CORNERS
            continue
        is_rim = is_outlined or not is_packed
        for k in range(m):
            is_rim = is_rim or get(N, k) < 0
        kind_of_cell[i] = RIM if is_rim else INNER
        if len(star):
            if len(suspect):
                _mark_if_changed(N, m if is_packed else 0, i, star, n_star, suspect)
            n_star[i] = m if is_packed else 0
            if is_packed:
                store_lanes(N, star, i)
        if is_fixed:
            continue
        second = 0.0
        if is_packed and not is_outlined and len(mass) == 0 and len(cells) == 0:
            area, du, dv = moments_of(U, V, m)
            area, du, dv = 0.5 * area, du / 6.0, dv / 6.0
        else:
            if not is_outlined:
                if is_packed:
                    unpack_lanes(U, V, N, m, xs, ys, x, y, x0, y0, x1, y1, cell)
                n_border, n = ZERO, outline_of_cell(cell, m, out)
            area, du, dv, second = sum_area(out, n)
            if len(mass):
                area, du, dv = sum_field(out, n, x, y, mass, moment, frame)
        if area > 0.0:
            du, dv = du / area, dv / area
        else:
            area = du = dv = 0.0
        if len(cells):
            cells[i, 0], cells[i, 1], cells[i, 2], cells[i, 3] = area, du, dv, second
        if over < 1.0 or (
            over > 1.0 and is_packed and is_in_cell(N, m, xs, ys, x, y, over * du, over * dv)
        ):
            du, dv = over * du, over * dv
        if n_border:
            margin = 1e-10 * math.sqrt(reach2) + 1e-15 * (abs(x) + abs(y))
            share = free_share(out, n_border, du, dv, margin)
            du, dv = share * du, share * dv
        new_x[i] = min(max(x + du, grid_real[c, 4]), grid_real[c, 6])
        new_y[i] = min(max(y + dv, grid_real[c, 5]), grid_real[c, 7])
        gone[i] = math.sqrt(du * du + dv * dv)
        free_of_dot[i] = free - gone[i]
