"""Eight numbers at once, for kernels written as LLVM operations (see `simd`)."""

from __future__ import annotations

from functools import partial
from typing import Any

from stippler.kernels.machine import simd

AT_ONCE = 8


class Eight:
    """Eight numbers, with the operators of one."""

    def __init__(self, builder: Any, value: Any) -> None:
        self.builder, self.value = builder, value

    def _of(self, other: Any) -> Any:
        if isinstance(other, Eight):
            return other.value
        return simd.ir.Constant(self.value.type, [float(other)] * AT_ONCE)

    def __add__(self, other: Any) -> Eight:
        return Eight(self.builder, simd._add(self.builder, self.value, self._of(other)))

    def __sub__(self, other: Any) -> Eight:
        return Eight(self.builder, simd._sub(self.builder, self.value, self._of(other)))

    def __mul__(self, other: Any) -> Eight:
        return Eight(self.builder, simd._mul(self.builder, self.value, self._of(other)))

    def __truediv__(self, other: Any) -> Eight:
        return Eight(self.builder, self.builder.fdiv(self.value, self._of(other)))

    def inverse_root(self) -> Eight:
        """Return one over the square roots, to rounding, of numbers from 1e-37 to 1e38.

        Found in half the digits, which takes a processor a fraction of the time, and mended.
        """
        builder = self.builder
        short = simd.ir.VectorType(simd.ir.FloatType(), AT_ONCE)
        root = Eight(builder, builder.fptrunc(self.value, short))._by("sqrt", "f32")
        about = builder.fdiv(simd.ir.Constant(short, [1.0] * AT_ONCE), root.value)
        near = Eight(builder, builder.fpext(about, self.value.type))
        off = Eight(builder, self._of(1.0)) - self * near * near
        return near + near * off * (off * 0.375 + 0.5)

    def floor(self) -> Eight:
        """Return the largest whole numbers not above."""
        return self._by("floor")

    def size(self) -> Eight:
        """Return the numbers without their signs."""
        return self._by("fabs")

    def at_least(self, other: Any) -> Eight:
        """Return the larger of each two."""
        return self._chosen(">", self._of(other))

    def at_most(self, other: Any) -> Eight:
        """Return the smaller of each two."""
        return self._chosen("<", self._of(other))

    def above(self, other: Any) -> Any:
        """Return a mask of those larger than others."""
        return self.builder.fcmp_ordered(">", self.value, self._of(other))

    def only(self, mask: Any) -> Eight:
        """Return those of a mask, and 0 for others."""
        return self.where(mask, 0.0)

    def where(self, mask: Any, other: Any) -> Eight:
        """Return those of a mask, and others in their place where it is not set."""
        return Eight(self.builder, self.builder.select(mask, self.value, self._of(other)))

    def largest(self) -> Any:
        """Return the largest number."""
        return simd._tree(self.builder, self.value, partial(simd._larger, self.builder))

    def total(self) -> Any:
        """Return the sum, added as a tree."""
        return simd._tree(self.builder, self.value, lambda a, b: simd._add(self.builder, a, b))

    def _by(self, name: str, digits: str = "f64") -> Eight:
        kind = simd.ir.FunctionType(self.value.type, [self.value.type])
        name = f"llvm.{name}.v{AT_ONCE}{digits}"
        function = simd.cgutils.get_or_insert_function(self.builder.module, kind, name)
        return Eight(self.builder, self.builder.call(function, [self.value]))

    def _chosen(self, than: str, other: Any) -> Eight:
        is_own = self.builder.fcmp_ordered(than, self.value, other)
        return Eight(self.builder, self.builder.select(is_own, self.value, other))


class Variable:
    """What a loop changes: eight numbers on the stack, for LLVM to put into a register."""

    def __init__(self, builder: Any, value: Any) -> None:
        self.builder = builder
        self._place = simd.cgutils.alloca_once(builder, value.type)
        self.set(value)

    def get(self) -> Any:
        """Return the vector."""
        return self.builder.load(self._place)

    def set(self, value: Any) -> None:
        """Put another vector in its place."""
        self.builder.store(value, self._place)
