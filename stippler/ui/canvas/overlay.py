"""What lies over the page and is no part of it: the brush's outline, and that of a selection."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.brushes.brush import Brush
from stippler.camera import Point
from stippler.editor.tools.toolbox import Toolbox
from stippler.editor.view import View
from stippler.ui.canvas.lens import Glass
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
        draw_outline(draw, placed(outline), closed=True)
        if brush.radius_mm * view.camera.px_per_mm < _LEAST_PX:
            ((x, y),) = placed([pointer_mm])
            draw_outline(draw, [(x - 7, y), (x + 7, y)])
            draw_outline(draw, [(x, y - 7), (x, y + 7)])
    if toolbox.outline:
        draw_outline(draw, placed(toolbox.outline), closed=True)
    draw.pop_clip_rect()


def draw_tip_in_lens(
    brush: Brush, glass: Glass, pointer_mm: Point | None, canvas: Rect, ratio: float
) -> None:
    """Draw a brush's outline at the scale of the lens, where it fits in."""
    d = glass.diameter_px
    if pointer_mm is None or not _LEAST_PX < brush.radius_mm * glass.camera.px_per_mm < 0.45 * d:
        return
    outline = brush.tip.outline(brush.radius_mm, 64) + pointer_mm
    points = glass.camera.page_to_screen(outline, (d, d)) + glass.corner_px
    placed = [(float(x) / ratio + canvas[0], float(y) / ratio + canvas[1]) for x, y in points]
    draw_outline(imgui.get_background_draw_list(), placed, closed=True)


def draw_outline(
    draw: imgui.ImDrawList, points: list[tuple[float, float]], *, closed: bool = False
) -> None:
    """Draw a line, light and dark; in ImGui's coordinates."""
    if len(points) < 2:
        return
    flags = imgui.ImDrawFlags_.closed if closed else imgui.ImDrawFlags_.none
    for colour, width in ((_LIGHT, 3.0), (_DARK, 1.2)):
        draw.add_polyline(list(points), colour, width, flags)
