"""How kernels are compiled, and where their machine code comes from.

Every kernel is a serial `nogil` function over flat arrays; `machine.pool` spreads a
range kernel over the cores. So each kernel compiles once, results do not depend on the number of
threads, and numba's own thread pools (of which one aborts when two threads meet in it) are never
started.

A kernel's machine code comes from a store (`machine.store`) where there is one of its sources;
numba, which takes a third of a second to import, then is not needed. For what is not stored, numba
compiles on first use and keeps what it made on disk.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np

from stippler.kernels.machine import store
from stippler.kernels.machine.cache import module_folder
from stippler.kernels.machine.numba_import import importing_numba

Function = TypeVar("Function", bound=Callable[..., Any])

_OPTIONS: dict[str, Any] = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}
_BARE: dict[str, Any] = {**_OPTIONS, "_nrt": False}
_INNER: dict[str, Any] = {**_BARE, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}

_setting = threading.RLock()  # window and worker compile kernels at the same time

ZERO: Any = np.int64(0)
"""Where a kernel counts from: after a plain 0 numba compiles what it calls once more for it."""


class Compiled:
    """A function that numba compiles once it is needed; it stands for numba's own object then."""

    def __init__(self, function: Callable[..., Any], options: dict[str, Any], cached: bool) -> None:
        self.function, self._options, self._cached = function, options, cached
        self._dispatcher: Any = None
        self.__name__, self.__doc__ = function.__name__, function.__doc__

    @property
    def dispatcher(self) -> Any:
        """What numba made of the function; imports numba."""
        with _setting:
            if self._dispatcher is None:
                self._dispatcher = _dispatcher_of(self.function, self._options, self._cached)
            return self._dispatcher

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__") or name == "_dispatcher":
            raise AttributeError(name)
        return getattr(self.dispatcher, name)


class Kernel(Compiled):
    """A function that Python calls; its code comes from a store, or from numba."""

    def __init__(self, function: Callable[..., Any], options: dict[str, Any]) -> None:
        super().__init__(function, options, cached=True)
        self._call = store.stored(function, self._by_numba) or self._by_numba

    def __call__(self, *args: Any) -> Any:  # noqa: D102  # as the function's own
        return self._call(*args)

    @property
    def is_stored(self) -> bool:
        """Whether its machine code came from a store."""
        return self._call != self._by_numba

    def _by_numba(self, *args: Any) -> Any:
        from stippler.kernels.machine import export

        if export.is_recording():
            entry = export.recorded(self.function, self._options, args)
            if entry is not None:
                return store.bound(self.__name__, [entry], self.dispatcher)(*args)
        return self.dispatcher(*args)


class Operation:
    """A function of kernels that writes LLVM's code itself; numba knows it once it is needed."""

    def __init__(
        self, generator: Callable[..., Any], get_ready: Callable[[], None], **options: bool
    ) -> None:
        self._generator, self._get_ready, self._options = generator, get_ready, options
        self._type: Any = None

    @property
    def _numba_type_(self) -> Any:
        with _setting:
            if self._type is None:
                from numba.core.registry import cpu_target
                from numba.extending import intrinsic

                self._get_ready()
                mark = intrinsic(**self._options) if self._options else intrinsic
                made = mark(self._generator)
                cpu_target.typing_context.refresh()
                cpu_target.target_context.refresh()
                self._type = cpu_target.typing_context.resolve_value_type(made)
            return self._type


def kernel(function: Function) -> Function:
    """Compile a kernel on first use and keep its machine code on disk."""
    made: Any = Kernel(function, _OPTIONS)
    return made  # type: ignore[no-any-return]


def bare_kernel(function: Function) -> Function:
    """Compile a kernel that makes no arrays, so that nothing in it counts references to them."""
    made: Any = Kernel(function, _BARE)
    return made  # type: ignore[no-any-return]


def merged(function: Function) -> Function:
    """Compile a function that numba copies into the one function that calls it: quicker there."""
    made: Any = Compiled(function, {**_INNER, "inline": "always"}, cached=False)
    return made  # type: ignore[no-any-return]


def inline(function: Function) -> Function:
    """Compile a function that is inlined by LLVM into every kernel that calls it."""
    made: Any = Compiled(function, {**_BARE, "forceinline": True}, cached=False)
    return made  # type: ignore[no-any-return]


def inner(function: Function) -> Function:
    """Compile a function that only kernels call, without the wrappers that Python would need."""
    made: Any = Compiled(function, _INNER, cached=False)
    return made  # type: ignore[no-any-return]


def _dispatcher_of(function: Callable[..., Any], options: dict[str, Any], cached: bool) -> Any:
    """Hand a function to numba; what it compiles is kept on disk where that can be done."""
    with importing_numba():
        import numba
        import numba.core.config
        import numba.np.arraymath
    config: Any = numba.core.config
    is_off, config.DISABLE_JIT = config.DISABLE_JIT, 0  # kernels are nothing without it
    try:
        made = numba.njit(**options)(function)
    finally:
        config.DISABLE_JIT = is_off
    if not cached:
        return made
    from stippler.kernels.machine.numba_cache import keep_on_disk

    before = config.CACHE_DIR
    config.CACHE_DIR = str(module_folder(function.__code__.co_filename))
    try:
        keep_on_disk(made)
    finally:
        config.CACHE_DIR = before
    return made
