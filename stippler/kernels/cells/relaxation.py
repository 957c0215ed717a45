"""One relaxation step over a list of dots: exact cells, their centroids, safe moves.

Dots come sorted by compartment and grid cell (see `grid`), so a row of grid cells is one run of
memory. A dot's cell is cut by the dots of growing rings of grid cells until no dot further out
can reach it.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from stippler.kernels.cells.big_cells import MANY, cut_big_cell_by_ring
from stippler.kernels.cells.border import (
    NOWHERE,
    border_distance,
    free_share,
    gather_edges,
    gather_edges_in_cell,
    has_walls,
    outline_of_cell,
    outline_of_lanes,
    outline_within,
    put_numbers,
    reach2_of_outline,
    sum_area,
    sum_field,
)
from stippler.kernels.cells.grid import seen_distance, spot_of
from stippler.kernels.cells.moves import crosses_border, move_in_piece
from stippler.kernels.cells.neighbour_search import cut_cell_by_ring, cut_lanes_by_ring
from stippler.kernels.cells.row_search import SWEEP_FROM, cut_far_corners, sweep_rows
from stippler.kernels.cells.spacing import ask, blend, rules_at_border, rules_in_lanes
from stippler.kernels.cells.tables import (
    F8,
    I4,
    Border,
    Dots,
    Field,
    Grid,
    Moves,
    Outlines,
    Pads,
    Spacing,
    Spot,
    Stars,
)
from stippler.kernels.cells.tree_search import (
    cut_cell_by_tree,
    cut_lanes_by_crowd,
    cut_lanes_by_tree,
)
from stippler.kernels.cells.voronoi import (
    FULL,
    OVERFLOW,
    reach2_of_cell,
    start_cell,
    start_lanes,
    unpack_lanes,
)
from stippler.kernels.machine.jit import ZERO, bare_kernel, inline, inner, merged
from stippler.kernels.machine.simd import (
    BUFFER,
    LANES,
    get,
    moments_of,
    put,
    reach2_of,
    stack_doubles,
    stack_ints,
    store_lanes,
)

INNER, RIM, TOO_MANY_CORNERS, KEPT = 0, 1, 2, 3
"""What a cell is: bounded by dots alone; near a border; not computed; near a border, and kept."""


def relax_dots(
    start: int, stop: int, corner_cap: int, which: I4, is_all: bool, dots: Dots, grid: Grid,
    border: Border, field: Field, over: float, moves: Moves, cells: F8, stars: Stars,
    outlines: Outlines, spacing: Spacing,
) -> None:  # fmt: skip
    """Compute the cells of dots ``which[start:stop]`` and where relaxation takes the dots.

    Parameters
    ----------
    which, is_all
        Rows of the dots' arrays; if `is_all` the rows are start..stop themselves.
    corner_cap
        Room for the corners of a cell.
    over
        Over-relaxation, 1 for plain Lloyd.
    moves, stars
        Results.
    cells
        Result, by row, unless empty: mass, centroid relative to the dot, area, second moment of
        area, square of the farthest corner's distance.
    outlines
        Results, unless empty.
    spacing
        The rules that dots move by, or none: then they go to their centroids.
    """
    room = border.most_edges + 1
    pads = Pads(
        np.empty((7, corner_cap)),
        np.empty((7, corner_cap + 4)),
        np.empty(room, np.int32),
        np.full(len(border.edge) + 1, -1, np.int64),
        np.zeros(1, np.int64),
        np.empty((room, 5)),
        np.empty((room, 5)),
        np.empty((2 * room + 3 * corner_cap + 8, 6)),
    )
    _relax(
        start, stop, which, is_all, dots, grid, border, field, over, moves, cells, stars,
        outlines, spacing, pads,
    )  # fmt: skip


@bare_kernel
def _relax(
    start: int, stop: int, which: I4, is_all: bool, dots: Dots, grid: Grid, border: Border,
    field: Field, over: float, moves: Moves, cells: F8, stars: Stars, outlines: Outlines,
    spacing: Spacing, pads: Pads,
) -> None:  # fmt: skip
    U, V, N = stack_doubles(BUFFER), stack_doubles(BUFFER), stack_ints(BUFFER)
    S = stack_ints(BUFFER)
    for k in range(BUFFER):
        put(U, k, 0.0)
        put(V, k, 0.0)
        put(N, k, np.int32(0))
        put(S, k, np.int32(0))
    for w in range(start, stop):
        i = w if is_all else which[w]
        x, y = dots.x[i], dots.y[i]
        is_fixed = len(dots.fixed) > 0 and dots.fixed[i]
        moves.x[i], moves.y[i], moves.gone[i] = x, y, 0.0
        if is_fixed and len(stars.around) == 0 and len(spacing.table) == 0:
            continue
        c = dots.compartment[i]
        spot = spot_of(x, y, c, grid)
        free = math.inf
        if grid.whole[c, 3] == 1:
            cell = spot.first_cell + spot.iy * spot.nx + spot.ix
            free = max(border.clear[cell] - 1, 0) * spot.h
        m, is_packed, n, reach2, free, n_near = _cell_of_dot(
            U, V, N, c, dots, grid, border, spot, free, pads
        )
        moves.free[i] = free
        if m == OVERFLOW:
            moves.kind[i] = TOO_MANY_CORNERS
            continue
        is_rim = n > 0 or not is_packed
        for k in range(m):
            is_rim = is_rim or get(N, k) < 0
        moves.kind[i] = RIM if is_rim else INNER
        if len(stars.around):
            n_star = ZERO
            if is_rim:
                n_star = _star_at_border(N, S, m, is_packed, n, grid.whole[c, 4], pads)
            if n_star >= 3:
                has_holes = n > 0 and pads.out[n - 1, 5] != 0.0
                moves.kind[i] = RIM if has_holes else KEPT
                _keep_star(S, n_star, i, stars)
            else:
                _keep_star(N, m if is_packed else ZERO, i, stars)
        if is_fixed and len(spacing.table) == 0:
            continue
        if len(outlines.n_sides):
            _put_outline(U, V, N, m, is_packed, n, grid.whole[c, 4], w, pads, outlines)
        mass, du, dv = _centroid_of(U, V, m, is_packed, n, dots, field, spot, i, cells, pads)
        if len(spacing.table):
            du, dv = _way_by_rules(
                U, V, N, m, is_packed, n, dots, spot, i, c, mass, du, dv, spacing, pads
            )
        if is_fixed:
            continue
        if n and mass > 0.0:
            margin = 1e-10 * math.sqrt(reach2) + 1e-15 * (abs(x) + abs(y))
            area = mass
            if len(field.sums):
                area, _u, _v, _second = sum_area(pads.out, n)
            du, dv = move_in_piece(pads.out, n, area, du, dv, over, margin)
            if crosses_border(border.edge, pads.near, n_near, spot, du, dv):
                du = dv = 0.0
        elif over < 1.0 or (
            over > 1.0 and is_packed and _is_in_cell(N, m, dots, spot, over, du, dv)
        ):
            du, dv = over * du, over * dv
        moves.x[i] = min(max(x + du, grid.real[c, 4]), grid.real[c, 6])
        moves.y[i] = min(max(y + dv, grid.real[c, 5]), grid.real[c, 7])
        moves.gone[i] = math.sqrt(du * du + dv * dv)
        moves.free[i] = free - moves.gone[i]


@merged
def _cell_of_dot(
    U: Any, V: Any, N: Any, c: int, dots: Dots, grid: Grid, border: Border, spot: Spot,
    free: float, pads: Pads,
) -> tuple[int, bool, int, float, float, int]:  # fmt: skip
    """Compute a dot's cell in compartment c; within `free` lies no border edge.

    Returns
    -------
    m, is_packed
        Its corners, in lanes or, if not `is_packed`, in ``pads.cell``; or `OVERFLOW`.
    n
        Segments in ``pads.out`` if the border cuts the cell, see `outline_piece`, else 0.
    reach2, free
        Squared distance of the farthest corner; what is now known to be free of border edges.
    n_near
        Border edges in ``pads.near``, of all that were looked at for the outline.
    """
    crowd = -ZERO - 1
    ring, root = ZERO + 1, ZERO - 1
    if len(grid.tree_of_cell) > 0:
        own = spot.first_cell + spot.iy * spot.nx + spot.ix
        tree = grid.tree_of_cell[own]
        if tree >= 0:
            crowd, ring = ZERO + own, ZERO
        if len(grid.root) > 0:
            root = ZERO + grid.root[c]
            if root >= 0 and tree >= 0 and grid.node[tree, 0] != 0.0:
                ring = ZERO + SWEEP_FROM
    is_packed = True
    m = start_lanes(U, V, N, spot.x0, spot.y0, spot.x1, spot.y1)
    while True:
        n = n_near = ZERO
        reach2 = 0.0
        is_swept = ring == SWEEP_FROM and (root >= 0 or (is_packed and free == math.inf))
        if is_packed:
            if is_swept and root >= 0:
                m, _n_leaves = cut_lanes_by_tree(U, V, N, m, dots, grid, spot, root)
            elif is_swept:
                m = sweep_rows(U, V, N, m, dots, grid, spot)
            elif ring == 0:
                m = cut_lanes_by_crowd(U, V, N, m, dots, grid, spot.x, spot.y, crowd)
            else:
                if ring == 2 and crowd >= 0:
                    m = cut_far_corners(U, V, N, m, dots, grid, spot)
                if m != OVERFLOW:
                    m = cut_lanes_by_ring(U, V, N, m, dots, grid, spot, ring, crowd)
            if m == OVERFLOW and root >= 0 and pads.cell.shape[1] <= MANY:
                if is_swept:
                    m = ZERO + FULL
                    unpack_lanes(U, V, N, m, dots.x, dots.y, spot, pads.cell)
                    is_packed = False
                else:
                    m = start_lanes(U, V, N, spot.x0, spot.y0, spot.x1, spot.y1)
                ring = ZERO + SWEEP_FROM
                continue
            if m == OVERFLOW:
                is_packed = False
                m = start_cell(pads.cell, spot.x0, spot.y0, spot.x1, spot.y1)
                ring = ZERO + 1
                continue
            reach2 = reach2_of(U, V, m)
        else:
            if pads.cell.shape[1] > MANY:
                is_swept = False
                m = cut_big_cell_by_ring(pads, m, dots, grid, spot, ring)
            elif is_swept:
                m = cut_cell_by_tree(pads.cell, m, dots, grid, spot.x, spot.y, root, True, True)
            else:
                m = cut_cell_by_ring(pads.cell, m, dots, grid, spot, ring)
            if m == OVERFLOW:
                break
            reach2 = reach2_of_cell(pads.cell, m)
        far = seen_distance(spot, ring, grid.slack)
        is_last = is_swept or 4.0 * reach2 <= far * far
        if free * free <= reach2 and (is_last or ring > 1):
            stamp = pads.stamp[0]
            pads.stamp[0] = stamp + 2
            if is_swept:
                if is_packed:
                    unpack_lanes(U, V, N, m, dots.x, dots.y, spot, pads.cell)
                n_near = gather_edges_in_cell(border, spot, pads.cell, m, pads, stamp)
                n, _r2 = outline_within(
                    m, border, spot, max(spot.nx, spot.ny), pads, n_near, stamp + 1
                )
                break
            n_near = gather_edges(border, spot, ring, pads, stamp)
            seen_free = seen_distance(spot, ring, 0.0)
            free = min(seen_free, border_distance(border.edge, pads.near, n_near, spot.x, spot.y))
            if free * free <= reach2:
                # the cell may lean out of the compartment: only its piece counts
                if is_packed:
                    unpack_lanes(U, V, N, m, dots.x, dots.y, spot, pads.cell)
                n, r2 = outline_within(m, border, spot, ring, pads, n_near, stamp + 1)
                is_last = is_last or 4.0 * r2 <= far * far
        if is_last:
            break
        ring += 1
    return m, is_packed, n, reach2, free, n_near


@merged
def _centroid_of(
    U: Any, V: Any, m: int, is_packed: bool, n: int, dots: Dots, field: Field, spot: Spot, i: int,
    cells: F8, pads: Pads,
) -> tuple[float, float, float]:  # fmt: skip
    """Return a cell's mass and the way to its (weighted) centroid; 0 without mass."""
    is_whole = n == 0
    if is_packed and n == 0 and len(field.sums) == 0 and len(cells) == 0:
        mass, du, dv = moments_of(U, V, m)
        mass, du, dv = 0.5 * mass, du / 6.0, dv / 6.0
    else:
        if n == 0:
            n = m
            if is_packed:
                outline_of_lanes(U, V, m, pads.out)
            else:
                outline_of_cell(pads.cell, m, pads.out)
        mass = du = dv = 0.0
        if len(field.sums) == 0 or len(cells):
            mass, du, dv, second = sum_area(pads.out, n)
            if len(cells):
                cells[i, 3], cells[i, 4], cells[i, 5] = mass, second, reach2_of_outline(pads.out, n)
        if len(field.sums):
            mass, du, dv = sum_field(pads.out, n, spot.x, spot.y, dots.compartment[i], field)
    if mass > 0.0:
        du, dv = du / mass, dv / mass
    else:
        mass = du = dv = 0.0
    if len(cells):
        cells[i, 0], cells[i, 1], cells[i, 2] = mass, du, dv
    if len(field.sums) and is_whole:  # next to nothing can have its centroid anywhere, by rounding
        share = free_share(pads.out, n, du, dv)
        du, dv = share * du, share * dv
    return mass, du, dv


@merged
def _way_by_rules(
    U: Any, V: Any, N: Any, m: int, is_packed: bool, n: int, dots: Dots, spot: Spot, i: int,
    c: int, mass: float, du: float, dv: float, spacing: Spacing, pads: Pads,
) -> tuple[float, float]:  # fmt: skip
    """Return the way that the rules of spacing take from (du, dv), that to the centroid."""
    if is_packed and (n == 0 or not has_walls(pads.out, n)):
        area, mu, mv = moments_of(U, V, m)
        area, mu, mv = 0.5 * area, mu / 6.0, mv / 6.0
        ru, rv = rules_in_lanes(U, V, N, ZERO, m, i, spot.x, spot.y, dots, spacing)
    else:
        if n == 0:
            n = m
            outline_of_cell(pads.cell, m, pads.out)
            put_numbers(N, pads.cell, m, False, 0, pads.out)
        area, mu, mv, _ = sum_area(pads.out, n)
        ru, rv = rules_at_border(pads.out, n, i, spot.x, spot.y, dots, spacing)
    ask(spacing, i, c, area, mass)
    if not mass > 0.0:
        return 0.0, 0.0
    return blend(spacing, i, area, du, dv, mu / area, mv / area, ru, rv)


@inner
def _put_outline(
    U: Any, V: Any, N: Any, m: int, is_packed: bool, n: int, first_edge: int, w: int, pads: Pads,
    outlines: Outlines,
) -> None:  # fmt: skip
    """Append a cell's outline, without sides of no length."""
    out = pads.out
    if n == 0:
        n = m
        if is_packed:
            outline_of_lanes(U, V, m, out)
        else:
            outline_of_cell(pads.cell, m, out)
        put_numbers(N, pads.cell, m, is_packed, first_edge, out)
    corner, beyond, following = outlines.corner, outlines.beyond, outlines.following
    base = outlines.used[0]
    k = first = ZERO
    ring = 0.0
    for s in range(n):
        if out[s, 5] != ring:
            if k > first and base + k <= len(corner):
                following[base + k - 1] = base + first
            first, ring = k, out[s, 5]
        if out[s, 0] == out[s, 2] and out[s, 1] == out[s, 3]:
            continue
        if base + k < len(corner):
            corner[base + k, 0], corner[base + k, 1] = out[s, 0], out[s, 1]
            beyond[base + k], following[base + k] = int(out[s, 4]), base + k + 1
        k += 1
    if k > first and base + k <= len(corner):
        following[base + k - 1] = base + first
    outlines.n_sides[w] = k
    outlines.used[0] = base + k


@inline
def _is_in_cell(N: Any, m: int, dots: Dots, spot: Spot, over: float, du: float, dv: float) -> bool:
    """Whether a place is nearer to the dot than to the dots beyond its sides."""
    for k in range(m):
        j = get(N, k)
        if j >= 0:
            a, b = dots.x[j] - spot.x, dots.y[j] - spot.y
            if a * over * du + b * over * dv > 0.5 * (a * a + b * b):
                return False
    return True


@inner
def _star_at_border(
    N: Any, S: Any, m: int, is_packed: bool, n: int, first_edge: int, pads: Pads
) -> int:
    """Put what lies beyond a cell's outer ring into S; return how many, 0 if it cannot be kept."""
    out, count = pads.out, ZERO
    if n == 0 and not is_packed:
        return int(ZERO)
    for s in range(n if n > 0 else m):
        if n > 0:
            j = int(out[s, 4])
            if out[s, 5] != 0.0:
                break
            if j == NOWHERE:
                return int(ZERO)
            if out[s, 0] == out[s, 2] and out[s, 1] == out[s, 3]:
                continue
        else:
            j = get(N, s)
            if j < 0:
                j -= first_edge
        if count + 3 > LANES:
            return int(ZERO)
        put(S, count, np.int32(j))
        count += 1
    for k in range(2):
        put(S, count + k, get(S, k))
    return int(count)


@inline
def _keep_star(N: Any, m: int, i: int, stars: Stars) -> None:
    """Note a dot's neighbours; mark old and new ones as suspect if they have changed."""
    if len(stars.suspect) and not _is_same_star(N, m, i, stars):
        for k in range(stars.n[i]):
            if stars.around[i, k] >= 0:
                stars.suspect[stars.around[i, k]] = 1
        for k in range(m):
            if get(N, k) >= 0:
                stars.suspect[get(N, k)] = 1
    stars.n[i] = m
    if m > 0:
        store_lanes(N, stars.around, i)


@inline
def _is_same_star(N: Any, m: int, i: int, stars: Stars) -> bool:
    """Whether a dot's ring of neighbours is, but for where it begins, the one noted."""
    around = stars.around
    if stars.n[i] != m or m == 0:
        return bool(stars.n[i] == m)
    turn = ZERO
    while turn < m and around[i, turn] != get(N, 0):
        turn += 1
    if turn == m:
        return False
    for k in range(m):
        w = k + turn if k + turn < m else k + turn - m
        if around[i, w] != get(N, k):
            return False
    return True
