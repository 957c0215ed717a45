"""Writing drawings to files, and what of a person's work no file holds yet."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.editor.messages import ERROR, Messages
from stippler.jobs import work

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.jobs.worker import Update, Worker


_NEVER = object()


class Exports:
    """The file being written, and the file that the open drawing was last written to.

    Parameters
    ----------
    worker : Worker
        Where files are written; the owner closes it.

    Attributes
    ----------
    path : Path or None
        The file that the open drawing was last written to.
    n_written : int
        How many files have been written so far.
    """

    def __init__(self, worker: Worker[Path], messages: Messages) -> None:
        self._worker, self._messages = worker, messages
        self._request: int | None = None
        self._writing = work.Writing()
        self.n_written = 0
        self.begin_drawing()

    @property
    def busy(self) -> bool:
        """Whether a file is being written."""
        return self._request is not None

    @property
    def n_bytes(self) -> int:
        """How much of the file has been written."""
        return self._writing.n_bytes

    def give_up(self) -> None:
        """End the writing at its next piece; what stood there before stays."""
        self._writing.given_up = True

    def begin_drawing(self) -> None:
        """Take note that another drawing is open."""
        self.path: Path | None = None
        self._written_mark: object = _NEVER
        self._mark: object = _NEVER

    def start(
        self,
        document: Document,
        path: Path,
        options: Mapping[str, Any],
        inputs: tuple[Path, ...] = (),
    ) -> None:
        """Write a drawing as it is now.

        Parameters
        ----------
        options : mapping
            Of the file's format; see `stippler.export.save`.
        inputs : paths
            The files that the drawing was made from, which are never written over.
        """
        drawing = document.drawing.snapshot()
        self._writing = writing = work.Writing()
        self._request = self._worker.start(
            lambda: work.export_drawing(drawing, path, options, inputs, writing)
        )
        self._mark = _mark(document)
        self._messages.say(f"writing {path.name}")

    def lack(self, document: Document) -> bool:
        """Return whether work of a person's hand is in the drawing and not in its file."""
        if document.in_stroke:
            return True
        if _mark(document) is self._written_mark:
            return False
        history = document.history
        return any(not step.of_job for step in history.steps[: history.n_done])

    def poll(self) -> bool:
        """Take what the worker has done; return whether anything changed."""
        update = self._worker.poll()
        return update is not None and self._apply(update)

    def _apply(self, update: Update[Path]) -> bool:
        """Take an export's update; that of an old request changes nothing."""
        if update.request_id != self._request or not update.ended:
            return False
        self._request = None
        if update.failure is not None:
            self._messages.say(str(update.failure), ERROR, update.failure.__cause__)
        elif update.ended == "finished" and update.result is not None:
            self.n_written += 1
            if self._mark is not _NEVER:  # else another drawing has been opened meanwhile
                self.path, self._written_mark = update.result, self._mark
            self._messages.say(f"{update.result} is written")
        return True


def _mark(document: Document) -> object:
    """Return what tells a state of the dots from others: the last step; None is the beginning."""
    if document.in_draft or document.in_run or document.in_stroke:
        return object()  # like no other
    return document.history.undone
