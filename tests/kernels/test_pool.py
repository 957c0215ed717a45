"""Ranges over threads: who shares them, and what becomes of errors and cancels."""

import os
import sys
import threading

import pytest

from stippler.kernels.machine.pool import begun, parallel_for, set_threads, stand_back


@pytest.fixture(autouse=True)
def three_threads():
    set_threads(3)
    yield
    set_threads(0)


def test_a_second_caller_runs_alone_while_all_cores_are_taken():
    begun, may_end = threading.Event(), threading.Event()
    seen: set[int] = set()

    def held(start: int, stop: int) -> None:
        begun.set()
        assert may_end.wait(10)

    def noted(start: int, stop: int) -> None:
        seen.add(threading.get_ident())

    first = threading.Thread(target=lambda: parallel_for(held, 100, grain=1))
    first.start()
    assert begun.wait(10)
    assert parallel_for(noted, 100, grain=1)
    assert seen == {threading.get_ident()}
    may_end.set()
    first.join()


def test_every_range_runs_once_and_an_error_comes_out():
    done = [0] * 1000

    def count(start: int, stop: int) -> None:
        for k in range(start, stop):
            done[k] += 1

    assert parallel_for(count, 1000, grain=10)
    assert done == [1] * 1000

    def broken(start: int, stop: int) -> None:
        raise RuntimeError("on purpose")

    with pytest.raises(RuntimeError, match="on purpose"):
        parallel_for(broken, 1000, grain=10)
    assert parallel_for(count, 1000, grain=10)  # and the pool lives on


@pytest.mark.skipif(sys.platform != "linux", reason="threads have no rank of their own")
def test_a_thread_that_stands_back_has_a_lower_rank_and_others_keep_theirs():
    mine = os.getpriority(os.PRIO_PROCESS, threading.get_native_id())
    told: list[int] = []

    def work() -> None:
        stand_back()
        told.append(os.getpriority(os.PRIO_PROCESS, threading.get_native_id()))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert told[0] >= max(mine, 10)
    assert os.getpriority(os.PRIO_PROCESS, threading.get_native_id()) == mine


def test_a_call_begun_gives_its_result_in_whatever_thread():
    for threads in (1, 2):
        set_threads(threads)
        try:
            results = [begun(divmod, 17, k) for k in (2, 3, 5)]
            assert [result() for result in results] == [(8, 1), (5, 2), (3, 2)]
            failing = begun(divmod, 1, 0)
            with pytest.raises(ZeroDivisionError):
                failing()
        finally:
            set_threads(0)
