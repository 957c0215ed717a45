"""Scripted hands and eyes for a window without a display.

Input goes through the window's own callbacks, so it takes the same way as a person's.
"""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from imgui_bundle import imgui  # noqa: F401  # isort: skip - first: glfw then uses its library
import glfw
import numpy as np
from numpy.typing import NDArray

from stippler.ui.editor_window import Editor
from stippler.ui.window.window import Window

_MOST_NOTCHES = 40  # of the wheel, until a control is given up
_BUTTONS = {
    "left": glfw.MOUSE_BUTTON_LEFT,
    "right": glfw.MOUSE_BUTTON_RIGHT,
    "middle": glfw.MOUSE_BUTTON_MIDDLE,
}
_PATIENCE_S = 60.0
_SOON_S = 0.2
_SETTLED = 24  # frames; work that goes on is not waited for


class Host:
    """Drives an editor in an offscreen window, frame by frame.

    Parameters
    ----------
    step : callable
        Waits at most so many seconds for something to do, then draws a frame if one is due.
    """

    def __init__(self, window: Window, editor: Editor, step: Callable[[float], bool]) -> None:
        self._window, self._editor, self._step = window, editor, step
        self._in_batch = False
        editor.gui.fields.is_watched = True
        window.input.focus(True)
        self.settle()

    @contextlib.contextmanager
    def batch(self) -> Iterator[None]:
        """Let all that the hands do within come in at once, as from a stalled or quick system."""
        self._in_batch = True
        try:
            yield
        finally:
            self._in_batch = False
        self.settle()

    # --- time -------------------------------------------------------------------------------

    def settle(self) -> None:
        """Go on until what has happened so far has been drawn."""
        if self._in_batch:
            return
        for _ in range(_SETTLED):
            if not self._step(0.0):
                if self._editor.idle:
                    return
                self._step(_SOON_S)

    def until(self, condition: Callable[[], bool], what: str = "it") -> None:
        """Go on until something is true.

        Raises
        ------
        TimeoutError
            If it is not after a minute.
        """
        deadline = time.monotonic() + _PATIENCE_S
        while not condition():
            if time.monotonic() > deadline:
                raise TimeoutError(f"{what} did not come true; {self.said()}")
            self._step(0.02)

    # --- hands ------------------------------------------------------------------------------

    def move(self, x: float, y: float) -> None:
        """Move the pointer."""
        self._window.input.move(float(x), float(y))
        self._frame()

    def leave(self) -> None:
        """Take the pointer out of the window."""
        self._window.input.enter(False)
        self._frame()

    def enter(self) -> None:
        """Bring it back."""
        self._window.input.enter(True)
        self._frame()

    def press(self, button: str = "left", *, shift: bool = False) -> None:
        """Press a mouse button."""
        self._button(button, glfw.PRESS, glfw.MOD_SHIFT if shift else 0)

    def release(self, button: str = "left") -> None:
        """Let a mouse button come up."""
        self._button(button, glfw.RELEASE)

    def click(self, target: str | tuple[float, float]) -> None:
        """Click a control by its label, or a place; a control out of sight is scrolled to."""
        if isinstance(target, str):
            self.bring(target)
            target = self.place(target)
        self.move(*target)
        self.press()
        self.release()
        self.settle()

    def drag(
        self,
        start: tuple[float, float],
        end: tuple[float, float],
        button: str,
        *,
        shift: bool = False,
    ) -> None:
        """Drag from one place to another."""
        self.move(*start)
        self.press(button, shift=shift)
        for share in (0.25, 0.5, 0.75, 1.0):
            self.move(*(a + share * (b - a) for a, b in zip(start, end, strict=True)))
        self.release(button)
        self.settle()

    def scroll(self, notches: float, at: tuple[float, float]) -> None:
        """Turn the wheel over a place."""
        self.move(*at)
        self._window.input.scroll(0.0, float(notches))
        self.settle()

    def key(self, name: str, *, ctrl: bool = False, shift: bool = False) -> None:
        """Type a key."""
        self.key_down(name, ctrl=ctrl, shift=shift)
        self.key_up(name, ctrl=ctrl, shift=shift)
        self.settle()

    def key_down(self, name: str, *, ctrl: bool = False, shift: bool = False) -> None:
        """Press a key and hold it."""
        self._key(name, glfw.PRESS, ctrl=ctrl, shift=shift)

    def key_up(self, name: str, *, ctrl: bool = False, shift: bool = False) -> None:
        """Let a key come up."""
        self._key(name, glfw.RELEASE, ctrl=ctrl, shift=shift)

    def type(self, text: str) -> None:
        """Type text into the field that has the keyboard."""
        for sign in text:
            key = sign if sign.isascii() and sign.isalnum() else "world_1"
            self._key(key, glfw.PRESS)
            self._window.input.character(ord(sign))
            self._key(key, glfw.RELEASE)
        self.settle()

    def fill(self, label: str, text: str) -> None:
        """Replace what stands in a field, by its label, and press Enter."""
        if not self._editor.gui.wants_keys:
            self.click(label)  # marks all
        self.type(text)
        self.key("enter")

    def bring(self, label: str) -> None:
        """Turn the wheel over a control's panel until the control is in sight, or stays."""
        before = math.nan
        for _ in range(_MOST_NOTCHES):
            _, y = self.place(label)
            if y == before:
                return
            before = y
            x0, low, x1, high = self._editor.widgets.rooms.get(label, (0.0, -1e9, 0.0, 1e9))
            if low <= y <= high:
                return
            margin = min(4.0, (x1 - x0) / 2)  # over a number the wheel would step that
            self.scroll(1.0 if y < low else -1.0, (x0 + margin, (low + high) / 2))

    def drop(self, *paths: Path) -> None:
        """Drop files on the window."""
        self._window.input.drop([str(path) for path in paths])
        self.settle()

    # --- eyes -------------------------------------------------------------------------------

    def place(self, label: str) -> tuple[float, float]:
        """Return the middle of a control, by its label."""
        x0, y0, x1, y1 = self._editor.widgets.marks[label]
        return (x0 + x1) / 2, (y0 + y1) / 2

    def shown(self, label: str) -> bool:
        """Return whether there is a control of that label."""
        return label in self._editor.widgets.marks

    def canvas(self) -> tuple[int, int, int, int]:
        """Return where the canvas is in the window, in pixels: left, top, right, bottom."""
        (x, y), (width, height) = self._editor.pointer.origin_px, self._editor.view.size_px
        return round(x), round(y), round(x) + width, round(y) + height

    def said(self) -> str:
        """Return the last message."""
        log = self._editor.session.messages.log
        return log[-1].text if log else ""

    def screenshot(self) -> NDArray[np.uint8]:
        """Return what the window shows, (height, width, 3), sRGB."""
        return self._window.pixels()

    # --- inside -----------------------------------------------------------------------------

    def _frame(self) -> None:
        if not self._in_batch:
            self._step(0.0)

    def _button(self, button: str, action: int, mods: int = 0) -> None:
        self._window.input.button(_BUTTONS[button], action, mods)
        self._frame()

    def _key(self, name: str, action: int, *, ctrl: bool = False, shift: bool = False) -> None:
        code = getattr(glfw, f"KEY_{name.upper()}")
        mods = (glfw.MOD_CONTROL if ctrl else 0) | (glfw.MOD_SHIFT if shift else 0)
        self._window.input.key(code, 0, action, mods)
        self._frame()
