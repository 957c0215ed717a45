"""Each point's nearest ones, by a grid; and a first order along Hilbert's curve."""

from __future__ import annotations

import math

import numpy as np

from stippler.kernels.machine.jit import inline, kernel

HILBERT_BITS = 16


@kernel
def hilbert_keys(start, stop, xy, left, top, per_mm, out):
    """Find the places of points along Hilbert's curve."""
    for i in range(start, stop):
        x = np.int64((xy[i, 0] - left) * per_mm)
        y = np.int64((xy[i, 1] - top) * per_mm)
        key = np.int64(0)
        s = np.int64(1) << (HILBERT_BITS - 1)
        while s > 0:
            rx = np.int64(1) if x & s else np.int64(0)
            ry = np.int64(1) if y & s else np.int64(0)
            key += s * s * ((3 * rx) ^ ry)
            if ry == 0:
                if rx == 1:
                    x = s - 1 - (x & (s - 1))
                    y = s - 1 - (y & (s - 1))
                x, y = y, x
            x &= s - 1
            y &= s - 1
            s >>= 1
        out[i] = key


@inline
def _put_near(near, away, n, k_most, i, d):
    """Insert a point into a sorted list of at most `k_most`; return how many it holds."""
    if n < k_most:
        n += 1
    elif d >= away[n - 1]:
        return n
    k = n - 1
    while k > 0 and away[k - 1] > d:
        away[k] = away[k - 1]
        near[k] = near[k - 1]
        k -= 1
    away[k] = d
    near[k] = i
    return n


@kernel
def nearest(start, stop, xy, order, cell_start, left, top, side, columns, rows, out):
    """Find the nearest points of each: rings of grid cells until none nearer can come; -1 fills."""
    k_most = out.shape[1]
    away = np.empty(k_most)
    for i in range(start, stop):
        x, y = xy[i]
        cx = min(int((x - left) / side), columns - 1)
        cy = min(int((y - top) / side), rows - 1)
        n = 0
        out[i] = -1
        for ring in range(max(columns, rows)):
            if n == k_most:
                clear = (ring - 1) * side  # cells of this ring are at least so far
                if clear > 0 and clear * clear > away[n - 1]:
                    break
            for v in range(max(cy - ring, 0), min(cy + ring, rows - 1) + 1):
                edge = v == cy - ring or v == cy + ring
                step = 1 if edge else max(2 * ring, 1)
                for u in range(cx - ring, cx + ring + 1, step):
                    if 0 <= u < columns:
                        cell = v * columns + u
                        for k in range(cell_start[cell], cell_start[cell + 1]):
                            j = order[k]
                            if j != i:
                                d = (xy[j, 0] - x) ** 2 + (xy[j, 1] - y) ** 2
                                n = _put_near(out[i], away, n, k_most, j, d)


@inline
def length_between(xy, i, j):
    """Return the distance of two points."""
    return math.hypot(xy[i, 0] - xy[j, 0], xy[i, 1] - xy[j, 1])
