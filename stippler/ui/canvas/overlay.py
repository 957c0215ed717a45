"""Draws what lies over the page and is no part of it: outlines of tips, selections, handles."""

from __future__ import annotations

import itertools
import math

from imgui_bundle import imgui

from stippler.editor.tools.tool import Handle, Overlay, Tip
from stippler.editor.view import View
from stippler.ui.canvas.lens import Glass
from stippler.ui.widgets import Rect

_DARK, _LIGHT = 0xFF201810, 0xE0FFFFFF  # ImGui's order: alpha, blue, green, red
_REFUSED = 0xFF2020D0
_CHOSEN = 0xFF785F2F
_HANDLE, _DASH = 5.0, 5.0
_LEAST_PX = 3.0  # a tip smaller than this gets a cross


def draw_overlay(overlay: Overlay, view: View, canvas: Rect, scale: float, ratio: float) -> None:
    """Draw an overlay, each line light and dark, so that it shows on ink and on paper.

    Parameters
    ----------
    scale : float
        ImGui's units for each of the theme's pixels.
    ratio : float
        Pixels of the canvas for each of ImGui's.
    """
    draw = imgui.get_background_draw_list()
    draw.push_clip_rect(canvas[:2], canvas[2:], True)

    def placed(points_mm: object) -> list[tuple[float, float]]:
        points = view.camera.page_to_screen(points_mm, view.size_px) / ratio  # type: ignore[arg-type]
        return [(float(x) + canvas[0], float(y) + canvas[1]) for x, y in points]

    for path in overlay.paths:
        dark = _REFUSED if path.refused else _DARK
        draw_outline(
            draw, placed(path.points_mm), closed=path.closed, dashed=path.dashed, dark=dark
        )
    if overlay.tip is not None:
        brush, at_mm = overlay.tip.brush, overlay.tip.at_mm
        outline = brush.tip.outline(brush.radius_mm, 64) + at_mm
        draw_outline(draw, placed(outline), closed=True)
        if brush.radius_mm * view.camera.px_per_mm < _LEAST_PX:
            ((x, y),) = placed([at_mm])
            draw_outline(draw, [(x - 7, y), (x + 7, y)])
            draw_outline(draw, [(x, y - 7), (x, y + 7)])
    if overlay.handles:
        for handle, at in zip(
            overlay.handles, placed([h.at_mm for h in overlay.handles]), strict=True
        ):
            _draw_handle(draw, handle, at, scale)
    draw.pop_clip_rect()


def _draw_handle(
    draw: imgui.ImDrawList, handle: Handle, at: tuple[float, float], scale: float
) -> None:
    """Draw a grip: round ones turn and bend, square ones scale and move."""
    side = _HANDLE * scale
    fill = _CHOSEN if handle.chosen else _LIGHT
    if handle.grip in ("turn", "control"):
        draw.add_circle_filled(at, side, fill, 16)
        draw.add_circle(at, side, _DARK, 16, 1.4)
        return
    low, high = (at[0] - side, at[1] - side), (at[0] + side, at[1] + side)
    draw.add_rect_filled(low, high, fill)
    draw.add_rect(low, high, _DARK, 0.0, 1.4)


def draw_tip_in_lens(tip: Tip, glass: Glass, canvas: Rect, ratio: float) -> None:
    """Draw a brush's outline at the scale of the lens, where it fits in."""
    d, brush = glass.diameter_px, tip.brush
    if not _LEAST_PX < brush.radius_mm * glass.camera.px_per_mm < 0.45 * d:
        return
    outline = brush.tip.outline(brush.radius_mm, 64) + tip.at_mm
    points = glass.camera.page_to_screen(outline, (d, d)) + glass.corner_px
    placed = [(float(x) / ratio + canvas[0], float(y) / ratio + canvas[1]) for x, y in points]
    draw_outline(imgui.get_background_draw_list(), placed, closed=True)


def draw_outline(
    draw: imgui.ImDrawList,
    points: list[tuple[float, float]],
    *,
    closed: bool = False,
    dashed: bool = False,
    dark: int = _DARK,
) -> None:
    """Draw a line, light and dark; in ImGui's coordinates."""
    if len(points) < 2:
        return
    if dashed:
        _draw_dashes(draw, [*points, points[0]] if closed else points)
        return
    flags = imgui.ImDrawFlags_.closed if closed else imgui.ImDrawFlags_.none
    for colour, width in ((_LIGHT, 3.0), (dark, 1.2 if dark == _DARK else 2.0)):
        draw.add_polyline(list(points), colour, width, flags)


def _draw_dashes(draw: imgui.ImDrawList, points: list[tuple[float, float]]) -> None:
    """Draw a light line with dark dashes."""
    draw.add_polyline(list(points), _LIGHT, 1.2, imgui.ImDrawFlags_.none)
    left, on = _DASH, True
    for (x0, y0), (x1, y1) in itertools.pairwise(points):
        length, at = math.hypot(x1 - x0, y1 - y0), 0.0
        while at < length:
            to = min(at + left, length)
            if on:
                a, b = at / length, to / length
                start = (x0 + a * (x1 - x0), y0 + a * (y1 - y0))
                draw.add_line(start, (x0 + b * (x1 - x0), y0 + b * (y1 - y0)), _DARK, 1.2)
            left -= to - at
            at = to
            if left <= 1e-3:  # rounding would leave a rest that never ends
                left, on = _DASH, not on
