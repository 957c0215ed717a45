"""Asking before work of a person's hand is lost."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from imgui_bundle import imgui

from stippler.editor.session import Session
from stippler.ui.popups.file_dialogs import POPUP, center
from stippler.ui.widgets import Widgets

_ASK, _WAIT = "Save your changes first?", "A file is being written"
_WIDTH = 440.0


@dataclass(slots=True)
class _Pending:
    """What is held back, and why: the person is asked, exports, or a file is being written.

    `n_written` is how many files had been written when it was held back.
    """

    what: str
    act: Callable[[], None]
    state: Literal["asking", "exporting", "waiting"]
    n_written: int


class Guard:
    """Holds back what would lose changes, until the person has decided.

    Parameters
    ----------
    export : callable
        Asks where to write the drawing.
    is_choosing : callable
        Whether that question is still open.
    """

    def __init__(
        self, session: Session, export: Callable[[], None], is_choosing: Callable[[], bool]
    ) -> None:
        self._session, self._export, self._is_choosing = session, export, is_choosing
        self._pending: _Pending | None = None

    @property
    def is_open(self) -> bool:
        """Whether something is held back."""
        return self._pending is not None

    def then(self, what: str, act: Callable[[], None], *, leaving: bool = False) -> None:
        """Do something that closes the drawing, at once or when the person has decided.

        Parameters
        ----------
        what : str
            As a sentence begins: "Quitting".
        leaving : bool
            Whether it would end the program; a file that is being written is finished first.
        """
        if self._pending is not None:  # asked twice is not answered
            return
        session = self._session
        n_written = session.exports.n_written
        if session.exporting and (leaving or session.unsaved):
            self._pending = _Pending(what, act, "waiting", n_written)
        elif session.unsaved:
            self._pending = _Pending(what, act, "asking", n_written)
        else:
            act()

    def draw(self, widgets: Widgets) -> None:
        """Draw the question, or go on with what was held back."""
        pending, session = self._pending, self._session
        if pending is None:
            return
        if pending.state == "asking":
            self._draw_question(widgets, pending)
        elif self._is_choosing():
            pass
        elif session.exporting:
            self._draw_wait(widgets)
        elif session.exports.n_written == pending.n_written:
            self._pending = None  # the file could not be written, or none was chosen
        elif session.unsaved and pending.state == "waiting":
            pending.state = "asking"
        else:
            self._go_on(pending)

    def _go_on(self, pending: _Pending) -> None:
        self._pending = None
        pending.act()

    def _draw_question(self, widgets: Widgets, pending: _Pending) -> None:
        imgui.open_popup(_ASK)
        center(_WIDTH * widgets.scale)
        if not imgui.begin_popup_modal(_ASK, None, POPUP)[0]:
            return
        widgets.heading(_ASK)
        widgets.paragraph(f"No file holds what you have changed in {self._session.name}.")
        widgets.caption(f"{pending.what} discards it.")
        discarded, cancelled, exported = self._draw_answers(widgets)
        if discarded or cancelled or exported:
            imgui.close_current_popup()
        imgui.end_popup()
        if exported:
            pending.state = "exporting"
            self._export()
        elif cancelled:
            self._pending = None
        elif discarded:
            self._go_on(pending)

    def _draw_answers(self, widgets: Widgets) -> tuple[bool, bool, bool]:
        width, gap = 104.0 * widgets.scale, widgets.gap
        imgui.dummy((0.0, 2.0 * widgets.scale))
        discarded = widgets.button("Discard", "Lets the changes go.", width=width)
        imgui.same_line(imgui.get_window_width() - 2 * width - gap - widgets.margin)
        cancelled = widgets.button("Cancel", "Leaves everything as it is (Esc).", width=width)
        imgui.same_line(0.0, gap)
        exported = widgets.button(
            "Save", "Saves the drawing, then goes on.", width=width, primary=True
        )
        imgui.set_item_default_focus()  # where the keyboard is in use, Enter loses nothing
        return discarded, cancelled or widgets.escaped(), exported or widgets.entered()

    def _draw_wait(self, widgets: Widgets) -> None:
        imgui.open_popup(_WAIT)
        center(_WIDTH * widgets.scale)
        if not imgui.begin_popup_modal(_WAIT, None, POPUP)[0]:
            return
        widgets.heading(_WAIT)
        widgets.progress(-float(imgui.get_time()), "It is finished first.")
        stays = widgets.button("Stay", "Leaves the drawing open (Esc).")
        if stays or widgets.escaped() or widgets.entered():
            self._pending = None
        if self._pending is None:
            imgui.close_current_popup()
        imgui.end_popup()
