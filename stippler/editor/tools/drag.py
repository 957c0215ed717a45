"""The state of a tool while something follows the pointer."""

from __future__ import annotations

from abc import ABC, abstractmethod

from stippler.editor.events import LEFT, Event, FocusLost, KeyDown, Moved, Released
from stippler.editor.tools.tool import RESTING, Desk, Point, ToolState


class Drag(ABC):
    """Follows the pointer until the button comes up, or Escape puts all back."""

    __slots__ = ()

    def take(self, event: Event, desk: Desk) -> ToolState:
        """Follow the pointer; let go, or put all back."""
        match event:
            case Moved():
                self._follow(desk.at(event), desk)
            case Released(button=button) if button == LEFT:
                return self._let_go(desk)
            case KeyDown(key="escape"):
                self.cancel(desk)
                return RESTING
            case FocusLost():
                return self._let_go(desk)
        return self  # type: ignore[return-value]  # each has an overlay of its own

    @abstractmethod
    def cancel(self, desk: Desk) -> None:
        """Take back what has been dragged."""

    @abstractmethod
    def _follow(self, at: Point, desk: Desk) -> None:
        """Bring what is held to a place on the page."""

    @abstractmethod
    def _let_go(self, desk: Desk) -> ToolState:
        """Keep it where it is; return the state that comes next."""
