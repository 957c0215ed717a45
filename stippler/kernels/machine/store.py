"""Machine code of kernels made beforehand: found, loaded and called without numba.

A store is a folder with a list of kernels and their machine code: linked into one library where
a linker was at hand, else as one object for each kernel, which llvmlite loads. One comes with a
wheel for each level of processor; another is made on this machine by ``python -m stippler.warm``.
A kernel is taken from it only if its sources are those that it was made of; for all others, and
for arguments of other kinds, numba compiles as ever.
"""

from __future__ import annotations

import ctypes
import json
import os
import platform
import sys
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

from stippler.kernels.machine.cache import all_sources_digest, cache_root, source_digest
from stippler.kernels.machine.entry_ir import DECLARATIONS, OBJECTS, TABLE
from stippler.kernels.machine.processor import level, processor_key

LIST, LIBRARY = "kernels.json", "kernels.so"
FORMAT = 1

MATH = (
    "sin", "cos", "tan", "acos", "asin", "atan", "atan2", "exp", "exp2", "log", "log2", "log10",
    "pow", "hypot", "sqrt", "floor", "ceil", "fmod", "sinf", "cosf", "acosf", "atan2f", "expf",
    "logf", "powf", "hypotf", "sqrtf", "floorf", "ceilf", "fmodf", "log1p", "expm1", "rint",
    "trunc", "round", "ldexp", "tanh", "tanf", "cbrt", "fmin", "fmax",
)  # fmt: skip
MEMORY = ("malloc", "free", "memcpy", "memmove", "memset")

_FASTCALL = 0x80  # as CPython's methodobject.h has it
_kept: list[Any] = []  # what the interpreter and the linker refer to by address


class _MethodDef(ctypes.Structure):
    _fields_ = (
        ("name", ctypes.c_char_p),
        ("function", ctypes.c_void_p),
        ("flags", ctypes.c_int),
        ("doc", ctypes.c_char_p),
    )


def local_store() -> Path:
    """Return the folder of the kernels made on this machine; it may not exist yet."""
    return cache_root() / f"kernels-{processor_key()}"


def packed_stores() -> Path:
    """Return the folder in which a wheel carries a store for each level of processor."""
    return Path(__file__).parents[2] / "_data" / "kernels"


def can_load() -> bool:
    """Whether this system's stores have been tried: CPython with its lock, on Linux."""
    return (
        sys.platform == "linux"
        and platform.python_implementation() == "CPython"
        and not sys.abiflags
        and os.environ.get("STIPPLER_KERNELS", "") != "numba"
    )


@cache
def stores() -> tuple[tuple[Path, dict[str, Any]], ...]:
    """Return the stores that this processor can run, and their lists, the better one first."""
    return tuple(_found()) if can_load() and os.environ.get("STIPPLER_KERNELS") != "new" else ()


def _found() -> Iterator[tuple[Path, dict[str, Any]]]:
    folders = [local_store()]
    if not os.environ.get("NUMBA_CPU_NAME"):
        folders.append(packed_stores() / level())
    for folder in folders:
        if not _is_ours(folder):
            continue
        try:
            made = json.loads((folder / LIST).read_text(encoding="utf-8"))
        except (OSError, ValueError):
            continue  # none, or one that was cut: numba compiles
        if isinstance(made, dict) and made.get("format") == FORMAT:
            yield folder, made


def _is_ours(folder: Path) -> bool:
    """Whether a folder belongs to this user or to the system: its code is about to be run."""
    try:
        return folder.stat().st_uid in (0, os.getuid())
    except OSError:
        return False


def is_complete() -> bool:
    """Whether one of the stores has all kernels of these sources."""
    return any(made.get("sources") == all_sources_digest() for _, made in stores())


def stored(function: Callable[..., Any], last: Callable[..., Any]) -> Callable[..., Any] | None:
    """Return a callable of a kernel's stored machine code, or None if there is none.

    `last` is called with arguments for whose kinds no code is stored.
    """
    name = f"{function.__module__}:{function.__qualname__}"
    for folder, made in stores():
        found = made["kernels"].get(name)
        if found and found["sources"] == source_digest(function.__code__.co_filename):
            addresses = _addresses(folder)
            if addresses is not None:
                return bound(function.__name__, [addresses(s) for s in found["entries"]], last)
    return None


def bound(name: str, entries: list[int], last: Callable[..., Any]) -> Callable[..., Any]:
    """Make a function of Python of entries, each the next one's resort, and of a last one."""
    make = ctypes.pythonapi.PyCFunction_NewEx
    make.restype, make.argtypes = (
        ctypes.py_object,
        (ctypes.c_void_p, ctypes.py_object, ctypes.c_void_p),
    )
    for address in reversed(entries):
        definition = _MethodDef(name.encode(), address, _FASTCALL, None)
        _kept.append(definition)
        last = make(ctypes.addressof(definition), last, None)
    return last


@cache
def _addresses(folder: Path) -> Callable[[str], int] | None:
    """Load a store's machine code; return what finds a symbol in it, or None if that fails."""
    try:
        if (folder / LIBRARY).exists():
            return _linked(folder / LIBRARY)
        return loaded_objects(path.read_bytes() for path in sorted(folder.glob("*.o")))
    except (OSError, RuntimeError, ValueError, AttributeError):
        return None  # cut, or of another system: numba compiles


def _linked(path: Path) -> Callable[[str], int]:
    library = ctypes.CDLL(str(path))
    fill_table(ctypes.addressof(ctypes.c_void_p.in_dll(library, TABLE)))
    _kept.append(library)

    def find(symbol: str) -> int:
        return ctypes.cast(getattr(library, symbol), ctypes.c_void_p).value or 0

    return find


def fill_table(address: int) -> None:
    """Write the addresses of the objects that entries compare with."""
    table = (ctypes.c_void_p * len(OBJECTS)).from_address(address)
    for k, value in enumerate(OBJECTS.values()):
        table[k] = id(value)
    _kept.append(list(OBJECTS.values()))


def loaded_objects(objects: Iterator[bytes]) -> Callable[[str], int]:
    """Load machine code by llvmlite, which needs no linker; return what finds a symbol in it."""
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    add_symbols()
    machine = llvm.Target.from_default_triple().create_target_machine(
        codemodel="jitdefault", jit=True, reloc="default"
    )
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), machine)
    _kept.extend((engine, machine))
    for code in objects:
        engine.add_object_file(llvm.object_file.ObjectFileRef.from_data(code))
    engine.finalize_object()
    fill_table(engine.get_global_value_address(TABLE))
    find: Callable[[str], int] = engine.get_function_address
    return find


@cache
def add_symbols() -> None:
    """Tell llvmlite where all that machine code may call is; an unknown name would be a crash."""
    import llvmlite.binding as llvm

    process = ctypes.CDLL(None)
    for library, names in ((ctypes.pythonapi, DECLARATIONS), (process, (*MATH, *MEMORY))):
        for name in names:
            function = getattr(library, name, None)
            if function is not None:
                llvm.add_symbol(name, ctypes.cast(function, ctypes.c_void_p).value)
