"""The menu bar, made from the commands."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from stippler.editor.commands import Command, Commands
from stippler.ui.widgets import Widgets

_RECENT_AFTER = "file.open"
_RULED = {
    "file.export", "file.quit", "edit.preferences", "selection.delete", "selection.fix",
    "selection.relax", "work.relax", "work.reset", "tool.larger", "view.theme", "panel.reset",
}  # fmt: skip
"""Commands that a line stands above."""


def draw_menu(widgets: Widgets, commands: Commands, recent: Callable[[], list[Command]]) -> None:
    """Draw the bar along the upper edge of the window; run what is chosen."""
    scale = widgets.scale
    imgui.push_style_var(imgui.StyleVar_.frame_padding, (9.0 * scale, 4.0 * scale))
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    chosen: Command | None = None
    if imgui.begin_main_menu_bar():
        imgui.pop_style_var(2)
        imgui.push_style_var(imgui.StyleVar_.window_padding, (8.0 * scale, 8.0 * scale))
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (12.0 * scale, 7.0 * scale))
        for group, members in commands.groups():
            opened = imgui.begin_menu(group)
            widgets.note(f"menu {group}")
            if opened:
                chosen = _draw_items(widgets, members, recent) or chosen
                imgui.end_menu()
        imgui.pop_style_var(2)
        low, size = imgui.get_window_pos(), imgui.get_window_size()
        y = low.y + size.y - 1.0
        line = widgets.packed(widgets.theme.line)
        imgui.get_window_draw_list().add_line((low.x, y), (low.x + size.x, y), line)
        imgui.end_main_menu_bar()
    else:
        imgui.pop_style_var(2)
    if chosen is not None:
        chosen.run()


def _draw_items(
    widgets: Widgets, members: list[Command], recent: Callable[[], list[Command]]
) -> Command | None:
    chosen = None
    for k, command in enumerate(members):
        if k and command.name in _RULED:
            imgui.separator()
        if _draw_item(widgets, command):
            chosen = command
        if command.name == _RECENT_AFTER and imgui.begin_menu("Open recent", bool(recent())):
            for picture in recent():
                if _draw_item(widgets, picture):
                    chosen = picture
            imgui.end_menu()
        if command.name == _RECENT_AFTER:
            widgets.note("item Open recent")
    return chosen


def _draw_item(widgets: Widgets, command: Command) -> bool:
    key = str(command.keys[0]) if command.keys else ""
    is_on = command.is_on is not None and command.is_on()
    pressed = imgui.menu_item_simple(
        f"{command.label}##{command.name}", key, is_on, command.enabled
    )
    widgets.note(f"item {command.label}")
    if command.detail:
        widgets.tip(command.detail)
    return pressed
