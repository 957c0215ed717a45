"""The keys that a person has chosen, kept as JSON in the settings folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from stippler.editor.commands import Commands, Key
from stippler.settings import read_document, write_document

FILE = "keys.json"
_VERSION = 1
_MODIFIERS = ("ctrl", "control", "shift", "alt", "super")
_HELD = {"space": "space is held to move the page", "escape": "Esc takes back and closes"}


def refusal(key: Key) -> str:
    """Return why a key cannot run a command; nothing where it can."""
    if key.key in _HELD:
        return _HELD[key.key]
    return "this key has no name" if key.key == "unknown" else ""


def is_modifier(name: str) -> bool:
    """Return whether a key only changes what others do."""
    return name.removeprefix("left_").removeprefix("right_") in _MODIFIERS


def load_keys(folder: Path, commands: Commands) -> str:
    """Give commands the keys kept in a folder; return what was wrong with them, if anything."""
    path = folder / FILE
    document, problem = read_document(path)
    chosen = document.get("keys", {})
    if not isinstance(chosen, dict):
        return f"{path}: 'keys' is no object; the keys are as at first"
    for name, texts in chosen.items():
        if name not in commands:
            continue  # of another version
        try:
            commands.bind(name, _read_keys(texts))
        except ValueError as error:
            problem = f"{path}: the keys of {name} cannot be used ({error}); they are as at first"
    return problem


def _read_keys(texts: Any) -> tuple[Key, ...]:
    if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
        raise ValueError("not a list of keys")
    keys = tuple(Key.read(text) for text in texts)
    for key in keys:
        if why := refusal(key):
            raise ValueError(why)
    return keys


def save_keys(folder: Path, commands: Commands) -> None:
    """Keep the keys that are not as at first.

    Raises
    ------
    StipplerError
        If they cannot be written.
    """
    chosen = {
        command.name: [str(key) for key in command.keys]
        for command in commands
        if commands.is_changed(command.name)
    }
    write_document(folder / FILE, {"version": _VERSION, "keys": chosen})
