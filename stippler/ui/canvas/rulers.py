"""Rulers in mm along the upper and the left edge of the canvas."""

from __future__ import annotations

import math

from imgui_bundle import imgui

from stippler.camera import Point
from stippler.editor.view import View
from stippler.ui.theme import SMALL_PX
from stippler.ui.widgets import Rect, Widgets

THICKNESS = 20.0  # the theme's pixels
_LABEL_PX, _TICK_PX = 56.0, 7.0  # least distances of numbers, and of ticks
_UPRIGHT = 1e-6


def tick_steps(px_per_mm: float, scale: float) -> tuple[float, float]:
    """Return how many mm lie between two numbers, and between two ticks."""
    label = _round_up(_LABEL_PX * scale / px_per_mm)
    for parts in (10, 5, 2):
        if label / parts * px_per_mm >= _TICK_PX * scale:
            return label, label / parts
    return label, label


def _round_up(value: float) -> float:
    power = 10.0 ** math.floor(math.log10(value))
    return next(m * power for m in (1.0, 2.0, 5.0, 10.0) if m * power >= value * (1 - 1e-9))


def mm_along(view: View, axis: int) -> tuple[float, float]:
    """Return the mm at the canvas's corner, and mm a pixel, along x (0) or y (1) of the screen.

    On a page that is turned by a right angle, or flipped, they are the page's own; at other angles
    distances from where its corner is.
    """
    camera = view.camera
    corner = camera.page_to_screen((0.0, 0.0), view.size_px)[axis]
    row = camera.linear()[axis] / camera.px_per_mm
    own = next((float(part) for part in row if abs(abs(part) - 1.0) < _UPRIGHT), 1.0)
    per_px = 1.0 / (camera.px_per_mm * own)
    return -float(corner) * per_px, per_px


def draw_rulers(
    widgets: Widgets, view: View, canvas: Rect, ratio: float, at_px: Point | None
) -> None:
    """Draw both, with marks where the pointer is."""
    draw, theme = imgui.get_background_draw_list(), widgets.theme
    wide = THICKNESS * widgets.scale
    x0, y0, x1, y1 = canvas
    draw.push_clip_rect((x0, y0), (x1, y1), True)
    draw.add_rect_filled((x0, y0), (x1, y0 + wide), widgets.packed(theme.panel, 0.94))
    draw.add_rect_filled((x0, y0 + wide), (x0 + wide, y1), widgets.packed(theme.panel, 0.94))
    line = widgets.packed(theme.line)
    draw.add_line((x0, y0 + wide), (x1, y0 + wide), line)
    draw.add_line((x0 + wide, y0), (x0 + wide, y1), line)
    imgui.push_font(None, SMALL_PX * 0.85)
    for axis in (0, 1):
        _draw_ticks(widgets, draw, view, canvas, ratio, axis, wide)
    imgui.pop_font()
    if at_px is not None:
        mark = widgets.packed(theme.accent)
        x, y = x0 + at_px[0] / ratio, y0 + at_px[1] / ratio
        draw.add_line((x, y0), (x, y0 + wide), mark, widgets.scale)
        draw.add_line((x0, y), (x0 + wide, y), mark, widgets.scale)
    draw.pop_clip_rect()


def _draw_ticks(
    widgets: Widgets,
    draw: imgui.ImDrawList,
    view: View,
    canvas: Rect,
    ratio: float,
    axis: int,
    wide: float,
) -> None:
    first, per_px = mm_along(view, axis)
    per_unit = per_px * ratio
    length = canvas[2 + axis] - canvas[axis]
    label, tick = tick_steps(1.0 / abs(per_unit), widgets.scale)
    ends = sorted((first, first + length * per_unit))
    ink = widgets.packed(widgets.theme.faint)
    every = round(label / tick)
    for k in range(math.ceil(ends[0] / tick), math.floor(ends[1] / tick) + 1):
        at = canvas[axis] + (k * tick - first) / per_unit
        if at < canvas[axis] + wide:
            continue
        is_label = k % every == 0
        size = wide * (0.55 if is_label else 0.3 if every < 10 or k % 5 else 0.42)
        if axis == 0:
            draw.add_line((at, canvas[1] + wide - size), (at, canvas[1] + wide), ink)
        else:
            draw.add_line((canvas[0] + wide - size, at), (canvas[0] + wide, at), ink)
        if is_label:
            text = f"{k * tick:.6g}".replace("-", "−")
            if axis == 0:
                draw.add_text((at + 3.0 * widgets.scale, canvas[1] + 1.0), ink, text)
            else:
                _draw_upright(widgets, draw, (canvas[0] + 2.0 * widgets.scale, at), ink, text)


def _draw_upright(widgets: Widgets, draw: imgui.ImDrawList, at: Point, ink: int, text: str) -> None:
    """Write a number downwards, a sign below the other: the ruler is narrower than numbers are."""
    step = imgui.get_font_size() * 0.82
    for k, sign in enumerate(text):
        draw.add_text((at[0], at[1] + 2.0 * widgets.scale + k * step), ink, sign)
