"""The list of commands in which a person gives them other keys."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from stippler.editor.commands import Command, Commands, Key
from stippler.editor.events import KeyDown
from stippler.editor.fuzzy import match
from stippler.editor.keymap import is_modifier, refusal
from stippler.ui.theme import ICON_RESET
from stippler.ui.widgets import Widgets

_KEYS_WIDTH = 150.0


class KeyList:
    """Lists commands; a click and a key give a command that key.

    Parameters
    ----------
    keep : callable
        Called after each change.

    Attributes
    ----------
    said : str
        What there is to say about the key that was pressed last.
    """

    def __init__(self, keep: Callable[[], None]) -> None:
        self._keep = keep
        self._typed = ""
        self._asked = ""  # the command that waits for a key
        self._wanted: Key | None = None  # pressed, and another command's so far
        self.said = ""

    @property
    def waits(self) -> bool:
        """Whether a command waits for a key."""
        return bool(self._asked)

    def forget(self) -> None:
        """Wait for a key no longer."""
        self._asked, self._wanted, self.said = "", None, ""

    def take(self, event: KeyDown, commands: Commands) -> None:
        """Take the key that the command waits for; Esc takes none."""
        if is_modifier(event.key) or event.repeated:
            return
        if event.key == "escape":
            self.forget()
            return
        key = Key(event.key, event.mods)
        if why := refusal(key):
            self.said = f"{key}: {why}; press another key"
            return
        owner = commands.owner(key)
        if owner is None or owner.name == self._asked:
            self._bind(commands, (key,))
        else:
            self._wanted = key
            self.said = f"{key} is used by {owner.label}; it will have {_rest(owner, key)}."

    def draw(self, widgets: Widgets, commands: Commands) -> None:
        """Draw the list, and what there is to say."""
        width = 96.0 * widgets.scale
        imgui.set_next_item_width(-width - widgets.gap)
        _, self._typed = imgui.input_text_with_hint("##key search", "Search", self._typed)
        widgets.note("key search")
        widgets.tip("Letters of a command's name, or of its keys.")
        imgui.same_line(0.0, widgets.gap)
        if widgets.button("Reset all", "Every command gets the keys it had at first.", width=width):
            commands.reset_all()
            self.forget()
            self._keep()
        self._draw_answer(widgets, commands)
        imgui.begin_child("##keys")
        for group, members in commands.groups():
            fits = [one for one in members if self._fits(one)]
            if fits:
                widgets.heading(group)
            for command in fits:
                self._draw_command(widgets, commands, command)
        imgui.end_child()

    def _fits(self, command: Command) -> bool:
        text = f"{command.label} {command.shown_keys}"
        return not self._typed.strip() or match(self._typed, text) is not None

    def _draw_command(self, widgets: Widgets, commands: Commands, command: Command) -> None:
        side, scale = imgui.get_frame_height(), widgets.scale
        keys = _KEYS_WIDTH * scale
        right = imgui.get_content_region_avail().x
        waits = command.name == self._asked
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(command.label)
        imgui.same_line(right - keys - side - widgets.gap)
        text = "Press a key…" if waits else command.shown_keys or "none"
        tip = "Click, then press the key that is to run this."
        if widgets.button(text, tip, name=f"key {command.label}", width=keys, primary=waits):
            self.forget()
            self._asked = "" if waits else command.name
        imgui.same_line(0.0, widgets.gap)
        if commands.is_changed(command.name):
            tip = "The keys it had at first."
            if widgets.icon_button(f"reset {command.label}", ICON_RESET, tip):
                commands.reset(command.name)
                self.forget()
                self._keep()
        else:
            imgui.dummy((side, side))

    def _draw_answer(self, widgets: Widgets, commands: Commands) -> None:
        """Draw what can be done while a command waits for a key."""
        if not self._asked:
            widgets.caption("Click the keys of a command to change them.")
            return
        label = commands[self._asked].label
        widgets.caption(
            self.said or f"Press the key for {label}. Esc leaves it as it is.",
            widgets.theme.alarm if self.said else None,
        )
        if self._wanted is not None:
            tip = "The other command loses this key."
            if widgets.button(f"Use {self._wanted}", tip, primary=True):
                self._bind(commands, (self._wanted,))
                return
            imgui.same_line(0.0, widgets.gap)
        if widgets.button("No key", f"{label} has no key then; menu and palette still run it."):
            self._bind(commands, ())
            return
        imgui.same_line(0.0, widgets.gap)
        if widgets.button("Leave", "Changes nothing (Esc)."):
            self.forget()

    def _bind(self, commands: Commands, keys: tuple[Key, ...]) -> None:
        commands.bind(self._asked, keys)
        self.forget()
        self._keep()


def _rest(command: Command, key: Key) -> str:
    """Return the keys that a command has besides one."""
    rest = [str(other) for other in command.keys if other != key]
    return f"only {', '.join(rest)}" if rest else "none"
