"""One pool of threads for all kernels.

A range kernel has the signature ``kernel(start, stop, *arrays)``, releases the interpreter lock,
and writes only to what belongs to ``start..stop``; so any number of threads gives the same bits.
"""

from __future__ import annotations

import contextlib
import itertools
import os
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Any, TypeVar

Result = TypeVar("Result")

_PATIENT = 10  # as `nice` counts

_lock = threading.Lock()
_pool: ThreadPoolExecutor | None = None
_n_threads = 0
_stands_back = False
_n_callers = 0  # that share their ranges with the pool's threads just now


def n_threads() -> int:
    """Return how many threads share a kernel: `STIPPLER_THREADS`, or all cores of this process."""
    global _n_threads
    if not _n_threads:
        wanted = os.environ.get("STIPPLER_THREADS", "")
        _n_threads = int(wanted) if wanted.isdigit() and int(wanted) else _cores()
    return _n_threads


def set_threads(n: int) -> None:
    """Use `n` threads from now on; 0 returns to the default. For tests and benchmarks."""
    global _pool, _n_threads
    with _lock:
        if _pool is not None:
            _pool.shutdown(wait=True)
        _pool, _n_threads = None, n


def stand_back() -> None:
    """Let others go first from now on: this thread, and those of the pool that are to come.

    A window's thread that wakes up then has a core at once. Only on Linux has a thread a rank of
    its own.
    """
    global _stands_back
    _stands_back = True
    _lower_rank()


def _lower_rank() -> None:
    if _stands_back and sys.platform == "linux":
        with contextlib.suppress(OSError):
            os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _PATIENT)


def _cores() -> int:
    try:
        return len(os.sched_getaffinity(0))
    except AttributeError:  # not on this platform
        return os.cpu_count() or 1


def _executor() -> ThreadPoolExecutor:
    global _pool
    with _lock:
        if _pool is None:
            _pool = ThreadPoolExecutor(
                n_threads(), thread_name_prefix="kernel", initializer=_lower_rank
            )
        return _pool


def parallel_for(
    kernel: Callable[..., Any],
    n: int,
    *args: Any,
    grain: int = 2048,
    chunks: int = 4,
    cancel: Callable[[], bool] | None = None,
) -> bool:
    """Run a range kernel over ``0..n``, on all cores when it is worth it and they are free.

    While another thread has all cores at work, a caller runs its ranges alone: it would else wait
    for a range that a thread has begun and finds no core to finish.

    Parameters
    ----------
    kernel : callable
        ``kernel(start, stop, *args)``, compiled and `nogil`.
    n : int
        Length of the range.
    grain : int
        Smallest range worth a thread; below it the kernel runs in the calling thread. With
        `cancel`, ranges are near this length, so that it is asked often.
    chunks : int
        Ranges for each thread, so that an uneven load levels out.
    cancel : callable, optional
        Asked before each range; once it returns True no further range starts.

    Returns
    -------
    bool
        False if `cancel` stopped the run before its end.
    """
    threads = n_threads()
    most = max(n // grain, 1)
    n_ranges = most if cancel is not None else min(threads * chunks, most)
    if n_ranges == 1 or (threads == 1 and cancel is None):
        if cancel is not None and cancel():
            return False
        kernel(0, n, *args)
        return True
    turn = itertools.count()  # `next` on it is atomic
    stopped = threading.Event()

    def work() -> None:
        while (k := next(turn)) < n_ranges and not stopped.is_set():
            if cancel is not None and cancel():
                stopped.set()
                return
            kernel(n * k // n_ranges, n * (k + 1) // n_ranges, *args)

    if threads == 1:
        work()
        return not stopped.is_set()
    with _counted() as is_alone:
        _share(work, min(threads, n_ranges) - 1 if is_alone else 0, stopped)
    return not stopped.is_set()


def begun(call: Callable[..., Result], *args: Any) -> Callable[[], Result]:
    """Begin a call in a thread of the pool; return what waits for its result.

    Where there is one thread only, or all are at work, the call is made once it is asked for.
    """
    if n_threads() == 1 or _n_callers:
        return lambda: call(*args)
    future = _executor().submit(call, *args)

    def result() -> Result:
        return call(*args) if future.cancel() else future.result()

    return result


@contextlib.contextmanager
def _counted() -> Iterator[bool]:
    """Count a caller; tell whether it is the only one."""
    global _n_callers
    with _lock:
        is_alone = _n_callers == 0
        _n_callers += 1
    try:
        yield is_alone
    finally:
        with _lock:
            _n_callers -= 1


def _share(work: Callable[[], None], n_others: int, stopped: threading.Event) -> None:
    """Run `work` in this thread and in some of the pool's, until all of them have ended."""
    futures: list[Future[None]] = []
    if n_others:
        executor = _executor()
        futures = [executor.submit(work) for _ in range(n_others)]
    try:
        work()
    except BaseException:
        stopped.set()
        raise
    finally:
        # all ranges are taken: what has not begun need not
        begun = [future for future in futures if not future.cancel()]
        for future in begun:
            future.exception()  # wait for all before anyone touches the arrays again
    for future in begun:
        future.result()
