"""Ink of discs within areas: the exact area of their union in each, by its boundary.

Where the union of all discs lies in an area is bounded by pieces of the discs' rims that no other
disc covers, and by pieces of the area's border that a disc does. The integral of ``x dy - y dx``
along both is twice its area. A piece of border counts with the disc whose power there is greatest.

A *row* is a disc that has to do with an area: its anchor lies in it, or its rim may cross its
border. Edges run with their area on the left (y up).
"""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.tone.union_share import Grids, reached

Array = NDArray[Any]

_TURN = 2.0 * math.pi
_NEARLY = 1e-9  # of an edge beyond its ends: the rim may go through a corner


@kernel
def list_overlapping(
    start: int,
    stop: int,
    dot: Array,
    place: Array,
    reach: Array,
    grids: Grids,
    order: Array,
    first: Array,
    other: Array,
    counting: bool,
) -> None:
    """List for each dot asked for the others that it may overlap; first count them.

    Parameters
    ----------
    dot : (k,) int64
    place : (n, 2), reach : (n,) float64
        Of all dots; their largest radii.
    grids, order
        As `sort_discs` has sorted discs there that are no smaller.
    first : (k + 1,) int64
        Counts after the first entry, or where each list begins.
    """
    for k in range(start, stop):
        i = dot[k]
        x, y, r = place[i, 0], place[i, 1], reach[i]
        n = 0
        for g in range(len(grids.real)):
            n_x, base = grids.whole[g, 0], grids.whole[g, 2]
            x0, x1, y0, y1 = reached(x, y, r, grids, g)
            for row in range(base + y0 * n_x, base + y1 * n_x + 1, n_x):
                for m in range(grids.first[row + x0], grids.first[row + x1 + 1]):
                    j = order[m]
                    dx, dy, far = place[j, 0] - x, place[j, 1] - y, r + reach[j]
                    if j != i and dx * dx + dy * dy < far * far:
                        if not counting:
                            other[first[k] + n] = j
                        n += 1
        if counting:
            first[k + 1] = n


@kernel
def list_touching(
    start: int,
    stop: int,
    place: Array,
    reach: Array,
    edges: Array,
    x0: float,
    y0: float,
    side: float,
    columns: int,
    rows: int,
    begin: Array,
    listed: Array,
    first: Array,
    touched: Array,
    counting: bool,
) -> None:
    """List for each dot the edges within its reach; first count them.

    Parameters
    ----------
    place : (n, 2), reach : (n,) float64
    edges : (m, 4) float64
        Listed by the cells of a grid, as `stippler.kernels.lines.nearest.list_segments` does.
    first : (n + 1,) int64
        Counts after the first entry, or where each list begins.
    """
    for i in range(start, stop):
        x, y, r = place[i, 0], place[i, 1], reach[i]
        n = 0
        if x0 <= x < x0 + columns * side and y0 <= y < y0 + rows * side:
            c = min(int((y - y0) / side), rows - 1) * columns + min(
                int((x - x0) / side), columns - 1
            )
            for m in range(begin[c], begin[c + 1]):
                e = listed[m]
                ax, ay = edges[e, 0] - x, edges[e, 1] - y
                dx, dy = edges[e, 2] - edges[e, 0], edges[e, 3] - edges[e, 1]
                d2 = dx * dx + dy * dy
                t = min(max(-(ax * dx + ay * dy) / d2, 0.0), 1.0) if d2 > 0.0 else 0.0
                ax, ay = ax + t * dx, ay + t * dy
                if ax * ax + ay * ay < r * r:
                    if not counting:
                        touched[first[i] + n] = e
                    n += 1
        if counting:
            first[i + 1] = n


@kernel
def ink_in_areas(
    start: int,
    stop: int,
    dot: Array,
    is_inside: Array,
    first_edge: Array,
    edge: Array,
    edges: Array,
    list_of_row: Array,
    first_other: Array,
    other: Array,
    place: Array,
    anchor: Array,
    radii: Array,
    first_room: Array,
    room: Array,
    ink: Array,
    rim: Array,
) -> None:
    """Write what each row adds to the ink of its area, and how much of its rim is free in it.

    Sums over an area's rows are the area of the union within it, and by how much that grows with
    the discs' radii.

    Parameters
    ----------
    dot : (k,) int64, is_inside : (k,) bool
        Whose disc, and whether its anchor lies in the area.
    first_edge : (k + 1,) int64, edge : int64, edges : (m, 4) float64
        The area's edges that the rim may cross.
    list_of_row : (k,) int64, first_other, other : int64
        Who may overlap the disc.
    place, anchor : (n, 2), radii : (n,) float64
        Of all discs: the centre, a place within it on no border, and the radius.
    first_room : (k + 1,) int64, room : float64
        To write in: two places for each other disc, and two for each edge.
    ink, rim : (k,) float64
        Square and length.
    """
    for k in range(start, stop):
        i, b0, b1 = dot[k], first_edge[k], first_edge[k + 1]
        o0, o1 = first_other[list_of_row[k]], first_other[list_of_row[k] + 1]
        ink[k] = rim[k] = 0.0
        x, y, r = place[i, 0], place[i, 1], radii[i]
        if not r > 0.0:
            continue
        n, at = 0, first_room[k]
        done = 0.0  # the rim is covered up to there
        for m in range(o0, o1):
            covered, low, span = _covered(i, other[m], place, radii)
            if covered == 0:
                continue
            if covered == 2:
                n, done = 0, _TURN
                break
            room[at + n] = low
            room[at + (o1 - o0) + n] = low + span
            n += 1
        starts, ends = room[at : at + n], room[at + (o1 - o0) : at + (o1 - o0) + n]
        _sort_both(starts, ends)
        crossing = room[at + 2 * (o1 - o0) : at + 2 * (o1 - o0) + 2 * (b1 - b0)]
        n_crossings = 0
        for m in range(b0, b1):
            e = edge[m]
            n_crossings = _cross(
                edges[e, 0] - x, edges[e, 1] - y, edges[e, 2] - x, edges[e, 3] - y, r,
                crossing, n_crossings,
            )  # fmt: skip
        _sort_both(crossing[:n_crossings], crossing[:n_crossings])
        free, east, north = 0.0, 0.0, 0.0
        for m in range(n):
            done = max(done, ends[m] - _TURN)
        for m in range(n + 1):
            until = starts[m] if m < n else _TURN
            if until > done:
                # from `done` to `until` the rim is free: piece by piece between crossings
                low = done
                for c in range(n_crossings + 1):
                    high = crossing[c] if c < n_crossings else until
                    if high <= low:
                        continue
                    high = min(high, until)
                    if b1 == b0:
                        is_in = is_inside[k]
                    else:
                        middle = 0.5 * (low + high)
                        is_in = _lies_inside(
                            anchor[i, 0], anchor[i, 1], x + r * math.cos(middle),
                            y + r * math.sin(middle), is_inside[k], edges, edge, b0, b1,
                        )  # fmt: skip
                    if is_in:
                        free += high - low
                        east += math.cos(high) - math.cos(low)
                        north += math.sin(high) - math.sin(low)
                    low = high
                    if low >= until:
                        break
            if m < n:
                done = max(done, ends[m])
        total = r * r * free + r * (x * north - y * east)
        for m in range(b0, b1):
            e = edge[m]
            ax, ay = edges[e, 0] - x, edges[e, 1] - y
            dx, dy = edges[e, 2] - edges[e, 0], edges[e, 3] - edges[e, 1]
            t0, t1 = _within_disc(ax, ay, dx, dy, r)
            for q in range(o0, o1):
                if t0 >= t1:
                    break
                t0, t1 = _kept_of_edge(ax, ay, dx, dy, i, other[q], place, radii, t0, t1)
            if t0 < t1:
                total += (t1 - t0) * (edges[e, 0] * dy - edges[e, 1] * dx)
        ink[k] = 0.5 * total
        rim[k] = r * free


@inline
def _covered(i: int, j: int, place: Array, radii: Array) -> tuple[int, float, float]:
    """Return how disc j covers the rim of disc i, and which part of it by angle.

    0: not at all; 1: from an angle of 0 to a turn, by so much; 2: all of it.
    """
    dx, dy = place[j, 0] - place[i, 0], place[j, 1] - place[i, 1]
    r, s = radii[i], radii[j]
    d2 = dx * dx + dy * dy
    if not s > 0.0 or d2 >= (r + s) * (r + s):
        return 0, 0.0, 0.0
    if d2 <= (r - s) * (r - s):
        is_under = s > r or (s == r and j < i)
        return (2, 0.0, 0.0) if is_under else (0, 0.0, 0.0)
    d = math.sqrt(d2)
    c = (d2 + r * r - s * s) / (2.0 * d * r)
    half = math.acos(min(max(c, -1.0), 1.0))
    low = math.atan2(dy, dx) - half
    if low < 0.0:
        low += _TURN
    return 1, low, 2.0 * half


@inline
def _cross(ax: float, ay: float, bx: float, by: float, r: float, crossing: Array, n: int) -> int:
    """Write at which angles an edge, seen from a disc's centre, crosses its rim."""
    dx, dy = bx - ax, by - ay
    d2 = dx * dx + dy * dy
    cross = ax * dy - ay * dx
    under = r * r * d2 - cross * cross
    if d2 == 0.0 or under <= 0.0:
        return n
    middle = -(ax * dx + ay * dy) / d2
    half = math.sqrt(under) / d2
    for t in (middle - half, middle + half):
        if -_NEARLY <= t <= 1.0 + _NEARLY:  # one too many parts a rim, one too few is wrong
            angle = math.atan2(ay + t * dy, ax + t * dx)
            crossing[n] = angle if angle >= 0.0 else angle + _TURN
            n += 1
    return n


@inline
def _lies_inside(
    x: float, y: float, px: float, py: float, is_inside: bool, edges: Array, edge: Array,
    begin: int, end: int,
) -> bool:  # fmt: skip
    """Tell whether a place (px, py) on a disc's rim lies in the area, as seen from its anchor.

    Each edge on the way there leads into the area, or out of it.
    """
    px, py = px - x, py - y
    depth = 1 if is_inside else 0
    for m in range(begin, end):
        e = edge[m]
        ax, ay = edges[e, 0] - x, edges[e, 1] - y
        bx, by = edges[e, 2] - x, edges[e, 3] - y
        side_a, side_b = px * ay - py * ax, px * by - py * bx
        if (side_a < 0.0) == (side_b < 0.0):
            continue
        dx, dy = bx - ax, by - ay
        here = ax * dy - ay * dx  # above 0 on the left
        there = here + dx * py - dy * px
        if here >= 0.0 > there:
            depth -= 1
        elif here < 0.0 <= there:
            depth += 1
    return depth > 0


@inline
def _kept_of_edge(
    ax: float, ay: float, dx: float, dy: float, i: int, j: int, place: Array, radii: Array,
    t0: float, t1: float,
) -> tuple[float, float]:  # fmt: skip
    """Return what of a piece of edge, seen from disc i, is not rather disc j's."""
    ex, ey = place[j, 0] - place[i, 0], place[j, 1] - place[i, 1]
    r, s = radii[i], radii[j]
    d2 = ex * ex + ey * ey
    if not s > 0.0 or d2 >= (r + s) * (r + s):
        return t0, t1
    # the power of i less that of j, which is no more than 0 where the edge is i's
    at = 2.0 * (ax * ex + ay * ey) - d2 + (s - r) * (s + r)
    slope = 2.0 * (dx * ex + dy * ey)
    if slope > 0.0:
        t1 = min(t1, -at / slope)
    elif slope < 0.0:
        t0 = max(t0, -at / slope)
    elif at > 0.0 or (at == 0.0 and j < i):
        t1 = t0
    return t0, t1


@inline
def _within_disc(ax: float, ay: float, dx: float, dy: float, r: float) -> tuple[float, float]:
    """Return from where to where, as shares of it, a side lies within the disc; (1, 0): nowhere."""
    d2 = dx * dx + dy * dy
    cross = ax * dy - ay * dx
    under = r * r * d2 - cross * cross
    if d2 == 0.0 or under <= 0.0:
        return 1.0, 0.0
    middle = -(ax * dx + ay * dy) / d2
    half = math.sqrt(under) / d2
    return max(middle - half, 0.0), min(middle + half, 1.0)


@inline
def _sort_both(keys: Array, others: Array) -> None:
    """Sort numbers, and others with them, which may be the same array."""
    n = len(keys)
    gap = 1
    while 3 * gap + 1 < n:
        gap = 3 * gap + 1
    while gap > 0:
        for m in range(gap, n):
            key, value = keys[m], others[m]
            at = m
            while at >= gap and keys[at - gap] > key:
                keys[at], others[at] = keys[at - gap], others[at - gap]
                at -= gap
            keys[at], others[at] = key, value
        gap //= 3
