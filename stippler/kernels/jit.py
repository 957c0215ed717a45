"""How kernels are compiled and where the machine code is kept.

Every kernel is a serial `nogil` function over flat arrays; `stippler.kernels.pool` spreads a
range kernel over the cores. So each kernel compiles once, results do not depend on the number of
threads, and numba's own thread pools (of which one aborts when two threads meet in it) are never
started.

Numba keys its cache by the file a kernel stands in and does not see changes in functions imported
from other files, so the cache folder carries a digest of all kernel sources.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import numba
from numba.core import config
from platformdirs import user_cache_path

Function = TypeVar("Function", bound=Callable[..., Any])

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}


@cache
def cache_folder() -> Path:
    """Return the folder that holds this version's compiled kernels (it may not exist yet)."""
    digest = hashlib.sha256(f"numba {numba.__version__}".encode())
    for source in sorted(Path(__file__).parent.glob("*.py")):
        digest.update(source.read_bytes())
    base = os.environ.get("STIPPLER_CACHE_DIR")
    root = Path(base) if base else user_cache_path("stippler")
    return root / f"kernels-{digest.hexdigest()[:16]}"


def kernel(function: Function) -> Function:
    """Compile a kernel on first use and keep its machine code on disk."""
    before = config.CACHE_DIR
    config.CACHE_DIR = str(cache_folder())
    try:
        compiled: Function = numba.njit(cache=True, **_OPTIONS)(function)
    finally:
        config.CACHE_DIR = before
    return compiled


def inline(function: Function) -> Function:
    """Compile a function that is inlined by LLVM into every kernel that calls it."""
    compiled: Function = numba.njit(forceinline=True, **_OPTIONS)(function)
    return compiled
