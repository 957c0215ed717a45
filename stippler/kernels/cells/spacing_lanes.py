"""The rules of even spacing (see `spacing`) for eight sides of a kept cell at once.

Written as LLVM operations, since compilers find no vectors in the plain form. There are no branches
in it: which dots are too near, and which holes too large, no processor foretells.
"""

from __future__ import annotations

import math
from typing import Any

from stippler.kernels.machine import simd
from stippler.kernels.machine.eight import AT_ONCE, Eight

NEAR, BASE, SLOPE, CAP, HOLE, NARROW, LEVEL, PULL, GAIN, LOW, LEAST = range(11)
"""Places in `Spacing.rule`."""

MASS, NEIGHBOUR, RADIUS = 0, 1, 2
"""Columns of `Spacing.wants` and `Spacing.found`."""

WIDE, WIDEST = 0.85, 1.05
"""Diameters of dots, in hexagonal spacings, between which holes get narrower."""

FAR = 1e-30
FARTHER = 1.6
"""A neighbour's own spacing counts for no more than so much of a dot's."""


class _Sides:
    """Reads what eight sides from the k-th on have to do with."""

    def __init__(self, builder: Any, m: Any, k: Any) -> None:
        self.builder, self.k = builder, k
        self.mask = simd._lanes_below(builder, builder.sub(m, k), AT_ONCE)

    def splat(self, value: Any) -> Eight:
        return Eight(self.builder, simd._splat(self.builder, value, AT_ONCE))

    def load(self, pointer: Any, beyond: int = 0) -> Eight:
        at = self.builder.add(self.k, simd._I8(beyond))
        return Eight(self.builder, simd._load(self.builder, pointer, at, AT_ONCE))

    def numbers(self, pointer: Any, beyond: int) -> Any:
        at = self.builder.add(self.k, simd._I8(beyond))
        return simd._load(self.builder, pointer, at, AT_ONCE)

    def gather(self, pointer: Any, numbers: Any, width: int = 1, column: int = 0) -> Eight:
        builder = self.builder
        if width > 1:
            kind = numbers.type
            numbers = builder.mul(numbers, simd.ir.Constant(kind, [width] * AT_ONCE))
            numbers = builder.add(numbers, simd.ir.Constant(kind, [column] * AT_ONCE))
        return Eight(builder, simd._gather(builder, pointer, numbers, self.mask))


def _push(rule: list[Eight], d2: Eight, mean: Eight, radii: Eight) -> Any:
    """Return one over the distance, and by how much of it dots are pushed apart."""
    apart = d2.root().inverse()
    wanted = (rule[BASE] * mean + rule[SLOPE] * radii).at_least(rule[NEAR] * mean)
    wanted = wanted.at_most(rule[CAP] * mean)
    return apart, ((wanted * apart - 1.0) * 0.5).at_least(0.0)


def _pull(rule: list[Eight], r2: Eight, mean: Eight, radius: Eight) -> Eight:
    """Return how much of the way to a corner pull goes."""
    wide = (radius * 2.0 - mean * WIDE).at_least(0.0).at_most(mean * (WIDEST - WIDE))
    largest = (rule[HOLE] * mean - rule[NARROW] * wide) * (1.0 / math.sqrt(3.0))
    return (rule[PULL] - rule[PULL] * (largest / r2.at_least(FAR).root())).at_least(0.0)


@simd._operation
def rules_of_sides(
    typing_context: Any, U: Any, V: Any, N: Any, k: Any, m: Any, x: Any, y: Any, mass: Any, h: Any,
    radius: Any, xs: Any, ys: Any, wants: Any, rule: Any, out: Any,
) -> Any:  # fmt: skip
    """Add the moves that sides k .. k + 7 of m want of a dot to ``out[0]`` and ``out[1]``.

    The dot lies at (x, y) and wants `mass`, `h` and `radius`. Beyond side k lies the dot
    ``N[k + 1]``; the first corner follows once more behind the m, as do the first two numbers. Rows
    of `wants` and numbers of `rule` are as `spacing` has them.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        arrays = [
            simd._data(context, builder, signature.args[at], args[at]) for at in range(10, 14)
        ]
        xs_, ys_, wants_, rule_ = arrays
        sides = _Sides(builder, args[4], args[3])
        strict = [
            sides.splat(builder.load(builder.gep(rule_, [simd._I8(n)]))) for n in range(PULL + 1)
        ]
        own_mass, own_h, own_radius = (sides.splat(args[at]) for at in (7, 8, 9))
        u, v, u1, v1 = (sides.load(args[at], n) for n in (0, 1) for at in (0, 1))
        one_before, dot = sides.numbers(args[2], 0), sides.numbers(args[2], 1)
        most = own_h * FARTHER
        before = sides.gather(wants_, one_before, 3, NEIGHBOUR).at_most(most)
        there = sides.gather(wants_, dot, 3, NEIGHBOUR).at_most(most)
        a = sides.gather(xs_, dot) - sides.splat(args[5])
        b = sides.gather(ys_, dot) - sides.splat(args[6])
        radii = own_radius + sides.gather(wants_, dot, 3, RADIUS)
        d2 = (a * a + b * b).at_least(FAR)
        apart, push = _push(strict, d2, (own_h + there) * 0.5, radii)
        level = strict[LEVEL] * (sides.gather(wants_, dot, 3, MASS) - own_mass)
        level = level * (a * (v1 - v) - b * (u1 - u)) * (apart * apart) * 0.5
        mean = (own_h + before + there) * (1.0 / 3.0)
        pull = _pull(strict, u * u + v * v, mean, own_radius)
        moves = (
            level * (u + u1) - push * a + pull * u,
            level * (v + v1) - push * b + pull * v,
        )
        for n, move in enumerate(moves):
            place = builder.gep(args[14], [simd._I8(n)])
            total = move.only(sides.mask).total()
            builder.store(builder.fadd(builder.load(place), total), place)
        return context.get_dummy_value()

    row, real = simd.types.int64, simd.types.float64
    return simd.types.void(
        U, V, N, row, row, real, real, real, real, real, xs, ys, wants, rule, out
    ), generate
