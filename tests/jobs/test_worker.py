"""The worker, with jobs that wait for the test's word; nothing here sleeps."""

import threading
import weakref

import pytest

from stippler.errors import PictureError
from stippler.jobs.worker import Worker

WAIT_S = 10.0


class Bell:
    """Counts the worker's calls, and lets the test wait for the next."""

    def __init__(self):
        self.rung = threading.Semaphore(0)
        self.n = 0

    def __call__(self):
        self.n += 1
        self.rung.release()

    def wait(self):
        assert self.rung.acquire(timeout=WAIT_S), "the worker did not wake the UI"


class Gated:
    """A job that yields 0, 1, 2 ..., each when told to."""

    def __init__(self, n=10**9, error=None):
        self.gate = threading.Semaphore(0)
        self.closed = threading.Event()
        self.started = threading.Event()
        self.n, self.error = n, error

    def __call__(self):
        self.started.set()
        try:
            for k in range(self.n):
                assert self.gate.acquire(timeout=WAIT_S)
                yield k
            if self.error is not None:
                raise self.error
        finally:
            self.closed.set()

    def go(self, times=1):
        for _ in range(times):
            self.gate.release()


@pytest.fixture
def bell():
    return Bell()


@pytest.fixture
def worker(bell):
    worker = Worker(bell)
    yield worker
    assert worker.close()


def next_update(worker, bell):
    bell.wait()
    update = worker.poll()
    assert update is not None
    return update


def end_of(worker, bell):
    while True:
        update = next_update(worker, bell)
        if update.ended:
            return update


def test_results_arrive_in_order_and_end(worker, bell):
    job = Gated(2)
    request = worker.start(job)
    for k in range(2):
        job.go()
        update = next_update(worker, bell)
        assert (update.request_id, update.result, update.n_results) == (request, k, k + 1)
        if update.ended:
            break
    else:
        update = next_update(worker, bell)
    assert (update.result, update.ended, update.n_results) == (1, "finished", 2)


def test_the_latest_result_wins_and_wakes_once(worker, bell):
    job = Gated(5)
    worker.start(job)
    job.go(5)
    assert job.closed.wait(WAIT_S)
    while worker.busy:
        pass
    update = worker.poll()
    assert (update.result, update.ended, update.n_results) == (4, "finished", 5)
    assert worker.poll() is None
    assert bell.n == 1


def test_a_new_request_supersedes_the_running_one(worker, bell):
    old, new = Gated(), Gated(1)
    worker.start(old)
    assert old.started.wait(WAIT_S)
    request = worker.start(new)
    old.go()
    assert old.closed.wait(WAIT_S)
    new.go()
    update = end_of(worker, bell)
    assert (update.request_id, update.result, update.ended) == (request, 0, "finished")


def test_no_result_of_a_superseded_request_is_seen(worker, bell):
    old, new = Gated(), Gated(1)
    first = worker.start(old)
    old.go()
    bell.wait()  # its result waits, untaken
    worker.start(new)
    assert worker.poll() is None
    old.go()
    new.go()
    assert end_of(worker, bell).request_id != first


def test_stop_keeps_the_last_result(worker, bell):
    job = Gated()
    worker.start(job)
    job.go()
    assert next_update(worker, bell).result == 0
    worker.stop()
    job.go()
    update = end_of(worker, bell)
    assert (update.ended, update.result) == ("stopped", 1)
    assert job.closed.is_set()


def test_a_pause_holds_the_job_and_stop_ends_it(worker, bell):
    job = Gated()
    worker.start(job)
    job.go()
    assert next_update(worker, bell).result == 0
    worker.pause()
    job.go(3)
    assert next_update(worker, bell).result == 1  # the one under way; then it holds
    assert worker.paused
    worker.stop()
    assert end_of(worker, bell).result == 1


def test_a_paused_job_goes_on(worker, bell):
    job = Gated(3)
    worker.start(job)
    worker.pause()
    job.go(3)
    assert next_update(worker, bell).result == 0
    worker.pause(False)
    assert end_of(worker, bell).result == 2


@pytest.mark.parametrize(
    ("error", "ended", "says"),
    [
        (PictureError("is empty", "a.png", "give another"), "failed", "a.png: is empty"),
        (ZeroDivisionError("oh"), "failed", "unexpected ZeroDivisionError: oh"),
        (MemoryError(), "failed", "not enough memory"),
    ],
)
def test_failures_are_values_and_the_thread_lives_on(worker, bell, error, ended, says):
    job = Gated(0, error)
    worker.start(job)
    update = end_of(worker, bell)
    assert update.ended == ended
    assert says in str(update.failure)
    after = Gated(1)
    worker.start(after)
    after.go()
    assert end_of(worker, bell).ended == "finished"


def test_a_request_that_fails_before_it_begins(worker, bell):
    def run():
        raise PictureError("no such file", "a.png")

    worker.start(run)
    assert "no such file" in str(end_of(worker, bell).failure)


def test_close_ends_a_job_that_is_paused(bell):
    worker = Worker(bell)
    job = Gated()
    worker.start(job)
    worker.pause()
    job.go()
    bell.wait()
    assert worker.close(WAIT_S)
    assert job.closed.is_set()


def test_stop_without_a_job(worker):
    worker.stop()
    assert not worker.busy
    assert worker.poll() is None


def test_what_a_job_held_goes_when_it_has_ended(worker, bell):
    job = Gated(n=0)
    held = weakref.ref(job)
    worker.start(job)
    del job
    bell.wait()
    assert worker.poll().ended == "finished"
    with worker._changed:
        assert worker._changed.wait_for(lambda: worker._running_id is None, WAIT_S)
    assert held() is None
