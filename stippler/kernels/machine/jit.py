"""How kernels are compiled.

Every kernel is a serial `nogil` function over flat arrays; `machine.pool` spreads a
range kernel over the cores. So each kernel compiles once, results do not depend on the number of
threads, and numba's own thread pools (of which one aborts when two threads meet in it) are never
started.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

from stippler.kernels.machine.cache import module_folder
from stippler.kernels.machine.numba_import import importing_numba

with importing_numba():
    import numba
    import numba.core.config
    import numba.np.arraymath

Function = TypeVar("Function", bound=Callable[..., Any])

config: Any = numba.core.config  # its names appear at run time
_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
_BARE: dict[str, Any] = {**_OPTIONS, "_nrt": False}
_INNER: dict[str, Any] = {**_BARE, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}

_setting = threading.Lock()  # window and worker import kernels at the same time

ZERO: Any = np.int64(0)
"""Where a kernel counts from: after a plain 0 numba compiles what it calls once more for it."""


def kernel(function: Function) -> Function:
    """Compile a kernel on first use and keep its machine code on disk."""
    return _compiled(function, _OPTIONS)


def bare_kernel(function: Function) -> Function:
    """Compile a kernel that makes no arrays, so that nothing in it counts references to them."""
    return _compiled(function, _BARE)


def _compiled(function: Function, options: dict[str, Any]) -> Function:
    with _setting:
        before = config.CACHE_DIR
        config.CACHE_DIR = str(module_folder(function.__code__.co_filename))
        try:
            compiled: Function = numba.njit(cache=True, **options)(function)
        finally:
            config.CACHE_DIR = before
    return compiled


def merged(function: Function) -> Function:
    """Compile a function that numba copies into the one function that calls it: quicker there."""
    compiled: Function = numba.njit(inline="always", **_INNER)(function)
    return compiled


def inline(function: Function) -> Function:
    """Compile a function that is inlined by LLVM into every kernel that calls it."""
    compiled: Function = numba.njit(forceinline=True, **_BARE)(function)
    return compiled


def inner(function: Function) -> Function:
    """Compile a function that only kernels call, without the wrappers that Python would need."""
    compiled: Function = numba.njit(**_INNER)(function)
    return compiled
