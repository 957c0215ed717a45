"""The strip of tools at the left edge of the window."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.editor.commands import Command, Commands
from stippler.editor.tools.toolbox import Toolbox
from stippler.ui.icons import Pen, draw_icon
from stippler.ui.theme import STATUS_HEIGHT, STRIP_WIDTH
from stippler.ui.widgets import Widgets

_BUTTON, _ICON = 34.0, 20.0
_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_nav
)


def draw_tools(widgets: Widgets, toolbox: Toolbox, commands: Commands) -> None:
    """Draw an icon for each tool."""
    viewport, scale = imgui.get_main_viewport(), widgets.scale
    imgui.set_next_window_pos(viewport.work_pos)
    height = viewport.work_size.y - STATUS_HEIGHT * scale
    imgui.set_next_window_size((STRIP_WIDTH * scale, height))
    imgui.push_style_var(imgui.StyleVar_.window_padding, (6.0 * scale, 8.0 * scale))
    imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.0, 3.0 * scale))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    imgui.push_style_var(imgui.StyleVar_.scrollbar_size, 5.0 * scale)  # beside the buttons
    imgui.begin("##tools", None, _FLAGS & ~imgui.WindowFlags_.no_scrollbar)
    imgui.pop_style_var(3)
    used = toolbox.name
    tip = "The pointer only looks around."
    if draw_tool(widgets, commands["tool.none"], "", tip, used=used == ""):
        commands["tool.none"].run()
    for tool in toolbox.tools:
        command = commands[f"tool.{tool.name}"]
        if draw_tool(widgets, command, tool.name, tool.tip, used=used == tool.name):
            command.run()
    imgui.end()
    imgui.pop_style_var(2)


def draw_tool(
    widgets: Widgets, command: Command, name: str, tip: str, *, used: bool, mark: str = ""
) -> bool:
    """Draw the icon of a tool as a button; return whether it was pressed."""
    side = _BUTTON * widgets.scale
    corner = imgui.get_cursor_screen_pos()
    pressed = imgui.invisible_button(
        f"##{command.name}", (side, side), imgui.ButtonFlags_.enable_nav
    )
    draw, theme = imgui.get_window_draw_list(), widgets.theme
    if used or imgui.is_item_hovered():
        fill = theme.accent if used else theme.hovered
        end = (corner.x + side, corner.y + side)
        draw.add_rect_filled(corner, end, widgets.packed(fill), 6.0 * widgets.scale)
    icon = _ICON * widgets.scale
    gap = (side - icon) / 2
    colour = widgets.packed(theme.on_accent if used else theme.text)
    draw_icon(name, command.label, Pen(draw, corner.x + gap, corner.y + gap, icon, colour))
    widgets.note(f"{mark}{command.label}")
    widgets.tip(f"{command.hint}\n{tip}", beside=not mark)
    return pressed
