"""Events handed to ImGui one by one, so that it sees each when the editor does."""

from __future__ import annotations

import sys

from imgui_bundle import imgui

from stippler.editor.events import (
    LEFT,
    MIDDLE,
    RIGHT,
    Event,
    FocusGained,
    FocusLost,
    Gone,
    KeyDown,
    KeyUp,
    Mods,
    Moved,
    Pressed,
    Released,
    Scrolled,
    Typed,
)
from stippler.ui.window.key_names import with_key

_BUTTONS = {LEFT: 0, RIGHT: 1, MIDDLE: 2}
_NOWHERE = -3.4028234663852886e38  # -FLT_MAX, which ImGui takes for no place
_OTHERS = {
    "'": "apostrophe", ",": "comma", "-": "minus", ".": "period", "/": "slash", ";": "semicolon",
    "=": "equal", "[": "left_bracket", "\\": "backslash", "]": "right_bracket",
    "`": "grave_accent", "left": "left_arrow", "right": "right_arrow", "up": "up_arrow",
    "down": "down_arrow", "left_control": "left_ctrl", "right_control": "right_ctrl",
}  # fmt: skip


def _key(name: str) -> imgui.Key | None:
    """Return ImGui's key of a name in events."""
    if len(name) == 1 and name.isdigit():
        return getattr(imgui.Key, f"_{name}", None)
    known = _OTHERS.get(name, name.replace("kp_", "keypad_"))
    return getattr(imgui.Key, known, None) if known.isidentifier() else None


def feed(event: Event, ratio: tuple[float, float]) -> None:
    """Hand an event to ImGui; it acts on it in its next frame.

    Parameters
    ----------
    ratio : (float, float)
        Pixels a unit.
    """
    io = imgui.get_io()
    match event:
        case Moved() | Pressed() | Released() | Scrolled():
            io.add_mouse_pos_event(event.x_px / ratio[0], event.y_px / ratio[1])
        case Gone():
            io.add_mouse_pos_event(_NOWHERE, _NOWHERE)
    match event:
        case Pressed() | Released():
            _hold(event.mods)
            io.add_mouse_button_event(_BUTTONS[event.button], isinstance(event, Pressed))
        case Scrolled():
            _hold(event.mods)
            io.add_mouse_wheel_event(event.dx, event.dy)
        case KeyDown() | KeyUp():
            down = isinstance(event, KeyDown)
            _hold(with_key(event.mods, event.key, down=down))
            if (key := _key(event.key)) is not None:
                io.add_key_event(key, down)
        case Typed():
            io.add_input_characters_utf8(event.text)
        case FocusGained() | FocusLost():
            io.add_focus_event(isinstance(event, FocusGained))


def _hold(mods: Mods) -> None:
    """Tell which modifier keys are held; ImGui itself swaps Command and Ctrl on a Mac."""
    io = imgui.get_io()
    ctrl = imgui.Key.mod_super if sys.platform == "darwin" else imgui.Key.mod_ctrl
    for key, down in ((ctrl, mods.ctrl), (imgui.Key.mod_shift, mods.shift)):
        io.add_key_event(key, down)
    io.add_key_event(imgui.Key.mod_alt, mods.alt)
