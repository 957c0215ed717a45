"""Kernels decorated in two threads at once keep their caches in their own folders."""

import threading
from pathlib import Path

from stippler.kernels.machine import jit
from stippler.kernels.machine.cache import module_folder


def test_the_folder_is_not_taken_from_another_thread(monkeypatch, tmp_path):
    # The window and the worker import kernels at the same time; one put numba's setting back
    # while the other used it, and machine code landed in the folder the program was started in.
    monkeypatch.setenv("STIPPLER_CACHE_DIR", str(tmp_path))
    inside, seen = threading.Semaphore(0), []
    njit = jit.numba.njit

    def slow_njit(**options):
        def decorate(function):
            inside.release()
            gate.acquire(timeout=10)
            seen.append(jit.config.CACHE_DIR)
            return njit(**options)(function)

        return decorate

    gate = threading.Semaphore(0)
    monkeypatch.setattr(jit.numba, "njit", slow_njit)

    def decorate():
        def function(x):
            return x

        jit.kernel(function)

    threads = [threading.Thread(target=decorate) for _ in range(2)]
    for thread in threads:
        thread.start()
    assert inside.acquire(timeout=10)
    assert not inside.acquire(timeout=0.2)  # the second is kept out
    gate.release(2)
    for thread in threads:
        thread.join(10)
    assert seen == [str(module_folder(str(Path(__file__))))] * 2
    assert jit.config.CACHE_DIR == ""
