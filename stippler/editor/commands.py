"""What the editor can do, by name: for keys, buttons and menus alike."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import cache

from stippler.editor.events import NO_MODS, KeyDown, Mods

CTRL = Mods(ctrl=True)
SHIFT = Mods(shift=True)
CTRL_SHIFT = Mods(ctrl=True, shift=True)

GROUPS = {
    "file": "File",
    "edit": "Edit",
    "selection": "Select",
    "area": "Areas",
    "nodes": "Nodes",
    "work": "Dots",
    "line": "Lines",
    "pattern": "Patterns",
    "tool": "Tool",
    "view": "View",
    "panel": "Panels",
    "help": "Help",
}
"""The first part of a command's name, and the menu it stands in; in the menu bar's order."""

_SHOWN = {
    "page_up": "Page Up", "page_down": "Page Down", "escape": "Esc", "kp_add": "Keypad Plus",
    "kp_subtract": "Keypad Minus", "kp_multiply": "Keypad Times", "kp_divide": "Keypad Divide",
    "kp_enter": "Keypad Enter", "kp_decimal": "Keypad Point",
}  # fmt: skip
_SMALL = {",": "Comma", ".": "Period"}  # hard to see where nothing stands before them
_NAMES = {shown.lower(): name for name, shown in (_SHOWN | _SMALL).items()}


@dataclass(frozen=True, slots=True)
class Key:
    """A key with its modifiers."""

    key: str
    mods: Mods = NO_MODS

    def __str__(self) -> str:
        return _written(self)

    @classmethod
    def read(cls, text: str) -> Key:
        """Return the key that `str` has written.

        Raises
        ------
        ValueError
            If the text names none.
        """
        head, _, name = text.rpartition("+") if text[-1:] != "+" else (text[:-2], "+", "+")
        held = head.split("+") if head else []
        if not name or not set(held) <= {"Ctrl", "Shift", "Alt"}:
            raise ValueError(f"{text!r} is no key")
        mods = Mods("Ctrl" in held, "Shift" in held, "Alt" in held)
        return cls(_NAMES.get(name.lower(), name.lower()), mods)


@cache
def _written(key: Key) -> str:
    mods = key.mods
    names = (("Ctrl", mods.ctrl), ("Shift", mods.shift), ("Alt", mods.alt))
    held = [name for name, is_down in names if is_down]
    shown = _SHOWN if held else _SHOWN | _SMALL
    return "+".join([*held, shown.get(key.key, key.key.capitalize())])


@dataclass(frozen=True, slots=True)
class Command:
    """One thing the editor can do.

    Attributes
    ----------
    name : str
        Unique; "view.fit". What stands before the point is its group.
    label : str
        As menus and tooltips show it.
    keys : tuple of Key
        The first is the one that is shown.
    can : callable or None
        Whether it would do anything now; menus show it faint where not.
    is_on : callable or None
        Whether what it turns on and off is on.
    detail : str
        Said beside the label where there is room.
    repeats : bool
        Whether it is run again and again while its key is held.
    short : str
        As a button says it, where what it is for is clear; the label if not given.
    tip : str
        What it does, where the label does not tell.
    hint : str
        The label with its key.
    """

    name: str
    label: str
    run: Callable[[], None]
    keys: tuple[Key, ...] = ()
    can: Callable[[], bool] | None = None
    is_on: Callable[[], bool] | None = None
    detail: str = ""
    repeats: bool = False
    short: str = ""
    tip: str = ""
    hint: str = field(init=False)

    def __post_init__(self) -> None:
        if not self.short:
            object.__setattr__(self, "short", self.label)
        shown = f"{self.label} ({self.keys[0]})" if self.keys else self.label
        object.__setattr__(self, "hint", shown)

    @property
    def explained(self) -> str:
        """The label with its key, and what it does."""
        return f"{self.hint}: {self.tip}" if self.tip else f"{self.hint}."

    @property
    def shown_keys(self) -> str:
        """All keys, as lists show them."""
        return ", ".join(dict.fromkeys(str(key) for key in self.keys))

    @property
    def group(self) -> str:
        """The menu it stands in."""
        head = self.name.partition(".")[0]
        return GROUPS.get(head, head.capitalize())

    @property
    def enabled(self) -> bool:
        """Whether it would do anything now."""
        return self.can is None or self.can()


class Commands:
    """All commands, found by name or by key; a person may give them other keys.

    Attributes
    ----------
    by_key : bool
        Whether the command that runs was asked for by its key.
    """

    def __init__(self, commands: Iterable[Command]) -> None:
        self.by_key = False
        self._by_name: dict[str, Command] = {}
        self._by_key: dict[Key, str] = {}
        for command in commands:
            if command.name in self._by_name:
                raise ValueError(f"two commands are called {command.name}")
            self._by_name[command.name] = command
            for key in command.keys:
                if key in self._by_key:
                    raise ValueError(f"{key} has two commands")
                self._by_key[key] = command.name
        self._groups: list[tuple[str, list[Command]]] = []
        self._first_keys = {name: command.keys for name, command in self._by_name.items()}

    def __getitem__(self, name: str) -> Command:
        return self._by_name[name]

    def __contains__(self, name: object) -> bool:
        return name in self._by_name

    def __iter__(self) -> Iterator[Command]:
        return iter(self._by_name.values())

    def groups(self) -> list[tuple[str, list[Command]]]:
        """Return the groups in the menu bar's order, each with its commands; asked every frame."""
        if not self._groups:
            self._groups = self._grouped()
        return self._groups

    def _grouped(self) -> list[tuple[str, list[Command]]]:
        found: dict[str, list[Command]] = {group: [] for group in GROUPS.values()}
        for command in self:
            found.setdefault(command.group, []).append(command)
        return [(group, commands) for group, commands in found.items() if commands]

    # --- keys -------------------------------------------------------------------------------

    def owner(self, key: Key) -> Command | None:
        """Return the command that a key runs."""
        name = self._by_key.get(key)
        return self._by_name[name] if name is not None else None

    def bind(self, name: str, keys: tuple[Key, ...]) -> None:
        """Give a command other keys; commands that had them before lose them."""
        for key in keys:
            other = self.owner(key)
            if other is not None and other.name != name:
                self._set_keys(other.name, tuple(k for k in other.keys if k != key))
        self._set_keys(name, keys)

    def reset(self, name: str) -> None:
        """Give a command the keys it had at first."""
        self.bind(name, self._first_keys[name])

    def reset_all(self) -> None:
        """Give every command the keys it had at first."""
        for name in self._by_name:
            self._set_keys(name, ())
        for name, keys in self._first_keys.items():
            self._set_keys(name, keys)

    def is_changed(self, name: str) -> bool:
        """Return whether a command has other keys than at first."""
        return self._by_name[name].keys != self._first_keys[name]

    def _set_keys(self, name: str, keys: tuple[Key, ...]) -> None:
        for key in self._by_name[name].keys:
            if self._by_key.get(key) == name:
                del self._by_key[key]
        self._by_name[name] = replace(self._by_name[name], keys=keys)
        self._by_key.update(dict.fromkeys(keys, name))
        self._groups = []

    def take(self, event: KeyDown) -> bool:
        """Run the command of a key; return whether it has one."""
        command = self.owner(Key(event.key, event.mods))
        if command is None:
            return False
        if command.repeats or not event.repeated:
            self.by_key = True
            try:
                command.run()
            finally:
                self.by_key = False
        return True
