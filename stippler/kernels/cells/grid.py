"""Uniform grids of dots and of border edges, one grid for each compartment.

All compartments share flat arrays. Row c of `grid_real` holds ``x0, y0, h, 1/h`` and the
compartment's box ``xmin, ymin, xmax, ymax``; row c of `grid_int` holds ``nx, ny, first cell, kind,
first border edge, convex``. Kind is 0 for a rectangle, whose box is its exact border, and 1 for a
polygon; convex is 0 or 1.
"""

from __future__ import annotations

import math

from stippler.kernels.cells.tables import F8, I4, Grid, Spot
from stippler.kernels.machine.jit import inline, kernel


@inline
def column_of(v: float, v0: float, inverse: float, n: int) -> int:
    """Return the grid column (or row) of a coordinate, clamped to the grid."""
    return min(max(int((v - v0) * inverse), 0), n - 1)


@kernel
def find_grid_cells(
    start: int,
    stop: int,
    xs: F8,
    ys: F8,
    compartment_of_dot: I4,
    grid_real: F8,
    grid_int: I4,
    out: I4,
) -> None:
    """Write the grid cell of each dot."""
    for i in range(start, stop):
        c = compartment_of_dot[i]
        ix = column_of(xs[i], grid_real[c, 0], grid_real[c, 3], grid_int[c, 0])
        iy = column_of(ys[i], grid_real[c, 1], grid_real[c, 3], grid_int[c, 1])
        out[i] = grid_int[c, 2] + iy * grid_int[c, 0] + ix


@kernel
def sort_by_grid_cell(cell_of_dot: I4, cell_start: I4, order: I4) -> None:
    """Sort dots by grid cell, stable; `cell_start` gets the offset of each cell and the end."""
    cell_start[:] = 0
    for i in range(len(cell_of_dot)):
        cell_start[cell_of_dot[i] + 1] += 1
    for k in range(1, len(cell_start)):
        cell_start[k] += cell_start[k - 1]
    for i in range(len(cell_of_dot)):
        k = cell_of_dot[i]
        order[cell_start[k]] = i
        cell_start[k] += 1
    for k in range(len(cell_start) - 1, 0, -1):
        cell_start[k] = cell_start[k - 1]
    cell_start[0] = 0


@inline
def _edge_misses_cell(ax: float, ay: float, bx: float, by: float, cx: float, cy: float) -> bool:
    """Whether an edge surely stays off the unit cell at (cx, cy); coordinates in cells."""
    slack = 1e-6
    nx, ny = ay - by, bx - ax
    reach = (abs(nx) + abs(ny)) * (0.5 + slack)
    return abs(nx * (cx + 0.5 - ax) + ny * (cy + 0.5 - ay)) > reach


@kernel
def spread_edges(
    edges: F8,
    compartment_of_edge: I4,
    grid_real: F8,
    grid_int: I4,
    cell_start: I4,
    edge_of_slot: I4,
    count_only: bool,
) -> None:
    """List for each grid cell the border edges that may touch it.

    Called twice: first counts into ``cell_start[k + 1]``, then, after a running sum, fills
    `edge_of_slot` and moves each ``cell_start[k]`` on to the end of its list.
    """
    for e in range(len(edges)):
        c = compartment_of_edge[e]
        if grid_int[c, 3] == 0:
            continue  # a rectangle's box is its border
        inv, nx, ny = grid_real[c, 3], grid_int[c, 0], grid_int[c, 1]
        ax, ay = (edges[e, 0] - grid_real[c, 0]) * inv, (edges[e, 1] - grid_real[c, 1]) * inv
        bx, by = (edges[e, 2] - grid_real[c, 0]) * inv, (edges[e, 3] - grid_real[c, 1]) * inv
        slack = 1e-6
        i0 = min(max(int(min(ax, bx) - slack), 0), nx - 1)
        i1 = min(max(int(max(ax, bx) + slack), 0), nx - 1)
        j0 = min(max(int(min(ay, by) - slack), 0), ny - 1)
        j1 = min(max(int(max(ay, by) + slack), 0), ny - 1)
        for j in range(j0, j1 + 1):
            for i in range(i0, i1 + 1):
                if _edge_misses_cell(ax, ay, bx, by, i, j):
                    continue
                k = grid_int[c, 2] + j * nx + i
                if count_only:
                    cell_start[k + 1] += 1
                else:
                    edge_of_slot[cell_start[k]] = e
                    cell_start[k] += 1


@kernel
def measure_clearance(grid_int: I4, cell_start: I4, clear: I4) -> None:
    """Write for each cell how many rings around it, itself included, hold no border edge.

    0 means an edge may touch the cell itself; k means that no edge comes nearer to any point of
    the cell than k - 1 cell sides.
    """
    far = 1 << 20
    for c in range(len(grid_int)):
        nx, ny, first = grid_int[c, 0], grid_int[c, 1], grid_int[c, 2]
        for k in range(first, first + nx * ny):
            clear[k] = 0 if cell_start[k + 1] > cell_start[k] else far
        for forward in (True, False):
            for a in range(ny):
                j = a if forward else ny - 1 - a
                back = -1 if forward else 1
                for b in range(nx):
                    i = b if forward else nx - 1 - b
                    k = first + j * nx + i
                    best = clear[k]
                    if 0 <= i + back < nx:
                        best = min(best, clear[k + back] + 1)
                    if 0 <= j + back < ny:
                        for s in range(-1, 2):
                            if 0 <= i + s < nx:
                                best = min(best, clear[k + back * nx + s] + 1)
                    clear[k] = best


@inline
def spot_of(x: float, y: float, c: int, grid: Grid) -> Spot:
    """Return where in the grid of compartment c a place is."""
    real, whole = grid.real, grid.whole
    gx, gy, h, inverse = real[c, 0], real[c, 1], real[c, 2], real[c, 3]
    nx, ny = whole[c, 0], whole[c, 1]
    ix, iy = column_of(x, gx, inverse, nx), column_of(y, gy, inverse, ny)
    x0, y0, x1, y1 = real[c, 4] - x, real[c, 5] - y, real[c, 6] - x, real[c, 7] - y
    return Spot(x, y, ix, iy, nx, ny, whole[c, 2], gx, gy, h, x0, y0, x1, y1)


@inline
def ring_span(ring: int, s: int, spot: Spot) -> tuple[int, int, int]:
    """Return row and first and last column of the s-th run of grid cells of a ring.

    Ring 1 includes the dot's own cell. A run off the grid has its last column before its first.
    """
    ix, iy = spot.ix, spot.iy
    if ring == 1:
        row = iy if s == 0 else iy - 1 if s == 1 else iy + 1
        first, last = ix - 1, ix + 1
    elif s < 2:
        row = iy - ring if s == 0 else iy + ring
        first, last = ix - ring, ix + ring
    else:
        row = iy - ring + 1 + ((s - 2) >> 1)
        first = last = ix + ring if s & 1 else ix - ring
    if row < 0 or row >= spot.ny:
        return 0, 0, -1
    return row, max(first, 0), min(last, spot.nx - 1)


@inline
def distance2_to_span(spot: Spot, row: int, first: int, last: int, slack: float) -> float:
    """Return the squared distance to the nearest place a dot of these grid cells can be."""
    left, top, h = spot.gx - spot.x, spot.gy - spot.y, spot.h
    dx = max(max(left + first * h, -(left + (last + 1) * h)) - slack, 0.0)
    dy = max(max(top + row * h, -(top + (row + 1) * h)) - slack, 0.0)
    return (dx * dx + dy * dy) * (1.0 - 1e-9)


@inline
def seen_distance(spot: Spot, ring: int, slack: float) -> float:
    """Return the distance within which all dots of the compartment are in rings up to `ring`."""
    best = math.inf
    if spot.ix - ring > 0:
        best = min(best, spot.x - (spot.gx + (spot.ix - ring) * spot.h))
    if spot.ix + ring < spot.nx - 1:
        best = min(best, spot.gx + (spot.ix + ring + 1) * spot.h - spot.x)
    if spot.iy - ring > 0:
        best = min(best, spot.y - (spot.gy + (spot.iy - ring) * spot.h))
    if spot.iy + ring < spot.ny - 1:
        best = min(best, spot.gy + (spot.iy + ring + 1) * spot.h - spot.y)
    return max(best * (1.0 - 1e-9) - slack, 0.0)
