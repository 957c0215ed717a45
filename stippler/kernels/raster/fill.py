"""Shapes into rows of bits: ellipses, rough outlines, lines with round ends, polygons.

A bit is set when its middle lies inside. Each kernel fills blocks of rows, so threads never meet;
lengths are in bits, rows count from the top of the page.
"""

from __future__ import annotations

import math

import numpy as np

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.raster.bits import fill_span

BLOCK_ROWS = 64
MAX_CROSSINGS = 64
"""A row crosses a rough outline at most so often; outlines are traced with fewer points."""


@inline
def _rows(low, high, top, bottom):
    """Return the rows whose middles lie in ``low..high``, of those in ``top..bottom``."""
    first, last = np.int64(math.ceil(low - 0.5)), np.int64(math.floor(high - 0.5))
    return max(first, top), min(last + 1, bottom)


@kernel
def fill_ellipses(start, stop, bits, n_bits, first_row, ellipses, reach, ink):
    """Fill ellipses (x, y, a, b, c, half height): a dx^2 + 2 b dx dy + c dy^2 <= 1; sorted by y."""
    for block in range(start, stop):
        top = first_row + block * BLOCK_ROWS
        bottom = min(top + BLOCK_ROWS, first_row + bits.shape[0])
        i = np.searchsorted(ellipses[:, 1], top - reach)
        while i < ellipses.shape[0] and ellipses[i, 1] <= bottom + reach:
            x, y, a, b, c, half = ellipses[i]
            y0, y1 = _rows(y - half, y + half, top, bottom)
            for row in range(y0, y1):
                dy = row + 0.5 - y
                root = b * b * dy * dy - a * (c * dy * dy - 1.0)
                if root > 0.0:
                    middle = x - b * dy / a
                    wide = math.sqrt(root) / a
                    fill_span(bits[row - first_row], middle - wide, middle + wide, n_bits, ink)
            i += 1


@inline
def _sorted_into(crossings, n, x):
    while n > 0 and crossings[n - 1] > x:
        crossings[n] = crossings[n - 1]
        n -= 1
    crossings[n] = x


@kernel
def fill_outlines(start, stop, bits, n_bits, first_row, outlines, bounds, reach, ink):
    """Fill closed outlines of equally many points; `bounds` (y, top, bottom), sorted by y."""
    m = outlines.shape[1]
    crossings = np.empty((BLOCK_ROWS, MAX_CROSSINGS))
    counts = np.zeros(BLOCK_ROWS, np.int64)
    for block in range(start, stop):
        top = first_row + block * BLOCK_ROWS
        bottom = min(top + BLOCK_ROWS, first_row + bits.shape[0])
        i = np.searchsorted(bounds[:, 0], top - reach)
        while i < outlines.shape[0] and bounds[i, 0] <= bottom + reach:
            y0, y1 = _rows(bounds[i, 1], bounds[i, 2], top, bottom)
            if y0 < y1:
                counts[: y1 - y0] = 0
                px, py = outlines[i, m - 1]
                for j in range(m):
                    qx, qy = outlines[i, j]
                    e0, e1 = _rows(min(py, qy), max(py, qy), y0, y1)
                    for row in range(e0, e1):
                        if (py <= row + 0.5) != (qy <= row + 0.5):
                            k = row - y0
                            x = px + (row + 0.5 - py) * (qx - px) / (qy - py)
                            _sorted_into(crossings[k], counts[k], x)
                            counts[k] += 1
                    px, py = qx, qy
                for row in range(y0, y1):
                    k = row - y0
                    for c in range(0, counts[k] - 1, 2):
                        left, right = crossings[k, c], crossings[k, c + 1]
                        fill_span(bits[row - first_row], left, right, n_bits, ink)
            i += 1


@kernel
def fill_lines(start, stop, bits, n_bits, first_row, lines, ink):
    """Fill lines (x0, y0, x1, y1, half width) with round ends."""
    for block in range(start, stop):
        top = first_row + block * BLOCK_ROWS
        bottom = min(top + BLOCK_ROWS, first_row + bits.shape[0])
        for i in range(lines.shape[0]):
            x0, y0, x1, y1, r = lines[i]
            first, end = _rows(min(y0, y1) - r, max(y0, y1) + r, top, bottom)
            length = math.hypot(x1 - x0, y1 - y0)
            nx = ny = 0.0
            if length > 0.0:
                nx, ny = -r * (y1 - y0) / length, r * (x1 - x0) / length
            for row in range(first, end):
                y = row + 0.5
                left, right = np.inf, -np.inf
                for k in range(2):
                    cx, cy = (x0, y0) if k == 0 else (x1, y1)
                    under = r * r - (y - cy) * (y - cy)
                    if under > 0.0:
                        left = min(left, cx - math.sqrt(under))
                        right = max(right, cx + math.sqrt(under))
                for k in range(4):
                    ax, ay = (x0 + nx, y0 + ny) if k == 0 or k == 3 else (x1 - nx, y1 - ny)
                    bx, by = (x1 + nx, y1 + ny) if k == 0 or k == 1 else (x0 - nx, y0 - ny)
                    if (ay <= y) != (by <= y):
                        x = ax + (y - ay) * (bx - ax) / (by - ay)
                        left, right = min(left, x), max(right, x)
                if left < right:
                    fill_span(bits[row - first_row], left, right, n_bits, ink)


@kernel
def fill_polygons(start, stop, bits, n_bits, first_row, edges, edges_from, ink):
    """Fill polygons by the even-odd rule; `edges` (x0, y0, x1, y1), a polygon's in one run."""
    near = np.empty(edges.shape[0], np.int64)
    crossings = np.empty(edges.shape[0] + 1)
    for block in range(start, stop):
        top = first_row + block * BLOCK_ROWS
        bottom = min(top + BLOCK_ROWS, first_row + bits.shape[0])
        for p in range(edges_from.shape[0] - 1):
            n_near = 0
            for e in range(edges_from[p], edges_from[p + 1]):
                if min(edges[e, 1], edges[e, 3]) < bottom and max(edges[e, 1], edges[e, 3]) > top:
                    near[n_near] = e
                    n_near += 1
            for row in range(top, bottom):
                y = row + 0.5
                n = 0
                for k in range(n_near):
                    x0, y0, x1, y1 = edges[near[k]]
                    if (y0 <= y) != (y1 <= y):
                        _sorted_into(crossings, n, x0 + (y - y0) * (x1 - x0) / (y1 - y0))
                        n += 1
                for c in range(0, n - 1, 2):
                    left, right = crossings[c], crossings[c + 1]
                    fill_span(bits[row - first_row], left, right, n_bits, ink)
