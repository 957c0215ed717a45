"""The nearest of many line segments, found through a grid; distances to lines with a width.

Segments are rows of x0, y0, x1, y1, w0, w1, s0, s1: ends, half widths there, arc lengths there. A
line's edge lies half its width, linear between ends, from its axis.
"""

from __future__ import annotations

import math

from stippler.kernels.machine.jit import inline, kernel


@kernel
def list_segments(segments, reach, x0, y0, cell, columns, rows, start, listed, counting) -> None:
    """List for each grid cell the segments that come within reach of it; first count them.

    Parameters
    ----------
    reach : (n,) float64
        Of each segment.
    start : (columns * rows + 1,) int64
        Counts at first, then where each cell's list begins; moved on as it is filled.
    """
    for i in range(len(segments)):
        ax, ay, bx, by = segments[i, 0], segments[i, 1], segments[i, 2], segments[i, 3]
        r = reach[i]
        i0 = max(int((min(ax, bx) - r - x0) / cell), 0)
        i1 = min(int((max(ax, bx) + r - x0) / cell), columns - 1)
        j0 = max(int((min(ay, by) - r - y0) / cell), 0)
        j1 = min(int((max(ay, by) + r - y0) / cell), rows - 1)
        far = r + 0.7072 * cell
        for j in range(j0, j1 + 1):
            y = y0 + (j + 0.5) * cell
            t0, t1 = _within_rows(y - far, y + far, ay, by)
            if t0 > t1:
                continue
            xa, xb = ax + t0 * (bx - ax), ax + t1 * (bx - ax)
            k0 = max(int((min(xa, xb) - far - x0) / cell) - 1, i0)
            k1 = min(int((max(xa, xb) + far - x0) / cell) + 1, i1)
            for k in range(k0, k1 + 1):
                x = x0 + (k + 0.5) * cell
                if _distance(x, y, ax, ay, bx, by) <= far:
                    c = j * columns + k
                    if counting:
                        start[c + 1] += 1
                    else:
                        listed[start[c]] = i
                        start[c] += 1


@inline
def _within_rows(low, high, ay, by):
    """Return from where to where, as shares of a segment, it lies between two heights."""
    if ay == by:
        return 0.0, 1.0
    a, b = (low - ay) / (by - ay), (high - ay) / (by - ay)
    return max(min(a, b), 0.0), min(max(a, b), 1.0)


@inline
def _foot(x, y, ax, ay, bx, by):
    dx, dy = bx - ax, by - ay
    length = dx * dx + dy * dy
    if length == 0.0:
        return 0.0
    return min(max(((x - ax) * dx + (y - ay) * dy) / length, 0.0), 1.0)


@inline
def _distance(x, y, ax, ay, bx, by):
    t = _foot(x, y, ax, ay, bx, by)
    return math.hypot(x - ax - t * (bx - ax), y - ay - t * (by - ay))


@inline
def _nearest(x, y, segments, x0, y0, cell, columns, rows, start, listed, inverse, widest):
    """Return the segment whose edge is nearest, the place along it, and how far its edge is."""
    best, within, place, found = 1e300, 1e300, 0.0, -1
    i, j = math.floor((x - x0) / cell), math.floor((y - y0) / cell)
    if i >= 0 and j >= 0 and i < columns and j < rows:
        c = j * columns + i
        for slot in range(start[c], start[c + 1]):
            k = listed[slot]
            px, py = x - segments[k, 0], y - segments[k, 1]
            dx, dy = segments[k, 2] - segments[k, 0], segments[k, 3] - segments[k, 1]
            t = min(max((px * dx + py * dy) * inverse[k], 0.0), 1.0)
            ex, ey = px - t * dx, py - t * dy
            d = ex * ex + ey * ey
            if d > within:
                continue
            d = math.sqrt(d) - segments[k, 4] - t * (segments[k, 5] - segments[k, 4])
            if d < best:
                best, place, found = d, t, k
                within = max(d + widest, 0.0)
                within *= within
    return found, place, best


@kernel
def find_nearest(
    begin, stop, points, segments, x0, y0, cell, columns, rows, start, listed, inverse, widest,
    which, along, away, feet,
) -> None:  # fmt: skip
    """Find for each point the nearest segment within reach.

    Parameters
    ----------
    inverse : (m,) float64
        Of the segments' squared lengths.
    widest : float
        The largest half width.
    which, along, away, feet : (n,) int64, float64, float64, (n, 2) float64
        Are filled: the segment or -1, the arc length there, the distance to the line's edge, and
        the nearest place on its axis.
    """
    for k in range(begin, stop):
        found, t, d = _nearest(
            points[k, 0], points[k, 1], segments, x0, y0, cell, columns, rows, start, listed,
            inverse, widest,
        )  # fmt: skip
        which[k], away[k] = found, d
        along[k] = 0.0
        if found >= 0:
            along[k] = segments[found, 6] + t * (segments[found, 7] - segments[found, 6])
            feet[k, 0] = segments[found, 0] + t * (segments[found, 2] - segments[found, 0])
            feet[k, 1] = segments[found, 1] + t * (segments[found, 3] - segments[found, 1])


@kernel
def push_out(
    begin, stop, points, gap, segments, x0, y0, cell, columns, rows, start, listed, turns, held
) -> None:
    """Move points away from lines until each keeps its gap from all edges.

    Parameters
    ----------
    points : (n, 2) float64
        Are moved.
    gap : (n,) float64
        By segment: what its line asks for.
    turns : int
        How often a point may be pushed.
    held : (n,) bool
        Is filled: whether a point keeps all gaps in the end.
    """
    for k in range(begin, stop):
        x, y = points[k, 0], points[k, 1]
        fine = False
        for turn in range(turns):
            i, j = math.floor((x - x0) / cell), math.floor((y - y0) / cell)
            if i < 0 or j < 0 or i >= columns or j >= rows:
                fine = True
                break
            c = j * columns + i
            worst, px, py = 0.0, 0.0, 0.0
            for slot in range(start[c], start[c + 1]):
                q = listed[slot]
                ax, ay, bx, by = segments[q, 0], segments[q, 1], segments[q, 2], segments[q, 3]
                t = _foot(x, y, ax, ay, bx, by)
                fx, fy = ax + t * (bx - ax), ay + t * (by - ay)
                d = math.hypot(x - fx, y - fy)
                lack = segments[q, 4] + t * (segments[q, 5] - segments[q, 4]) + gap[q] - d
                if lack > worst:
                    worst = lack
                    if d > 1e-12:
                        px, py = (x - fx) / d, (y - fy) / d
                    else:  # on the axis: to the left of it, or right, in turn
                        length = max(math.hypot(bx - ax, by - ay), 1e-300)
                        side = 1.0 if (k + turn) % 2 == 0 else -1.0
                        px, py = -side * (by - ay) / length, side * (bx - ax) / length
            if worst <= 1e-9:
                fine = True
                break
            over = 1.0 if turn < 8 else 1.5  # corners are left by larger steps
            x, y = x + over * (worst + 1e-9) * px, y + over * (worst + 1e-9) * py
        points[k, 0], points[k, 1] = x, y
        held[k] = fine
