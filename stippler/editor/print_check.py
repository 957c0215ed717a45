"""What print would spoil, shown one after the other in the drawing, and repaired as one step."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.visible import shown
from stippler.editor.events import NO_MODS
from stippler.editor.messages import INFO, WARNING

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.editor.painting import Painting
    from stippler.editor.session import Session
    from stippler.editor.view import View
    from stippler.files.checks import Findings, Process

_AROUND_MM = 4.0  # what is shown around a fault


class PrintCheck:
    """Commands that look for faults at the size the drawing has.

    Attributes
    ----------
    process : Process or None
        What the print can do; None: dots of 0.1 mm, gaps of 0.05 mm, a gain of 0.01 mm.
    """

    def __init__(self, session: Session, painting: Painting, view: View) -> None:
        self._session, self._painting, self._view = session, painting, view
        self.process: Process | None = None
        self._shown = -1

    def show_next(self) -> None:
        """Choose the dots of the next fault, and bring them into view."""
        document = self._session.document
        if document is None or not len(document.dots):
            return
        faults = list(_faults(self._found(document)))
        if not faults:
            self._session.messages.say("nothing that print would spoil")
            return
        self._shown = (self._shown + 1) % len(faults)
        what, rows = faults[self._shown]
        dots = shown(document.drawing).dots
        self._painting.toolbox.selection.choose(dots.id[rows], NO_MODS)
        place = dots.position_mm[rows]
        low, high = place.min(axis=0) - _AROUND_MM, place.max(axis=0) + _AROUND_MM
        self._view.show_box((float(low[0]), float(low[1])), (float(high[0]), float(high[1])))
        text = f"{self._shown + 1:,} of {len(faults):,}: {what}"
        self._session.messages.say(text, WARNING)

    def repair(self) -> None:
        """Repair what can be, as one step of the history."""
        document = self._session.document
        if document is None:
            return
        before = self._found(document)
        self._painting.act("Repair for print", lambda some: _repair(some, self._process()))
        after = self._found(document)
        told = f"{before.n:,} faults for print, {after.n:,} after the repair"
        self._session.messages.say(told, WARNING if after.n else INFO)
        self._shown = -1

    def _process(self) -> Process:
        from stippler.files.checks import Process

        return self.process or Process()

    def _found(self, document: Document) -> Findings:
        from stippler.files.checks import check

        return check(shown(document.drawing), self._process())


def _faults(found: Findings) -> Iterator[tuple[str, NDArray[np.int64]]]:
    """Yield what is wrong, and the rows of the dots concerned."""
    pairs = {tuple(pair) for pair in found.too_close.tolist()}
    others = [pair for pair in found.bleeding.tolist() if tuple(pair) not in pairs]
    bleeding = np.array(others, np.int64).reshape(-1, 2)
    for what, those in (
        ("the dot is too small", found.too_small),
        ("the dot lies beside the page", found.off_page),
        ("the page's edge cuts the dot", found.cut),
        ("the gap between the dots is too narrow", found.too_close),
        ("the dots grow together as ink spreads", bleeding),
    ):
        for rows in those:
            yield what, np.atleast_1d(rows)


def _repair(document: Document, process: Process) -> None:
    """Change what differs between the dots and the repaired ones, within a stroke."""
    from stippler.files.checks import repaired

    visible = shown(document.drawing)
    made = repaired(visible, process)
    gone = np.setdiff1d(visible.dots.id, made.id)
    document.remove(document.rows(gone))
    rows = document.rows(made.id)
    dots = document.dots
    moved = (dots.position_mm[rows] != made.position_mm).any(axis=1)
    sized = dots.radius_mm[rows] != made.radius_mm
    document.move(rows[moved], made.position_mm[moved])
    document.change("radius_mm", rows[sized], made.radius_mm[sized])
