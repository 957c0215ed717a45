"""Exact integrals of a picture's piecewise constant field over polygons.

The integral of f over a polygon is the line integral of ``G dy`` along its border, where G is
f's running integral in x. `sums` holds G, and the same of x f, at the pixel borders of each row, so
an edge costs one term for each pixel it crosses. G is taken relative to a column near the polygon:
where f is 0 every term is then exactly 0, and so is the integral.
"""

from __future__ import annotations

import math

from stippler.kernels.jit import inner, kernel
from stippler.kernels.simd import data_of, get
from stippler.kernels.tables import F8


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
    m = mx = my = 0.0
    if ay == by:
        return m, mx, my
    base = min(max(math.floor(x), 0), w)
    slope = (bx - ax) / (by - ay)
    above, below = y + ay, y + by
    r = max(math.floor(above), 0)
    r_end = min(math.ceil(below), h)
    va = max(ay, r - y)
    ua = ax if va == ay else ax + (va - ay) * slope
    while r < r_end:
        vb = min(by, r + 1 - y)
        ub = bx if vb == by else ax + (vb - ay) * slope
        row = r * (w + 1)
        # from left to right, whichever way the edge leans
        if ua <= ub:
            u, u_end, v, v_end = ua, ub, va, vb
        else:
            u, u_end, v, v_end = ub, ua, vb, va
        c, c_last = math.floor(x + u), math.floor(x + u_end)
        at = 2 * (row + min(max(c, 0), w))
        at0 = 2 * (row + base)
        g0, q0 = get(g_and_q, at0), get(g_and_q, at0 + 1)
        g, q = get(g_and_q, at), get(g_and_q, at + 1)
        if get(g_and_q, 2 * (row + min(max(c_last + 1, 0), w))) == g:
            # no ink under the edge: the running sums stay as they are
            dv = vb - va
            g -= g0
            if g != 0.0:
                m += g * dv
                mx += (q - q0 - x * g) * dv
                my += g * dv * 0.5 * (va + vb)
        else:
            lean = (v_end - v) / (u_end - u) if c != c_last else 0.0
            while c <= c_last:
                p = c - x
                at = 2 * (row + min(max(c + 1, 0), w))
                g1, q1 = get(g_and_q, at), get(g_and_q, at + 1)
                is_last = c == c_last
                u1 = u_end if is_last else p + 1.0
                v1 = v_end if is_last else v + (u1 - u) * lean
                dv = abs(v1 - v)
                f = 0.5 * (g1 - g)
                g -= g0
                q -= q0 + x * g
                s = u - p + (u1 - p)
                m += (g + f * s) * dv
                mx += (q + f * ((u * u + u * u1 + u1 * u1) * (1.0 / 3.0) - p * p)) * dv
                my += (
                    (0.5 * g) * (v + v1)
                    + f * ((s * (v + v1) + (u - p) * v + (u1 - p) * v1) * (1.0 / 3.0))
                ) * dv
                u, v, g, q = u1, v1, g1, q1
                c += 1
        ua, va = ub, vb
        r += 1
    return sign * m, sign * mx, sign * my
