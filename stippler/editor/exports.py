"""Writing drawings to files, and what of a person's work no file holds yet."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.editor.messages import ERROR, WARNING, Messages
from stippler.jobs.exporting import Writing, export_drawing

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.jobs.worker import Update, Worker


_NEVER = object()

SAVED = ".stipple"
"""Ending of files that hold all of a drawing; others are exports."""


@dataclass(frozen=True, slots=True)
class FailedSave:
    """A save that came to nothing.

    Attributes
    ----------
    path : Path
        The file that was to be written; what stood there still does.
    why : str
    is_copy : bool
        Whether it was to be a copy.
    """

    path: Path
    why: str
    is_copy: bool


class Exports:
    """The file being written, and the file that the open drawing was last written to.

    Parameters
    ----------
    worker : Worker
        Where files are written; the owner closes it.

    Attributes
    ----------
    path : Path or None
        The file that the open drawing was last exported to.
    file : Path or None
        The file that it is saved in.
    n_written : int
        How many files have been written so far.
    differs : bool
        Whether the drawing was opened as another than its file holds.
    failed : FailedSave or None
        The last save, if it failed and nobody has been asked yet what to do.
    writing : Path or None
        The file that is being written, or was last.
    """

    def __init__(self, worker: Worker[Path], messages: Messages) -> None:
        self._worker, self._messages = worker, messages
        self._request: int | None = None
        self._writing = Writing()
        self._expected_bytes = 0
        self.writing: Path | None = None
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

    @property
    def share(self) -> float | None:
        """How much of the file is there; None where that is not known."""
        if not self._expected_bytes or not self.n_bytes:
            return None
        return min(self.n_bytes / self._expected_bytes, 1.0)

    @property
    def is_given_up(self) -> bool:
        """Whether the writing ends at its next piece."""
        return self._writing.given_up

    def give_up(self) -> None:
        """End the writing at its next piece; what stood there before stays."""
        self._writing.given_up = True

    def begin_drawing(self, file: Path | None = None, saved: Document | None = None) -> None:
        """Take note that another drawing is open.

        Parameters
        ----------
        file : Path or None
            What it is saved in.
        saved : Document or None
            The drawing, if the file holds it as it is.
        """
        self.path: Path | None = None
        self.file = file
        self.failed: FailedSave | None = None
        self.differs = False
        self._seen = _seen(file)
        self._written_mark: object = _NEVER
        self._mark: object = _NEVER
        self._is_copy = False
        if file is not None and saved is not None:
            self._written_mark = state_mark(saved)

    @property
    def is_changed_on_disk(self) -> bool:
        """Whether the file that the drawing is saved in has been changed by another program."""
        return self.file is not None and _seen(self.file) != self._seen

    def allow_replacing(self) -> None:
        """Take the file on disk as it is now: the next save may replace it."""
        self._seen = _seen(self.file)

    def start(
        self,
        document: Document,
        path: Path,
        options: Mapping[str, Any],
        inputs: tuple[Path, ...] = (),
        *,
        is_copy: bool = False,
        expected_bytes: int = 0,
        job: Callable[[Writing], Iterator[Path]] | None = None,
    ) -> None:
        """Write a drawing as it is now.

        Parameters
        ----------
        options : mapping
            Of the file's format; see `stippler.export.save`.
        is_copy : bool
            Whether the drawing stays that of the file it was saved in before.
        inputs : paths
            The files that the drawing was made from, which are never written over.
        expected_bytes : int
            About how large the file will be; 0 is not known.
        job : callable, optional
            Writes it, in place of what `options` would.
        """
        self.writing, self._expected_bytes = path, expected_bytes
        drawing = document.drawing.snapshot() if job is None else document.drawing
        self._writing = writing = Writing()
        self.failed = None
        self._request = self._worker.start(
            lambda: (
                job(writing)
                if job is not None
                else export_drawing(drawing, path, options, inputs, writing)
            )
        )
        self._mark, self._is_copy = state_mark(document), is_copy
        self._messages.say(f"writing {path.name}")

    def lack(self, document: Document) -> bool:
        """Return whether work of a person's hand is in the drawing and not in its file."""
        if document.in_stroke or self.differs:
            return True
        if state_mark(document) is self._written_mark:
            return False
        history = document.history
        return any(not step.of_job for step in history.steps[: history.n_done])

    def poll(self) -> Path | None:
        """Take what the worker has done; return what has been written or has failed to be."""
        update = self._worker.poll()
        return self._apply(update) if update is not None else None

    def _apply(self, update: Update[Path]) -> Path | None:
        """Take an export's update; that of an old request changes nothing."""
        if update.request_id != self._request or not update.ended:
            return None
        self._request = None
        if update.failure is not None and self._writing.given_up:
            self._messages.say(str(update.failure))
        elif update.failure is not None:
            self._messages.say(str(update.failure), ERROR, update.failure.__cause__)
            path, is_open = self.writing, self._mark is not _NEVER
            if is_open and path is not None and path.suffix.lower() == SAVED:
                self.failed = FailedSave(path, str(update.failure), self._is_copy)
        elif update.ended == "finished" and update.result is not None:
            self.n_written += 1
            if self._mark is not _NEVER:  # else another drawing has been opened meanwhile
                self._note(update.result)
            self._messages.say(f"{update.result} is written")
            if self._writing.note:
                self._messages.say(self._writing.note, WARNING)
            return update.result
        return Path()

    def _note(self, path: Path) -> None:
        """Remember where the drawing is now."""
        if path.suffix.lower() != SAVED:
            self.path = path
        elif not self._is_copy:
            self.file, self._seen, self._written_mark = path, _seen(path), self._mark
            self.differs = False


def _seen(path: Path | None) -> tuple[int, int] | None:
    """Return what tells a file's content from another's; None where there is no file."""
    try:
        status = path.stat() if path is not None else None
    except OSError:
        return None
    return (status.st_mtime_ns, status.st_size) if status is not None else None


def state_mark(document: Document) -> object:
    """Return what tells a state of the dots from others: the last step; None is the beginning."""
    if document.in_draft or document.in_run or document.in_stroke:
        return object()  # like no other
    return document.history.undone


def bytes_text(n: int) -> str:
    """Return a size as people say it."""
    for unit, name, decimals in ((1e6, "MB", 1), (1e3, "kB", 0)):
        if n >= unit:
            return f"{n / unit:.{decimals}f} {name}"
    return f"{n} bytes"
