"""Before and after: the picture, or the drawing before its last step, while a key is held."""

from __future__ import annotations

from stippler.editor.events import Event, FocusLost, KeyDown, KeyUp, Pressed
from stippler.editor.painting import Painting
from stippler.editor.session import Session
from stippler.ui.look import Look

PICTURE, BEFORE = "picture", "before"


class Peek:
    """Shows something else for as long as a key is held; a button that is pressed ends it."""

    def __init__(self, look: Look, session: Session, painting: Painting) -> None:
        self._look, self._session, self._painting = look, session, painting
        self._down: KeyDown | None = None  # the event that is being taken
        self._key = ""
        self._undone: object = None  # the step that is taken back meanwhile

    def take(self, event: Event) -> None:
        """Look at an event before the commands have it."""
        self._down = event if isinstance(event, KeyDown) and not event.repeated else None
        match event:
            case KeyUp(key=key) if key == self._key:
                self.end()
            case Pressed() | FocusLost() if self._look.peek:
                self.end()
            case KeyDown(key=key) if self._look.peek and key != self._key:
                self.end()

    def let_pass(self) -> None:
        """Take note that the event has been taken."""
        self._down = None

    def show_picture(self) -> None:
        """Show the picture alone, without dots."""
        if self._session.reference is not None:
            self._begin(PICTURE)

    def show_before(self) -> None:
        """Show the drawing as it was before its last step."""
        document = self._session.document
        if document is None or self._painting.is_busy or self._session.busy:
            return
        step = document.history.undone
        if step is None:
            return
        self._painting.undo()
        if document.history.undone is not step:
            self._undone = step
            self._begin(BEFORE)

    def _begin(self, what: str) -> None:
        if self._look.peek:  # from a menu, a second choice ends it
            self.end()
            return
        self._look.peek = what
        self._key = self._down.key if self._down is not None else ""

    def end(self) -> None:
        """Show the drawing again."""
        self._look.peek, self._key = "", ""
        step, self._undone = self._undone, None
        document = self._session.document
        if step is not None and document is not None and document.history.redone is step:
            self._painting.redo()
