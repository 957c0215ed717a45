"""Painting on a session's drawing: brings input to the tools, and tells what went wrong."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.brushes.presets import presets_path
from stippler.camera import Point
from stippler.drawing.one_step import as_one_step
from stippler.editor.events import LEFT, NO_MODS, Event, KeyDown, Pressed
from stippler.editor.messages import ERROR, WARNING
from stippler.editor.selection_memory import SelectionMemory
from stippler.editor.session import Session
from stippler.editor.tools.toolbox import Toolbox
from stippler.errors import StipplerError

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.preview import Preview
    from stippler.drawing.shape_change import ShapeChange
    from stippler.editor.tools.tool import Desk

Action = Callable[["Document"], None]


class Painting:
    """The toolbox on the desk of a session.

    Attributes
    ----------
    toolbox : Toolbox
    """

    def __init__(self, session: Session) -> None:
        self._session = session
        self.toolbox = Toolbox(presets_path(), session.messages.say)
        self._memory = SelectionMemory(self.toolbox.selection)
        self._document: Document | None = None

    @property
    def is_busy(self) -> bool:
        """Whether a stroke or a selection is under way."""
        return self.toolbox.is_busy

    def take(self, event: Event, page: Callable[[float, float], Point], px_per_mm: float) -> bool:
        """Take an event in pixels of the canvas; return whether it was for a tool."""
        self._follow_session()
        if self._document is None or not self._session.paintable:
            if not self._is_wanted(event):
                return False
            if not self._session.take_over():
                return self._refuse()
            self._follow_session()
        return self._hand_on(event, page, px_per_mm)

    def _hand_on(
        self, event: Event, page: Callable[[float, float], Point], px_per_mm: float
    ) -> bool:
        assert self._document is not None
        self._memory.note(self._document)
        try:
            return self.toolbox.take(event, self._document, page, px_per_mm)
        except Exception as error:  # noqa: BLE001 - the stroke is taken back; the editor lives on
            self._report(error)
            return True
        finally:
            self._memory.keep(self._document)

    def tick(self, now_s: float) -> None:
        """Let time go on."""
        self._follow_session()
        try:
            self.toolbox.rest(now_s)
        except Exception as error:  # noqa: BLE001 - the stroke is taken back; the editor lives on
            self._report(error)

    def _is_wanted(self, event: Event) -> bool:
        """Whether an event is one that begins to paint."""
        pressed = isinstance(event, Pressed) and event.button == LEFT
        return pressed and self.toolbox.tool is not None

    def _refuse(self) -> bool:
        if self._session.busy:
            text = "the first dots are being placed; paint as soon as they move, or stop the work"
        else:
            text = "there is no page to paint on; open a picture, or begin a new page"
        self._session.messages.say(text, WARNING)
        return True

    def _follow_session(self) -> None:
        """Give up what was held when another drawing is open, or new dots are being made."""
        now = self._session.document
        if now is not self._document:
            self.toolbox.drop(None)
            self._document = now
        elif now is not None and self.toolbox.is_busy and not self._session.paintable:
            self.toolbox.drop(now)

    def _report(self, error: Exception) -> None:
        if isinstance(error, StipplerError):
            self._session.messages.say(str(error), WARNING)
            return
        what = str(error).strip().partition("\n")[0][:120]
        text = f"the brush failed ({type(error).__name__}: {what}); the stroke is taken back"
        self._session.messages.say(text, ERROR, error)

    # --- changes of shape -------------------------------------------------------------------

    def preview(self, at_mm: Point | None) -> Preview | None:
        """Return what the brush would do where the pointer is, to be shown; None elsewhere."""
        if at_mm is None or self._document is None or not self._session.paintable:
            return None
        return self.toolbox.preview(at_mm, self._session.reference)

    def reshape(self, label: str, change: ShapeChange, *, selected: bool) -> None:
        """Change the shapes of all dots, or of the chosen ones."""
        from stippler.brushes.selection import alive
        from stippler.brushes.shape import reshape

        def act(document: Document) -> None:
            rows = alive(document, self._ids) if selected else np.arange(len(document.dots))
            reshape(document, rows, change)

        self.act(label, act)

    # --- the selection ----------------------------------------------------------------------

    @property
    def n_selected(self) -> int:
        """How many of the chosen dots are there."""
        if self._document is None:
            return 0
        return int((self._document.rows(self.toolbox.selection.ids) >= 0).sum())

    def selected_box(self) -> tuple[Point, Point] | None:
        """Return the corners of what encloses the chosen dots, in mm; None without any."""
        if self._document is None:
            return None
        rows = self._document.rows(self.toolbox.selection.ids)
        dots, rows = self._document.dots, rows[rows >= 0]
        if not len(rows):
            return None
        place, radius = dots.position_mm[rows], dots.radius_mm[rows, None]
        low, high = (place - radius).min(axis=0), (place + radius).max(axis=0)
        return (float(low[0]), float(low[1])), (float(high[0]), float(high[1]))

    def select_all(self) -> None:
        """Choose every dot."""
        if self._document is not None and self._session.paintable:
            self.toolbox.selection.choose(self._document.dots.id.copy(), NO_MODS)

    def select_none(self) -> None:
        """Choose no dot."""
        self.toolbox.selection.choose(np.empty(0, np.int64), NO_MODS)

    def delete(self) -> None:
        """Remove the chosen dots."""
        from stippler.brushes import selection

        self.act("Delete selection", lambda e: selection.delete(e, self._ids))

    def duplicate(self) -> None:
        """Copy the chosen dots, and choose the copies."""
        from stippler.brushes import selection

        def act(document: Document) -> None:
            copies = selection.duplicate(document, self._ids)
            self.toolbox.selection.choose(copies, NO_MODS)

        self.act("Duplicate selection", act)

    def fix(self, fixed: bool) -> None:
        """Fix or free the chosen dots."""
        from stippler.brushes import selection

        label = "Fix selection" if fixed else "Free selection"
        self.act(label, lambda e: selection.fix(e, self._ids, fixed))

    def relax(self) -> None:
        """Relax the chosen dots by one step."""
        from stippler.brushes import selection

        self.act("Relax selection", lambda e: selection.relax(e, self._ids))

    def jitter(self) -> None:
        """Shift the chosen dots at random."""
        from stippler.brushes import selection

        seed = zlib.crc32(self._ids.tobytes()) + len(self._session.messages.log)
        rng = np.random.default_rng(seed)
        self.act("Jitter selection", lambda e: selection.shake(e, self._ids, rng))

    def resize(self, percent: float) -> None:
        """Enlarge the chosen dots, or reduce them below 0."""
        from stippler.brushes import selection

        self.act("Resize selection", lambda e: selection.resize(e, self._ids, percent))

    @property
    def _ids(self) -> NDArray[np.int64]:
        return self.toolbox.selection.ids

    def act(self, label: str, act: Action) -> None:
        """Do something as a stroke of its own, whole or not at all."""
        document = self._document
        if document is None or not self._session.paintable or self.is_busy:
            return
        self._memory.note(document)
        try:
            as_one_step(document, label, act)
        except Exception as error:  # noqa: BLE001 - taken back; the editor lives on
            self._report(error)
            return
        self._memory.keep(document)

    # --- the history ------------------------------------------------------------------------

    def go_to(self, n_done: int) -> None:
        """Undo or redo until so many steps are in effect."""
        document = self._document
        if document is None or self.is_busy:
            return
        history = document.history
        while (before := history.n_done) > n_done and self._session.paintable:
            self.undo()
            if history.n_done != before - 1:
                return  # steps were lost, which is said
        while (before := history.n_done) < min(n_done, len(history.steps)):
            self.redo()
            if history.n_done == before:
                return

    def undo(self) -> None:
        """Take the last step back; not within a stroke."""
        if self.is_busy or self._session.document is None:
            return
        history = self._session.document.history
        step = history.undone
        self._session.undo()
        if step is not None and history.undone is not step:
            self._memory.undone(step)

    def redo(self) -> None:
        """Do the last undone step again."""
        if self.is_busy or self._session.document is None:
            return
        history = self._session.document.history
        step = history.redone
        self._session.redo()
        if step is not None and history.redone is not step:
            self._memory.redone(step)

    def at_desk(self, act: Callable[[Desk], None], px_per_mm: float) -> None:
        """Do something as the tool at hand would."""
        self._follow_session()
        document = self._document
        if document is None or not self._session.paintable or self.is_busy:
            return
        self._memory.note(document)
        try:
            act(self.toolbox.desk(document, lambda x, y: (x, y), px_per_mm))
        except Exception as error:  # noqa: BLE001 - the stroke is taken back; the editor lives on
            if document.in_stroke:
                document.cancel()
            self._report(error)
        self._memory.keep(document)

    def wants(self, event: KeyDown) -> bool:
        """Return whether a key is for the tool at hand, before any command has it."""
        if self._document is None or not self._session.paintable:
            return False
        return self.toolbox.wants(event, self._document)

    def leave(self, event: KeyDown) -> bool:
        """Take Escape while nothing is held: first the selection goes, then the brush."""
        if event.key != "escape" or self.is_busy:
            return False
        if len(self.toolbox.selection.ids):
            self.select_none()
        elif self.toolbox.tool is not None:
            self.toolbox.choose("")
        else:
            return False
        return True
