"""The window of preferences: look, values, panels and keys."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from stippler.editor.commands import Commands
from stippler.editor.events import KeyDown
from stippler.editor.saving import MOST_AUTOSAVE_MIN, MOST_BACKUPS
from stippler.ui.popups.key_list import KeyList
from stippler.ui.preferences import Preferences
from stippler.ui.theme import DARK, LIGHT
from stippler.ui.widgets import Widgets

TITLE = "Preferences"
_WIDTH, _HEIGHT = 480.0, 520.0
_PERCENT = (75, 90, 100, 110, 125, 150, 175, 200, 250, 300)
_THEMES = (LIGHT, DARK)


class PreferencesWindow:
    """Changes take effect at once, and are kept.

    Parameters
    ----------
    keep_keys : callable
        Called when a command has other keys.
    display_scale : callable
        The scale that the display tells.
    """

    def __init__(
        self,
        kept: Preferences,
        keep_keys: Callable[[], None],
        display_scale: Callable[[], float],
    ) -> None:
        self._kept, self._display_scale = kept, display_scale
        self._focus = self._focused = False
        self.keys = KeyList(keep_keys)
        self.is_open = False

    def ask(self) -> None:
        """Open the window, or bring it to the front."""
        self.is_open = self._focus = True

    def take(self, event: KeyDown, commands: Commands) -> bool:
        """Take the key that a command waits for, or Esc; return whether it was for the window."""
        if self.is_open and self.keys.waits:
            self.keys.take(event, commands)
            return True
        if self.is_open and self._focused and event.key == "escape":
            self.is_open = False
            return True
        return False

    def draw(self, widgets: Widgets, commands: Commands) -> None:
        """Draw the window, if it is open."""
        if not self.is_open:
            return
        viewport, scale = imgui.get_main_viewport(), widgets.scale
        size = (
            min(_WIDTH * scale, viewport.work_size.x - 40 * scale),
            min(_HEIGHT * scale, viewport.work_size.y - 60 * scale),
        )
        imgui.set_next_window_size(size, imgui.Cond_.always)
        imgui.set_next_window_pos(viewport.get_center(), imgui.Cond_.appearing, (0.5, 0.5))
        if self._focus:
            imgui.set_next_window_focus()
            self._focus = False
        flags = (
            imgui.WindowFlags_.no_collapse
            | imgui.WindowFlags_.no_docking
            | imgui.WindowFlags_.no_resize
            | imgui.WindowFlags_.no_saved_settings
        )
        shown, stays = imgui.begin(TITLE, True, flags)
        self.is_open = bool(stays)
        self._focused = imgui.is_window_focused(imgui.FocusedFlags_.root_and_child_windows)
        if shown:
            self._draw_tabs(widgets, commands)
        imgui.end()
        if not self.is_open:
            self.keys.forget()

    def _draw_tabs(self, widgets: Widgets, commands: Commands) -> None:
        if not imgui.begin_tab_bar("##tabs"):
            return
        for label, draw in (
            ("Look", self._draw_look),
            ("Files", self._draw_files),
            ("Panels", self._draw_panels),
            ("Keys", self.keys.draw),
        ):
            shown = imgui.begin_tab_item(label)[0]
            widgets.note(f"tab {label}")
            if shown:
                imgui.dummy((0.0, 2.0 * widgets.scale))
                draw(widgets, commands)
                imgui.end_tab_item()
        imgui.end_tab_bar()

    def _draw_look(self, widgets: Widgets, commands: Commands) -> None:
        look = self._kept.look
        chosen = widgets.segments(
            "Theme",
            ("Light", "Dark"),
            _THEMES.index(look.theme),
            ("Paper in daylight.", "At night."),
        )
        look.theme = _THEMES[chosen]
        self._draw_scale(widgets)
        widgets.label("Picture")
        look.opacity = widgets.share(
            "Picture opacity", look.opacity, "Of the picture under the dots."
        )
        widgets.rule()
        widgets.heading("Values")
        widgets.caption(
            "Tone, page width and the values of the dots are at the next start as they were last "
            "used, but for those on the command line; the seed is 1 again."
        )
        if widgets.button("Default values", f"{commands['work.reset'].label}: tone, width, dots."):
            commands["work.reset"].run()
        if self._kept.folder is not None:
            widgets.rule()
            widgets.caption(f"All this is kept in {self._kept.folder}")

    def _draw_scale(self, widgets: Widgets) -> None:
        look = self._kept.look
        options = [
            f"Automatic ({100 * self._display_scale():.0f} %)",
            *(f"{p} %" for p in _PERCENT),
        ]
        now = round(100 * look.scale)
        if now and now not in _PERCENT:
            options.append(f"{now} %")
        chosen = 0 if not now else _PERCENT.index(now) + 1 if now in _PERCENT else len(options) - 1
        picked = widgets.choice(
            "Scale",
            options,
            chosen,
            "Size of text and controls; 100 % is meant for 96 dots per inch.",
        )
        if picked != chosen:
            look.scale = _PERCENT[picked - 1] / 100 if picked else 0.0

    def _draw_files(self, widgets: Widgets, commands: Commands) -> None:
        wishes = self._kept.saving
        wishes.history = widgets.check(
            "History in files", wishes.history,
            "Saves the steps of the history, too: they can be undone after opening.",
        )  # fmt: skip
        n = widgets.number(
            "Earlier versions", wishes.n_backups, "How many of each drawing are kept; 0 for none."
        )
        wishes.n_backups = min(max(n, 0), MOST_BACKUPS)
        n = widgets.number(
            "Autosave, min", wishes.autosave_min, "Minutes between two of them; 0 for none."
        )
        wishes.autosave_min = min(max(n, 0), MOST_AUTOSAVE_MIN)
        widgets.caption(
            "An autosave is an earlier version, too: your file is replaced only when you save. "
            f"{commands['file.earlier'].label} in the File menu opens them."
        )

    def _draw_panels(self, widgets: Widgets, commands: Commands) -> None:
        for command in commands:
            if command.is_on is not None and command.name.startswith("panel."):
                is_on = command.is_on()
                if (
                    widgets.check(
                        command.label,
                        is_on,
                        f"Show or hide the panel {command.label}.",
                        name=f"show {command.label}",
                    )
                    != is_on
                ):
                    command.run()
        widgets.caption("Drag a panel by its tab to dock it elsewhere, or to let it float.")
        imgui.dummy((0.0, 2.0 * widgets.scale))
        if widgets.button(
            "Reset the panels", "All panels in a row of tabs at the left, as at first."
        ):
            commands["panel.reset"].run()
