"""What lies over the page and is no part of it: the brush's outline, and that of a selection."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.camera import Point
from stippler.ui.tools.toolbox import Toolbox
from stippler.ui.view import View
from stippler.ui.widgets import Rect

_DARK, _LIGHT = 0xFF201810, 0xE0FFFFFF  # ImGui's order: alpha, blue, green, red
_LEAST_PX = 3.0  # a tip smaller than this gets a cross


def draw_overlay(
    toolbox: Toolbox, view: View, canvas: Rect, ratio: float, pointer_mm: Point | None
) -> None:
    """Draw the outlines, each light and dark, so that they show on ink and on paper.

    Parameters
    ----------
    ratio : float
        Pixels of the canvas for each of ImGui's.
    pointer_mm : (x, y) or None
        None while the pointer is elsewhere.
    """
    draw = imgui.get_background_draw_list()
    draw.push_clip_rect(canvas[:2], canvas[2:], True)

    def placed(points_mm: object) -> list[tuple[float, float]]:
        points = view.camera.page_to_screen(points_mm, view.size_px) / ratio  # type: ignore[arg-type]
        return [(float(x) + canvas[0], float(y) + canvas[1]) for x, y in points]

    brush = toolbox.brush
    if brush is not None and pointer_mm is not None and brush.about.rhythm != "select":
        outline = brush.tip.outline(brush.radius_mm, 64) + pointer_mm
        _draw_line(draw, placed(outline), closed=True)
        if brush.radius_mm * view.camera.px_per_mm < _LEAST_PX:
            ((x, y),) = placed([pointer_mm])
            _draw_line(draw, [(x - 7, y), (x + 7, y)])
            _draw_line(draw, [(x, y - 7), (x, y + 7)])
    if toolbox.outline:
        _draw_line(draw, placed(toolbox.outline), closed=True)
    draw.pop_clip_rect()


def _draw_line(
    draw: imgui.ImDrawList, points: list[tuple[float, float]], *, closed: bool = False
) -> None:
    if len(points) < 2:
        return
    flags = imgui.ImDrawFlags_.closed if closed else imgui.ImDrawFlags_.none
    for colour, width in ((_LIGHT, 3.0), (_DARK, 1.2)):
        draw.add_polyline(list(points), colour, width, flags)
