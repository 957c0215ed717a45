"""The dialog that scales a drawing or areas: size, number of dots, and how small they may be."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.editor.area_choice import AreaChoice
from stippler.editor.scaling import scale
from stippler.editor.session import Session
from stippler.ui.widgets import Widgets

_TITLE = "Scale"
_FEW = 2  # areas that are named


class ScaleDrawing:
    """Asks how, and begins; the drawing can be had back by undoing."""

    def __init__(self, session: Session, chosen: AreaChoice) -> None:
        self._session, self._chosen = session, chosen
        self.only_areas = False
        self._wanted = False
        self.is_open = False
        self.percent, self.n_dots, self.least_mm = 50.0, 0, 0.1

    def ask(self) -> None:
        """Open the dialog in the next frame; for the chosen areas, if there are any."""
        self._wanted, self.only_areas = True, bool(self._areas)

    @property
    def _areas(self) -> list[int]:
        document = self._session.document
        return self._chosen.drawn(document) if document is not None else []

    def draw(self, widgets: Widgets) -> None:
        """Draw the dialog, if it is open."""
        if self._wanted:
            imgui.open_popup(_TITLE)
            self._wanted = False
        center = imgui.get_main_viewport().get_center()
        imgui.set_next_window_pos(center, imgui.Cond_.appearing, (0.5, 0.5))
        imgui.set_next_window_size((340.0 * widgets.scale, 0.0))
        self.is_open = imgui.begin_popup_modal(_TITLE, None, imgui.WindowFlags_.no_resize)[0]
        if self.is_open:
            self._draw_fields(widgets)
            self._draw_verbs(widgets)
            imgui.end_popup()

    def _draw_fields(self, widgets: Widgets) -> None:
        widgets.caption(
            "Dots go or come, and what is near them relaxes; tone, areas, lines, fixed dots stay."
        )
        if names := self._names():
            tip = "Areas about their middles; what is next to them follows their borders."
            whole, only = "the whole drawing", names
            index = widgets.choice("What", [whole, only], int(self.only_areas), tip)
            self.only_areas = bool(index)
        tip = "Of all lengths; 100 keeps the size."
        self.percent = widgets.length("New size", self.percent, tip, "%")
        tip = "No dot has a smaller radius afterwards; 0 lets sizes shrink."
        self.least_mm = max(widgets.length("Least dot", self.least_mm, tip), 0.0)
        tip = "How many dots there are afterwards; 0: as many as the least radius lets be."
        self.n_dots = max(widgets.number("Number", self.n_dots, tip), 0)
        drawing = self._session.drawing
        if drawing is not None and not (self.only_areas and names):
            f = self.percent / 100
            page = drawing.page
            widgets.caption(f"{page.width_mm * f:.4g} × {page.height_mm * f:.4g} mm on paper")

    def _draw_verbs(self, widgets: Widgets) -> None:
        go, cancelled = widgets.verbs(
            "Scale", "One step to undo.", "Leave it as it is.", cancel="Cancel scaling"
        )
        if go or cancelled:
            imgui.close_current_popup()
        if go:
            areas = self._areas if self.only_areas else ()
            scale(self._session, self.percent, self.n_dots or None, self.least_mm, areas)

    def _names(self) -> str:
        """Return the names of the chosen areas; empty where none is chosen."""
        drawing, areas = self._session.drawing, self._areas
        if drawing is None or not areas:
            return ""
        if len(areas) > _FEW:
            return f"{len(areas)} chosen areas"
        return ", ".join(drawing.areas[k].name for k in areas)
