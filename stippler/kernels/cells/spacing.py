"""Three rules of even spacing, for one dot and its cell: push, pull and level.

*Push* parts dots nearer than they should be, *pull* draws dots to a hole larger than it should be,
*level* evens out the masses of neighbouring cells. Each wants nothing once it is met, so dots come
to rest in a packing without rows. Lloyd's steps never stop wanting and end in crystals.

The rules know what a clipped cell knows: its corners, its sides and the dots beyond. What the other
dots want (`Spacing.wants`: mass, dots per area, radius) is that of the step before, so a step
passes over the cells once. Where the ink in a cell is uneven its dot belongs in the midst of the
ink, and goes there instead (`Spacing.rule`, see `stippler.stippling.spacing`).

Push and pull: Ahmed, Guo, Yan, Franceschi, Zhang, Deussen 2017; level: Balzer, Schloemer, Deussen
2009; de Goes, Breeden, Ostromoukhov, Desbrun 2012.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.kernels.cells.tables import F8, Dots, Spacing
from stippler.kernels.machine.jit import inline, inner
from stippler.kernels.machine.simd import get

NEAR, BASE, SLOPE, CAP, HOLE, NARROW, LEVEL, PULL, GAIN, LOW, LEAST, SCALE = range(12)
"""Places in `Spacing.rule`."""

WIDE, WIDEST = 0.85, 1.05
"""Diameters of dots, in hexagonal spacings, between which holes get narrower."""

MASS, PER_AREA, RADIUS = 0, 1, 2
"""Columns of `Spacing.wants` and `Spacing.found`."""

HEXAGONAL = 2.0 / math.sqrt(3.0)
"""Squared neighbour distance of the hexagonal grid with one dot a unit of area."""

_FAR = 1e-30


@inline
def ask(spacing: Spacing, i: int, c: int, area: float, mass: float) -> None:
    """Note what the dot of row i wants: how many dots its cell asks for, how dense, how large."""
    table = spacing.table
    per_area, radius = table[0, 0], table[0, 1]
    if len(table) > 1:
        at = min(max(mass / max(area, _FAR) * spacing.rule[SCALE], 0.0), len(table) - 1.0)
        k = min(int(at), len(table) - 2)
        t = at - k
        per_area += table[k, 0] - table[0, 0] + t * (table[k + 1, 0] - table[k, 0])
        radius = table[k, 1] + t * (table[k + 1, 1] - table[k, 1])
    if len(spacing.radius):
        own = spacing.radius[i]
        per_area *= (radius / own) * (radius / own)
        radius = own
    per_area *= spacing.unit[c]
    spacing.found[i, MASS] = area * per_area
    spacing.found[i, PER_AREA] = per_area
    spacing.found[i, RADIUS] = radius


@inline
def _by_side(
    rule: F8, d2: float, a: float, b: float, length: float, mu: float, mv: float, more: float,
    per_area: float, radii: float,
) -> tuple[float, float]:  # fmt: skip
    """Return push and level across a side with middle (mu, mv) from a dot at (a, b), d2 away."""
    d = math.sqrt(d2)
    h = math.sqrt(HEXAGONAL / per_area)
    wanted = min(max(rule[NEAR] * h, rule[BASE] * h + rule[SLOPE] * radii), rule[CAP] * h)
    push = 0.5 * max(wanted - d, 0.0) / d
    level = rule[LEVEL] * more * length / d
    return level * mu - push * a, level * mv - push * b


@inline
def _by_corner(rule: F8, u: float, v: float, per_area: float, radius: float) -> float:
    """Return how much of the way to a corner pull goes."""
    r = math.sqrt(u * u + v * v)
    h = math.sqrt(HEXAGONAL / per_area)
    wide = min(max(2.0 * radius / h - WIDE, 0.0), WIDEST - WIDE)
    largest = (rule[HOLE] - rule[NARROW] * wide) * h * (1.0 / math.sqrt(3.0))
    return float(rule[PULL] * max(r - largest, 0.0) / max(r, _FAR))


@inner
def rules_in_lanes(
    U: Any, V: Any, N: Any, first: int, m: int, i: int, x: float, y: float, dots: Dots,
    spacing: Spacing,
) -> tuple[float, float]:  # fmt: skip
    """Return the move that the rules want of a dot whose cell lies in lanes, no border near.

    The number of the dot beyond side k is ``N[first + k]``.
    """
    rule, wants = spacing.rule, spacing.wants
    own, e, radius = wants[i, MASS], wants[i, PER_AREA], wants[i, RADIUS]
    du = dv = 0.0
    j = get(N, first + m - 1)
    before = wants[j, PER_AREA] if j >= 0 else e
    for k in range(m):
        j = get(N, first + k)
        u, v = get(U, k), get(V, k)
        n = k + 1 if k + 1 < m else 0
        u1, v1 = get(U, n), get(V, n)
        eu, ev = u1 - u, v1 - v
        length = math.sqrt(eu * eu + ev * ev)
        more, there, r = 0.0, e, radius
        if j >= 0:
            a, b = dots.x[j] - x, dots.y[j] - y
            more, there, r = wants[j, MASS] - own, wants[j, PER_AREA], wants[j, RADIUS]
        else:
            t = 2.0 * (u * ev - v * eu) / max(length * length, _FAR)
            a, b = t * ev, -t * eu
        d2 = max(a * a + b * b, _FAR)
        su, sv = _by_side(
            rule, d2, a, b, length, 0.5 * (u + u1), 0.5 * (v + v1), more,
            max(0.5 * (e + there), _FAR), radius + r,
        )  # fmt: skip
        t = _by_corner(rule, u, v, max((e + before + there) / 3.0, _FAR), radius)
        du += su + t * u
        dv += sv + t * v
        before = there
    return du, dv


@inner
def rules_at_border(
    out: F8, n: int, i: int, x: float, y: float, dots: Dots, spacing: Spacing
) -> tuple[float, float]:
    """Return the move that the rules want of a dot, by its cell's outline (see `border`).

    A wall pushes as the dot's own image behind its nearest place would; it pulls into its farthest
    corner.
    """
    rule, wants = spacing.rule, spacing.wants
    own, e, radius = wants[i, MASS], wants[i, PER_AREA], wants[i, RADIUS]
    du = dv = 0.0
    near2, near_u, near_v, far2, far_u, far_v = math.inf, 0.0, 0.0, 0.0, 0.0, 0.0
    for s in range(n):
        u, v, u1, v1 = out[s, 0], out[s, 1], out[s, 2], out[s, 3]
        eu, ev = u1 - u, v1 - v
        length2 = eu * eu + ev * ev
        if out[s, 4] < 0.0:
            t = min(max(-(u * eu + v * ev) / max(length2, _FAR), 0.0), 1.0)
            a, b = u + t * eu, v + t * ev
            if a * a + b * b < near2:
                near2, near_u, near_v = a * a + b * b, a, b
            if u * u + v * v > far2:
                far2, far_u, far_v = u * u + v * v, u, v
            continue
        mu, mv = 0.5 * (u + u1), 0.5 * (v + v1)
        j = int(out[s, 4])
        there = wants[j, PER_AREA]
        a, b = dots.x[j] - x, dots.y[j] - y
        mean = max(0.5 * (e + there), _FAR)
        su, sv = _by_side(
            rule, max(a * a + b * b, _FAR), a, b, math.sqrt(length2), mu, mv,
            wants[j, MASS] - own, mean, radius + wants[j, RADIUS],
        )  # fmt: skip
        t0, t1 = _by_corner(rule, u, v, mean, radius), _by_corner(rule, u1, v1, mean, radius)
        du += su + 0.5 * (t0 * u + t1 * u1)
        dv += sv + 0.5 * (t0 * v + t1 * v1)
    e = max(e, _FAR)
    if 0.0 < near2 < math.inf:
        su, sv = _by_side(
            rule, 4.0 * near2, 2.0 * near_u, 2.0 * near_v, 0.0, 0.0, 0.0, 0.0, e, 2.0 * radius
        )
        t = _by_corner(rule, far_u, far_v, e, radius)
        du += su + t * far_u
        dv += sv + t * far_v
    return du, dv


@inline
def blend(
    spacing: Spacing, i: int, area: float, ink_u: float, ink_v: float, mid_u: float, mid_v: float,
    du: float, dv: float,
) -> tuple[float, float]:  # fmt: skip
    """Return the rules' move, held within half a spacing, and Lloyd's in its place on uneven ink.

    No less than `LEAST` of the move is Lloyd's.

    (ink_u, ink_v) is the centroid of the cell's ink, (mid_u, mid_v) that of the cell.
    """
    rule, e = spacing.rule, max(spacing.wants[i, PER_AREA], _FAR)
    s = math.sqrt(min(area, 1.0 / e))
    length = math.sqrt(du * du + dv * dv)
    if length > 0.5 * s:
        du *= 0.5 * s / length
        dv *= 0.5 * s / length
    off = math.hypot(ink_u - mid_u, ink_v - mid_v)
    w = min(max(rule[GAIN] * off / max(s, _FAR) - rule[LOW], rule[LEAST]), 1.0)
    return (1.0 - w) * du + w * ink_u, (1.0 - w) * dv + w * ink_v
