"""Eight sides of a cell walked through a field at once (see `field`), each in a lane of its own.

Written as LLVM operations, since compilers find no vectors in the plain form. A side that has come
to its end waits for the longest: what it adds by then has no height. There is no branch but at the
end of the loop, which is met once for all sides.
"""

from __future__ import annotations

from typing import Any

from stippler.kernels.machine import simd
from stippler.kernels.machine.eight import AT_ONCE, Eight, Variable

LONG = 128
"""Columns from which on a side is left to be looked at row by row: much of it may lie on white."""

_SIDE = 6
"""Numbers that a side has in an outline, see `border`."""

_FLAT = 1e-200
"""Height in pixels below which an edge counts for nothing: its slope is no number."""


class _Sums:
    """Reads running sums by the addresses of their pairs."""

    def __init__(self, builder: Any) -> None:
        self.builder = builder
        self.whole = simd.ir.VectorType(simd._I8, AT_ONCE)
        self._all = simd.ir.Constant(simd.ir.VectorType(simd.ir.IntType(1), AT_ONCE), [1] * AT_ONCE)

    def pairs(self, numbers: Eight) -> Any:
        """Return how many bytes so many pairs take; numbers are whole."""
        kind = simd.ir.VectorType(simd._I4, AT_ONCE)
        short = self.builder.fptosi(numbers.value, kind)
        return self.builder.shl(self.builder.sext(short, self.whole), self._eight(4))

    def at(self, addresses: Any, place: int) -> Eight:
        """Return the first or the second number of pairs."""
        there = self.builder.add(addresses, self._eight(8 * place))
        return Eight(self.builder, simd._gather_at(self.builder, there, self._all))

    def _eight(self, value: int) -> Any:
        return simd.ir.Constant(self.whole, [value] * AT_ONCE)


def _walked(builder: Any, ends: list[Eight], field: Any, scalars: Any) -> tuple[Any, ...]:
    """Walk eight sides with these ends: u0, v0, u1, v1; see `walk_sides` for the rest."""
    ku_, kv_, start_, h_, w_, x_, y_ = scalars

    def splat(value: Any) -> Eight:
        return Eight(builder, simd._splat(builder, value, AT_ONCE))

    def whole(value: Any) -> Eight:
        return splat(builder.sitofp(value, simd._F8))

    scale = splat(ku_), splat(kv_)
    ax, ay, bx, by = (end * scale[k % 2] for k, end in enumerate(ends))
    x, y, width = splat(x_), splat(y_), whole(w_)
    zero = Eight(builder, simd.ir.Constant(x.value.type, [0.0] * AT_ONCE))
    is_up = ay.above(by)
    ax, ay, bx, by = (
        bx.where(is_up, ax), by.where(is_up, ay), ax.where(is_up, bx), ay.where(is_up, by)
    )  # fmt: skip
    va, vb = ay.at_least(zero - y), by.at_most(whole(h_) - y)
    has_height = (vb - va).above(_FLAT)
    slope = (bx - ax) / (by - ay).where(has_height, 1.0)
    ua = ax.where(builder.not_(va.above(ay)), ax + (va - ay) * slope)
    ub = bx.where(builder.not_(by.above(vb)), ax + (vb - ay) * slope)
    is_short = (zero + LONG).above((ub - ua).size())
    is_long = builder.and_(has_height, builder.not_(is_short))
    taken = builder.and_(has_height, is_short)
    va, ua, ub, slope = va.only(taken), ua.only(taken), ub.only(taken), slope.only(taken)
    vb = vb.where(taken, va)

    column, last = (x + ua).floor(), (x + ub).floor()
    last_row = (zero - (zero - (y + vb)).floor() - 1.0).at_most(whole(h_) - 1.0).at_least(0.0)
    row_number = (y + va).floor().at_least(0.0).at_most(last_row)
    n_steps = last_row - row_number + (last - column).size() + 1.0
    goes_left = ua.above(ub)
    step = (zero - 1.0).where(goes_left, 1.0)
    crosses = builder.not_(builder.fcmp_ordered("==", column.value, last.value))
    d_column = (vb - va) / (ub - ua).size().where(crosses, 1.0)
    to_border = ((column - x) + (zero).where(goes_left, 1.0) - ua) * step
    v_column = (va + to_border.at_least(0.0) * d_column).where(crosses, float("inf"))
    d_column = d_column.only(crosses)
    v_row = (row_number + 1.0 - y).where(taken, float("inf"))
    lowest = last_row + 0.5 - y

    read = _Sums(builder)
    stride = builder.shl(builder.add(w_, simd._I8(1)), simd._I8(4))
    stride = simd._splat(builder, stride, AT_ONCE)
    rows = builder.fptosi(row_number.value, read.whole)
    begin = builder.add(builder.ptrtoint(field, simd._I8), builder.shl(start_, simd._I8(4)))
    rows = builder.add(simd._splat(builder, begin, AT_ONCE), builder.mul(rows, stride))
    base = read.pairs(x.floor().at_least(0.0).at_most(width))

    names = [Variable(builder, e.value) for e in (
        ua, va, column, v_column, v_row, zero, zero, zero
    )]  # fmt: skip
    at_row = Variable(builder, rows)
    count = builder.fptosi(n_steps.only(taken).largest(), simd._I8)
    with simd.cgutils.for_range(builder, count):
        u, v, c, v_col, v_row, m, mx, my = (Eight(builder, one.get()) for one in names)
        here = at_row.get()
        v1 = v_col.at_most(v_row).at_most(vb)
        u1 = ua + (v1 - va) * slope
        left = builder.add(here, read.pairs(c.at_least(0.0).at_most(width)))
        right = builder.add(here, read.pairs((c + 1.0).at_least(0.0).at_most(width)))
        zeroth = builder.add(here, base)
        g = read.at(left, 0)
        f = (read.at(right, 0) - g) * 0.5
        g = g - read.at(zeroth, 0)
        q = read.at(left, 1) - read.at(zeroth, 1) - x * g
        p = c - x
        a, b, dv = u - p, u1 - p, v1 - v
        s = a + b
        m = m + (g + f * s) * dv
        mx = mx + (q + f * ((a * s + b * b) * (1.0 / 3.0) + p * s)) * dv
        vs = v + v1
        my = my + (g * 0.5 * vs + f * ((s * vs + a * v + b * v1) * (1.0 / 3.0))) * dv
        is_row = v_col.above(v_row)
        goes_on = builder.and_(is_row, lowest.above(v_row))
        none = simd.ir.Constant(read.whole, [0] * AT_ONCE)
        at_row.set(builder.add(here, builder.select(goes_on, stride, none)))
        c = c + zero.where(is_row, step)
        v_col = v_col + zero.where(is_row, d_column)
        v_row = v_row + (zero + 1.0).only(is_row)
        for one, value in zip(names, (u1, v1, c, v_col, v_row, m, mx, my), strict=True):
            one.set(value.value)
    m, mx, my = (Eight(builder, one.get()) for one in names[5:])
    signs = (zero - 1.0).where(is_up, 1.0)
    totals = [(one * signs).total() for one in (m, mx, my)] + [m.size().total()]
    return (*totals, simd._mask_bits(builder, is_long, AT_ONCE))


@simd._operation
def walk_sides(
    typing_context: Any, out: Any, first: Any, n: Any, ku: Any, kv: Any, sums: Any, start: Any,
    h: Any, w: Any, x: Any, y: Any,
) -> Any:  # fmt: skip
    """Return what sides first .. first + 7 of n give of mass and both its moments about (x, y).

    Sides are the rows of `out`, lengths of which times (ku, kv) are pixels. The window's sums begin
    with pair `start`, it has h rows, one at least, and w columns; outside it f is 0.

    Returns
    -------
    m, mx, my, gross
        Sums over the sides, in pixels, and that of masses without their signs.
    long
        Bits for the sides that were left out, for they go over `LONG` columns or more.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        out_, first_, n_, ku_, kv_, sums_, start_, h_, w_, x_, y_ = args
        outline = simd._data(context, builder, signature.args[0], out_)
        field = simd._data(context, builder, signature.args[5], sums_)

        mask = simd._lanes_below(builder, builder.sub(n_, first_), AT_ONCE)
        row = simd._splat(builder, builder.trunc(first_, simd._I4), AT_ONCE)
        row = builder.add(row, simd._lane_numbers(AT_ONCE))
        at = builder.mul(row, simd.ir.Constant(row.type, [_SIDE] * AT_ONCE))
        ends = [
            Eight(builder, simd._gather(
                builder, outline, builder.add(at, simd.ir.Constant(row.type, [k] * AT_ONCE)), mask
            ))
            for k in range(4)
        ]  # fmt: skip
        scalars = ku_, kv_, start_, h_, w_, x_, y_
        totals = _walked(builder, ends, field, scalars)
        return context.make_tuple(builder, signature.return_type, totals)

    whole, real = simd.types.int64, simd.types.float64
    result = simd.types.Tuple((real, real, real, real, whole))
    return result(out, whole, whole, real, real, sums, whole, whole, whole, real, real), generate


@simd._operation
def walk_lanes(
    typing_context: Any, U: Any, V: Any, m: Any, ku: Any, kv: Any, sums: Any, start: Any, h: Any,
    w: Any, x: Any, y: Any,
) -> Any:  # fmt: skip
    """Return what `walk_sides` does for the first eight sides of a cell of m corners in lanes.

    The first corner follows once more behind the m.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        U_, V_, m_, ku_, kv_, sums_, start_, h_, w_, x_, y_ = args
        field = simd._data(context, builder, signature.args[5], sums_)
        mask = simd._lanes_below(builder, m_, AT_ONCE)
        ends = []
        for beyond in (0, 1):
            lanes = list(range(beyond, beyond + AT_ONCE))
            order = simd.ir.Constant(simd.ir.VectorType(simd._I4, AT_ONCE), lanes)
            for row in (U_, V_):
                all_of_it = simd._load(builder, row, simd._I8(0), simd.LANES)
                undefined = simd.ir.Constant(all_of_it.type, simd.ir.Undefined)
                chosen = builder.shuffle_vector(all_of_it, undefined, order)
                ends.append(Eight(builder, chosen).only(mask))
        scalars = ku_, kv_, start_, h_, w_, x_, y_
        totals = _walked(builder, ends, field, scalars)
        return context.make_tuple(builder, signature.return_type, totals)

    whole, real = simd.types.int64, simd.types.float64
    result = simd.types.Tuple((real, real, real, real, whole))
    return result(U, V, whole, real, real, sums, whole, whole, whole, real, real), generate
