"""The menu bar, made from the commands."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from stippler.editor.commands import GROUPS, Command, Commands
from stippler.editor.events import NO_MODS, KeyDown, Mods
from stippler.ui.theme import TEXT_PX
from stippler.ui.widgets import Widgets

_SMALLEST = 0.6
_RECENT_AFTER = "file.open"
_RULED = {
    "file.save", "file.export_as", "file.quit", "edit.preferences", "selection.delete",
    "selection.fix", "selection.relax", "work.relax", "work.reset", "tool.larger", "view.peek",
    "view.turn_left", "view.reduce", "view.theme", "panel.reset",
}  # fmt: skip
"""Commands that a line stands above."""


class MenuBar:
    """The bar along the upper edge of the window; Alt and a letter, or F10, opens a menu."""

    def __init__(self) -> None:
        self._wanted = ""  # the menu that a key has asked for
        self._pointed = ""  # the open menu that was opened by pointing at it, not by a press
        self._open = ""

    def take(self, event: KeyDown) -> bool:
        """Take a key that opens a menu; return whether it was one."""
        names = list(GROUPS.values())
        if event.key == "f10" and event.mods == NO_MODS:
            self._wanted = names[0]
            return True
        if event.mods == Mods(alt=True):
            self._wanted = next((n for n in names if n[0].lower() == event.key), self._wanted)
        return event.mods == Mods(alt=True) and bool(self._wanted)

    def draw(
        self, widgets: Widgets, commands: Commands, recent: Callable[[], list[Command]]
    ) -> None:
        """Draw the bar; run what is chosen."""
        scale = widgets.scale
        share = _share([group for group, _ in commands.groups()], scale)
        imgui.push_style_var(imgui.StyleVar_.frame_padding, (9.0 * scale * share, 4.0 * scale))
        imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
        chosen: Command | None = None
        if imgui.begin_main_menu_bar():
            imgui.pop_style_var(2)
            imgui.push_style_var(imgui.StyleVar_.window_padding, (8.0 * scale, 8.0 * scale))
            imgui.push_style_var(imgui.StyleVar_.item_spacing, (12.0 * scale, 7.0 * scale))
            for group, members in commands.groups():
                if self._draw_title(widgets, group, share):
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

    def _draw_title(self, widgets: Widgets, group: str, share: float) -> bool:
        """Draw a menu's title; return whether it is open, for a click after pointing, too."""
        if self._wanted == group:
            self._wanted = ""
            imgui.open_popup(group)
            imgui.set_nav_cursor_visible(True)
        was_open, pressed = self._open == group, imgui.is_mouse_clicked(imgui.MouseButton_.left)
        imgui.push_font(None, TEXT_PX * share)
        imgui.push_style_var(
            imgui.StyleVar_.item_spacing, (12.0 * widgets.scale * share, 7.0 * widgets.scale)
        )
        opened = imgui.begin_menu(group)
        imgui.pop_style_var()
        imgui.pop_font()
        if not opened and was_open and self._pointed == group and pressed:
            imgui.open_popup(group)  # a click on what pointing has opened is no wish to close it
            self._pointed = ""
        elif opened and not was_open:
            self._pointed = "" if pressed else group
            self._open = group
        elif not opened and was_open:
            self._open = ""
        widgets.note(f"menu {group}")
        return opened


def _share(titles: list[str], scale: float) -> float:
    """Return how small titles have to be, that all of them stand in the bar."""
    room = imgui.get_main_viewport().size.x - 24.0 * scale
    wide = sum(imgui.calc_text_size(title).x + 25.0 * scale for title in titles)
    return max(min(room / wide, 1.0), _SMALLEST)


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
