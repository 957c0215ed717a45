"""Lines over the canvas: warnings and errors, and what to do while nothing is open."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.ui.messages import ERROR, INFO, Messages
from stippler.ui.theme import ICON_WARNING
from stippler.ui.widgets import Rect, Widgets

_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_focus_on_appearing
    | imgui.WindowFlags_.always_auto_resize
)


def draw_notice(widgets: Widgets, messages: Messages, canvas: Rect) -> None:
    """Show the current warning or error above the lower edge of the canvas; a click ends it."""
    message = messages.current
    if message is None or message.level == INFO:
        return
    scale = widgets.scale
    x0, _, x1, y1 = canvas
    width = min(560.0 * scale, (x1 - x0) - 48.0 * scale)
    imgui.set_next_window_pos(((x0 + x1) / 2, y1 - 20.0 * scale), imgui.Cond_.always, (0.5, 1.0))
    imgui.set_next_window_size_constraints((0.0, 0.0), (width, 1e6))
    imgui.push_style_var(imgui.StyleVar_.window_padding, (14.0 * scale, 11.0 * scale))
    imgui.begin("##notice", None, _FLAGS)
    colour = widgets.theme.alarm if message.level == ERROR else widgets.theme.accent
    imgui.text_colored((*colour, 1.0), ICON_WARNING)
    imgui.same_line(0.0, 10.0 * scale)
    room = width - 60.0 * scale
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + room)
    imgui.text_unformatted(message.text)
    imgui.pop_text_wrap_pos()
    if imgui.is_window_hovered() and imgui.is_mouse_clicked(imgui.MouseButton_.left):
        messages.dismiss()
    at, size = imgui.get_window_pos(), imgui.get_window_size()
    widgets.marks["notice"] = (at.x, at.y, at.x + size.x, at.y + size.y)
    imgui.end()
    imgui.pop_style_var()


def draw_invitation(widgets: Widgets, canvas: Rect) -> None:
    """Say how to begin, in the middle of an empty desk."""
    x0, y0, x1, y1 = canvas
    lines = ("Drop a picture here", "or press Ctrl+O to open one")
    inks = (widgets.theme.text, widgets.theme.faint)
    background = imgui.get_background_draw_list()
    y = (y0 + y1) / 2 - imgui.get_text_line_height_with_spacing()
    for line, ink in zip(lines, inks, strict=True):
        size = imgui.calc_text_size(line)
        colour = imgui.color_convert_float4_to_u32((*ink, 0.75))
        background.add_text(((x0 + x1 - size.x) / 2, y), colour, line)
        y += imgui.get_text_line_height_with_spacing()
