"""The dialog for a new page."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from stippler.drawing.drawing import MAX_PAGE_MM, Page
from stippler.ui.popups.file_dialogs import center
from stippler.ui.widgets import Widgets

_TITLE = "New page"
_WIDTH = 320.0
_SIZES = (("A4", 210.0, 297.0), ("A5", 148.0, 210.0), ("A6", 105.0, 148.0))


class NewPage:
    """Asks for the size of a page, and begins a drawing on it."""

    def __init__(self, begin: Callable[[Page], None]) -> None:
        self._begin = begin
        self._wanted = False
        self.is_open = False
        self.width_mm, self.height_mm = 148.0, 210.0

    def ask(self) -> None:
        """Open the dialog in the next frame."""
        self._wanted = True

    def draw(self, widgets: Widgets) -> None:
        """Draw the dialog, if it is open."""
        if self._wanted:
            imgui.open_popup(_TITLE)
            self._wanted = False
        center(_WIDTH * widgets.scale)
        self.is_open = imgui.begin_popup_modal(_TITLE, None, imgui.WindowFlags_.no_resize)[0]
        if self.is_open:
            self._draw_fields(widgets)
            self._draw_verbs(widgets)
            imgui.end_popup()

    def _draw_fields(self, widgets: Widgets) -> None:
        for k, (name, width_mm, height_mm) in enumerate(_SIZES):
            if k:
                imgui.same_line()
            if widgets.button(name, f"{width_mm:g} × {height_mm:g} mm."):
                self.width_mm, self.height_mm = width_mm, height_mm
        imgui.same_line()
        if widgets.button("Turn page", "Exchanges width and height."):
            self.width_mm, self.height_mm = self.height_mm, self.width_mm
        self.width_mm = _length(widgets, "Page width", self.width_mm)
        self.height_mm = _length(widgets, "Page height", self.height_mm)

    def _draw_verbs(self, widgets: Widgets) -> None:
        begun, cancelled = widgets.verbs(
            "Begin", "The drawing that is open is closed.", "Keep the drawing that is open."
        )
        if begun or cancelled:
            imgui.close_current_popup()
        if begun:
            self._begin(Page(self.width_mm, self.height_mm))


def _length(widgets: Widgets, label: str, value: float) -> float:
    return widgets.length(label, value, "On paper.", low=1.0, high=MAX_PAGE_MM)
