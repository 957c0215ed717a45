"""What the editor can do, by name: for keys, buttons and menus alike."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from stippler.ui.events import NO_MODS, KeyDown, Mods

CTRL = Mods(ctrl=True)
CTRL_SHIFT = Mods(ctrl=True, shift=True)


@dataclass(frozen=True, slots=True)
class Key:
    """A key with its modifiers."""

    key: str
    mods: Mods = NO_MODS

    def __str__(self) -> str:
        held = [
            name
            for name, down in (
                ("Ctrl", self.mods.ctrl),
                ("Shift", self.mods.shift),
                ("Alt", self.mods.alt),
            )
            if down
        ]
        return "+".join([*held, self.key.capitalize()])


@dataclass(frozen=True, slots=True)
class Command:
    """One thing the editor can do.

    Attributes
    ----------
    name : str
        Unique; "view.fit".
    label : str
        As menus and tooltips show it.
    keys : tuple of Key
        The first is the one that is shown.
    """

    name: str
    label: str
    run: Callable[[], None]
    keys: tuple[Key, ...] = ()

    @property
    def hint(self) -> str:
        """The label with its key."""
        return f"{self.label} ({self.keys[0]})" if self.keys else self.label


class Commands:
    """All commands, found by name or by key."""

    def __init__(self, commands: Iterable[Command]) -> None:
        self._by_name: dict[str, Command] = {}
        self._by_key: dict[Key, Command] = {}
        for command in commands:
            if command.name in self._by_name:
                raise ValueError(f"two commands are called {command.name}")
            self._by_name[command.name] = command
            for key in command.keys:
                if key in self._by_key:
                    raise ValueError(f"{key} has two commands")
                self._by_key[key] = command

    def __getitem__(self, name: str) -> Command:
        return self._by_name[name]

    def __iter__(self) -> Iterator[Command]:
        return iter(self._by_name.values())

    def take(self, event: KeyDown) -> bool:
        """Run the command of a key; return whether it has one. Held keys do not repeat."""
        command = self._by_key.get(Key(event.key, event.mods))
        if command is None:
            return False
        if not event.repeated:
            command.run()
        return True
