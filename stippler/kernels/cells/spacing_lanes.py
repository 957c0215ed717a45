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
    """Reads what the eight sides of a star from the k-th on have to do with.

    Whole rows are read and lanes chosen from them: a processor passes on what was stored just now
    only to a load of the same place and width.
    """

    def __init__(self, builder: Any, m: Any, k: int) -> None:
        self.builder, self.k = builder, k
        self.mask = simd._lanes_below(builder, builder.sub(m, simd._I8(k)), AT_ONCE)

    def splat(self, value: Any) -> Eight:
        return Eight(self.builder, simd._splat(self.builder, value, AT_ONCE))

    def lanes(self, row: Any, beyond: int) -> Any:
        chosen = [min(self.k + beyond + lane, simd.LANES - 1) for lane in range(AT_ONCE)]
        order = simd.ir.Constant(simd.ir.VectorType(simd._I4, AT_ONCE), chosen)
        undefined = simd.ir.Constant(row.type, simd.ir.Undefined)
        return self.builder.shuffle_vector(row, undefined, order)

    def numbers(self, row: Any, beyond: int) -> Eight:
        return Eight(self.builder, self.lanes(row, beyond))

    def gather(self, pointer: Any, numbers: Any, width: int = 1, column: int = 0) -> Eight:
        builder = self.builder
        if width > 1:
            kind = numbers.type
            numbers = builder.mul(numbers, simd.ir.Constant(kind, [width] * AT_ONCE))
            numbers = builder.add(numbers, simd.ir.Constant(kind, [column] * AT_ONCE))
        return Eight(builder, simd._gather(builder, pointer, numbers, self.mask))

    def one(self, pointer: Any, row: Any, width: int, column: int) -> Any:
        """Read what `gather` does, for the dot before these alone."""
        builder = self.builder
        number = builder.sext(builder.extract_element(row, simd._I4(self.k)), simd._I8)
        at = builder.add(builder.mul(number, simd._I8(width)), simd._I8(column))
        return builder.load(builder.gep(pointer, [at]))

    def shifted(self, numbers: Eight, first: Any) -> Eight:
        """Return numbers one lane on, another before them."""
        builder = self.builder
        order = simd.ir.Constant(simd.ir.VectorType(simd._I4, AT_ONCE), [0, *range(AT_ONCE - 1)])
        undefined = simd.ir.Constant(numbers.value.type, simd.ir.Undefined)
        moved = builder.shuffle_vector(numbers.value, undefined, order)
        return Eight(builder, builder.insert_element(moved, first, simd._I4(0)))


def _push(rule: list[Eight], d2: Eight, mean: Eight, radii: Eight) -> Any:
    """Return one over the distance, and by how much of it dots are pushed apart."""
    apart = d2.inverse_root()
    wanted = (rule[BASE] * mean + rule[SLOPE] * radii).at_least(rule[NEAR] * mean)
    wanted = wanted.at_most(rule[CAP] * mean)
    return apart, ((wanted * apart - 1.0) * 0.5).at_least(0.0)


def _pull(rule: list[Eight], r2: Eight, mean: Eight, radius: Eight) -> Eight:
    """Return how much of the way to a corner pull goes."""
    wide = (radius * 2.0 - mean * WIDE).at_least(0.0).at_most(mean * (WIDEST - WIDE))
    largest = (rule[HOLE] * mean - rule[NARROW] * wide) * (1.0 / math.sqrt(3.0))
    return (rule[PULL] - rule[PULL] * (largest * r2.at_least(FAR).inverse_root())).at_least(0.0)


@simd._operation
def moves_of_star(
    typing_context: Any, U: Any, V: Any, star: Any, i: Any, m: Any, x: Any, y: Any, mass: Any,
    h: Any, radius: Any, xs: Any, ys: Any, wants: Any, rule: Any,
) -> Any:  # fmt: skip
    """Return the move that the m sides of a cell want of the dot of row i, dots all around it.

    The dot lies at (x, y) and wants `mass`, `h` and `radius`. Corner k of (U, V) lies between the
    dots k and k + 1 of its row of `star`; the first corner follows once more behind the m, as does
    the first dot. Rows of `wants` and numbers of `rule` are as `spacing` has them.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        star_, xs_, ys_, wants_, rule_ = (
            simd._data(context, builder, signature.args[at], args[at]) for at in (2, 10, 11, 12, 13)
        )
        u16, v16 = (simd._load(builder, args[at], simd._I8(0), simd.LANES) for at in (0, 1))
        first = builder.mul(args[3], simd._I8(simd.LANES))
        dots = simd._load(builder, star_, first, simd.LANES)

        def moves(sides: _Sides) -> list[Any]:
            strict = [
                sides.splat(builder.load(builder.gep(rule_, [simd._I8(n)])))
                for n in range(PULL + 1)
            ]
            own_mass, own_h, own_radius = (sides.splat(args[at]) for at in (7, 8, 9))
            u, v, u1, v1 = (sides.numbers(row, n) for n in (0, 1) for row in (u16, v16))
            dot = sides.lanes(dots, 1)
            there = sides.gather(wants_, dot, 3, NEIGHBOUR)
            before = sides.shifted(there, sides.one(wants_, dots, 3, NEIGHBOUR))
            most = own_h * FARTHER
            there, before = there.at_most(most), before.at_most(most)
            a = sides.gather(xs_, dot) - sides.splat(args[5])
            b = sides.gather(ys_, dot) - sides.splat(args[6])
            radii = own_radius + sides.gather(wants_, dot, 3, RADIUS)
            d2 = (a * a + b * b).at_least(FAR)
            apart, push = _push(strict, d2, (own_h + there) * 0.5, radii)
            level = strict[LEVEL] * (sides.gather(wants_, dot, 3, MASS) - own_mass)
            level = level * (a * (v1 - v) - b * (u1 - u)) * (apart * apart) * 0.5
            mean = (own_h + before + there) * (1.0 / 3.0)
            pull = _pull(strict, u * u + v * v, mean, own_radius)
            both = (
                level * (u + u1) - push * a + pull * u,
                level * (v + v1) - push * b + pull * v,
            )
            return [move.only(sides.mask).total() for move in both]

        places = [simd.cgutils.alloca_once_value(builder, total)
                  for total in moves(_Sides(builder, args[4], 0))]  # fmt: skip
        has_more = builder.icmp_signed(">", args[4], simd._I8(AT_ONCE))
        with builder.if_then(has_more, likely=False):
            for place, total in zip(places, moves(_Sides(builder, args[4], AT_ONCE)), strict=True):
                builder.store(builder.fadd(builder.load(place), total), place)
        totals = [builder.load(place) for place in places]
        return context.make_tuple(builder, signature.return_type, totals)

    row, real = simd.types.int64, simd.types.float64
    return simd.types.UniTuple(real, 2)(
        U, V, star, row, row, real, real, real, real, real, xs, ys, wants, rule
    ), generate
