"""Who gets an event over the canvas: what is held, the tool at hand, or the view.

The order: a key or button that holds the page (space, the middle button) has it until it comes up;
else what the tool holds; else the tool at hand may begin; what nobody wants moves the view.
"""

from __future__ import annotations

from stippler.editor.batches import PointerOwner
from stippler.editor.events import Event, KeyDown, Moved, Pressed, Released, Scrolled
from stippler.editor.painting import Painting
from stippler.editor.pointer import Pointer
from stippler.editor.pointer_states import Idle
from stippler.editor.view import View


class Hands:
    """Brings what pointer and keys do over the canvas to tools and view.

    Attributes
    ----------
    pointer : Pointer
        Where it is, and what it holds of the view.
    """

    def __init__(self, view: View, painting: Painting) -> None:
        self._view, self._painting = view, painting
        self._owner = PointerOwner()
        self.pointer = Pointer(view)

    @property
    def is_free(self) -> bool:
        """Whether the view is not held."""
        return isinstance(self.pointer.state, Idle)

    def owns(self, event: Event, *, over_panel: bool) -> bool:
        """Take note of who has the pointer; return whether the canvas does.

        To be asked once for every event, in order.
        """
        return not self._owner.is_panel(event, over_panel=over_panel)

    def take(self, event: Event, *, elsewhere: bool) -> None:
        """Take an event; `elsewhere` is whether a panel has the pointer."""
        if not self._offer(event, elsewhere=elsewhere):
            self.pointer.take(event, elsewhere=elsewhere)

    def take_key(self, event: KeyDown) -> bool:
        """Take a key before commands have it: what is held keeps it, and Esc puts things away."""
        painting = self._painting
        if not (painting.is_busy or painting.wants(event) or painting.leave(event)):
            return False
        self._offer(event, elsewhere=False)
        return True

    def _offer(self, event: Event, *, elsewhere: bool) -> bool:
        """Offer an event to the tool; return whether it was for it."""
        if isinstance(event, Moved | Pressed | Released | Scrolled):
            follows = self._painting.is_busy and isinstance(event, Moved)  # an open polygon does
            if not (follows or (self.is_free and not elsewhere)):
                return False
            event = self.pointer.local(event)
        return self._painting.take(event, self._view.at, self._view.camera.px_per_mm)
