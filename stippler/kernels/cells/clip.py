"""The piece of a convex cell inside its compartment that holds the dot.

The border inside a cell falls into chains, which enter and leave the cell, and loops, which lie
wholly within it. A chain has the compartment on its left and hides from the dot what lies on its
right: the stretch of the cell's rim from where it enters round to where it leaves. The piece is
the cell without what is hidden by each chain that has the dot on its left and is not itself
hidden by another.

Corners of the border on the cell's rim, or nearer to it than `margin`, count as outside. So a wall
along a side is none, and what touches the piece in a corner alone is no part of it. What remains
to rounding is where two crossings of the rim lie all but in one place: of one chain its area tells
their order; of two, either order is right to rounding.

`rim` positions are corner number + fraction of the side after it. `Chain` rows: enter, leave
(``leave >= enter``, may exceed m), first and last + 1 of its segments in `trace`, state. Segments
are ``u0, v0, u1, v1, number``, see `border`.
"""

from __future__ import annotations

from stippler.kernels.cells.tables import F8, Border, Pads
from stippler.kernels.machine.jit import ZERO, inline, inner, merged

_ENTER, _LEAVE, _FIRST, _END, _KEPT = 0, 1, 2, 3, 4


@inline
def _rim_position(cell: F8, m: int, k: int, u: float, v: float) -> float:
    """Return the rim position of a point on side k."""
    n = k + 1 if k + 1 < m else 0
    du, dv = cell[0, n] - cell[0, k], cell[1, n] - cell[1, k]
    length2 = du * du + dv * dv
    if length2 == 0.0:
        return float(k)
    t = ((u - cell[0, k]) * du + (v - cell[1, k]) * dv) / length2
    return float(k + min(max(t, 0.0), 1.0))


@inner
def _clip_edge(
    cell: F8, m: int, au: float, av: float, bu: float, bv: float
) -> tuple[float, float, int, int]:
    """Return the edge's part inside the cell (t0, t1) and the sides it enters and leaves by.

    Sides are -1 where the edge starts or ends inside; t0 > t1 where it misses the cell. A corner
    shared by two edges is judged by the same arithmetic for both.
    """
    t0, t1, k0, k1 = 0.0, 1.0, -1, -1
    for k in range(m):
        c = cell[4, k] - cell[6, k]
        da = cell[2, k] * au + cell[3, k] * av - c
        db = cell[2, k] * bu + cell[3, k] * bv - c
        if da > 0.0:
            if db > 0.0:
                return 1.0, 0.0, -1, -1
            t = da / (da - db)
            if k0 < 0 or t > t0:
                t0, k0 = t, k
        elif db > 0.0:
            t = da / (da - db)
            if k1 < 0 or t < t1:
                t1, k1 = t, k
    return t0, t1, k0, k1


@inline
def _is_inside(cell: F8, m: int, u: float, v: float) -> bool:
    for k in range(m):  # noqa: SIM110 - a kernel
        if cell[2, k] * u + cell[3, k] * v - (cell[4, k] - cell[6, k]) > 0.0:
            return False
    return True


@inline
def _crossing(au: float, av: float, bu: float, bv: float) -> int:
    """Return +1 or -1 if the segment crosses the ray from the origin towards +u, else 0."""
    if (av <= 0.0) == (bv <= 0.0):
        return 0
    side = au * bv - bu * av
    if bv > av:
        return 1 if side > 0.0 else 0
    return -1 if side < 0.0 else 0


@inline
def _put(trace: F8, n: int, au: float, av: float, bu: float, bv: float, number: float) -> int:
    trace[n, 0], trace[n, 1], trace[n, 2], trace[n, 3] = au, av, bu, bv
    trace[n, 4] = number
    return n + 1


@inline
def _put_rim(cell: F8, m: int, begin: float, end: float, out: F8, n: int) -> int:
    """Append the rim's corners strictly between two rim positions, joined to out's last point.

    ``end`` may exceed m. The caller sets out's last point before and closes the run after.
    """
    k = int(begin)
    out[n, 4] = cell[5, k if k < m else k - m]
    k += 1
    while k < end:
        w = k if k < m else k - m
        out[n, 2], out[n, 3] = cell[0, w], cell[1, w]
        n += 1
        out[n, 0], out[n, 1] = cell[0, w], cell[1, w]
        out[n, 4] = cell[5, w]
        k += 1
    return n


@inner
def _hides(cell: F8, m: int, chain: F8, trace: F8, u: float, v: float, near2: float) -> bool:
    """Whether the chain hides the point from the piece's side: whether it lies on its right.

    A point within ``sqrt(near2)`` of the chain counts as on its left.
    """
    first, end = int(chain[_FIRST]), int(chain[_END])
    wind = 0
    for s in range(first, end):
        au, av = trace[s, 0] - u, trace[s, 1] - v
        bu, bv = trace[s, 2] - u, trace[s, 3] - v
        wind -= _crossing(au, av, bu, bv)
        du, dv = bu - au, bv - av
        side = au * bv - bu * av
        along = -(au * du + av * dv)
        length2 = du * du + dv * dv
        if side * side <= near2 * length2 and 0.0 <= along <= length2:
            return False
    pu, pv = trace[first, 0] - u, trace[first, 1] - v
    k = int(chain[_ENTER]) + 1
    while k < chain[_LEAVE]:
        w = k if k < m else k - m
        qu, qv = cell[0, w] - u, cell[1, w] - v
        wind += _crossing(pu, pv, qu, qv)
        pu, pv = qu, qv
        k += 1
    wind += _crossing(pu, pv, trace[end - 1, 2] - u, trace[end - 1, 3] - v)
    return wind != 0


@inner
def _trace_chain(
    m: int, x: float, y: float, border: Border, e: int, n: int, chain: F8, pads: Pads, stamp: int
) -> int:
    """Follow the border from an edge that enters the cell to where it leaves it."""
    cell, edge, trace, seen = pads.cell2, border.edge, pads.trace, pads.seen
    chain[_FIRST] = n
    entering = True
    for _ in range(len(edge)):
        au, av = edge[e, 0] - x, edge[e, 1] - y
        bu, bv = edge[e, 2] - x, edge[e, 3] - y
        t0, t1, k0, k1 = _clip_edge(cell, m, au, av, bu, bv)
        pu, pv = au, av
        if entering:
            pu, pv = au + t0 * (bu - au), av + t0 * (bv - av)
            chain[_ENTER] = _rim_position(cell, m, k0, pu, pv)
            entering = False
        else:
            seen[e] = stamp
        if k1 >= 0:
            bu, bv = au + t1 * (bu - au), av + t1 * (bv - av)
            chain[_LEAVE] = _rim_position(cell, m, k1, bu, bv)
        n = _put(trace, n, pu, pv, bu, bv, -1.0 - e)
        if k1 >= 0:
            break
        e = border.next_edge[e]
    chain[_END] = n
    if chain[_ENTER] >= m:
        chain[_ENTER] -= m
    if chain[_LEAVE] < chain[_ENTER]:
        chain[_LEAVE] += m
    return n


@inner
def _settle_ends(m: int, chain: F8, trace: F8, margin: float) -> bool:
    """Put right where a chain leaves that comes back to where it entered; False if it is none.

    Its area tells whether it bounds a pocket, and hides all else, or a spike, and hides nothing.
    """
    first, end = int(chain[_FIRST]), int(chain[_END])
    u, v = trace[first, 0], trace[first, 1]
    du, dv = trace[end - 1, 2] - u, trace[end - 1, 3] - v
    near2 = 64.0 * margin * margin
    if du * du + dv * dv > near2:
        return True
    twice_area, far2 = 0.0, 0.0
    for s in range(first, end):
        au, av = trace[s, 0] - u, trace[s, 1] - v
        bu, bv = trace[s, 2] - u, trace[s, 3] - v
        twice_area += au * bv - bu * av
        far2 = max(far2, bu * bu + bv * bv)
    if far2 <= near2:
        return False
    hidden = chain[_LEAVE] - chain[_ENTER]
    if twice_area > 0.0 and 2.0 * hidden < m:
        chain[_LEAVE] = chain[_ENTER] + m
    elif twice_area <= 0.0 and 2.0 * hidden > m:
        chain[_LEAVE] = chain[_ENTER]
    return True


@inline
def _hides_end(m: int, chain: F8, other: F8) -> bool:
    """Whether a chain hides the rim around an end of another."""
    length = chain[_LEAVE] - chain[_ENTER]
    for at in (other[_ENTER], other[_LEAVE]):
        offset = at - chain[_ENTER]
        if offset < 0.0:
            offset += m
        elif offset >= m:
            offset -= m
        if 1e-9 < offset < length - 1e-9:
            return True
    return False


@inner
def _choose_side(m: int, chains: F8, n_chains: int, trace: F8) -> None:
    """Of two chains that hide each other keep that of the least edge.

    They meet in the dot: it stands in a corner where the inside touches itself.
    """
    for i in range(n_chains):
        for j in range(n_chains):
            if i == j or chains[i, _KEPT] == 0.0 or chains[j, _KEPT] == 0.0:
                continue
            if not _hides_end(m, chains[i], chains[j]) or not _hides_end(m, chains[j], chains[i]):
                continue
            if trace[int(chains[i, _FIRST]), 4] > trace[int(chains[j, _FIRST]), 4]:
                chains[j, _KEPT] = 0.0


@inner
def _drop_hidden(cell: F8, m: int, chains: F8, n_chains: int, trace: F8, near2: float) -> int:
    """Keep the chains that bound the dot's piece, sorted by where they enter; return how many."""
    kept = 0
    for i in range(n_chains):
        chains[i, _KEPT] = 0.0 if _hides(cell, m, chains[i], trace, 0.0, 0.0, near2) else 1.0
    _choose_side(m, chains, n_chains, trace)
    for i in range(n_chains):
        if chains[i, _KEPT] == 0.0:
            continue
        length = chains[i, _LEAVE] - chains[i, _ENTER]
        middle = chains[i, _ENTER] + 0.5 * length
        for j in range(n_chains):
            if j == i or chains[j, _KEPT] == 0.0:
                continue
            other = chains[j, _LEAVE] - chains[j, _ENTER]
            if other < length or (other == length and j > i):
                continue
            offset = middle - chains[j, _ENTER]
            if offset < 0.0:
                offset += m
            elif offset >= m:
                offset -= m
            if offset <= other:
                chains[i, _KEPT] = 0.0
                break
    for i in range(n_chains):
        if chains[i, _KEPT] == 0.0:
            continue
        if kept != i:
            for r in range(5):
                chains[kept, r] = chains[i, r]
        k = kept
        while k > 0 and chains[k - 1, _ENTER] > chains[k, _ENTER]:
            for r in range(5):
                chains[k - 1, r], chains[k, r] = chains[k, r], chains[k - 1, r]
            k -= 1
        kept += 1
    return kept


@inline
def _put_chains_and_rim(cell: F8, m: int, chains: F8, n_chains: int, trace: F8, out: F8) -> int:
    """Write the piece's outer ring, in order; return its number of segments."""
    n = ZERO
    for i in range(n_chains):
        for s in range(int(chains[i, _FIRST]), int(chains[i, _END])):
            n = _put(out, n, trace[s, 0], trace[s, 1], trace[s, 2], trace[s, 3], trace[s, 4])
        j = i + 1 if i + 1 < n_chains else 0
        a, b = int(chains[i, _END]) - 1, int(chains[j, _FIRST])
        begin, end = chains[i, _LEAVE], chains[j, _ENTER]
        if j == 0:
            end += m
        if begin >= m and end >= m:
            begin -= m
            end -= m
        out[n, 0], out[n, 1] = trace[a, 2], trace[a, 3]
        n = _put_rim(cell, m, begin, end, out, n)
        out[n, 2], out[n, 3] = trace[b, 0], trace[b, 1]
        n += 1
    if n_chains == 0:
        out[n, 0], out[n, 1] = cell[0, 0], cell[1, 0]
        n = _put_rim(cell, m, 0.0, float(m), out, n)
        out[n, 2], out[n, 3] = cell[0, 0], cell[1, 0]
        n += 1
    for s in range(n):
        out[s, 5] = 0.0
    return int(n)


@inner
def _put_loops(
    m: int, x: float, y: float, border: Border, pads: Pads, n_near: int, n_chains: int, n: int,
    stamp: int,
) -> tuple[int, bool]:  # fmt: skip
    """Append the border loops that lie wholly within the piece; tell if one is its outer ring."""
    cell, edge, seen, out = pads.cell2, border.edge, pads.seen, pads.out
    is_ringed, ring = False, 0.0
    for i in range(n_near):
        e = pads.near[i]
        au, av = edge[e, 0] - x, edge[e, 1] - y
        if seen[e] == stamp or not _is_inside(cell, m, au, av):
            continue
        first, twice_area = n, 0.0
        ring += 1.0
        hidden = False
        for c in range(n_chains):
            hidden = hidden or _hides(cell, m, pads.chains[c], pads.trace, au, av, 0.0)
        while seen[e] != stamp:
            seen[e] = stamp
            au, av = edge[e, 0] - x, edge[e, 1] - y
            bu, bv = edge[e, 2] - x, edge[e, 3] - y
            twice_area += au * bv - bu * av
            if not hidden:
                out[n, 5] = ring
                n = _put(out, n, au, av, bu, bv, -1.0 - e)
            e = border.next_edge[e]
        if n > first and twice_area > 0.0:
            is_ringed = True
    return n, is_ringed


@merged
def outline_piece(
    m: int, x: float, y: float, border: Border, pads: Pads, n_near: int, stamp: int, margin: float
) -> int:
    """Write the outline of the dot's piece of a cell as directed segments, piece on the left.

    Parameters
    ----------
    m
        Corners of the convex cell about (x, y) in ``pads.cell2``, see `voronoi`; its last row
        holds `margin` times the length of each side's ``a, b``.
    n_near
        Every border edge that meets the cell is among the first of ``pads.near``, each once.
    stamp
        ``pads.seen`` holds none on entry.
    margin
        The distance within which the dot counts as on the border, not beyond it, and corners of
        the border as on the cell's rim, not inside.

    Returns
    -------
    n : int
        ``pads.out[:n]`` holds ring after ring, each in order: ``u0, v0, u1, v1, number, ring``.
    """
    cell, edge, chains, out = pads.cell2, border.edge, pads.chains, pads.out
    n_chains = n_trace = ZERO
    n_started_inside = 0
    for i in range(n_near):
        e = ZERO + pads.near[i]
        au, av = edge[e, 0] - x, edge[e, 1] - y
        bu, bv = edge[e, 2] - x, edge[e, 3] - y
        t0, t1, k0, _k1 = _clip_edge(cell, m, au, av, bu, bv)
        if k0 < 0 and t0 <= t1:
            n_started_inside += 1
        elif t0 <= t1:
            before = n_trace
            n_trace = _trace_chain(m, x, y, border, e, n_trace, chains[n_chains], pads, stamp)
            n_started_inside -= n_trace - before - 1
            if _settle_ends(m, chains[n_chains], pads.trace, margin):
                n_chains += 1
            else:
                n_trace = before
    if n_chains:
        n_chains = _drop_hidden(cell, m, chains, n_chains, pads.trace, margin * margin)
    n = _put_chains_and_rim(cell, m, chains, n_chains, pads.trace, out)
    if n_started_inside <= 0:
        return n
    n_all, is_ringed = _put_loops(m, x, y, border, pads, n_near, n_chains, n, stamp)
    if not is_ringed:
        return n_all
    for s in range(n, n_all):  # the whole outer border lies in this cell: the rim bounds nothing
        for r in range(6):
            out[s - n, r] = out[s, r]
    return n_all - n
