"""What was chosen before and after each step of the history, so that undo brings it back."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

from stippler.editor.tools.selection import NO_IDS, Ids, Selection

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.history import Step

_MOST_BYTES = 32 << 20


class SelectionMemory:
    """Restores the selection as steps are undone and done again."""

    def __init__(self, selection: Selection) -> None:
        self._selection = selection
        self._before: Ids = NO_IDS
        # newest last; what is known of a step goes with it
        self._kept: WeakKeyDictionary[Step, tuple[Ids, Ids | None]] = WeakKeyDictionary()

    def note(self, document: Document) -> None:
        """Take note of what is chosen now; to be called before anything that may be a step."""
        if not document.in_stroke:
            self._before = self._selection.ids

    def keep(self, document: Document) -> None:
        """Take note that something was done: the last step, if it is a new one."""
        step = document.history.undone
        if step is not None and step not in self._kept:
            self._kept[step] = (self._before, None)
            self._forget_oldest()

    def undone(self, step: Step) -> None:
        """Choose what was chosen before a step that has been taken back."""
        if step in self._kept:
            before, _ = self._kept[step]
            self._kept[step] = (before, self._selection.ids)
            self._selection.choose(before)

    def redone(self, step: Step) -> None:
        """Choose what was chosen after a step that has been done again."""
        if step in self._kept and (after := self._kept[step][1]) is not None:
            self._selection.choose(after)

    def _forget_oldest(self) -> None:
        """Keep no more than fits; steps with the same selection share it."""
        sizes = {
            id(ids): ids.nbytes for pair in self._kept.values() for ids in pair if ids is not None
        }
        if sum(sizes.values()) > _MOST_BYTES:
            for step in list(self._kept)[: len(self._kept) // 4 + 1]:
                del self._kept[step]
