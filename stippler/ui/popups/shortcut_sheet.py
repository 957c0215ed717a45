"""The sheet of shortcuts: every command that has keys, and what the mouse does."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.editor.commands import Commands
from stippler.editor.fuzzy import match
from stippler.editor.gestures import GESTURES
from stippler.ui.theme import SMALL_PX, TEXT_PX
from stippler.ui.widgets import Widgets

_TITLE = "##sheet"
_COLUMN, _MOST_COLUMNS = 300.0, 3
_FLAGS = imgui.WindowFlags_.no_decoration | imgui.WindowFlags_.no_move

Lines = list[tuple[str, str]]


class Sheet:
    """An overlay over the window; Esc, a click beside it, or its own key closes it."""

    def __init__(self) -> None:
        self._wanted = False
        self._typed = ""
        self._close = False
        self.is_open = False

    def ask(self) -> None:
        """Open the sheet in the next frame, or close it."""
        self._wanted, self._close = not self.is_open, self.is_open

    def draw(self, widgets: Widgets, commands: Commands) -> None:
        """Draw the sheet, if it is open."""
        fresh = self._wanted
        if fresh:
            self._wanted, self._typed = False, ""
            imgui.open_popup(_TITLE)
        viewport, scale = imgui.get_main_viewport(), widgets.scale
        room = (viewport.work_size.x - 48 * scale, viewport.work_size.y - 48 * scale)
        columns = max(min(int(room[0] / (_COLUMN * scale)), _MOST_COLUMNS), 1)
        imgui.set_next_window_pos(viewport.get_work_center(), imgui.Cond_.always, (0.5, 0.5))
        imgui.set_next_window_size((min(columns * (_COLUMN + 24) * scale, room[0]), room[1]))
        self.is_open = imgui.begin_popup(_TITLE, _FLAGS)
        if not self.is_open:
            return
        self._draw_head(widgets, commands, fresh=fresh)
        imgui.begin_child("##lines")
        _draw_columns(widgets, _parts(commands, self._typed), columns)
        imgui.end_child()
        if self._close or widgets.escaped():
            self._close = self.is_open = False
            imgui.close_current_popup()
        imgui.end_popup()

    def _draw_head(self, widgets: Widgets, commands: Commands, *, fresh: bool) -> None:
        field = 220.0 * widgets.scale
        imgui.align_text_to_frame_padding()
        imgui.push_font(widgets.fonts.heading, TEXT_PX * 1.2)
        imgui.text("Shortcuts")
        imgui.pop_font()
        imgui.same_line(imgui.get_window_width() - field - widgets.margin)
        if fresh:
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(field)
        _, self._typed = imgui.input_text_with_hint("##typed", "Search", self._typed)
        widgets.note("sheet")
        palette = commands["help.palette"].shown_keys or "in the Help menu"
        widgets.caption(
            f"All commands, also those without keys: {palette}. "
            "Other keys: Preferences. Esc closes this sheet."
        )
        widgets.rule()


def _parts(commands: Commands, typed: str) -> list[tuple[str, Lines]]:
    """Return the groups with their lines, of which only those that fit what is typed."""
    parts = [
        (group, [(one.label, one.shown_keys) for one in members if one.keys])
        for group, members in commands.groups()
    ]
    parts.append(("Mouse", list(GESTURES)))
    if typed.strip():
        parts = [
            (group, [line for line in lines if match(typed, f"{line[0]} {line[1]} {group}")])
            for group, lines in parts
        ]
    return [(group, lines) for group, lines in parts if lines]


def _spread(parts: list[tuple[str, Lines]], n: int) -> list[list[tuple[str, Lines]]]:
    """Deal groups into columns of like height, in their order."""
    height = sum(len(lines) + 2 for _, lines in parts)
    columns: list[list[tuple[str, Lines]]] = [[] for _ in range(n)]
    filled = 0.0
    for group, lines in parts:
        middle = filled + (len(lines) + 2) / 2
        columns[min(int(n * middle / max(height, 1)), n - 1)].append((group, lines))
        filled += len(lines) + 2
    return columns


def _draw_columns(widgets: Widgets, parts: list[tuple[str, Lines]], n: int) -> None:
    if not parts:
        widgets.caption("Nothing is called so.")
        return
    imgui.push_style_var(imgui.StyleVar_.cell_padding, (10.0 * widgets.scale, 0.0))
    if imgui.begin_table("##columns", n, imgui.TableFlags_.sizing_stretch_same):
        for column in _spread(parts, n):
            imgui.table_next_column()
            for group, lines in column:
                widgets.heading(group)
                imgui.push_style_var(
                    imgui.StyleVar_.item_spacing, (6.0 * widgets.scale, 5.0 * widgets.scale)
                )
                for label, keys in lines:
                    _draw_line(widgets, label, keys)
                imgui.pop_style_var()
        imgui.end_table()
    imgui.pop_style_var()


def _draw_line(widgets: Widgets, label: str, keys: str) -> None:
    """Draw a label at the left and its keys at the right, below each other where both are long."""
    left, room = imgui.get_cursor_pos_x(), imgui.get_content_region_avail().x
    imgui.push_font(None, SMALL_PX)
    imgui.text_unformatted(label)
    widgets.note(f"sheet {label}")
    width = imgui.calc_text_size(keys).x
    if imgui.calc_text_size(label).x + width + 12.0 * widgets.scale <= room:
        imgui.same_line()
    imgui.set_cursor_pos_x(left + room - width)
    imgui.text_colored((*widgets.theme.accent, 1.0), keys)
    imgui.pop_font()
