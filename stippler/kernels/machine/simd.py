"""Vector instructions for the inner loops of cells, written as LLVM operations.

A cell of up to `LANES` corners is one row of vector lanes, so a bisector is tested against all
corners at once, without a branch. LLVM lowers the same operations to AVX-512, AVX2, SSE or NEON.
Sums over lanes are added as a tree in a fixed order.

A *cell buffer* is a pointer to ``BUFFER`` numbers on the stack: corners 0..m - 1, followed by the
same m corners again, so that a run around the end can be read in one piece. A row of corners has,
`FRONT` numbers further on, a second copy of the first `LANES` for tests against all corners: a
processor passes a value from store to load without delay only where one store wrote all of it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from stippler.kernels.machine.jit import Operation

LANES = 16
"""Corners a cell may have here."""

FRONT, BUFFER = 3 * LANES, 4 * LANES

SCAN = 8
"""Dots that `near_mask` tests at once; arrays need this many numbers of padding."""

_FAST = ("contract",)

ir: Any
cgutils: Any
types: Any
_F8: Any
_I4: Any
_I8: Any


def _import_llvm() -> None:
    """Import what operations are written in: when numba compiles the first, and not before."""
    global ir, cgutils, types, _F8, _I4, _I8
    from llvmlite import ir
    from numba.core import cgutils, types

    _F8, _I4, _I8 = ir.DoubleType(), ir.IntType(32), ir.IntType(64)


def _operation(generator: Callable[..., Any]) -> Any:
    """Make a kernels' function of one that returns a signature and a generator of LLVM code."""
    return Operation(generator, _import_llvm)


def _literal_operation(generator: Callable[..., Any]) -> Any:
    return Operation(generator, _import_llvm, prefer_literal=True)


def _splat(builder: Any, value: Any, lanes: int) -> Any:
    vector = ir.VectorType(value.type, lanes)
    one = builder.insert_element(ir.Constant(vector, ir.Undefined), value, _I4(0))
    zeros = ir.Constant(ir.VectorType(_I4, lanes), [0] * lanes)
    return builder.shuffle_vector(one, ir.Constant(vector, ir.Undefined), zeros)


def _load(builder: Any, pointer: Any, index: Any, lanes: int) -> Any:
    element = pointer.type.pointee
    there = builder.gep(pointer, [index])
    wide = builder.bitcast(there, ir.VectorType(element, lanes).as_pointer())
    return builder.load(wide, align=element.width // 8 if isinstance(element, ir.IntType) else 8)


def _store(builder: Any, vector: Any, pointer: Any, index: Any) -> None:
    element = pointer.type.pointee
    there = builder.gep(pointer, [index])
    wide = builder.bitcast(there, vector.type.as_pointer())
    builder.store(vector, wide, align=element.width // 8 if isinstance(element, ir.IntType) else 8)


def _lane_numbers(lanes: int) -> Any:
    return ir.Constant(ir.VectorType(_I4, lanes), list(range(lanes)))


def _lanes_below(builder: Any, m: Any, lanes: int) -> Any:
    limit = _splat(builder, builder.trunc(m, _I4), lanes)
    return builder.icmp_signed("<", _lane_numbers(lanes), limit)


def _next_lane(builder: Any, vector: Any) -> Any:
    """Return the vector with lane k + 1 in lane k; the last lane has no meaning."""
    lanes = vector.type.count
    order = ir.Constant(ir.VectorType(_I4, lanes), [*range(1, lanes), lanes - 1])
    return builder.shuffle_vector(vector, ir.Constant(vector.type, ir.Undefined), order)


def _tree(builder: Any, vector: Any, combine: Callable[[Any, Any], Any]) -> Any:
    lanes = vector.type.count
    while lanes > 1:
        lanes //= 2
        low = ir.Constant(ir.VectorType(_I4, lanes), list(range(lanes)))
        high = ir.Constant(ir.VectorType(_I4, lanes), list(range(lanes, 2 * lanes)))
        undefined = ir.Constant(vector.type, ir.Undefined)
        vector = combine(
            builder.shuffle_vector(vector, undefined, low),
            builder.shuffle_vector(vector, undefined, high),
        )
    return builder.extract_element(vector, _I4(0))


def _mask_bits(builder: Any, mask: Any, lanes: int) -> Any:
    return builder.zext(builder.bitcast(mask, ir.IntType(lanes)), _I8)


def _mul(builder: Any, a: Any, b: Any) -> Any:
    return builder.fmul(a, b, flags=_FAST)


def _add(builder: Any, a: Any, b: Any) -> Any:
    return builder.fadd(a, b, flags=_FAST)


def _sub(builder: Any, a: Any, b: Any) -> Any:
    return builder.fsub(a, b, flags=_FAST)


def _larger(builder: Any, a: Any, b: Any) -> Any:
    return builder.select(builder.fcmp_ordered(">", a, b), a, b)


def _data(context: Any, builder: Any, array_type: Any, array: Any) -> Any:
    return cgutils.create_struct_proxy(array_type)(context, builder, value=array).data


@_literal_operation
def stack_doubles(typing_context: Any, n: Any) -> Any:
    """Return a pointer to n doubles on the stack, n a literal."""
    size = n.literal_value

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        buffer = cgutils.alloca_once(builder, _F8, size=size)
        buffer.align = 64
        return buffer

    return types.CPointer(types.float64)(n), generate


@_literal_operation
def stack_ints(typing_context: Any, n: Any) -> Any:
    """Return a pointer to n 32-bit integers on the stack, n a literal."""
    size = n.literal_value

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        buffer = cgutils.alloca_once(builder, _I4, size=size)
        buffer.align = 64
        return buffer

    return types.CPointer(types.int32)(n), generate


@_operation
def data_of(typing_context: Any, array: Any) -> Any:
    """Return a pointer to an array's first number; indices from there on are not checked."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return _data(context, builder, signature.args[0], args[0])

    return types.CPointer(array.dtype)(array), generate


@_operation
def get(typing_context: Any, pointer: Any, index: Any) -> Any:
    """Return ``pointer[index]``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.load(builder.gep(args[0], [args[1]]))

    return pointer.dtype(pointer, types.int64), generate


@_operation
def put(typing_context: Any, pointer: Any, index: Any, value: Any) -> Any:
    """Set ``pointer[index]``."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        builder.store(args[2], builder.gep(args[0], [args[1]]))
        return context.get_dummy_value()

    return types.void(pointer, types.int64, pointer.dtype), generate


@_operation
def lowest_bit(typing_context: Any, bits: Any) -> Any:
    """Return the number of the lowest bit set, 64 if none is."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        return builder.cttz(args[0], ir.Constant(ir.IntType(1), 0))

    return types.int64(types.int64), generate


@_operation
def near_mask(
    typing_context: Any, xs: Any, ys: Any, j: Any, x: Any, y: Any, least: Any, limit: Any
) -> Any:
    """Return bits for the dots j..j + SCAN - 1 with ``least <= distance² < limit`` from (x, y)."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        px = _data(context, builder, signature.args[0], args[0])
        py = _data(context, builder, signature.args[1], args[1])
        dx = _sub(builder, _load(builder, px, args[2], SCAN), _splat(builder, args[3], SCAN))
        dy = _sub(builder, _load(builder, py, args[2], SCAN), _splat(builder, args[4], SCAN))
        d2 = _add(builder, _mul(builder, dx, dx), _mul(builder, dy, dy))
        apart = builder.fcmp_ordered(">=", d2, _splat(builder, args[5], SCAN))
        near = builder.fcmp_ordered("<", d2, _splat(builder, args[6], SCAN))
        return _mask_bits(builder, builder.and_(near, apart), SCAN)

    real = types.float64
    return types.int64(xs, ys, types.int64, real, real, real, real), generate


@_operation
def out_mask(typing_context: Any, us: Any, vs: Any, a: Any, b: Any, limit: Any) -> Any:
    """Return bits for the corners with ``a u + b v > limit``, lanes beyond the cell included."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        u = _load(builder, args[0], _I8(FRONT), LANES)
        v = _load(builder, args[1], _I8(FRONT), LANES)
        s = _add(
            builder,
            _mul(builder, u, _splat(builder, args[2], LANES)),
            _mul(builder, v, _splat(builder, args[3], LANES)),
        )
        out = builder.fcmp_ordered(">", s, _splat(builder, args[4], LANES))
        return _mask_bits(builder, out, LANES)

    real = types.float64
    return types.int64(us, vs, real, real, real), generate


@_operation
def holds(typing_context: Any, numbers: Any, m: Any, number: Any) -> Any:
    """Return whether a number is among the first m, no more than `LANES`, of a cell buffer."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        row = _load(builder, args[0], _I8(0), LANES)
        wanted = _splat(builder, builder.trunc(args[2], _I4), LANES)
        same = builder.icmp_signed("==", row, wanted)
        same = builder.and_(same, _lanes_below(builder, args[1], LANES))
        bits = _mask_bits(builder, same, LANES)
        return builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))

    return types.boolean(numbers, types.int64, types.int64), generate


@_operation
def roll(typing_context: Any, row: Any, first: Any, kept: Any, p: Any, q: Any) -> Any:
    """Keep `kept` entries of a cell buffer from `first` on and put p and q behind them."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        row_, first_, kept_, p_, q_ = args
        vector = _load(builder, row_, first_, LANES)
        number = _splat(builder, builder.trunc(kept_, _I4), LANES)
        lane = _lane_numbers(LANES)
        ones = ir.Constant(lane.type, [1] * LANES)
        at_p = builder.icmp_signed("==", lane, number)
        at_q = builder.icmp_signed("==", lane, builder.add(number, ones))
        vector = builder.select(at_p, _splat(builder, p_, LANES), vector)
        vector = builder.select(at_q, _splat(builder, q_, LANES), vector)
        _store(builder, vector, row_, _I8(0))
        _store(builder, vector, row_, builder.add(kept_, _I8(2)))
        if row.dtype == types.float64:
            _store(builder, vector, row_, _I8(FRONT))
        return context.get_dummy_value()

    return types.void(row, types.int64, types.int64, row.dtype, row.dtype), generate


@_operation
def reach2_of(typing_context: Any, us: Any, vs: Any, m: Any) -> Any:
    """Return the largest squared distance of the m corners from the dot."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        u = _load(builder, args[0], _I8(FRONT), LANES)
        v = _load(builder, args[1], _I8(FRONT), LANES)
        d2 = _add(builder, _mul(builder, u, u), _mul(builder, v, v))
        zero = ir.Constant(d2.type, [0.0] * LANES)
        d2 = builder.select(_lanes_below(builder, args[2], LANES), d2, zero)

        return _tree(builder, d2, partial(_larger, builder))

    return types.float64(us, vs, types.int64), generate


@_operation
def may_cut_from_box(
    typing_context: Any, us: Any, vs: Any, at: Any, m: Any, x0: Any, y0: Any, x1: Any, y1: Any
) -> Any:
    """Return whether a box reaches into the circle about a corner through the dot, or nearly.

    Asked are the m corners from `at` on, no more than `LANES`. Only a dot within one of these
    circles can cut a corner away.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        u = _load(builder, args[0], args[2], LANES)
        v = _load(builder, args[1], args[2], LANES)
        zero = ir.Constant(u.type, [0.0] * LANES)
        d2 = zero
        for corner, low, high in ((u, args[4], args[6]), (v, args[5], args[7])):
            d = _larger(builder, _sub(builder, _splat(builder, low, LANES), corner), zero)
            d = _larger(builder, _sub(builder, corner, _splat(builder, high, LANES)), d)
            d2 = _add(builder, d2, _mul(builder, d, d))
        radius2 = _add(builder, _mul(builder, u, u), _mul(builder, v, v))
        radius2 = _mul(builder, radius2, ir.Constant(u.type, [1.0 + 1e-9] * LANES))
        near = builder.fcmp_ordered("<=", d2, radius2)
        near = builder.and_(near, _lanes_below(builder, args[3], LANES))
        bits = _mask_bits(builder, near, LANES)
        return builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))

    real, whole = types.float64, types.int64
    return types.boolean(us, vs, whole, whole, real, real, real, real), generate


@_operation
def may_cut_from_arc(
    typing_context: Any, us: Any, vs: Any, at: Any, m: Any, x: Any, y: Any, arc: Any, row: Any,
    slack: Any,
) -> Any:  # fmt: skip
    """Return whether dots along an arc may lie in the circle about a corner through the dot.

    Asked are the m corners from `at` on, no more than `LANES`. `arc` is a table of what
    `crowd_arcs` tells of dots, by row; (x, y) is the arc's middle seen from the dot. A dot counts
    as outside from `slack` times the corner's distance on.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = _data(context, builder, signature.args[6], args[6])
        first = builder.mul(args[7], _I8(8))
        row_ = [builder.load(builder.gep(data, [builder.add(first, _I8(k))])) for k in range(2, 8)]
        tx, ty, ratio, ax, ay, least = (_splat(builder, number, LANES) for number in row_)
        x_, y_ = _splat(builder, args[4], LANES), _splat(builder, args[5], LANES)
        u = _load(builder, args[0], args[2], LANES)
        v = _load(builder, args[1], args[2], LANES)
        two = ir.Constant(u.type, [2.0] * LANES)

        def size(vector: Any) -> Any:
            return _larger(builder, vector, builder.fneg(vector))

        def both(a: Any, b: Any, c: Any, d: Any) -> Any:
            return _add(builder, _mul(builder, a, b), _mul(builder, c, d))

        gx = _add(builder, ax, _mul(builder, two, _sub(builder, x_, u)))
        gy = _add(builder, ay, _mul(builder, two, _sub(builder, y_, v)))
        across = _sub(builder, _mul(builder, gy, tx), _mul(builder, gx, ty))
        spread = _add(builder, size(both(gx, tx, gy, ty)), _mul(builder, ratio, size(across)))
        middle = _sub(builder, both(x_, x_, y_, y_), _mul(builder, two, both(u, x_, v, y_)))
        off = _sub(builder, _add(builder, middle, least), spread)
        far = _larger(builder, size(u), size(v))
        off = _add(builder, off, _mul(builder, far, _splat(builder, args[8], LANES)))
        near = builder.fcmp_ordered("<", off, ir.Constant(u.type, [0.0] * LANES))
        bits = _mask_bits(builder, builder.and_(near, _lanes_below(builder, args[3], LANES)), LANES)
        return builder.icmp_unsigned("!=", bits, ir.Constant(bits.type, 0))

    real, whole = types.float64, types.int64
    return types.boolean(us, vs, whole, whole, real, real, arc, whole, real), generate


@_operation
def moments_of(typing_context: Any, us: Any, vs: Any, m: Any) -> Any:
    """Return twice the area and six times both first moments of the m corners' polygon."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        u0 = _load(builder, args[0], _I8(0), LANES)
        v0 = _load(builder, args[1], _I8(0), LANES)
        u1, v1 = _next_lane(builder, u0), _next_lane(builder, v0)
        cross = _sub(builder, _mul(builder, u0, v1), _mul(builder, u1, v0))
        below = _lanes_below(builder, args[2], LANES)
        zero = ir.Constant(cross.type, [0.0] * LANES)

        def total(vector: Any) -> Any:
            kept = builder.select(below, vector, zero)
            return _tree(builder, kept, lambda a, b: builder.fadd(a, b))

        sums = [
            total(cross),
            total(_mul(builder, cross, _add(builder, u0, u1))),
            total(_mul(builder, cross, _add(builder, v0, v1))),
        ]
        return context.make_tuple(builder, signature.return_type, sums)

    return types.UniTuple(types.float64, 3)(us, vs, types.int64), generate


@_operation
def store_lanes(typing_context: Any, numbers: Any, table: Any, i: Any) -> Any:
    """Copy a cell buffer's first `LANES` numbers to row i of a table `LANES` wide."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = _data(context, builder, signature.args[1], args[1])
        vector = _load(builder, args[0], _I8(0), LANES)
        _store(builder, vector, data, builder.mul(args[2], _I8(LANES)))
        return context.get_dummy_value()

    return types.void(numbers, table, types.int64), generate


@_operation
def load_lanes(typing_context: Any, numbers: Any, table: Any, i: Any) -> Any:
    """Copy row i of a table `LANES` wide to a cell buffer's first `LANES` numbers."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = _data(context, builder, signature.args[1], args[1])
        vector = _load(builder, data, builder.mul(args[2], _I8(LANES)), LANES)
        _store(builder, vector, args[0], _I8(0))
        return context.get_dummy_value()

    return types.void(numbers, table, types.int64), generate


@_operation
def pair_mask(typing_context: Any, table: Any, i: Any, a: Any, b: Any) -> Any:
    """Return bits for the places in row i of a table `LANES` wide that hold a, the next one b."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        data = _data(context, builder, signature.args[0], args[0])
        row = _load(builder, data, builder.mul(args[1], _I8(LANES)), LANES)
        first, second = (_splat(builder, number, LANES) for number in args[2:])
        is_pair = builder.and_(
            builder.icmp_signed("==", row, first),
            builder.icmp_signed("==", _next_lane(builder, row), second),
        )
        return _mask_bits(builder, is_pair, LANES)

    return types.int64(table, types.int64, types.int32, types.int32), generate


def _gather(builder: Any, base: Any, index: Any, mask: Any) -> Any:
    """Load ``base[index]`` in the lanes of the mask, 0 in the others."""
    lanes = index.type.count
    offsets = builder.shl(
        builder.sext(index, ir.VectorType(_I8, lanes)),
        ir.Constant(ir.VectorType(_I8, lanes), [3] * lanes),
    )
    addresses = builder.add(_splat(builder, builder.ptrtoint(base, _I8), lanes), offsets)
    return _gather_at(builder, addresses, mask)


def _gather_at(builder: Any, addresses: Any, mask: Any) -> Any:
    """Load the doubles at some addresses in the lanes of the mask, 0 in the others."""
    lanes = addresses.type.count
    vector = ir.VectorType(_F8, lanes)
    pointers = ir.VectorType(_F8.as_pointer(), lanes)
    kind = ir.FunctionType(vector, [pointers, _I4, mask.type, vector])
    name = f"llvm.masked.gather.v{lanes}f64.v{lanes}p0"
    function = cgutils.get_or_insert_function(builder.module, kind, name)
    zeros = ir.Constant(vector, [0.0] * lanes)
    return builder.call(function, [builder.inttoptr(addresses, pointers), _I4(8), mask, zeros])


@_operation
def corners_of_star(
    typing_context: Any,
    xs: Any,
    ys: Any,
    star: Any,
    i: Any,
    m: Any,
    x: Any,
    y: Any,
    U: Any,
    V: Any,
) -> Any:
    """Put the corners of a cell with known neighbours into U, V; return the corners that fail.

    Corner k is the centre of the circle through the dot and its neighbours k and k + 1. It fails
    if those two are not in counter-clockwise order, or if the side from it to the next corner
    runs backwards, which means that another dot has come between.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        xs_, ys_, star_, i_, m_, x_, y_, U_, V_ = args
        px = _data(context, builder, signature.args[0], xs_)
        py = _data(context, builder, signature.args[1], ys_)
        table = _data(context, builder, signature.args[2], star_)
        index = _load(builder, table, builder.mul(i_, _I8(LANES)), LANES)
        around = _lanes_below(builder, builder.add(m_, _I8(2)), LANES)
        ax = _sub(builder, _gather(builder, px, index, around), _splat(builder, x_, LANES))
        ay = _sub(builder, _gather(builder, py, index, around), _splat(builder, y_, LANES))
        bx, by = _next_lane(builder, ax), _next_lane(builder, ay)
        a2 = _add(builder, _mul(builder, ax, ax), _mul(builder, ay, ay))
        b2 = _add(builder, _mul(builder, bx, bx), _mul(builder, by, by))
        cross = _sub(builder, _mul(builder, ax, by), _mul(builder, ay, bx))
        half = ir.Constant(cross.type, [0.5] * LANES)
        scale = builder.fdiv(half, cross)
        u = _mul(builder, _sub(builder, _mul(builder, a2, by), _mul(builder, b2, ay)), scale)
        v = _mul(builder, _sub(builder, _mul(builder, b2, ax), _mul(builder, a2, bx)), scale)
        for at in (0, FRONT):
            _store(builder, u, U_, _I8(at))
            _store(builder, v, V_, _I8(at))
        eu = _sub(builder, _next_lane(builder, u), u)
        ev = _sub(builder, _next_lane(builder, v), v)
        forward = _sub(builder, _mul(builder, ev, bx), _mul(builder, eu, by))
        zero = ir.Constant(cross.type, [0.0] * LANES)
        least = _mul(builder, b2, ir.Constant(cross.type, [-1e-13] * LANES))
        good = builder.and_(
            builder.fcmp_ordered(">", cross, zero), builder.fcmp_ordered(">=", forward, least)
        )
        bad = builder.and_(builder.not_(good), _lanes_below(builder, m_, LANES))
        return _mask_bits(builder, bad, LANES)

    row = types.int64
    real = types.float64
    return types.int64(xs, ys, star, row, row, real, real, U, V), generate


@_operation
def corners_of_lines(typing_context: Any, A: Any, B: Any, C: Any, m: Any, U: Any, V: Any) -> Any:
    """Put the corners of a cell with known sides into U, V; return those that turn the wrong way.

    Side k lies on the line ``A u + B v = C``, the dot where less; the first two sides follow once
    more behind the m. Corner k is where sides k and k + 1 meet.
    """

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        A_, B_, C_, m_, U_, V_ = args
        a0, b0, c0 = (_load(builder, row, _I8(0), LANES) for row in (A_, B_, C_))
        a1, b1, c1 = (_next_lane(builder, row) for row in (a0, b0, c0))
        cross = _sub(builder, _mul(builder, a0, b1), _mul(builder, b0, a1))
        scale = builder.fdiv(ir.Constant(cross.type, [1.0] * LANES), cross)
        u = _mul(builder, _sub(builder, _mul(builder, c0, b1), _mul(builder, c1, b0)), scale)
        v = _mul(builder, _sub(builder, _mul(builder, a0, c1), _mul(builder, a1, c0)), scale)
        for at in (0, FRONT):
            _store(builder, u, U_, _I8(at))
            _store(builder, v, V_, _I8(at))
        good = builder.fcmp_ordered(">", cross, ir.Constant(cross.type, [0.0] * LANES))
        bad = builder.and_(builder.not_(good), _lanes_below(builder, m_, LANES))
        return _mask_bits(builder, bad, LANES)

    return types.int64(A, B, C, types.int64, U, V), generate


@_operation
def backward_sides(typing_context: Any, A: Any, B: Any, m: Any, U: Any, V: Any) -> Any:
    """Return bits for the corners whose side on to the next corner runs backwards."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        A_, B_, m_, U_, V_ = args
        u, v, a, b = (_load(builder, row, _I8(0), LANES) for row in (U_, V_, A_, B_))
        a, b = _next_lane(builder, a), _next_lane(builder, b)
        eu = _sub(builder, _next_lane(builder, u), u)
        ev = _sub(builder, _next_lane(builder, v), v)
        forward = _sub(builder, _mul(builder, ev, a), _mul(builder, eu, b))
        length2 = _add(builder, _mul(builder, a, a), _mul(builder, b, b))
        least = _mul(builder, length2, ir.Constant(length2.type, [-1e-13] * LANES))
        good = builder.fcmp_ordered(">=", forward, least)
        bad = builder.and_(builder.not_(good), _lanes_below(builder, m_, LANES))
        return _mask_bits(builder, bad, LANES)

    return types.int64(A, B, types.int64, U, V), generate


@_operation
def sides_before(typing_context: Any, U: Any, V: Any, m: Any, u: Any, v: Any) -> Any:
    """Return bits for the sides on to the next corner that a place lies beyond."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        u0, v0 = (_load(builder, row, _I8(0), LANES) for row in args[:2])
        eu = _sub(builder, _next_lane(builder, u0), u0)
        ev = _sub(builder, _next_lane(builder, v0), v0)
        du = _sub(builder, u0, _splat(builder, args[3], LANES))
        dv = _sub(builder, v0, _splat(builder, args[4], LANES))
        left = _sub(builder, _mul(builder, ev, du), _mul(builder, eu, dv))
        inside = builder.fcmp_ordered(">=", left, ir.Constant(left.type, [0.0] * LANES))
        bad = builder.and_(builder.not_(inside), _lanes_below(builder, args[2], LANES))
        return _mask_bits(builder, bad, LANES)

    real = types.float64
    return types.int64(U, V, types.int64, real, real), generate


@_operation
def outside_box(typing_context: Any, U: Any, V: Any, x0: Any, y0: Any, x1: Any, y1: Any) -> Any:
    """Return bits for the corners outside a box, lanes beyond the cell included."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        u = _load(builder, args[0], _I8(0), LANES)
        v = _load(builder, args[1], _I8(0), LANES)
        low_u, low_v, high_u, high_v = (_splat(builder, a, LANES) for a in args[2:])
        out = builder.or_(
            builder.or_(builder.fcmp_ordered("<", u, low_u), builder.fcmp_ordered("<", v, low_v)),
            builder.or_(builder.fcmp_ordered(">", u, high_u), builder.fcmp_ordered(">", v, high_v)),
        )
        return _mask_bits(builder, out, LANES)

    real = types.float64
    return types.int64(U, V, real, real, real, real), generate
