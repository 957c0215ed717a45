"""What was chosen before and after each step of the history, so that undo brings it back."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stippler.editor.tools.selection import NO_IDS, Ids, Selection

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.history import Step

_MOST = 2_000


class SelectionMemory:
    """Restores the selection as steps are undone and done again."""

    def __init__(self, selection: Selection) -> None:
        self._selection = selection
        self._before: Ids = NO_IDS
        self._kept: dict[int, tuple[Step, Ids, Ids | None]] = {}  # by identity; newest last

    def note(self, document: Document) -> None:
        """Take note of what is chosen now; to be called before anything that may be a step."""
        if not document.in_stroke:
            self._before = self._selection.ids

    def keep(self, document: Document) -> None:
        """Take note that something was done: the last step, if it is a new one."""
        step = document.history.undone
        if step is not None and id(step) not in self._kept:
            self._kept[id(step)] = (step, self._before, None)
            while len(self._kept) > _MOST:
                del self._kept[next(iter(self._kept))]

    def undone(self, step: Step) -> None:
        """Choose what was chosen before a step that has been taken back."""
        if id(step) in self._kept:
            _, before, _ = self._kept[id(step)]
            self._kept[id(step)] = (step, before, self._selection.ids)
            self._selection.choose(before)

    def redone(self, step: Step) -> None:
        """Choose what was chosen after a step that has been done again."""
        if id(step) in self._kept and (after := self._kept[id(step)][2]) is not None:
            self._selection.choose(after)
