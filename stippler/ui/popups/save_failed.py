"""What to do when a drawing could not be saved: elsewhere, again, or later."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from stippler.editor.session import Session
from stippler.ui.widgets import Widgets

if TYPE_CHECKING:
    from stippler.editor.exports import FailedSave

_TITLE = "The drawing is not saved"
_WIDTH = 460.0


class SaveFailed:
    """Asks as soon as a save has failed.

    Parameters
    ----------
    elsewhere : callable
        Asks where else to save it; told whether it was to be a copy.
    """

    def __init__(self, session: Session, elsewhere: Callable[[bool], None]) -> None:
        self._session, self._elsewhere = session, elsewhere
        self._failed: FailedSave | None = None
        self.is_open = False

    def draw(self, widgets: Widgets) -> None:
        """Draw the window, if it is open."""
        exports = self._session.exports
        if exports.failed is not None:
            self._failed, exports.failed = exports.failed, None
            imgui.open_popup(_TITLE)
        center = imgui.get_main_viewport().get_center()
        imgui.set_next_window_pos(center, imgui.Cond_.appearing, (0.5, 0.5))
        imgui.set_next_window_size((_WIDTH * widgets.scale, 0.0))
        self.is_open = imgui.begin_popup_modal(_TITLE, None, imgui.WindowFlags_.no_resize)[0]
        if not self.is_open or self._failed is None:
            return
        failed = self._failed
        widgets.paragraph(failed.why)
        kept = self._session.keeping
        safe = "; the edits are kept for recovery, too" if kept.root is not None else ""
        widgets.caption(f"Nothing is lost: the drawing is open as it is{safe}.")
        width = 128.0 * widgets.scale
        elsewhere = widgets.button(
            "Save elsewhere", "Asks for another place.", width=width, primary=True
        )
        imgui.same_line(0.0, widgets.gap)
        again = widgets.button("Try again", "When the cause is mended.", width=width)
        imgui.same_line(0.0, widgets.gap)
        later = widgets.button("Later", "Goes on without a file (Esc).", width=width)
        if elsewhere or again or later or widgets.escaped():
            imgui.close_current_popup()
            self._failed = None
        imgui.end_popup()
        if elsewhere:
            self._elsewhere(failed.is_copy)
        elif again:
            self._session.save(failed.path, is_copy=failed.is_copy)
