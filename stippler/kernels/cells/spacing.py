"""Three rules of even spacing, for one dot and its cell: push, pull and level.

*Push* parts dots nearer than they should be, *pull* draws dots to a hole larger than it should be,
*level* evens out the masses of neighbouring cells. Each wants nothing once it is met, so dots come
to rest in a packing without rows. Lloyd's steps never stop wanting and end in crystals.

The rules know what a clipped cell knows: its corners, its sides and the dots beyond. What the
other dots want (`Spacing.wants`: mass, distance of neighbours, radius) is that of the step before,
so a step passes over the cells once. Where the ink in a cell is uneven its dot belongs in the midst
of the ink, and goes there instead (`Spacing.rule`, see `stippler.stippling.spacing`).

Push and pull: Ahmed, Guo, Yan, Franceschi, Zhang, Deussen 2017; level: Balzer, Schloemer, Deussen
2009; de Goes, Breeden, Ostromoukhov, Desbrun 2012.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.kernels.cells.spacing_lanes import (
    BASE,
    CAP,
    FAR,
    FARTHER,
    GAIN,
    HOLE,
    LEAST,
    LEVEL,
    LOW,
    MASS,
    NARROW,
    NEAR,
    NEIGHBOUR,
    PULL,
    RADIUS,
    SLOPE,
    WIDE,
    WIDEST,
    moves_of_star,
)
from stippler.kernels.cells.tables import F8, I4, Dots, Spacing
from stippler.kernels.machine.jit import inline, inner
from stippler.kernels.machine.simd import get

FIRST, ROWS, SCALE, UNIT = range(4)
"""Columns of `Spacing.of_part`."""

HEXAGONAL = 2.0 / math.sqrt(3.0)
"""Squared neighbour distance of the hexagonal grid with one dot a unit of area."""


@inline
def ask(spacing: Spacing, i: int, c: int, area: float, mass: float) -> None:
    """Note what the dot of row i wants: how many dots its cell asks for, how far apart, how large.

    The distance is that of neighbours in the hexagonal grid of the density.
    """
    table, part = spacing.table, spacing.of_part
    first, rows = int(part[c, FIRST]), part[c, ROWS]
    per_area, radius = table[first, 0], table[first, 1]
    if rows > 1.0:
        at = min(max(mass / max(area, FAR) * part[c, SCALE], 0.0), rows - 1.0)
        k = int(min(at, rows - 2.0))
        t = at - k
        k += first
        per_area = table[k, 0] + t * (table[k + 1, 0] - table[k, 0])
        radius = table[k, 1] + t * (table[k + 1, 1] - table[k, 1])
    if len(spacing.radius):
        own = spacing.radius[i]
        per_area *= (radius / own) * (radius / own)
        radius = own
    per_area *= part[c, UNIT]
    spacing.found[i, MASS] = area * per_area
    spacing.found[i, NEIGHBOUR] = math.sqrt(HEXAGONAL / max(per_area, FAR))
    spacing.found[i, RADIUS] = radius


@inline
def _push(rule: F8, d2: float, h: float, radii: float) -> float:
    """Return by how much of the distance, whose square is d2, dots are pushed apart."""
    wanted = min(max(rule[NEAR] * h, rule[BASE] * h + rule[SLOPE] * radii), rule[CAP] * h)
    if d2 >= wanted * wanted:
        return 0.0
    return float(0.5 * (wanted / math.sqrt(d2) - 1.0))


@inline
def _pull(rule: F8, u: float, v: float, h: float, radius: float) -> float:
    """Return how much of the way to a corner pull goes."""
    wide = min(max(2.0 * radius - WIDE * h, 0.0), (WIDEST - WIDE) * h)
    largest = (rule[HOLE] * h - rule[NARROW] * wide) * (1.0 / math.sqrt(3.0))
    r2 = u * u + v * v
    if r2 <= largest * largest:
        return 0.0
    return float(rule[PULL] * (1.0 - largest / math.sqrt(r2)))


@inner
def rules_in_lanes(
    U: Any, V: Any, N: Any, first: int, m: int, i: int, x: float, y: float, dots: Dots,
    spacing: Spacing,
) -> tuple[float, float]:  # fmt: skip
    """Return the move that the rules want of a dot whose cell lies in lanes, no border near.

    The number of the dot beyond side k is ``N[first + k]``. A side of length L between dots d
    apart has ``L d = a e_v - b e_u``, with (a, b) the way to the dot beyond.
    """
    rule, wants = spacing.rule, spacing.wants
    own, h, radius = wants[i, MASS], wants[i, NEIGHBOUR], wants[i, RADIUS]
    most = FARTHER * h
    du = dv = 0.0
    j = get(N, first + m - 1)
    before = min(wants[j, NEIGHBOUR], most) if j >= 0 else h
    u, v = get(U, 0), get(V, 0)
    for k in range(m):
        j = get(N, first + k)
        n = k + 1 if k + 1 < m else 0
        u1, v1 = get(U, n), get(V, n)
        eu, ev = u1 - u, v1 - v
        there = h
        if j >= 0:
            there = min(wants[j, NEIGHBOUR], most)
            a, b = dots.x[j] - x, dots.y[j] - y
            d2 = max(a * a + b * b, FAR)
            push = _push(rule, d2, 0.5 * (h + there), radius + wants[j, RADIUS])
            level = rule[LEVEL] * (wants[j, MASS] - own) * (a * ev - b * eu) / d2
            du += level * 0.5 * (u + u1) - push * a
            dv += level * 0.5 * (v + v1) - push * b
        else:
            t = 2.0 * (u * ev - v * eu) / max(eu * eu + ev * ev, FAR)
            a, b = t * ev, -t * eu
            push = _push(rule, max(a * a + b * b, FAR), h, 2.0 * radius)
            du -= push * a
            dv -= push * b
        t = _pull(rule, u, v, (h + before + there) * (1.0 / 3.0), radius)
        du += t * u
        dv += t * v
        before, u, v = there, u1, v1
    return du, dv


@inline
def rules_of_star(
    U: Any, V: Any, star: I4, m: int, i: int, dots: Dots, spacing: Spacing
) -> tuple[float, float]:
    """Return what `rules_in_lanes` does for a dot that dots surround on all sides, by its star."""
    mass, h, radius = spacing.wants[i, MASS], spacing.wants[i, NEIGHBOUR], spacing.wants[i, RADIUS]
    du, dv = moves_of_star(
        U, V, star, i, m, dots.x[i], dots.y[i], mass, h, radius, dots.x, dots.y, spacing.wants,
        spacing.rule,
    )  # fmt: skip
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
    own, h, radius = wants[i, MASS], wants[i, NEIGHBOUR], wants[i, RADIUS]
    du = dv = 0.0
    near2, near_u, near_v, far2, far_u, far_v = math.inf, 0.0, 0.0, 0.0, 0.0, 0.0
    for s in range(n):
        u, v, u1, v1 = out[s, 0], out[s, 1], out[s, 2], out[s, 3]
        eu, ev = u1 - u, v1 - v
        if out[s, 4] < 0.0:
            t = -(u * eu + v * ev) / max(eu * eu + ev * ev, FAR)
            t = min(max(t, 0.0), 1.0)
            a, b = u + t * eu, v + t * ev
            if a * a + b * b < near2:
                near2, near_u, near_v = a * a + b * b, a, b
            if u * u + v * v > far2:
                far2, far_u, far_v = u * u + v * v, u, v
            continue
        j = int(out[s, 4])
        mean = 0.5 * (h + min(wants[j, NEIGHBOUR], FARTHER * h))
        a, b = dots.x[j] - x, dots.y[j] - y
        d2 = max(a * a + b * b, FAR)
        push = _push(rule, d2, mean, radius + wants[j, RADIUS])
        level = rule[LEVEL] * (wants[j, MASS] - own) * (a * ev - b * eu) / d2
        t0, t1 = _pull(rule, u, v, mean, radius), _pull(rule, u1, v1, mean, radius)
        du += level * 0.5 * (u + u1) - push * a + 0.5 * (t0 * u + t1 * u1)
        dv += level * 0.5 * (v + v1) - push * b + 0.5 * (t0 * v + t1 * v1)
    if 0.0 < near2 < math.inf:
        push = _push(rule, 4.0 * near2, h, 2.0 * radius)
        t = _pull(rule, far_u, far_v, h, radius)
        du += t * far_u - push * 2.0 * near_u
        dv += t * far_v - push * 2.0 * near_v
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
    rule, h = spacing.rule, spacing.wants[i, NEIGHBOUR]
    s2 = min(area, h * h * (1.0 / HEXAGONAL))
    length2 = du * du + dv * dv
    if length2 > 0.25 * s2:
        shorter = 0.5 * math.sqrt(s2 / length2)
        du *= shorter
        dv *= shorter
    au, av = ink_u - mid_u, ink_v - mid_v
    off2 = au * au + av * av
    off = math.sqrt(off2 / max(s2, FAR * FAR)) if off2 > 0.0 else 0.0
    w = min(max(rule[GAIN] * off - rule[LOW], rule[LEAST]), 1.0)
    return (1.0 - w) * du + w * ink_u, (1.0 - w) * dv + w * ink_v
