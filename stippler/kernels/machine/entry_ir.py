"""How Python calls machine code that numba has compiled, without numba: functions in LLVM's IR.

An entry is a C function as Python calls it (``METH_FASTCALL``). It compares the kinds of what it
is given with those that the code was compiled for, takes numbers and arrays out, releases the
interpreter lock, and calls. What is of another kind it passes to its `self`: the entry for other
kinds, or at last numba.

It reads CPython's and numpy's objects where their public headers put them; addresses of types
come from one table, `OBJECTS`, that is filled when the code is loaded.
"""

from __future__ import annotations

import builtins
import importlib
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any

import numpy as np

NUMBERS = (
    "int8", "int16", "int32", "int64", "uint8", "uint16", "uint32", "uint64", "float32", "float64",
    "bool",
)  # fmt: skip
OBJECTS: dict[str, object] = {
    "ndarray": np.ndarray, "int": int, "float": float, "truth": bool, "none": None,
    "error": builtins.RuntimeError,
    **{f"number {name}": np.dtype(name).type for name in NUMBERS},
    **{f"dtype {name}": np.dtype(name) for name in NUMBERS},
}  # fmt: skip
"""What entries compare with, in the order of their table."""

TABLE = "stippler_objects"

_C_CONTIGUOUS, _F_CONTIGUOUS, _ALIGNED, _WRITEABLE = 1, 2, 0x100, 0x400
_TUPLE_SUBCLASS = 1 << 26
_TYPE, _DATA, _ND, _SHAPE, _STRIDES, _DTYPE, _FLAGS = 8, 16, 24, 32, 40, 56, 64
_SIZE, _ITEMS = 16, 24  # of a tuple
_MEMBER = 8  # bytes that each number of a tuple takes which a kernel returns

DECLARATIONS = {
    "PyLong_AsLongLong": "i64 @PyLong_AsLongLong(ptr)",
    "PyLong_FromLongLong": "ptr @PyLong_FromLongLong(i64)",
    "PyLong_AsUnsignedLongLong": "i64 @PyLong_AsUnsignedLongLong(ptr)",
    "PyLong_FromUnsignedLongLong": "ptr @PyLong_FromUnsignedLongLong(i64)",
    "PyFloat_AsDouble": "double @PyFloat_AsDouble(ptr)",
    "PyFloat_FromDouble": "ptr @PyFloat_FromDouble(double)",
    "PyBool_FromLong": "ptr @PyBool_FromLong(i64)",
    "PyObject_IsTrue": "i32 @PyObject_IsTrue(ptr)",
    "PyType_GetFlags": "i64 @PyType_GetFlags(ptr)",
    "PyObject_Vectorcall": "ptr @PyObject_Vectorcall(ptr, ptr, i64, ptr)",
    "PyEval_SaveThread": "ptr @PyEval_SaveThread()",
    "PyEval_RestoreThread": "void @PyEval_RestoreThread(ptr)",
    "PyErr_Occurred": "ptr @PyErr_Occurred()",
    "PyErr_SetString": "void @PyErr_SetString(ptr, ptr)",
    "PyTuple_New": "ptr @PyTuple_New(i64)",
    "PyTuple_SetItem": "i32 @PyTuple_SetItem(ptr, i64, ptr)",
    "Py_IncRef": "void @Py_IncRef(ptr)",
}
"""What entries call of CPython's stable interface."""

RUNTIME = f"""
@{TABLE} = global [{len(OBJECTS)} x ptr] zeroinitializer
declare ptr @malloc(i64)
declare void @free(ptr)
define ptr @NRT_MemInfo_alloc_aligned(i64 %size, i32 %align) {{
  %wide = zext i32 %align to i64
  %most = add i64 %size, %wide
  %all = add i64 %most, 64
  %info = call ptr @malloc(i64 %all)
  %none = icmp eq ptr %info, null
  br i1 %none, label %failed, label %made
made:
  store i64 1, ptr %info
  %start = ptrtoint ptr %info to i64
  %behind = add i64 %start, 63
  %beyond = add i64 %behind, %wide
  %mask = sub i64 0, %wide
  %at = and i64 %beyond, %mask
  %data = inttoptr i64 %at to ptr
  %slot = getelementptr i8, ptr %info, i64 24
  store ptr %data, ptr %slot
  %length = getelementptr i8, ptr %info, i64 32
  store i64 %size, ptr %length
  ret ptr %info
failed:
  ret ptr null
}}
define void @NRT_MemInfo_call_dtor(ptr %info) {{
  call void @free(ptr %info)
  ret void
}}
"""
"""The table, and the room for a kernel's own arrays as numba's runtime lays it out."""


class UnsupportedError(Exception):
    """Code whose arguments or result no entry can be made for; numba stays in charge of it."""


@dataclass
class _Entry:
    """The text of one entry as it grows."""

    natives: list[str]  # types of the flat arguments that numba's function takes
    lines: list[str] = field(default_factory=list)
    values: list[str] = field(default_factory=list)
    used: set[str] = field(default_factory=set)
    boxed: list[tuple[int, str, Any]] = field(default_factory=list)
    n: int = 0

    def let(self, text: str) -> str:
        self.n += 1
        self.lines.append(f"  %v{self.n} = {text}")
        return f"%v{self.n}"

    def load(self, pointer: str, offset: int, kind: str) -> str:
        return self.let(
            f"load {kind}, ptr {self.let(f'getelementptr i8, ptr {pointer}, i64 {offset}')}"
        )

    def object(self, name: str) -> str:
        return self.load(f"@{TABLE}", 8 * list(OBJECTS).index(name), "ptr")

    def call(self, name: str, args: str) -> str:
        self.used.add(name)
        text = f"call {DECLARATIONS[name].split(' @')[0]} @{name}({args})"
        if text.startswith("call void"):
            self.lines.append(f"  {text}")
            return ""
        return self.let(text)

    def demand(self, truth: str) -> None:
        """Go to the next entry unless this holds."""
        self.n += 1
        self.lines += [f"  br i1 {truth}, label %b{self.n}, label %other", f"b{self.n}:"]

    def take(self, value: str) -> None:
        self.values.append(value)

    def next_native(self) -> str:
        return self.natives[len(self.values)]


def entry_ir(symbol: str, native: str, natives: list[str], args: Any, result: Any) -> str:
    """Write an entry for a function that numba compiled.

    Parameters
    ----------
    symbol, native : str
        The entry's name, and that of the function it calls.
    natives : list of str
        LLVM types of what that function takes, those of result and exception included.
    args, result : numba types
    """
    entry = _Entry(natives[2:])
    entry.demand(entry.let(f"icmp eq i64 %n, {len(args)}"))
    for k, kind in enumerate(args):
        _argument(entry, entry.load("%args", 8 * k, "ptr"), kind)
    _unbox(entry)
    failed = entry.let(f"icmp ne ptr {entry.call('PyErr_Occurred', '')}, null")
    entry.lines += [f"  br i1 {failed}, label %wrong, label %go", "go:"]
    thread = entry.call("PyEval_SaveThread", "")
    given = ", ".join(
        f"{kind} {value}" for kind, value in zip(entry.natives, entry.values, strict=True)
    )
    status = entry.let(
        f"call i32 @{native}(ptr %result, ptr %raised{', ' if given else ''}{given})"
    )
    entry.call("PyEval_RestoreThread", f"ptr {thread}")
    good = entry.let(f"icmp eq i32 {status}, 0")
    none = entry.let(f"icmp eq i32 {status}, -2")
    entry.lines += [
        f"  %fine = or i1 {good}, {none}",
        "  br i1 %fine, label %done, label %bad",
        "done:",
    ]
    _box(entry, result)
    entry.lines.append("bad:")
    entry.call("PyErr_SetString", f"ptr {entry.object('error')}, ptr @{symbol}_words")
    entry.lines += ["  ret ptr null", "wrong:", "  ret ptr null", "other:"]
    other = entry.call("PyObject_Vectorcall", "ptr %self, ptr %args, i64 %n, ptr null")
    entry.lines.append(f"  ret ptr {other}")
    words = "a kernel failed"
    head = [
        f"@{TABLE} = external global [{len(OBJECTS)} x ptr]",
        f'@{symbol}_words = internal constant [{len(words) + 1} x i8] c"{words}\\00"',
        f"declare i32 @{native}({', '.join(natives)})",
        *(f"declare {DECLARATIONS[name]}" for name in sorted(entry.used)),
        f"define ptr @{symbol}(ptr %self, ptr %args, i64 %n) {{",
        f"  %result = alloca [{max(16, _MEMBER * _n_members(result))} x i8], align 16",
        "  %raised = alloca ptr",
    ]
    return "\n".join([*head, *entry.lines, "}", ""])


def _n_members(result: Any) -> int:
    return len(result) if hasattr(result, "__len__") else 1


def _argument(entry: _Entry, value: str, kind: Any) -> None:
    """Check what is given for one argument, and take it apart."""
    types: Any = importlib.import_module("numba.core.types")

    if isinstance(kind, types.Array):
        _array(entry, value, kind)
    elif isinstance(kind, types.BaseTuple):
        flags = entry.call("PyType_GetFlags", f"ptr {entry.load(value, _TYPE, 'ptr')}")
        entry.demand(
            entry.let(f"icmp ne i64 {entry.let(f'and i64 {flags}, {_TUPLE_SUBCLASS}')}, 0")
        )
        entry.demand(entry.let(f"icmp eq i64 {entry.load(value, _SIZE, 'i64')}, {len(kind)}"))
        for k, member in enumerate(kind):
            _argument(entry, entry.load(value, _ITEMS + 8 * k, "ptr"), member)
    elif isinstance(kind, types.NoneType):
        entry.demand(entry.let(f"icmp eq ptr {value}, {entry.object('none')}"))
        entry.take("null")
    else:
        _number(entry, value, kind)


def _number(entry: _Entry, value: str, kind: Any) -> None:
    types: Any = importlib.import_module("numba.core.types")

    name = "bool" if isinstance(kind, types.Boolean) else str(kind)
    if name not in NUMBERS or isinstance(kind, types.Literal):
        raise UnsupportedError(str(kind))
    found = entry.load(value, _TYPE, "ptr")
    is_it = entry.let(f"icmp eq ptr {found}, {entry.object(f'number {name}')}")
    plain = {"int64": "int", "float64": "float", "bool": "truth"}.get(name)
    if plain is not None:
        is_plain = entry.let(f"icmp eq ptr {found}, {entry.object(plain)}")
        is_it = entry.let(f"or i1 {is_it}, {is_plain}")
    entry.demand(is_it)
    entry.boxed.append((len(entry.values), value, name))
    entry.take("")  # once all kinds are known to be right


def _unbox(entry: _Entry) -> None:
    for at, value, name in entry.boxed:
        kind = entry.natives[at]
        if name == "bool":
            truth = entry.call("PyObject_IsTrue", f"ptr {value}")
            entry.values[at] = entry.let(f"trunc i32 {truth} to {kind}")
        elif name.startswith("float"):
            real = entry.call("PyFloat_AsDouble", f"ptr {value}")
            entry.values[at] = (
                real if kind == "double" else entry.let(f"fptrunc double {real} to float")
            )
        else:
            call = "PyLong_AsUnsignedLongLong" if name == "uint64" else "PyLong_AsLongLong"
            whole = entry.call(call, f"ptr {value}")
            entry.values[at] = whole if kind == "i64" else entry.let(f"trunc i64 {whole} to {kind}")


def _array(entry: _Entry, value: str, kind: Any) -> None:
    name = str(kind.dtype)
    if name not in NUMBERS:
        raise UnsupportedError(name)
    found = entry.load(value, _TYPE, "ptr")
    entry.demand(entry.let(f"icmp eq ptr {found}, {entry.object('ndarray')}"))
    entry.demand(entry.let(f"icmp eq i32 {entry.load(value, _ND, 'i32')}, {kind.ndim}"))
    dtype = entry.load(value, _DTYPE, "ptr")
    entry.demand(entry.let(f"icmp eq ptr {dtype}, {entry.object(f'dtype {name}')}"))
    asked = _ALIGNED | {"C": _C_CONTIGUOUS, "F": _F_CONTIGUOUS, "A": 0}[kind.layout]
    asked |= _WRITEABLE if kind.mutable else 0
    flags = entry.let(f"and i32 {entry.load(value, _FLAGS, 'i32')}, {asked}")
    entry.demand(entry.let(f"icmp eq i32 {flags}, {asked}"))
    sides = [*_row(entry, entry.load(value, _SHAPE, "ptr"), kind.ndim)]
    steps = [*_row(entry, entry.load(value, _STRIDES, "ptr"), kind.ndim)]
    n_items = "1"
    for side in sides:
        n_items = entry.let(f"mul i64 {n_items}, {side}")
    data = entry.load(value, _DATA, "ptr")
    for part in ("null", "null", n_items, str(np.dtype(name).itemsize), data, *sides, *steps):
        entry.take(part)


def _row(entry: _Entry, pointer: str, n: int) -> Iterator[str]:
    for k in range(n):
        yield entry.load(pointer, 8 * k, "i64")


def _box(entry: _Entry, kind: Any) -> None:
    """Make Python's object of the result."""
    types: Any = importlib.import_module("numba.core.types")

    if isinstance(kind, (types.Tuple, types.UniTuple)):
        made = _box_tuple(entry, kind)
    elif isinstance(kind, types.NoneType):
        made = entry.object("none")
        entry.call("Py_IncRef", f"ptr {made}")
    elif isinstance(kind, types.Boolean):
        truth = entry.let(f"zext i8 {entry.load('%result', 0, 'i8')} to i64")
        made = entry.call("PyBool_FromLong", f"i64 {truth}")
    else:
        made = _box_number(entry, kind, 0)
    entry.lines.append(f"  ret ptr {made}")


def _box_tuple(entry: _Entry, kind: Any) -> str:
    """Make a tuple of numbers that fill eight bytes each, one after the other."""
    if not all(str(member) in ("int64", "uint64", "float64") for member in kind):
        raise UnsupportedError(str(kind))
    made = entry.call("PyTuple_New", f"i64 {len(kind)}")
    _end_unless_made(entry, made)
    for k, member in enumerate(kind):
        item = _box_number(entry, member, _MEMBER * k)
        _end_unless_made(entry, item)
        entry.call("PyTuple_SetItem", f"ptr {made}, i64 {k}, ptr {item}")
    return made


def _end_unless_made(entry: _Entry, made: str) -> None:
    """End with the error that Python has set, of too little memory, if there is no object."""
    is_none = entry.let(f"icmp eq ptr {made}, null")
    entry.n += 1
    entry.lines += [f"  br i1 {is_none}, label %wrong, label %b{entry.n}", f"b{entry.n}:"]


def _box_number(entry: _Entry, kind: Any, offset: int) -> str:
    """Make Python's number of one that lies so many bytes into the result."""
    types: Any = importlib.import_module("numba.core.types")

    if str(kind) == "float64":
        real = entry.load("%result", offset, "double")
        return entry.call("PyFloat_FromDouble", f"double {real}")
    if not isinstance(kind, types.Integer):
        raise UnsupportedError(str(kind))
    whole = entry.load("%result", offset, f"i{kind.bitwidth}")
    if str(kind) == "uint64":
        return entry.call("PyLong_FromUnsignedLongLong", f"i64 {whole}")
    if kind.bitwidth < 64:
        whole = entry.let(f"{'sext' if kind.signed else 'zext'} i{kind.bitwidth} {whole} to i64")
    return entry.call("PyLong_FromLongLong", f"i64 {whole}")
