"""Saving a drawing as a person wants it: with its history, earlier versions kept, by itself."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.editor.exports import Exports, state_mark
from stippler.editor.messages import ERROR, Messages
from stippler.jobs.exporting import Writing, save_drawing

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing
    from stippler.files.native.backups import Backups

MOST_BACKUPS, MOST_AUTOSAVE_MIN = 100, 240


@dataclass(slots=True)
class Wishes:
    """What a person has chosen of saving.

    Attributes
    ----------
    history : bool
        Whether files hold the steps of the history.
    n_backups : int
        How many earlier versions of a drawing are kept; 0 keeps none.
    autosave_min : int
        Minutes between two autosaves of a drawing that is worked on; 0 makes none.
    """

    history: bool = False
    n_backups: int = 5
    autosave_min: int = 10


class Saving:
    """Saves the open drawing, and now and then by itself, beside what a person saves.

    Autosaves are earlier versions in the program's own folder; a person's file is replaced only
    by what they save.

    Parameters
    ----------
    root : Path or None
        Where earlier versions are kept; None keeps none.

    Attributes
    ----------
    tell_desk : callable
        Returns the members that tell how the drawing is looked at, from what it came with.
    """

    def __init__(
        self,
        exports: Exports,
        messages: Messages,
        root: Path | None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.root, self.wishes = root, Wishes()
        self._exports, self._messages, self._clock = exports, messages, clock
        self.tell_desk: Callable[[bytes | None], Mapping[str, bytes]] = lambda before: {}
        self._thread: threading.Thread | None = None
        self._failure = ""
        self.begin_drawing("")

    def begin_drawing(self, name: str) -> None:
        """Take note that another drawing is open, of a name that tells it while it has no file."""
        self._name = name
        self._auto_mark: object = None
        self._since_s: float | None = None

    def save(self, document: Document, path: Path, *, is_copy: bool = False) -> None:
        """Write a drawing to its own kind of file."""
        complete = self._complete(document)
        backups = self._backups_of(path)
        most = self.wishes.n_backups

        def job(writing: Writing) -> Iterator[Path]:
            return save_drawing(complete, path, backups, most, writing)

        self._exports.start(document, path, {}, is_copy=is_copy, job=job)

    def earlier(self) -> Backups | None:
        """Return the earlier versions of the open drawing."""
        return self._backups_of(self._exports.file)

    def poll(self, document: Document | None) -> None:
        """Save by itself, if it is time to; tell of one that failed."""
        if self._failure:
            failure, self._failure = self._failure, ""
            self._messages.say(failure, ERROR)
        wait_s = 60.0 * self.wishes.autosave_min
        backups = self.earlier()
        if document is None or backups is None or not wait_s or not self.wishes.n_backups:
            return
        mark = state_mark(document)
        if not self._exports.lack(document) or mark is self._auto_mark:
            self._since_s = None
            return
        now = self._clock()
        self._since_s = now if self._since_s is None else self._since_s
        if now - self._since_s >= wait_s and not (document.in_stroke or document.in_draft):
            self._since_s, self._auto_mark = None, mark
            self._autosave(self._complete(document), backups)

    def wait(self) -> None:
        """Wait for an autosave to be done."""
        if self._thread is not None:
            self._thread.join()

    def _autosave(self, complete: Callable[[], Drawing], backups: Backups) -> None:
        most = self.wishes.n_backups

        def write() -> None:
            from stippler.files.native.drawing_file import file_bytes

            try:
                backups.keep_bytes(file_bytes(complete()), most)
            except Exception as error:  # noqa: BLE001 - the drawing lives on; the person is told
                why = str(error) or type(error).__name__
                self._failure = f"the drawing could not be saved by itself ({why}); save it"

        self.wait()
        self._thread = threading.Thread(target=write, name="autosave", daemon=True)
        self._thread.start()

    def _backups_of(self, path: Path | None) -> Backups | None:
        from stippler.files.native.backups import Backups

        return None if self.root is None else Backups(self.root, path or f"untitled {self._name}")

    def _complete(self, document: Document) -> Callable[[], Drawing]:
        """Return what makes, in another thread, the drawing with all that its file is to hold."""
        drawing = document.drawing.snapshot()
        before = drawing.foreign.members
        desk = self.tell_desk(before.get("editor.json"))
        steps = document.steps() if self.wishes.history else None
        n_done = document.history.n_done

        def complete() -> Drawing:
            from stippler.files.native.step_file import MEMBER, steps_to_bytes

            members = {name: data for name, data in before.items() if name != MEMBER} | dict(desk)
            if steps:
                members[MEMBER] = steps_to_bytes(steps, n_done, drawing)
            return replace(drawing, foreign=replace(drawing.foreign, members=members))

        return complete
