"""One background thread that runs one job at a time and hands its latest result to the UI."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar

from stippler.errors import StipplerError
from stippler.kernels.machine.pool import stand_back

Result = TypeVar("Result")


@dataclass(frozen=True, slots=True)
class Request(Generic[Result]):
    """Work to do: an id, and a function that holds all its frozen inputs.

    `run` yields results, each newer and more complete than the one before, at least every 50 ms
    of work; between two of them the worker looks for a pause or a stop.
    """

    id: int
    run: Callable[[], Iterator[Result]]


@dataclass(frozen=True, slots=True)
class Update(Generic[Result]):
    """What became of a request so far.

    Attributes
    ----------
    result : object or None
        The latest the job yielded; None before the first, and then only with an end.
    ended : {"", "finished", "stopped", "failed"}
        Empty while the job runs.
    failure : StipplerError or None
        Why it failed, ready to be shown.
    n_results : int
        How many results the job has yielded, those that nobody took included.
    """

    request_id: int
    result: Result | None
    ended: str
    failure: StipplerError | None
    n_results: int


class Worker(Generic[Result]):
    """Runs requests in a thread of its own; all methods are for the one thread that owns it.

    Parameters
    ----------
    wake : callable
        Called from the worker thread, once, when an update waits that was not there before.
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._changed = threading.Condition()
        self._pending: Request[Result] | None = None
        self._update: Update[Result] | None = None
        self._running_id: int | None = None
        self._paused = False
        self._stop = False  # the job that runs now
        self._closed = False
        self._last_id = 0
        self._thread = threading.Thread(target=self._loop, name="worker", daemon=True)
        self._thread.start()

    def start(self, run: Callable[[], Iterator[Result]]) -> int:
        """Ask for a job; one that runs or waits is superseded. Return the request's id."""
        with self._changed:
            self._last_id += 1
            self._pending = Request(self._last_id, run)
            self._stop, self._paused, self._update = True, False, None
            self._changed.notify_all()
            return self._last_id

    def stop(self) -> None:
        """Ask the job to end at its next result; what it yielded before stays valid."""
        with self._changed:
            self._stop, self._paused, self._pending = True, False, None
            self._changed.notify_all()

    def pause(self, paused: bool = True) -> None:
        """Hold the job at its next result, or let it go on."""
        with self._changed:
            self._paused = paused
            self._changed.notify_all()

    @property
    def busy(self) -> bool:
        """Whether a job runs, is paused or waits."""
        with self._changed:
            return self._running_id is not None or self._pending is not None

    @property
    def paused(self) -> bool:
        """Whether the job is held."""
        with self._changed:
            return self._paused

    def poll(self) -> Update[Result] | None:
        """Take the latest update, if there is one; those in between are gone."""
        with self._changed:
            update, self._update = self._update, None
            return update

    def close(self, timeout_s: float | None = 5.0) -> bool:
        """Stop the job and end the thread; return whether it ended in time. None waits for it."""
        with self._changed:
            self._closed = self._stop = True
            self._paused, self._pending = False, None
            self._changed.notify_all()
        self._thread.join(timeout_s)
        return not self._thread.is_alive()

    # --- in the worker thread ---------------------------------------------------------------

    def _loop(self) -> None:
        stand_back()
        while self._has_next():
            self._run()

    def _has_next(self) -> bool:
        """Wait for a request; return whether there is one, and not the end."""
        with self._changed:
            self._running_id = None
            self._changed.notify_all()
            while self._pending is None and not self._closed:
                self._changed.wait()
            return self._pending is not None

    def _next(self) -> Request[Result] | None:
        """Take the request that waits, unless it has been taken back since it was seen."""
        with self._changed:
            request, self._pending = self._pending, None
            if request is not None:
                self._running_id, self._stop = request.id, False
            return request

    def _run(self) -> None:
        request = self._next()  # known here alone, so that its inputs go when it has ended
        if request is None:
            return
        n, result = 0, None
        ended, failure = "finished", None
        try:
            steps = request.run()
            for result in steps:
                n += 1
                if not self._publish(Update(request.id, result, "", None, n)):
                    ended = "stopped"
                    close = getattr(steps, "close", None)
                    if close is not None:
                        close()
                    break
        except StipplerError as error:
            ended, failure = "failed", error
        except MemoryError:
            ended = "failed"
            failure = StipplerError("not enough memory", do="ask for fewer dots or a smaller page")
        except Exception as error:  # noqa: BLE001 - errors travel as values; the thread lives on
            ended = "failed"
            failure = StipplerError(
                f"unexpected {type(error).__name__}: {error}", do="please report this"
            )
            failure.__cause__ = error
        self._publish(Update(request.id, result, ended, failure, n))

    def _publish(self, update: Update[Result]) -> bool:
        """Offer an update; return whether the job may go on, after any pause is over."""
        with self._changed:
            superseded = self._pending is not None
            if not superseded and not self._closed:
                fresh, self._update = self._update is None, update
                if fresh:
                    self._wake()
            while self._paused and not self._stop and not update.ended:
                self._changed.wait()
            return not (self._stop or superseded or self._closed)
