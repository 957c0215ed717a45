"""In which area points lie, decided exactly: a sum of what a ray crosses."""

from __future__ import annotations

import numpy as np

from stippler.kernels.machine.jit import kernel

UNSURE = -9
"""What `find_areas_in` says where a point lies too near a border for its arithmetic."""

_DOUBT = 64.0
"""Above the error of a cross product of coordinates below 2^28, in squares of the unit."""


@kernel
def fill_bands(s, low, height, start, found, counting) -> None:
    """Sort segments into horizontal bands; first count them, then list them."""
    n_bands = len(start) - 1
    for i in range(len(s)):
        bottom, top = min(s[i, 1], s[i, 3]), max(s[i, 1], s[i, 3])
        first = min(max((bottom - low) // height, 0), n_bands - 1)
        last = min(max((top - low) // height, 0), n_bands - 1)
        for band in range(first, last + 1):
            if counting:
                start[band + 1] += 1
            else:
                found[start[band]] = i
                start[band] += 1


@kernel
def find_areas_in(
    begin, stop, points, s, left, right, low, height, start, listed, outside, found
) -> None:
    """Find for each point the area that it lies in.

    On a way from far right to the point the area changes at each border from the one on its right
    side to the one on its left; so the areas' numbers telescope.

    Parameters
    ----------
    points : (n, 2) float64, in units of the grid
    s : (m, 4) int64
    left, right : (m,) int64
        Areas beside each segment.
    outside : int
        What lies beyond all.
    found : (n,) int64
        Is filled; `UNSURE` where a point lies on a border or all but.
    """
    n_bands = len(start) - 1
    for k in range(begin, stop):
        x, y = points[k, 0], points[k, 1]
        total = np.int64(outside)
        band = np.int64(np.floor((y - low) / height))
        found[k] = outside
        if band < 0 or band >= n_bands:
            continue
        for slot in range(start[band], start[band + 1]):
            i = listed[slot]
            y0, y1 = s[i, 1], s[i, 3]
            if (y0 <= y) == (y1 <= y):
                continue
            x0, x1 = s[i, 0], s[i, 2]
            if x > max(x0, x1):
                continue
            if x >= min(x0, x1) - 1:
                c = (x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)
                if abs(c) <= _DOUBT:
                    total = np.int64(UNSURE)
                    break
                if (c > 0) != (y1 > y0):
                    continue
            total += (left[i] - right[i]) if y1 > y0 else (right[i] - left[i])
        found[k] = total
