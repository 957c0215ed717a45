"""One relaxation step over a list of dots: exact cells, their centroids, safe moves.

Dots come sorted by compartment and grid cell (see `grid`), so a row of grid cells is one run of
memory. A dot's cell is cut by the dots of growing rings of grid cells until no dot further out
can reach it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.clip import outline_piece
from stippler.kernels.field import integrate_edge
from stippler.kernels.grid import column_of
from stippler.kernels.jit import inline, kernel
from stippler.kernels.voronoi import OVERFLOW, cut_cell, reach2_of_cell, start_cell

F8 = NDArray[np.float64]
I4 = NDArray[np.int32]

DONE, TOO_MANY_CORNERS = 0, 1


@inline
def _cut_by_run(cell: F8, m: int, xy: F8, i: int, first: int, end: int, reach2: float):
    """Cut the cell by the dots first..end; return (corners, reach2)."""
    x, y = xy[i, 0], xy[i, 1]
    for j in range(first, end):
        a, b = xy[j, 0] - x, xy[j, 1] - y
        d2 = a * a + b * b
        if d2 >= 4.0 * reach2 or d2 == 0.0:
            continue
        n = cut_cell(cell, m, a, b, 0.5 * d2, j)
        if n == OVERFLOW:
            return OVERFLOW, reach2
        m = n
        reach2 = reach2_of_cell(cell, m)
    return m, reach2


@kernel
def _cut_by_ring(
    cell: F8,
    m: int,
    xy: F8,
    cell_start: I4,
    i: int,
    ring: int,
    ix: int,
    iy: int,
    nx: int,
    ny: int,
    first_cell: int,
    reach2: float,
):
    """Cut by the dots of the grid cells at Chebyshev distance `ring`."""
    x0, x1 = max(ix - ring, 0), min(ix + ring, nx - 1)
    for j in range(max(iy - ring, 0), min(iy + ring, ny - 1) + 1):
        row = first_cell + j * nx
        if j == iy - ring or j == iy + ring:
            m, reach2 = _cut_by_run(
                cell, m, xy, i, cell_start[row + x0], cell_start[row + x1 + 1], reach2
            )
        else:
            for k in (ix - ring, ix + ring):
                if 0 <= k < nx and m > 0:
                    m, reach2 = _cut_by_run(
                        cell, m, xy, i, cell_start[row + k], cell_start[row + k + 1], reach2
                    )
        if m < 0:
            break
    return m, reach2


@inline
def _seen_distance(
    x: float, y: float, ring: int, ix: int, iy: int, nx: int, ny: int, grid: F8
) -> float:
    """Return the distance within which all dots of the compartment are in rings up to `ring`."""
    best = math.inf
    if ix - ring > 0:
        best = min(best, x - (grid[0] + (ix - ring) * grid[2]))
    if ix + ring < nx - 1:
        best = min(best, grid[0] + (ix + ring + 1) * grid[2] - x)
    if iy - ring > 0:
        best = min(best, y - (grid[1] + (iy - ring) * grid[2]))
    if iy + ring < ny - 1:
        best = min(best, grid[1] + (iy + ring + 1) * grid[2] - y)
    return best * (1.0 - 1e-9)


@inline
def _gather_edges(
    edge_start: I4,
    edge_of_slot: I4,
    ring: int,
    ix: int,
    iy: int,
    nx: int,
    ny: int,
    first_cell: int,
    near: I4,
    seen: NDArray[np.int64],
    stamp: int,
) -> int:
    """List the border edges in the grid cells up to `ring`, each once."""
    n = 0
    x0, x1 = max(ix - ring, 0), min(ix + ring, nx - 1)
    for j in range(max(iy - ring, 0), min(iy + ring, ny - 1) + 1):
        row = first_cell + j * nx
        for s in range(edge_start[row + x0], edge_start[row + x1 + 1]):
            e = edge_of_slot[s]
            if seen[e] != stamp:
                seen[e] = stamp
                near[n] = e
                n += 1
    return n


@inline
def _reach2_of_outline(out: F8, n: int) -> float:
    best = 0.0
    for s in range(n):
        best = max(best, out[s, 0] * out[s, 0] + out[s, 1] * out[s, 1])
        best = max(best, out[s, 2] * out[s, 2] + out[s, 3] * out[s, 3])
    return best


@inline
def _outline_of_cell(cell: F8, m: int, out: F8) -> int:
    for k in range(m):
        n = k + 1 if k + 1 < m else 0
        out[k, 0], out[k, 1], out[k, 2], out[k, 3] = cell[0, k], cell[1, k], cell[0, n], cell[1, n]
    return m


@inline
def _sum_area(out: F8, n: int) -> tuple[float, float, float, float]:
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


@kernel
def _sum_field(
    out: F8, n: int, x: float, y: float, mass: F8, moment: F8, frame: F8
) -> tuple[float, float, float]:
    """Return the field's mass over the outline and its first moments about the dot."""
    ku, kv = 1.0 / frame[2], 1.0 / frame[3]
    px, py = (x - frame[0]) * ku, (y - frame[1]) * kv
    total = mu = mv = 0.0
    for s in range(n):
        m, mx, my = integrate_edge(
            mass, moment, px, py, out[s, 0] * ku, out[s, 1] * kv, out[s, 2] * ku, out[s, 3] * kv
        )
        total += m
        mu += mx
        mv += my
    size = frame[2] * frame[3]
    return total * size, mu * size * frame[2], mv * size * frame[3]


@inline
def _free_share(out: F8, n_border: int, du: float, dv: float, margin: float) -> float:
    """Return the share of the move (du, dv) that stays clear of the border segments.

    1 if the straight way ends well inside; else half of the way to the first border met; 0 if
    even that comes nearer to it than `margin`.
    """
    share = 1.0
    for s in range(n_border):
        au, av = out[s, 0], out[s, 1]
        eu, ev = out[s, 2] - au, out[s, 3] - av
        length = math.sqrt(eu * eu + ev * ev)
        if length == 0.0:
            continue
        before = (ev * au - eu * av) / length  # distance of the dot, left is positive
        after = before + (eu * dv - ev * du) / length
        if after >= margin or after >= before:
            continue
        t = max((before - margin) / (before - after), 0.0)
        along = (eu * (t * du - au) + ev * (t * dv - av)) / length
        if -margin <= along <= length + margin:
            share = min(share, 0.5 * t)
    return share


@inline
def _is_in_cell(cell: F8, m: int, u: float, v: float) -> bool:
    for k in range(m):
        if cell[2, k] * u + cell[3, k] * v > cell[4, k]:
            return False
    return True


@kernel
def _outline_within(
    cell: F8,
    cell2: F8,
    m: int,
    x: float,
    y: float,
    ring: int,
    ix: int,
    iy: int,
    nx: int,
    ny: int,
    first_cell: int,
    grid: F8,
    edges: F8,
    next_edge: I4,
    edge_start: I4,
    edge_of_slot: I4,
    near: I4,
    seen: NDArray[np.int64],
    stamp: int,
    chains: F8,
    trace: F8,
    out: F8,
) -> tuple[int, int, float]:
    """Outline the dot's piece of the cell within the rings seen; return its reach, squared, too.

    A piece that touches the outermost ring's walls reaches as far as they do, which tells the
    caller to look further.
    """
    for r in range(6):
        for k in range(m):
            cell2[r, k] = cell[r, k]
    n2 = m
    if ix - ring > 0:
        n2 = cut_cell(cell2, n2, -1.0, 0.0, x - (grid[0] + (ix - ring) * grid[2]), -1.0)
    if ix + ring < nx - 1:
        n2 = cut_cell(cell2, n2, 1.0, 0.0, grid[0] + (ix + ring + 1) * grid[2] - x, -1.0)
    if iy - ring > 0:
        n2 = cut_cell(cell2, n2, 0.0, -1.0, y - (grid[1] + (iy - ring) * grid[2]), -1.0)
    if iy + ring < ny - 1:
        n2 = cut_cell(cell2, n2, 0.0, 1.0, grid[1] + (iy + ring + 1) * grid[2] - y, -1.0)
    n_near = _gather_edges(
        edge_start, edge_of_slot, ring, ix, iy, nx, ny, first_cell, near, seen, stamp
    )
    reach2 = reach2_of_cell(cell2, n2)
    n_border, n = outline_piece(
        cell2,
        n2,
        x,
        y,
        edges,
        next_edge,
        near,
        n_near,
        stamp + 1,
        seen,
        chains,
        trace,
        out,
        1e-24 * reach2,
    )
    return n_border, n, _reach2_of_outline(out, n)


@kernel
def relax_dots(
    start: int,
    stop: int,
    which: I4,
    xy: F8,
    compartment_of_dot: I4,
    cell_start: I4,
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
    new_xy: F8,
    cells: F8,
    status: NDArray[np.uint8],
) -> None:
    """Compute the cells of dots ``which[start:stop]`` and where relaxation takes the dots.

    Parameters
    ----------
    which : rows of `xy`
    mass, moment, frame
        Running sums of the density (see `field`) and its origin and pixel sides;
        an empty `mass` means uniform density.
    corner_cap, most_edges
        Room for the corners of a cell and the border edges of a compartment.
    over
        Over-relaxation, 1 for plain Lloyd.
    new_xy, cells, status
        Results, by row of `xy`: position; mass, centroid relative to the dot, second moment
        of area; `DONE` or `TOO_MANY_CORNERS`.
    """
    cell, cell2 = np.empty((7, corner_cap)), np.empty((7, corner_cap + 4))
    room = most_edges + 1
    near = np.empty(room, np.int32)
    seen = np.full(len(edges) + 1, -1, np.int64)
    chains = np.empty((room, 5))
    trace = np.empty((room, 4))
    out = np.empty((2 * room + 3 * corner_cap + 8, 4))
    stamp = 0
    for w in range(start, stop):
        i = which[w]
        x, y = xy[i, 0], xy[i, 1]
        grid = grid_real[compartment_of_dot[i]]
        nx, ny, first_cell, kind = grid_int[compartment_of_dot[i]]
        ix = column_of(x, grid[0], grid[3], nx)
        iy = column_of(y, grid[1], grid[3], ny)
        m = start_cell(cell, grid[4] - x, grid[5] - y, grid[6] - x, grid[7] - y)
        reach2 = reach2_of_cell(cell, m)
        free = math.inf
        if kind == 1:
            free = max(clear[first_cell + iy * nx + ix] - 1, 0) * grid[2]
        n_border = n = 0
        is_outlined = False
        ring = 0
        while True:
            m, reach2 = _cut_by_ring(
                cell, m, xy, cell_start, i, ring, ix, iy, nx, ny, first_cell, reach2
            )
            if m < 0:
                break
            if ring == 0:
                ring = 1
                continue
            far = _seen_distance(x, y, ring, ix, iy, nx, ny, grid)
            if 4.0 * reach2 <= far * far:
                break
            if free * free <= reach2 and far < math.inf:
                # the cell may lean out of the compartment: only its piece counts
                n_border, n, r2 = _outline_within(
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
                    first_cell,
                    grid,
                    edges,
                    next_edge,
                    edge_start,
                    edge_of_slot,
                    near,
                    seen,
                    stamp,
                    chains,
                    trace,
                    out,
                )
                stamp += 2
                if 4.0 * r2 <= far * far:
                    is_outlined = True
                    break
            ring += 1
        new_xy[i, 0], new_xy[i, 1] = x, y
        cells[i, 0] = cells[i, 1] = cells[i, 2] = cells[i, 3] = 0.0
        if m < 0:
            status[i] = TOO_MANY_CORNERS
            continue
        status[i] = DONE
        if not is_outlined and free * free <= reach2:
            n_border, n, _ = _outline_within(
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
                first_cell,
                grid,
                edges,
                next_edge,
                edge_start,
                edge_of_slot,
                near,
                seen,
                stamp,
                chains,
                trace,
                out,
            )
            stamp += 2
        elif not is_outlined:
            n_border, n = 0, _outline_of_cell(cell, m, out)
        area, du, dv, second = _sum_area(out, n)
        cells[i, 3] = second
        if len(mass):
            area, du, dv = _sum_field(out, n, x, y, mass, moment, frame)
        cells[i, 0] = area
        if not area > 0.0:
            continue
        du, dv = du / area, dv / area
        cells[i, 1], cells[i, 2] = du, dv
        if over != 1.0 and _is_in_cell(cell, m, over * du, over * dv):
            du, dv = over * du, over * dv
        if n_border:
            margin = 1e-10 * math.sqrt(reach2) + 1e-15 * (abs(x) + abs(y))
            share = _free_share(out, n_border, du, dv, margin)
            du, dv = share * du, share * dv
        new_xy[i, 0] = min(max(x + du, grid[4]), grid[6])
        new_xy[i, 1] = min(max(y + dv, grid[5]), grid[7])
