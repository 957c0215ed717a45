"""Exact integrals of a picture's piecewise constant field over polygons.

The integral of f over a polygon is the line integral of ``G dy`` along its border, where G is
f's running integral in x. `sums` holds G, and the same of x f, at the pixel borders of each row, so
an edge costs one term for each pixel it crosses; a long one, where it lies on white, one a row. G
is taken relative to a column near the polygon: where f is 0 every term is then exactly 0, and so
is the integral. A window's sums lie in one run, rows of ``columns + 1`` pairs. Most edges are
walked many at a time, see `field_lanes`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.cells.tables import F8
from stippler.kernels.machine.jit import inline, inner, kernel
from stippler.kernels.machine.simd import data_of, get

FIRST, ROWS, COLUMNS, TOP, LEFT, TABLE = range(6)
"""Columns of what describes a window: where its sums begin, its size and place, its table."""

LONG = 32
"""Columns from which on an edge is looked at row by row, as much of it may lie on white."""


@inline
def _mirrored(k: int, n: int) -> int:
    k = -1 - k if k < 0 else k
    return k if k < n else 2 * n - 1 - k


@kernel
def sum_rows(
    start: int, stop: int, values: Any, tables: NDArray[np.float32], row_start: NDArray[np.int64],
    window: NDArray[np.int64], sums: F8,
) -> None:  # fmt: skip
    """Write the running sums along x of f and of x f, in pixels, for rows start..stop.

    Parameters
    ----------
    values : (h, w)
        f itself, or with `tables` its levels.
    tables : (k, levels) float32
        f by level, a row for each table; none if `values` are f.
    row_start : (v + 1,) int64
        Windows' rows are counted one after the other: where each one's begin.
    window : (v, 6) int64
        What of them lies beyond `values` repeats these, mirrored.
    """
    height, width = values.shape
    v = 0
    for r in range(start, stop):
        while row_start[v + 1] <= r:
            v += 1
        columns, left, table = window[v, COLUMNS], window[v, LEFT], window[v, TABLE]
        row = r - row_start[v]
        at = 2 * (window[v, FIRST] + row * (columns + 1))
        row = _mirrored(row + window[v, TOP], height)
        m = q = 0.0
        for c in range(columns):
            sums[at], sums[at + 1] = m, q
            column = _mirrored(left + c, width)
            f = np.float64(values[row, column])
            if len(tables) > 0:
                f = np.float64(tables[table, int(values[row, column])])
            m += f
            q += f * (c + 0.5)
            at += 2
        sums[at], sums[at + 1] = m, q


@inner
def _walk(
    g_and_q: Any, start: int, h: int, w: int, x: float, y: float, ua: float, va: float, ub: float,
    vb: float,
) -> tuple[float, float, float]:  # fmt: skip
    """Return the share of a piece of an edge within the field's rows, va < vb, pixel by pixel.

    Whether a row or a column ends next is a number, 0 or 1, and no branch: a processor would
    foretell it wrongly every other time.
    """
    base = min(max(math.floor(x), 0), w)
    first, last = math.floor(x + ua), math.floor(x + ub)
    r_last = min(math.ceil(y + vb), h) - 1
    r = min(max(math.floor(y + va), 0), r_last)
    n = r_last - r + abs(last - first) + 1
    slope = (ub - ua) / (vb - va)
    step = math.copysign(1.0, ub - ua)
    c, row = float(first), float(r)
    v_col, v_row, d_col = math.inf, r + 1 - y, 0.0
    if first != last:
        d_col = (vb - va) / abs(ub - ua)
        v_col = va + max(((c - x) + (0.5 + 0.5 * step) - ua) * step, 0.0) * d_col
    m = mx = my = 0.0
    u, v = ua, va
    for _ in range(n):
        v1 = min(min(v_col, v_row), vb)
        u1 = ua + (v1 - va) * slope
        k, at0 = int(c), start + min(int(row), r_last) * (w + 1)
        at, at1 = 2 * (at0 + min(max(k, 0), w)), 2 * (at0 + min(max(k + 1, 0), w))
        at0 = 2 * (at0 + base)
        g = get(g_and_q, at)
        f = 0.5 * (get(g_and_q, at1) - g)
        g -= get(g_and_q, at0)
        q = get(g_and_q, at + 1) - get(g_and_q, at0 + 1) - x * g
        p = c - x
        a, b, dv = u - p, u1 - p, v1 - v
        s = a + b
        m += (g + f * s) * dv
        mx += (q + f * ((a * s + b * b) * (1.0 / 3.0) + p * s)) * dv
        my += ((0.5 * g) * (v + v1) + f * ((s * (v + v1) + a * v + b * v1) * (1.0 / 3.0))) * dv
        u, v = u1, v1
        is_col = 0.5 + math.copysign(0.5, v_row - v_col)
        c += is_col * step
        v_col += is_col * d_col
        v_row += 1.0 - is_col
        row += 1.0 - is_col
    return m, mx, my


@inner
def integrate_edge(
    sums: F8, start: int, h: int, w: int, x: float, y: float, ax: float, ay: float, bx: float,
    by: float,
) -> tuple[float, float, float]:  # fmt: skip
    """Return an edge's share of mass and of both first moments about (x, y), in pixels.

    The edge runs from (x + ax, y + ay) to (x + bx, y + by). The window's sums begin at `start`, it
    has h rows and w columns; outside it f is 0.
    """
    g_and_q = data_of(sums)
    sign = 1.0
    if ay > by:
        ax, ay, bx, by, sign = bx, by, ax, ay, -1.0
    va, vb = max(ay, -y), min(by, h - y)
    m = mx = my = 0.0
    if not va < vb:
        return m, mx, my
    slope = (bx - ax) / (by - ay)
    ua = ax if va == ay else ax + (va - ay) * slope
    ub = bx if vb == by else ax + (vb - ay) * slope
    if abs(ub - ua) < LONG:
        m, mx, my = _walk(g_and_q, start, h, w, x, y, ua, va, ub, vb)
        return sign * m, sign * mx, sign * my
    base = min(max(math.floor(x), 0), w)
    u, v = ua, va
    for r in range(max(math.floor(y + va), 0), min(math.ceil(y + vb), h)):
        v1 = min(vb, r + 1 - y)
        u1 = ub if v1 == vb else ua + (v1 - va) * slope
        left, right = math.floor(x + min(u, u1)), math.floor(x + max(u, u1)) + 1
        first = start + r * (w + 1)
        at = 2 * (first + min(max(left, 0), w))
        g = get(g_and_q, at)
        if get(g_and_q, 2 * (first + min(max(right, 0), w))) == g:
            # no ink under the edge: the running sums stay as they are
            at0 = 2 * (first + base)
            g -= get(g_and_q, at0)
            dv = v1 - v
            m += g * dv
            mx += (get(g_and_q, at + 1) - get(g_and_q, at0 + 1) - x * g) * dv
            my += g * dv * 0.5 * (v + v1)
        elif v < v1:
            m1, mx1, my1 = _walk(g_and_q, start, h, w, x, y, u, v, u1, v1)
            m += m1
            mx += mx1
            my += my1
        u, v = u1, v1
    return sign * m, sign * mx, sign * my
