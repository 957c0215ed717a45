"""The system's input as events, in the order in which it came."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from pathlib import Path

from imgui_bundle import imgui  # noqa: F401  # isort: skip - first: glfw then uses its library
import glfw

from stippler.editor.events import (
    LEFT,
    MIDDLE,
    NO_MODS,
    RIGHT,
    CloseAsked,
    Dropped,
    Event,
    Exposed,
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
from stippler.ui.window.key_names import key_name, mods_of, with_key

_BUTTONS = {
    glfw.MOUSE_BUTTON_LEFT: LEFT,
    glfw.MOUSE_BUTTON_RIGHT: RIGHT,
    glfw.MOUSE_BUTTON_MIDDLE: MIDDLE,
}


class Input:
    """Takes GLFW's callbacks of one window; scripted hands call the same methods.

    Parameters
    ----------
    handle : GLFWwindow
    ratio : callable
        Pixels a unit, across and down.
    """

    def __init__(
        self, handle: ctypes._Pointer[glfw._GLFWwindow], ratio: Callable[[], tuple[float, float]]
    ) -> None:
        self._ratio = ratio
        self._events: list[Event] = []
        self._at_px = (0.0, 0.0)
        self._held = NO_MODS
        self._listen(handle)

    def attach(self, handle: ctypes._Pointer[glfw._GLFWwindow]) -> None:
        """Take the input of another window from now on; what was held down is let go."""
        self._listen(handle)
        self.focus(False)
        self.focus(True)

    def _listen(self, handle: ctypes._Pointer[glfw._GLFWwindow]) -> None:
        self._handle = handle
        glfw.set_cursor_pos_callback(handle, lambda _, x, y: self.move(x, y))
        glfw.set_mouse_button_callback(handle, lambda _, *told: self.button(*told))
        glfw.set_scroll_callback(handle, lambda _, dx, dy: self.scroll(dx, dy))
        glfw.set_key_callback(handle, lambda _, *told: self.key(*told))
        glfw.set_char_callback(handle, lambda _, code: self.character(code))
        glfw.set_window_focus_callback(handle, lambda _, focused: self.focus(bool(focused)))
        glfw.set_cursor_enter_callback(handle, lambda _, entered: self.enter(bool(entered)))
        glfw.set_drop_callback(handle, self._dropped)  # type: ignore[arg-type]
        glfw.set_window_close_callback(handle, lambda _: self.close())
        glfw.set_window_refresh_callback(handle, self._expose)
        glfw.set_framebuffer_size_callback(handle, self._expose)
        glfw.set_window_content_scale_callback(handle, self._expose)

    def take(self) -> list[Event]:
        """Return what came in since the last call, oldest first."""
        events, self._events = self._events, []
        return events

    def move(self, x: float, y: float) -> None:
        """Take the pointer's place, in units of the window."""
        sx, sy = self._ratio()
        self._at_px = (x * sx, y * sy)
        self._events.append(Moved(*self._at_px, glfw.get_time(), self._held))

    def button(self, button: int, action: int, mods: int) -> None:
        """Take a mouse button, by GLFW's numbers."""
        self._held = mods_of(mods)
        if name := _BUTTONS.get(button):
            kind = Pressed if action == glfw.PRESS else Released
            self._events.append(kind(name, *self._at_px, glfw.get_time(), self._held))

    def scroll(self, dx: float, dy: float) -> None:
        """Take a turn of the wheel."""
        self._events.append(Scrolled(dx, dy, *self._at_px, glfw.get_time(), self._held))

    def key(self, key: int, scancode: int, action: int, mods: int) -> None:
        """Take a key, by GLFW's numbers."""
        name = key_name(key, scancode)
        told = mods_of(mods)
        self._held = with_key(told, name, down=action != glfw.RELEASE)
        if action == glfw.RELEASE:
            self._events.append(KeyUp(name, told, glfw.get_time()))
        else:
            self._events.append(KeyDown(name, told, action == glfw.REPEAT, glfw.get_time()))

    def character(self, code: int) -> None:
        """Take what the keys typed, as Unicode."""
        self._events.append(Typed(chr(code)))

    def focus(self, focused: bool) -> None:
        """Take note of whether the window has the keyboard."""
        self._held = Mods()
        self._events.append(FocusGained() if focused else FocusLost())

    def enter(self, entered: bool) -> None:
        """Take note of whether the pointer is over the window."""
        # where it was last; a callback with the new place follows
        at = Moved(*self._at_px, glfw.get_time(), self._held)
        self._events.append(at if entered else Gone())

    def _dropped(self, _: object, paths: list[str]) -> None:
        self.drop(paths)

    def drop(self, paths: list[str]) -> None:
        """Take files that were dropped on the window."""
        self._events.append(Dropped(tuple(Path(path) for path in paths)))

    def close(self) -> None:
        """Take the close button: the editor may have to ask first."""
        glfw.set_window_should_close(self._handle, False)
        self._events.append(CloseAsked())

    def _expose(self, *_: object) -> None:
        self._events.append(Exposed())
