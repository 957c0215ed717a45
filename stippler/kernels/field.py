"""Exact integrals of a picture's piecewise constant field over polygons.

The integral of f over a polygon is the line integral of ``G dy`` along its border, where G is
f's running integral in x. `mass` and `moment` hold G at the pixel borders of each row, so an
edge costs one term for each pixel it crosses. G is taken relative to a column near the polygon:
where f is 0 every term is then exactly 0, and so is the integral.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.jit import inner, kernel

F8 = NDArray[np.float64]


@kernel
def sum_rows(start: int, stop: int, values: F8, mass: F8, moment: F8) -> None:
    """Write the running sums along x of f and of x f, in pixels, for rows start..stop."""
    for r in range(start, stop):
        m = q = 0.0
        for c in range(values.shape[1]):
            mass[r, c], moment[r, c] = m, q
            m += values[r, c]
            q += values[r, c] * (c + 0.5)
        mass[r, values.shape[1]], moment[r, values.shape[1]] = m, q


@inner
def integrate_edge(
    mass: F8, moment: F8, x: float, y: float, ax: float, ay: float, bx: float, by: float
) -> tuple[float, float, float]:
    """Return an edge's share of mass and of both first moments about (x, y), in pixels.

    The edge runs from (x + ax, y + ay) to (x + bx, y + by). Outside the field f is 0.
    """
    h, w = mass.shape[0], mass.shape[1] - 1
    base = min(max(math.floor(x), 0), w)
    m = mx = my = 0.0
    if ay == by:
        return m, mx, my
    up = 1 if by > ay else -1
    r = math.floor(y + ay) if up > 0 else math.ceil(y + ay) - 1
    r_last = math.ceil(y + by) - 1 if up > 0 else math.floor(y + by)
    slope = (bx - ax) / (by - ay)
    rise = (by - ay) / (bx - ax) if bx != ax else 0.0
    right = 1 if bx > ax else -1
    ua, va = ax, ay
    while True:
        is_last = r == r_last or (r - r_last) * up > 0
        v_end = by if is_last else (r + (up > 0)) - y
        u_end = bx if is_last else ax + (v_end - ay) * slope
        if 0 <= r < h:
            c = math.floor(x + ua) if right > 0 else math.ceil(x + ua) - 1
            c_last = math.ceil(x + u_end) - 1 if right > 0 else math.floor(x + u_end)
            m0, q0 = mass[r, base], moment[r, base]
            while True:
                in_last = c == c_last or (c - c_last) * right > 0
                ub = u_end if in_last else (c + (right > 0)) - x
                vb = v_end if in_last else va + (ub - ua) * rise
                left = min(max(c, 0), w)
                g = mass[r, left] - m0
                q = moment[r, left] - q0 - x * g
                dv = vb - va
                m += g * dv
                mx += q * dv
                my += g * dv * 0.5 * (va + vb)
                if 0 <= c < w:
                    f = mass[r, c + 1] - mass[r, c]
                    p = c - x
                    m += f * (0.5 * (ua + ub) - p) * dv
                    mx += f * ((ua * ua + ua * ub + ub * ub) / 3.0 - p * p) * 0.5 * dv
                    my += (
                        f
                        * dv
                        * (
                            (2.0 * (ua * va + ub * vb) + ua * vb + ub * va) / 6.0
                            - p * 0.5 * (va + vb)
                        )
                    )
                ua, va = ub, vb
                if in_last:
                    break
                c += right
        ua, va = u_end, v_end
        if is_last:
            break
        r += up
    return m, mx, my
