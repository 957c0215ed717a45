"""The strip of tools at the left edge of the window."""

from __future__ import annotations

from dataclasses import dataclass

from imgui_bundle import imgui

from stippler.editor.commands import Command, Commands
from stippler.editor.tools.toolbox import Toolbox
from stippler.ui.icons import Pen, draw_icon
from stippler.ui.theme import STATUS_HEIGHT
from stippler.ui.widgets import Widgets

_BUTTON, _ICON = 34.0, 20.0
_PADDING, _BETWEEN = (6.0, 8.0), 3.0
_READABLE = ((1, 25.0), (2, 17.0), (3, 0.0))  # columns of tools, with buttons no smaller than this
_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_nav
)


@dataclass(frozen=True, slots=True)
class StripShape:
    """How the strip's tools stand, that all of them can be seen; in ImGui's units."""

    columns: int
    side: float
    width: float
    height: float

    @classmethod
    def fitting(cls, n_tools: int, scale: float) -> StripShape:
        """Return the shape of a strip as high as the window allows."""
        height = imgui.get_main_viewport().work_size.y - STATUS_HEIGHT * scale
        room = height / scale - 2 * _PADDING[1]
        for columns, least in _READABLE:
            rows = -(-n_tools // columns)
            side = min(room / rows - _BETWEEN, _BUTTON)
            if side >= least:
                break
        side = max(side, 8.0)
        width = columns * side + (columns - 1) * _BETWEEN + 2 * _PADDING[0]
        return cls(columns, side * scale, round(width * scale), height)


def draw_tools(
    widgets: Widgets,
    toolbox: Toolbox,
    commands: Commands,
    shape: StripShape,
) -> None:
    """Draw an icon for each tool."""
    viewport, scale = imgui.get_main_viewport(), widgets.scale
    imgui.set_next_window_pos(viewport.work_pos)
    imgui.set_next_window_size((shape.width, shape.height))
    imgui.push_style_var(imgui.StyleVar_.window_padding, (_PADDING[0] * scale, _PADDING[1] * scale))
    imgui.push_style_var(imgui.StyleVar_.item_spacing, (_BETWEEN * scale,) * 2)
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    imgui.begin("##tools", None, _FLAGS)
    used = toolbox.name
    tip = "The pointer only looks around."
    if draw_tool(widgets, commands["tool.none"], "", tip, used=used == "", side=shape.side):
        commands["tool.none"].run()
    for k, tool in enumerate(toolbox.cards, 1):
        if k % shape.columns:
            imgui.same_line()
        command = commands[f"tool.{tool.name}"]
        is_used = used == tool.name
        if draw_tool(widgets, command, tool.name, tool.tip, used=is_used, side=shape.side):
            command.run()
    imgui.end()
    imgui.pop_style_var(4)


def draw_tool(
    widgets: Widgets,
    command: Command,
    name: str,
    tip: str,
    *,
    used: bool,
    mark: str = "",
    side: float = 0.0,
) -> bool:
    """Draw the icon of a tool as a button; return whether it was pressed."""
    side = side or _BUTTON * widgets.scale
    corner = imgui.get_cursor_screen_pos()
    pressed = imgui.invisible_button(
        f"##{command.name}", (side, side), imgui.ButtonFlags_.enable_nav
    )
    draw, theme = imgui.get_window_draw_list(), widgets.theme
    if used or imgui.is_item_hovered():
        fill = theme.accent if used else theme.hovered
        end = (corner.x + side, corner.y + side)
        draw.add_rect_filled(corner, end, widgets.packed(fill), 6.0 * widgets.scale)
    icon = _ICON / _BUTTON * side
    gap = (side - icon) / 2
    colour = widgets.packed(theme.on_accent if used else theme.text)
    draw_icon(name, command.label, Pen(draw, corner.x + gap, corner.y + gap, icon, colour))
    widgets.note(f"{mark}{command.label}")
    widgets.tip(f"{command.hint}\n{tip}", at_once=command.hint)
    return pressed
