"""What is drawn over the page: marks of the tool, borders of areas, the lens, rulers, navigator."""

from __future__ import annotations

from typing import TYPE_CHECKING

from stippler.ui.canvas.area_overlay import AreaOverlay
from stippler.ui.canvas.lens import place_lens
from stippler.ui.canvas.navigator import camera_of, draw_navigator, size_of
from stippler.ui.canvas.overlay import draw_overlay, draw_tip_in_lens
from stippler.ui.canvas.rulers import draw_rulers

if TYPE_CHECKING:
    from stippler.editor.pointer import Pointer
    from stippler.editor.session import Session
    from stippler.editor.tools.tool import Overlay
    from stippler.editor.tools.toolbox import Toolbox
    from stippler.editor.view import View
    from stippler.ui.canvas.canvas import Canvas
    from stippler.ui.look import Look
    from stippler.ui.widgets import Rect, Widgets
    from stippler.ui.window.gui import Gui


class OverPage:
    """Draws over the canvas; `area` is its place in the window, `ratio` its pixels a unit."""

    def __init__(
        self,
        look: Look,
        gui: Gui,
        canvas: Canvas,
        session: Session,
        view: View,
        toolbox: Toolbox,
        pointer: Pointer,
    ) -> None:
        self._look, self._gui, self.canvas, self._session = look, gui, canvas, session
        self._view, self._toolbox, self._pointer = view, toolbox, pointer
        self._areas = AreaOverlay()

    @property
    def _overlay(self) -> Overlay:
        document, camera = self._session.document, self._view.camera
        return self._toolbox.overlay(document, self._pointer.at_mm, camera.px_per_mm)

    def draw_marks(self, area: Rect, ratio: float, *, borders: bool) -> None:
        """Draw what the tool shows, and the borders of areas if asked or if the tool needs them."""
        tool, document = self._toolbox.tool, self._session.document
        overlay = self._overlay
        seen = borders or (tool is not None and tool.shows_areas)
        if document is not None and seen and not overlay.has_borders:
            self._areas.draw(document, self._toolbox.areas, self._view, area, ratio)
        draw_overlay(overlay, self._view, area, self._gui.scale, ratio)

    def draw_beside(self, widgets: Widgets, area: Rect, ratio: float) -> None:
        """Draw the picture's half, the rulers and the navigator."""
        look, drawing = self._look, self._session.drawing
        if drawing is None:
            return
        if look.split_shown and self._session.reference is not None:
            self.canvas.show_half(area, self._view.size_px, self._gui.scale, look.theme)
        if look.rulers_shown:
            draw_rulers(widgets, self._view, area, ratio, self._pointer.at_px)
        if look.navigator_shown:
            page = drawing.page
            size_px = size_of(page, area, self._gui.scale, ratio)
            texture = self.canvas.map_texture(camera_of(page, size_px), size_px)
            draw_navigator(widgets, self._view, page, texture, area, ratio)

    def draw_lens(self, area: Rect, ratio: float) -> None:
        """Draw the lens under the pointer, and in it the brush's tip."""
        at_px, tip = self._pointer.at_px, self._overlay.tip
        if self._look.lens == "none" or at_px is None or self._session.drawing is None:
            return
        reach_px = tip.brush.radius_mm * self._view.camera.px_per_mm if tip else None
        diameter_px = self._look.lens_diameter * self._gui.scale * ratio
        glass = place_lens(self._view, at_px, self._look.lens_factor, diameter_px, reach_px)
        self.canvas.show_lens(area, glass, self._gui.scale, ratio)
        if tip is not None:
            draw_tip_in_lens(tip, glass, area, ratio)
