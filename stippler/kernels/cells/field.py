"""Exact integrals of a picture's piecewise constant field over polygons.

The integral of f over a polygon is the line integral of ``G dy`` along its border, where G is
f's running integral in x. `sums` holds G, and the same of x f, at the pixel borders of each row, so
an edge costs one term for each pixel it crosses; a long one, where it lies on white, one a row. G
is taken relative to a column near the polygon: where f is 0 every term is then exactly 0, and so
is the integral.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.kernels.cells.tables import F8
from stippler.kernels.machine.jit import inner, kernel
from stippler.kernels.machine.simd import data_of, get

LONG = 32
"""Columns from which on an edge is looked at row by row, as much of it may lie on white."""


@kernel
def sum_rows(start: int, stop: int, values: F8, sums: F8) -> None:
    """Write the running sums along x of f and of x f, in pixels, for rows start..stop."""
    for r in range(start, stop):
        m = q = 0.0
        for c in range(values.shape[1]):
            sums[r, c, 0], sums[r, c, 1] = m, q
            m += values[r, c]
            q += values[r, c] * (c + 0.5)
        sums[r, values.shape[1], 0], sums[r, values.shape[1], 1] = m, q


@inner
def _walk(
    g_and_q: Any, h: int, w: int, x: float, y: float, ua: float, va: float, ub: float, vb: float
) -> tuple[float, float, float]:
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
        k, at0 = int(c), min(int(row), r_last) * (w + 1)
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
    sums: F8, x: float, y: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float, float]:
    """Return an edge's share of mass and of both first moments about (x, y), in pixels.

    The edge runs from (x + ax, y + ay) to (x + bx, y + by). Outside the field f is 0.
    """
    h, w = sums.shape[0], sums.shape[1] - 1
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
        m, mx, my = _walk(g_and_q, h, w, x, y, ua, va, ub, vb)
        return sign * m, sign * mx, sign * my
    base = min(max(math.floor(x), 0), w)
    u, v = ua, va
    for r in range(max(math.floor(y + va), 0), min(math.ceil(y + vb), h)):
        v1 = min(vb, r + 1 - y)
        u1 = ub if v1 == vb else ua + (v1 - va) * slope
        left, right = math.floor(x + min(u, u1)), math.floor(x + max(u, u1)) + 1
        at = 2 * (r * (w + 1) + min(max(left, 0), w))
        g = get(g_and_q, at)
        if get(g_and_q, 2 * (r * (w + 1) + min(max(right, 0), w))) == g:
            # no ink under the edge: the running sums stay as they are
            at0 = 2 * (r * (w + 1) + base)
            g -= get(g_and_q, at0)
            dv = v1 - v
            m += g * dv
            mx += (get(g_and_q, at + 1) - get(g_and_q, at0 + 1) - x * g) * dv
            my += g * dv * 0.5 * (v + v1)
        elif v < v1:
            m1, mx1, my1 = _walk(g_and_q, h, w, x, y, u, v, u1, v1)
            m += m1
            mx += mx1
            my += my1
        u, v = u1, v1
    return sign * m, sign * mx, sign * my
