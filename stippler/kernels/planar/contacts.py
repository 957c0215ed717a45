"""Where line segments on an integer grid meet, so that they can be split there.

Coordinates are below 2^28, so that cross products of differences are exact in int64. Segments keep
clear of each other when none crosses another and no end lies within `NEAR` of another's inside:
then they stay apart whatever is rounded to the grid (iterated snap rounding: Halperin and Packer
2002).
"""

from __future__ import annotations

import numpy as np

from stippler.kernels.machine.jit import inline, kernel

NEAR_SQUARED = 0.5625  # 0.75 of the grid's unit
_REACH = 1


@inline
def cross(ax, ay, bx, by, px, py):
    """Return twice the signed area of a triangle."""
    return (bx - ax) * (py - ay) - (by - ay) * (px - ax)


@inline
def _is_near(ax, ay, bx, by, px, py):
    """Return whether a point that is no end lies beside the inside of a segment."""
    dx, dy = bx - ax, by - ay
    along = (px - ax) * dx + (py - ay) * dy
    length = dx * dx + dy * dy
    if along <= 0 or along >= length:
        return False
    c = float(cross(ax, ay, bx, by, px, py))
    return c * c < NEAR_SQUARED * float(length)


@inline
def _put(which, at, n, i, x, y):
    if n < len(which):
        which[n] = i
        at[n, 0], at[n, 1] = x, y
    return n + 1


@inline
def _ends_beside(s, i, j, which, at, n):
    """Note the ends of segment j that lie beside segment i."""
    for e in range(2):
        x, y = s[j, 2 * e], s[j, 2 * e + 1]
        if (x == s[i, 0] and y == s[i, 1]) or (x == s[i, 2] and y == s[i, 3]):
            continue
        if _is_near(s[i, 0], s[i, 1], s[i, 2], s[i, 3], x, y):
            n = _put(which, at, n, i, x, y)
    return n


@inline
def _crossing(s, i, j, which, at, n):
    """Note where segments i and j cross, as a point of the grid, for both."""
    a = cross(s[i, 0], s[i, 1], s[i, 2], s[i, 3], s[j, 0], s[j, 1])
    b = cross(s[i, 0], s[i, 1], s[i, 2], s[i, 3], s[j, 2], s[j, 3])
    if not ((a > 0 and b < 0) or (a < 0 and b > 0)):
        return n
    c = cross(s[j, 0], s[j, 1], s[j, 2], s[j, 3], s[i, 0], s[i, 1])
    d = cross(s[j, 0], s[j, 1], s[j, 2], s[j, 3], s[i, 2], s[i, 3])
    if not ((c > 0 and d < 0) or (c < 0 and d > 0)):
        return n
    share = float(a) / (float(a) - float(b))
    x = s[j, 0] + np.int64(np.floor(share * float(s[j, 2] - s[j, 0]) + 0.5))
    y = s[j, 1] + np.int64(np.floor(share * float(s[j, 3] - s[j, 1]) + 0.5))
    for k in (i, j):
        if (x != s[k, 0] or y != s[k, 1]) and (x != s[k, 2] or y != s[k, 3]):
            n = _put(which, at, n, k, x, y)
    return n


@kernel
def find_contacts(s, order, is_new, which, at) -> int:
    """Find where segments have to be split.

    Parameters
    ----------
    s : (m, 4) int64
        x0, y0, x1, y1.
    order : (m,) int64
        By their smallest x.
    is_new : (m,) bool
        Pairs of which neither is new are known to keep clear.
    which, at : (k,) int64, (k, 2) int64
        Are filled: the segment to split, and where.

    Returns
    -------
    int
        How many were found; more than k if there was no room.
    """
    n = 0
    m = len(order)
    for p in range(m):
        i = order[p]
        right = max(s[i, 0], s[i, 2]) + _REACH
        low, high = min(s[i, 1], s[i, 3]) - _REACH, max(s[i, 1], s[i, 3]) + _REACH
        for q in range(p + 1, m):
            j = order[q]
            if min(s[j, 0], s[j, 2]) > right:
                break
            if not (is_new[i] or is_new[j]):
                continue
            if max(s[j, 1], s[j, 3]) < low or min(s[j, 1], s[j, 3]) > high:
                continue
            n = _ends_beside(s, i, j, which, at, n)
            n = _ends_beside(s, j, i, which, at, n)
            n = _crossing(s, i, j, which, at, n)
    return n
