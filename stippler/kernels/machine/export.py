"""Making the machine code that programs load without numba, by numba and its LLVM.

While `recording`, each kernel that is called with arguments of new kinds is compiled into an
object of its own, which is kept under a name made of its sources, its arguments' kinds and the
processor: another process finds it there, and so does the next version if it has not changed.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import shutil
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any

from stippler.kernels.machine import store
from stippler.kernels.machine.cache import all_sources_digest, source_digest
from stippler.kernels.machine.entry_ir import (
    DECLARATIONS,
    RUNTIME,
    TABLE,
    UnsupportedError,
    entry_ir,
)
from stippler.kernels.machine.quick_numba import only_for_objects

_KNOWN = {*DECLARATIONS, *store.MATH, *store.MEMORY, TABLE, "_GLOBAL_OFFSET_TABLE_"}
_OURS = ("NRT_MemInfo_alloc_aligned", "NRT_MemInfo_call_dtor")
_OLD_S = 30 * 86_400.0  # from when on objects of other versions go
_lock = threading.Lock()

Kernels = dict[str, dict[str, Any]]
"""Of each kernel by name: a digest of its sources, and its entries' symbols."""


@dataclass
class _Recorder:
    """Objects made so far, and where they are kept."""

    folder: Path
    kernels: Kernels = field(default_factory=dict)
    unsupported: set[tuple[str, str]] = field(default_factory=set)
    has_runtime: bool = False


_recorder: _Recorder | None = None


def is_recording() -> bool:
    """Whether kernels are compiled into objects just now."""
    return _recorder is not None


@contextmanager
def recording(folder: Path) -> Iterator[Kernels]:
    """Compile what is called into objects in a folder, from which they are called, too.

    What is yielded names the kernels made or used so far, for `finish` to gather.
    """
    global _recorder
    folder.mkdir(parents=True, exist_ok=True)
    _recorder = _Recorder(folder)
    runtime = folder / "runtime.o"
    if not runtime.exists():
        _write(runtime, _object_of(_parsed(RUNTIME)))
    try:
        yield _recorder.kernels
    finally:
        _recorder = None


def recorded(function: Any, options: dict[str, Any], args: tuple[Any, ...]) -> int | None:
    """Return the entry for arguments of these kinds, compiled if need be; None if there is none."""
    from numba import typeof

    assert _recorder is not None
    kinds = tuple(typeof(value) for value in args)
    name = f"{function.__module__}:{function.__qualname__}"
    sources = source_digest(function.__code__.co_filename)
    if (name, str(kinds)) in _recorder.unsupported:
        return None
    text = f"{name} {sources} {kinds} numba {metadata.version('numba')}"
    symbol = f"stippler_{hashlib.sha256(text.encode()).hexdigest()[:20]}"
    path = _recorder.folder / f"{symbol}.o"
    with _lock:
        if not path.exists():
            with _claimed(path):
                try:
                    if not path.exists():
                        _write(path, _compiled(function, options, kinds, symbol))
                except UnsupportedError:
                    _recorder.unsupported.add((name, str(kinds)))
                    return None
        if not _recorder.has_runtime:
            _recorder.has_runtime = True
            _engine_of(_recorder.folder)
        made = _recorder.kernels.setdefault(name, {"sources": sources, "entries": []})
        if symbol not in made["entries"]:
            made["entries"].append(symbol)
        return _engine_of(_recorder.folder)(symbol, path)


@contextmanager
def _claimed(path: Path) -> Iterator[None]:
    """Claim what is to be made, once no other process that still runs is making it."""
    import fcntl  # late: only where there are stores is it known to be there

    with path.with_suffix(".claim").open("w") as claim:
        with contextlib.suppress(OSError):  # a disk without locks: it may be made twice
            fcntl.flock(claim, fcntl.LOCK_EX)
        yield


def finish(folder: Path, kernels: Kernels, target: Path) -> None:
    """Gather the objects of kernels that were made or used while recording into a store.

    Of several processes that make the same store each writes all of it, one after the other.
    """
    target.mkdir(parents=True, exist_ok=True)
    with _claimed(folder / "store"):
        _gather(folder, kernels, target)
    store.stores.cache_clear()


def _gather(folder: Path, kernels: Kernels, target: Path) -> None:
    """Link objects into one library where there is a linker; else copy them as they are."""
    symbols = [symbol for made in kernels.values() for symbol in made["entries"]]
    objects = [folder / f"{symbol}.o" for symbol in ("runtime", *symbols)]
    (target / store.LIST).unlink(missing_ok=True)
    for stale in target.glob("*.o"):
        stale.unlink()
    if not _link(objects, target / store.LIBRARY):
        (target / store.LIBRARY).unlink(missing_ok=True)
        for path in objects:
            shutil.copy(path, target)
    old = time.time() - _OLD_S
    for path in (*folder.glob("stippler_*.o"), *folder.glob("*.claim")):
        if path not in objects and path.stat().st_mtime < old:
            path.unlink(missing_ok=True)
    about = {"format": store.FORMAT, "sources": all_sources_digest(), "kernels": kernels}
    _write(target / store.LIST, json.dumps(about).encode())


def _link(objects: list[Path], target: Path) -> bool:
    """Link objects into one library; False without a linker, or if it fails."""
    linker = next((path for name in ("cc", "gcc", "clang") if (path := shutil.which(name))), None)
    if linker is None:
        return False
    fresh = target.with_suffix(f".{os.getpid()}")
    command = [linker, "-shared", "-o", str(fresh), *map(str, objects), "-lm", "-Wl,-z,now"]
    done = subprocess.run(command, capture_output=True, check=False)
    if done.returncode:
        fresh.unlink(missing_ok=True)
        return False
    os.replace(fresh, target)
    return True


_engines: dict[Path, Callable[[str, Path], int]] = {}


def _engine_of(folder: Path) -> Callable[[str, Path], int]:
    """Return what loads an object and finds its entry; each is loaded once."""
    if folder not in _engines:
        known: dict[str, int] = {}

        def find(symbol: str, path: Path) -> int:
            if symbol not in known:
                parts = ((folder / "runtime.o").read_bytes(), path.read_bytes())
                known[symbol] = store.loaded_objects(iter(parts))(symbol)
            return known[symbol]

        _engines[folder] = find
    return _engines[folder]


def _compiled(function: Any, options: dict[str, Any], kinds: tuple[Any, ...], symbol: str) -> bytes:
    """Compile a function for arguments of these kinds; return an object with its entry."""
    from numba.core import compiler
    from numba.core.compiler_lock import global_compiler_lock
    from numba.core.registry import cpu_target

    flags: Any = compiler.Flags()
    cpu_target.options.parse_as_flags(flags, dict(options))
    flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
    with global_compiler_lock:
        typing, target = cpu_target.typing_context, cpu_target.target_context
        typing.refresh()
        target.refresh()
        with only_for_objects() as finish:
            made = compiler.compile_extra(typing, target, function, kinds, None, flags, {})
            finish(made.library)
        module = made.library._final_module.clone()
    native = made.fndesc.llvm_func_name
    natives = [str(arg.type) for arg in module.get_function(native).arguments]
    entry = entry_ir(symbol, native, natives, kinds, made.signature.return_type)
    module.link_in(_parsed(entry))
    return _object_of(_stripped(module, symbol))


def _parsed(text: str) -> Any:
    import llvmlite.binding as llvm

    module = llvm.parse_assembly(text)
    module.verify()
    return module


def _stripped(module: Any, symbol: str) -> Any:
    """Hide all but the entry, drop what nothing calls, and check what is left to be found."""
    import llvmlite.binding as llvm

    for value in (*module.functions, *module.global_variables):
        if not value.is_declaration and value.name != symbol:
            value.linkage = llvm.Linkage.internal
    machine = _machine()
    builder = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(0))
    passes = llvm.create_new_module_pass_manager()
    passes.add_global_dead_code_eliminate_pass() if hasattr(
        passes, "add_global_dead_code_eliminate_pass"
    ) else passes.add_global_dce_pass()
    passes.run(module, builder)
    unknown = {
        value.name
        for value in (*module.functions, *module.global_variables)
        if value.is_declaration and not re.match(r"llvm\.", value.name)
    } - _KNOWN - set(_OURS)  # fmt: skip
    if unknown:
        raise UnsupportedError(f"it calls {', '.join(sorted(unknown))}")
    return module


def _machine() -> Any:
    """Return LLVM's target machine for the processor that numba compiles for."""
    import llvmlite.binding as llvm
    from numba.core.registry import cpu_target

    code = cpu_target.target_context.codegen()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=code._get_host_cpu_name(), features=code._get_host_cpu_features(), opt=3, reloc="pic",
        codemodel="small",
    )  # fmt: skip


def _object_of(module: Any) -> bytes:
    made: bytes = _machine().emit_object(module)
    return made


def _write(path: Path, data: bytes) -> None:
    """Write a file that is whole whenever another process looks."""
    fresh = path.with_name(f".{path.name}.{os.getpid()}")
    fresh.write_bytes(data)
    os.replace(fresh, path)
