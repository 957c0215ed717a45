"""GLFW's keys by the names that events carry."""

from __future__ import annotations

import sys

import imgui_bundle  # noqa: F401  # isort: skip - first: glfw then uses its library
import glfw

from stippler.editor.events import Mods

# What the keys print on most keyboards; asked only where the window system does not know.
_SIGNS = {
    "apostrophe": "'",
    "backslash": "\\",
    "comma": ",",
    "equal": "=",
    "grave_accent": "`",
    "left_bracket": "[",
    "minus": "-",
    "period": ".",
    "right_bracket": "]",
    "semicolon": ";",
    "slash": "/",
}


def _key_names() -> dict[int, str]:
    names = {
        value: name[4:].lower()
        for name, value in vars(glfw).items()
        if name.startswith("KEY_") and isinstance(value, int) and value >= 0
    }
    # The keypad types the same digits and signs.
    return {
        value: name[3:] if name.startswith("kp_") and len(name) == 4 else _SIGNS.get(name, name)
        for value, name in names.items()
    }


_NAMES = _key_names()


def key_name(key: int, scancode: int) -> str:
    """Name a key by what the person's own keyboard layout prints on it."""
    if glfw.KEY_SPACE < key < glfw.KEY_ESCAPE:  # the keys that print a sign
        printed = glfw.get_key_name(key, scancode)
        if printed and len(printed) == 1 and printed.isascii():
            return str(printed).lower()
    return _NAMES.get(key, "unknown")


def mods_of(bits: int) -> Mods:
    """Read GLFW's modifier bits; Command counts as Ctrl on a Mac."""
    ctrl = glfw.MOD_SUPER if sys.platform == "darwin" else glfw.MOD_CONTROL
    return Mods(bool(bits & ctrl), bool(bits & glfw.MOD_SHIFT), bool(bits & glfw.MOD_ALT))


def with_key(mods: Mods, name: str, *, down: bool) -> Mods:
    """Return what is held once a key is down or up; systems tell what was held before it."""
    held = name.removeprefix("left_").removeprefix("right_")
    ctrl = "super" if sys.platform == "darwin" else "control"
    return Mods(
        down if held == ctrl else mods.ctrl,
        down if held == "shift" else mods.shift,
        down if held == "alt" else mods.alt,
    )
