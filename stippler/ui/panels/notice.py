"""Lines over the canvas: warnings and errors, and what to do while nothing is open."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.editor.commands import Command, Commands
from stippler.editor.messages import ERROR, INFO, Messages
from stippler.ui.theme import ICON_WARNING, TEXT_PX, Colour
from stippler.ui.widgets import Rect, Widgets

_INVITATION = 340.0
_AUTO = imgui.WindowFlags_.always_auto_resize
_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_focus_on_appearing
    | _AUTO
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


def draw_preparing(widgets: Widgets, share: float, canvas: Rect) -> None:
    """Say, in the middle of an empty desk, what the first start takes its time for."""
    x0, y0, x1, y1 = canvas
    width = min(_INVITATION * widgets.scale, x1 - x0)
    imgui.set_next_window_pos(((x0 + x1) / 2, (y0 + y1) / 2), imgui.Cond_.always, (0.5, 0.5))
    imgui.set_next_window_size((width, 0.0))
    imgui.begin("##preparing", None, (_FLAGS & ~_AUTO) | imgui.WindowFlags_.no_background)
    imgui.push_font(widgets.fonts.heading, TEXT_PX * 1.2)
    _write_centred(widgets, "Getting ready for the first time", widgets.theme.text)
    imgui.pop_font()
    told = "a minute or two, once on this computer"
    _write_centred(widgets, told, widgets.theme.faint)
    imgui.push_style_var(imgui.StyleVar_.frame_padding, (0.0, 0.0))
    imgui.progress_bar(share, (-1.0, 5.0 * widgets.scale), "")
    imgui.pop_style_var()
    imgui.end()


def draw_invitation(
    widgets: Widgets, commands: Commands, recent: list[Command], canvas: Rect
) -> None:
    """Say how to begin, in the middle of an empty desk, and offer the last pictures."""
    x0, y0, x1, y1 = canvas
    width = min(_INVITATION * widgets.scale, x1 - x0)
    imgui.set_next_window_pos(((x0 + x1) / 2, (y0 + y1) / 2), imgui.Cond_.always, (0.5, 0.5))
    imgui.set_next_window_size((width, 0.0))
    imgui.push_style_color(imgui.Col_.button, (*widgets.theme.panel, 1.0))
    imgui.begin("##invitation", None, (_FLAGS & ~_AUTO) | imgui.WindowFlags_.no_background)
    imgui.push_font(widgets.fonts.heading, TEXT_PX * 1.2)
    _write_centred(widgets, "Drop a picture here", widgets.theme.text)
    imgui.pop_font()
    _write_centred(widgets, "or begin with one of these", widgets.theme.faint)
    imgui.dummy((0.0, 2.0 * widgets.scale))
    half = (imgui.get_content_region_avail().x - widgets.gap) / 2
    for k, (name, label) in enumerate((("file.open", "Open…"), ("file.new", "New page…"))):
        if k:
            imgui.same_line(0.0, widgets.gap)
        hint = f"{commands[name].hint}."
        if widgets.button(label, hint, name=f"begin {name}", width=half, primary=not k):
            commands[name].run()
    if recent:
        imgui.dummy((0.0, 2.0 * widgets.scale))
    for picture in recent:
        if widgets.button(
            picture.label.removeprefix("Open "), picture.detail, name=picture.name, width=-1.0
        ):
            picture.run()
    imgui.end()
    imgui.pop_style_color()


def _write_centred(widgets: Widgets, text: str, colour: Colour) -> None:
    room, left = imgui.get_content_region_avail().x, imgui.get_cursor_pos_x()
    if imgui.calc_text_size(text).x > room:
        imgui.push_text_wrap_pos(0.0)
        imgui.text_colored((*colour, 0.85), text)
        imgui.pop_text_wrap_pos()
        return
    imgui.set_cursor_pos_x(left + (room - imgui.calc_text_size(text).x) / 2)
    imgui.text_colored((*colour, 0.85), text)
