"""Keeping the open drawing recoverable: a journal of all that happens to it."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from stippler.editor.messages import ERROR, INFO, WARNING, Messages

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.log import Entry
    from stippler.files.native.edit_log import EditLog
    from stippler.files.native.recovery import Keeper, Lost

PART_S = 2.0
"""How often what a run has changed is written down."""

RETRY_S = 30.0
"""How long after a failure it is tried again."""


class Keeping:
    """Follows whatever document is open, and writes down what happens to it.

    Parameters
    ----------
    root : Path or None
        The folder above what is kept; None keeps nothing.
    """

    def __init__(
        self,
        root: Path | None,
        messages: Messages,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.root, self._messages, self._clock = root, messages, clock
        self._document: Document | None = None
        self._keeper: Keeper | None = None
        self._log: EditLog | None = None
        self._name = ""
        self._path: Path | None = None
        self._lost: Lost | None = None
        self._told_s = clock()
        self._failed_s: float | None = None

    def open(
        self, document: Document, name: str, path: Path | None = None, lost: Lost | None = None
    ) -> None:
        """Keep another drawing from now on; the one before was closed as it should be.

        Parameters
        ----------
        path : Path or None
            The file it is saved in.
        lost : Lost or None
            What a crash had left of it; removed as soon as the drawing is kept anew.
        """
        self.close()
        if self.root is None:
            return
        self._document, self._name, self._path, self._lost = document, name, path, lost
        from stippler.files.native.recovery import is_open_elsewhere

        if path is not None and is_open_elsewhere(self.root, path):
            self._messages.say(
                f"{path.name} is open in another window; what is saved last replaces the other",
                WARNING,
            )
        document.follow(lambda entry: self._take(document, entry))
        self._begin()

    def saved(self, path: Path) -> None:
        """Begin anew with what is now in a file."""
        self._name, self._path = path.name, path
        if self._document is not None:
            self._begin()

    def poll(self) -> None:
        """Write down what a run has changed, now and then; look after a disk that failed."""
        now, keeper = self._clock(), self._keeper
        if self._document is None or keeper is None:
            return
        if self._document.in_run and now - self._told_s >= PART_S:
            self._told_s = now
            self._document.tell_run()
        if self._lost is not None and keeper.is_on_disk:
            self._lost.discard()
            self._lost = None
        if keeper.problem is not None and self._failed_s is None:
            self._failed_s = now
            self._messages.say(str(keeper.problem), ERROR, keeper.problem)
        elif self._failed_s is not None and keeper.is_on_disk:
            self._failed_s = None
            self._messages.say("edits are kept for recovery again", INFO)
        elif self._failed_s is not None and now - self._failed_s >= RETRY_S:
            self._failed_s = now
            self._begin()

    def close(self) -> None:
        """Forget what was kept: the drawing is closed, or saved, as a person wished."""
        if self._keeper is not None:
            self._keeper.forget()
        self._document = self._keeper = self._log = self._lost = None
        self._failed_s = None

    def _begin(self) -> None:
        """Keep the drawing as it is now."""
        if self.root is None or self._document is None:
            return
        from stippler.files.native.drawing_file import PROGRAM, members_of
        from stippler.files.native.edit_log import EditLog
        from stippler.files.native.recovery import Keeper

        self._keeper = self._keeper or Keeper(self.root)
        start = self._document.drawing.snapshot()
        self._keeper.begin(lambda: members_of(start), self._name, self._path, PROGRAM)
        self._log = EditLog(self._keeper.append, self._document)

    def _take(self, document: Document, entry: Entry) -> None:
        if self._log is not None and document is self._document:  # not one that was open before
            self._log.take(entry)
