"""The palette: every command, found by a few typed letters."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from stippler.editor.commands import Command, Commands
from stippler.editor.fuzzy import match
from stippler.ui.preferences import Preferences
from stippler.ui.theme import SMALL_PX
from stippler.ui.widgets import Widgets

_TITLE = "##palette"
_WIDTH, _ROWS, _TOP = 520.0, 11, 56.0
_MOST_HEIGHT = 0.6  # of the window, for the list
_WORST, _CLOSE = 0.25, 10.0  # of the best fit, and below it; what fits worse is chance
_FLAGS = imgui.WindowFlags_.no_decoration | imgui.WindowFlags_.no_move


class Palette:
    """Lists commands, best first, and runs the one that is chosen.

    Parameters
    ----------
    kept : Preferences
        Knows which commands were run last.
    more : callable
        Commands that come and go: recent pictures, controls of panels.
    values : callable
        Commands that a text with a number at its end tells: "gamma 1.2".

    Attributes
    ----------
    found : list of Command
        What is listed, the best first.
    """

    def __init__(
        self,
        kept: Preferences,
        more: Callable[[], list[Command]],
        values: Callable[[str], list[Command]] = lambda _: [],
    ) -> None:
        self._kept, self._more, self._values = kept, more, values
        self._wanted = False
        self._typed, self._at = "", 0
        self._follow = False  # the list scrolls to what the arrows have chosen
        self.is_open = False
        self.found: list[Command] = []

    @property
    def is_asked(self) -> bool:
        """Whether it opens in this frame."""
        return self._wanted

    def ask(self) -> None:
        """Open the palette in the next frame."""
        self._wanted = True

    def draw(self, widgets: Widgets, commands: Commands) -> None:
        """Draw the palette, if it is open; run what was chosen."""
        fresh = self._wanted
        if fresh:
            self._wanted = False
            self._typed, self._at = "", 0
            self.found = self._find(commands)
            imgui.open_popup(_TITLE)
        viewport, scale = imgui.get_main_viewport(), widgets.scale
        width = min(_WIDTH * scale, viewport.work_size.x - 2 * widgets.margin)
        top = viewport.work_pos.y + min(_TOP * scale, viewport.work_size.y / 8)
        imgui.set_next_window_pos((viewport.get_center().x, top), imgui.Cond_.always, (0.5, 0.0))
        imgui.set_next_window_size((width, 0.0))
        imgui.push_style_var(imgui.StyleVar_.window_padding, (10.0 * scale, 10.0 * scale))
        self.is_open = imgui.begin_popup(_TITLE, _FLAGS)
        imgui.pop_style_var()
        if not self.is_open:
            return
        chosen = self._draw_field(widgets, commands, fresh=fresh) or self._draw_list(widgets)
        if chosen is not None or widgets.escaped():
            imgui.close_current_popup()
            self.is_open = False
        imgui.end_popup()
        if chosen is not None:
            if chosen.name in commands:
                self._kept.note_ran(chosen.name)
            chosen.run()

    def _draw_field(self, widgets: Widgets, commands: Commands, *, fresh: bool) -> Command | None:
        """Draw the field; return the command that Enter chooses."""
        if fresh:
            imgui.set_keyboard_focus_here()
        imgui.set_next_item_width(-1.0)
        changed, self._typed = imgui.input_text_with_hint(
            "##typed", "What do you want to do?", self._typed
        )
        widgets.note("palette")
        if changed:
            self._at, self.found = 0, self._find(commands)
            imgui.set_scroll_y(0.0)
        step = imgui.is_key_pressed(imgui.Key.down_arrow) - imgui.is_key_pressed(imgui.Key.up_arrow)
        self._follow = bool(step) or changed
        if self.found and step:
            self._at = (self._at + step) % len(self.found)
        entered = imgui.is_key_pressed(imgui.Key.enter) or imgui.is_key_pressed(
            imgui.Key.keypad_enter
        )
        return self.found[self._at] if entered and self.found else None

    def _draw_list(self, widgets: Widgets) -> Command | None:
        """Draw the commands; return the one that is clicked."""
        if not self.found:
            widgets.caption("No command has such a name.")
            return None
        chosen = None
        height = imgui.get_text_line_height() + 10.0 * widgets.scale
        room = imgui.get_main_viewport().work_size.y * _MOST_HEIGHT
        rows = min(len(self.found), _ROWS, max(int(room / height), 1))
        imgui.push_style_var(imgui.StyleVar_.item_spacing, (0.0, 0.0))
        imgui.begin_child("##found", (0.0, rows * height))
        for k, command in enumerate(self.found):
            if _draw_row(widgets, command, height, chosen=k == self._at):
                chosen = command
            if k == self._at and self._follow:
                imgui.set_scroll_here_y(0.5)
        imgui.end_child()
        imgui.pop_style_var()
        return chosen

    def _find(self, commands: Commands) -> list[Command]:
        """Return the commands that fit what is typed, the best first."""
        every = [*commands, *self._more()]
        if not self._typed.strip():
            every = [one for one in every if not one.name.startswith("field.")]
            last = {name: k for k, name in enumerate(self._kept.ran)}
            return sorted(every, key=lambda command: last.get(command.name, len(last)))
        typed = self._values(self._typed)
        scored = [(_score(self._typed, command), command) for command in every]
        fits = [(score, command) for score, command in scored if score is not None]
        fits.sort(key=lambda fit: -fit[0])
        best = fits[0][0] if fits else 0.0
        least = min(_WORST * best, best - _CLOSE)
        return typed + [command for score, command in fits if score >= least]


def _score(typed: str, command: Command) -> float | None:
    """Return how well a command fits: by its label, else with its group and detail."""
    own = match(typed, command.label)
    if own is not None:
        return own
    wide = match(typed, f"{command.label} {command.group} {command.detail}")
    return wide - 20.0 if wide is not None else None


def _draw_row(widgets: Widgets, command: Command, height: float, *, chosen: bool) -> bool:
    """Draw a command with its group and keys; return whether it was clicked."""
    corner = imgui.get_cursor_screen_pos()
    width = imgui.get_content_region_avail().x
    clicked = imgui.invisible_button(f"##{command.name}", (width, height))
    widgets.note(f"palette {command.label}")
    draw, theme, scale = imgui.get_window_draw_list(), widgets.theme, widgets.scale
    if chosen or imgui.is_item_hovered():
        end = (corner.x + width, corner.y + height)
        fill = theme.accent if chosen else theme.raised
        draw.add_rect_filled(corner, end, widgets.packed(fill), 5.0 * scale)
    text = theme.on_accent if chosen else theme.text if command.enabled else theme.faint
    faint = theme.on_accent if chosen else theme.faint
    y = corner.y + (height - imgui.get_text_line_height()) / 2
    draw.add_text((corner.x + 9.0 * scale, y), widgets.packed(text), command.label)
    aside = corner.x + 9.0 * scale + imgui.calc_text_size(command.label).x + 12.0 * scale
    keys = command.shown_keys
    right = corner.x + width - 9.0 * scale - imgui.calc_text_size(keys).x
    draw.add_text((right, y), widgets.packed(faint), keys)
    imgui.push_font(None, SMALL_PX)
    y = corner.y + (height - imgui.get_text_line_height()) / 2 + scale
    draw.push_clip_rect(
        (aside, corner.y), (max(right - 12.0 * scale, aside), corner.y + height), True
    )
    draw.add_text((aside, y), widgets.packed(faint, 0.85), command.detail or command.group)
    draw.pop_clip_rect()
    imgui.pop_font()
    return clicked
