"""Work on areas that takes longer than a frame: import, proposals; one job at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from stippler.editor.messages import ERROR, Messages

if TYPE_CHECKING:
    from stippler.jobs.worker import Worker


@dataclass(frozen=True, slots=True)
class Step:
    """How far a job is; the last one has a result.

    Attributes
    ----------
    share : float
        0 to 1; below 0 is unknown.
    """

    share: float
    result: Any = None


class AreaJobs:
    """Runs a job beside everything else, and hands over its result.

    Parameters
    ----------
    worker : Worker
        The owner closes it.
    """

    def __init__(self, worker: Worker[Step], messages: Messages) -> None:
        self._worker, self._messages = worker, messages
        self._take: Callable[[Any], None] | None = None
        self._request = -1
        self.label, self.share = "", -1.0

    @property
    def busy(self) -> bool:
        """Whether a job runs."""
        return self._take is not None

    def start(
        self, label: str, job: Callable[[], Iterator[Step]], take: Callable[[Any], None]
    ) -> None:
        """Run a job instead of the one that runs; its result is given to `take`."""
        self.label, self.share, self._take = label, -1.0, take
        self._request = self._worker.start(job)

    def stop(self) -> None:
        """End the job without a result."""
        self._worker.stop()
        self._take = None

    def poll(self) -> bool:
        """Take what the job has come to; return whether anything changed."""
        update = self._worker.poll()
        if update is None or update.request_id != self._request or self._take is None:
            return False
        if update.result is not None:
            self.share = update.result.share
        if not update.ended:
            return True
        take, self._take = self._take, None
        if update.ended == "failed":
            self._messages.say(str(update.failure), ERROR, update.failure)
        elif update.result is not None and update.result.result is not None:
            take(update.result.result)
        return True
