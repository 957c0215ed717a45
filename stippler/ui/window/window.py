"""The window: GLFW, an OpenGL 3.3 context on it, and its input as events.

The offscreen window (GLFW's null platform with EGL) differs from the real one in the hints it is
made with and in nothing else.
"""

from __future__ import annotations

import contextlib
import ctypes
import os
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from imgui_bundle import imgui  # noqa: F401  # isort: skip - first: glfw then uses its library
import glfw
import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.editor.events import (
    LEFT,
    MIDDLE,
    RIGHT,
    CloseAsked,
    Dropped,
    Event,
    Exposed,
    FocusLost,
    Gone,
    KeyDown,
    KeyUp,
    Mods,
    Moved,
    Pressed,
    Released,
    Scrolled,
)
from stippler.errors import DisplayError
from stippler.ui.window.key_names import key_name, mods_of
from stippler.ui.window.placement import Place, place_of, put
from stippler.units import px_per_mm

_NULL_PLATFORM = 0x00060005  # GLFW_PLATFORM_NULL, which python's glfw does not name
_PLAUSIBLE_PX_PER_MM = (2.0, 30.0)  # 50 to 760 dpi; screens that tell less or more do not know
_BUTTONS = {
    glfw.MOUSE_BUTTON_LEFT: LEFT,
    glfw.MOUSE_BUTTON_RIGHT: RIGHT,
    glfw.MOUSE_BUTTON_MIDDLE: MIDDLE,
}
_NO_DISPLAY = "start it inside a desktop session, or draw without a window: stippler render"
_NO_GL = (
    "install a graphics driver with OpenGL 3.3 (Debian, Ubuntu: apt install libgl1 "
    "libgl1-mesa-dri libglx-mesa0 libegl1), or draw without a window: stippler render"
)


class _Current:
    """The window's GL context as moderngl asks for it, whichever system made it.

    moderngl's own search asks GLX alone, which does not know of an EGL context.
    """

    def load_opengl_function(self, name: str) -> int:
        address: int = ctypes.cast(glfw.get_proc_address(name), ctypes.c_void_p).value or 0
        return address

    def __enter__(self) -> None:
        pass

    def __exit__(self, *error: object) -> None:
        pass

    def release(self) -> None:
        pass


class Window:
    """One window with its OpenGL context; all methods are for the thread that made it.

    Parameters
    ----------
    place : Place
        Size and corner, in screen coordinates (pixels, but on high-dpi screens of some systems).
    offscreen : bool
        Without any display, for tests and screenshots.
    """

    def __init__(self, title: str, place: Place, *, offscreen: bool = False) -> None:
        self._events: list[Event] = []
        self._pointer = (0.0, 0.0)
        self._errors: list[str] = []
        self._title = title
        # The null platform's waiting does not wait.
        self._woken = threading.Event() if offscreen else None
        glfw.set_error_callback(lambda _, text: self._errors.append(_decoded(text)))
        self._start(offscreen)
        try:
            self._handle = self._open(title, place.size, offscreen)
            self._place = place
            put(self._handle, place)
            glfw.make_context_current(self._handle)
            glfw.swap_interval(0 if offscreen else 1)
            self.ctx = self._context()
        except BaseException:
            glfw.terminate()
            raise
        self._listen()

    # --- opening ----------------------------------------------------------------------------

    def _start(self, offscreen: bool) -> None:
        glfw.init_hint(glfw.PLATFORM, _NULL_PLATFORM if offscreen else glfw.ANY_PLATFORM)
        if not glfw.init():
            raise DisplayError(
                f"the display {os.environ.get('DISPLAY', '')} cannot be opened ({self._why()})"
                if os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
                else "there is no display to open a window on",
                do=_NO_DISPLAY,
            )

    def _open(
        self, title: str, size: tuple[int, int], offscreen: bool
    ) -> ctypes._Pointer[glfw._GLFWwindow]:
        glfw.default_window_hints()
        glfw.window_hint(glfw.CONTEXT_VERSION_MAJOR, 3)
        glfw.window_hint(glfw.CONTEXT_VERSION_MINOR, 3)
        glfw.window_hint(glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE)
        glfw.window_hint(glfw.OPENGL_FORWARD_COMPAT, True)
        glfw.window_hint(glfw.DEPTH_BITS, 0)
        glfw.window_hint(glfw.STENCIL_BITS, 0)
        glfw.window_hint(glfw.SCALE_TO_MONITOR, True)
        glfw.window_hint_string(glfw.X11_CLASS_NAME, "stippler")
        glfw.window_hint_string(glfw.X11_INSTANCE_NAME, "stippler")
        if offscreen:
            glfw.window_hint(glfw.CONTEXT_CREATION_API, glfw.EGL_CONTEXT_API)
        handle = glfw.create_window(*size, title, None, None)
        if not handle:
            raise DisplayError(
                f"no window with OpenGL 3.3 could be made ({self._why()})", do=_NO_GL
            )
        return handle

    def _context(self) -> moderngl.Context:
        context: Any = _Current()
        try:
            return moderngl.create_context(require=330, context=context)
        except Exception as error:
            raise DisplayError(f"OpenGL 3.3 is not there ({error})", do=_NO_GL) from error

    def _why(self) -> str:
        return self._errors[-1] if self._errors else "no reason given"

    # --- input ------------------------------------------------------------------------------

    def _listen(self) -> None:
        # ImGui's own callbacks, installed later, call these in turn.
        glfw.set_cursor_pos_callback(self._handle, self._on_move)
        glfw.set_mouse_button_callback(self._handle, self._on_button)
        glfw.set_scroll_callback(self._handle, self._on_scroll)
        glfw.set_key_callback(self._handle, self._on_key)
        glfw.set_window_focus_callback(self._handle, self._on_focus)
        glfw.set_cursor_enter_callback(self._handle, self._on_enter)
        glfw.set_drop_callback(self._handle, self._on_drop)  # type: ignore[arg-type]
        glfw.set_window_close_callback(self._handle, self._on_close)
        exposed = self._on_expose
        glfw.set_window_refresh_callback(self._handle, exposed)
        glfw.set_framebuffer_size_callback(self._handle, exposed)
        glfw.set_window_content_scale_callback(self._handle, exposed)

    def _on_move(self, _: object, x: float, y: float) -> None:
        sx, sy = self._pixels_per_unit()
        self._pointer = (x * sx, y * sy)
        self._events.append(Moved(*self._pointer, glfw.get_time()))

    def _on_button(self, _: object, button: int, action: int, mods: int) -> None:
        if name := _BUTTONS.get(button):
            kind = Pressed if action == glfw.PRESS else Released
            self._events.append(kind(name, *self._pointer, glfw.get_time(), mods_of(mods)))

    def _on_scroll(self, _: object, dx: float, dy: float) -> None:
        held = self._held_mods()
        self._events.append(Scrolled(dx, dy, *self._pointer, glfw.get_time(), held))

    def _on_key(self, _: object, key: int, scancode: int, action: int, mods: int) -> None:
        name = key_name(key, scancode)
        if action == glfw.RELEASE:
            self._events.append(KeyUp(name, mods_of(mods), glfw.get_time()))
        else:
            repeated = action == glfw.REPEAT
            self._events.append(KeyDown(name, mods_of(mods), repeated, glfw.get_time()))

    def _on_focus(self, _: object, focused: int) -> None:
        if not focused:
            self._events.append(FocusLost())

    def _on_enter(self, _: object, entered: int) -> None:
        if not entered:
            self._events.append(Gone())

    def _on_drop(self, _: object, paths: list[str]) -> None:
        self._events.append(Dropped(tuple(Path(path) for path in paths)))

    def _on_close(self, _: object) -> None:
        glfw.set_window_should_close(self._handle, False)  # the editor may have to ask first
        self._events.append(CloseAsked())

    def _on_expose(self, *_: object) -> None:
        self._events.append(Exposed())

    def drop(self, paths: list[Path]) -> None:
        """Take files as if they had been dropped; GLFW cannot be asked to."""
        self._on_drop(None, [str(path) for path in paths])

    def press_close(self) -> None:
        """Act as if the window's close button had been pressed; GLFW cannot be asked to."""
        self._on_close(None)

    def _held_mods(self) -> Mods:
        def held(*keys: int) -> bool:
            return any(glfw.get_key(self._handle, key) == glfw.PRESS for key in keys)

        ctrl = held(glfw.KEY_LEFT_CONTROL, glfw.KEY_RIGHT_CONTROL)
        shift = held(glfw.KEY_LEFT_SHIFT, glfw.KEY_RIGHT_SHIFT)
        return Mods(ctrl, shift, held(glfw.KEY_LEFT_ALT, glfw.KEY_RIGHT_ALT))

    def take_events(self) -> list[Event]:
        """Return what came in since the last call, oldest first."""
        events, self._events = self._events, []
        return events

    def wait(self, timeout_s: float) -> None:
        """Let events in; sleep until one comes or the time is over (0 does not sleep)."""
        if timeout_s > 0 and self._woken is not None:
            self._woken.wait(timeout_s)
            self._woken.clear()
        elif timeout_s > 0:
            glfw.wait_events_timeout(timeout_s)
        glfw.poll_events()

    def wake(self) -> None:
        """End the wait; may be called from any thread."""
        if self._woken is not None:
            self._woken.set()
        else:
            glfw.post_empty_event()

    # --- state ------------------------------------------------------------------------------

    @property
    def address(self) -> int:
        """Where the GLFWwindow lies in memory, for ImGui's backend."""
        return ctypes.cast(self._handle, ctypes.c_void_p).value or 0

    @property
    def size_px(self) -> tuple[int, int]:
        """Framebuffer size; (0, 0) while minimised on some systems."""
        width, height = glfw.get_framebuffer_size(self._handle)
        return int(width), int(height)

    @property
    def scale(self) -> float:
        """How much larger than at 96 dpi text and controls should be."""
        if os.environ.get("STIPPLER_SCALE"):
            with contextlib.suppress(ValueError):
                return min(max(float(os.environ["STIPPLER_SCALE"]), 0.5), 4.0)
        scale = float(glfw.get_window_content_scale(self._handle)[0])
        return scale if 0.5 <= scale <= 4.0 else 1.0

    @property
    def px_per_mm(self) -> float:
        """Pixels a millimetre of the screen; 96 dpi times the scale where it does not tell."""
        monitor = glfw.get_primary_monitor()
        if monitor:
            width_mm, _ = glfw.get_monitor_physical_size(monitor)
            mode = glfw.get_video_mode(monitor)
            if width_mm > 0 and mode:
                told = mode.size.width * self._pixels_per_unit()[0] / width_mm
                if _PLAUSIBLE_PX_PER_MM[0] <= told <= _PLAUSIBLE_PX_PER_MM[1]:
                    return float(told)
        return px_per_mm(96.0 * self.scale)

    def _pixels_per_unit(self) -> tuple[float, float]:
        width, height = glfw.get_window_size(self._handle)
        width_px, height_px = glfw.get_framebuffer_size(self._handle)
        return (width_px / width if width else 1.0), (height_px / height if height else 1.0)

    @property
    def now_s(self) -> float:
        """The time, as events have it."""
        return float(glfw.get_time())

    @property
    def wants_to_close(self) -> bool:
        """Whether the window is to be closed."""
        return bool(glfw.window_should_close(self._handle))

    @property
    def place(self) -> Place:
        """Where the window is, to be put there again."""
        return place_of(self._handle, self._place)

    def end(self) -> None:
        """Close the window after this frame."""
        glfw.set_window_should_close(self._handle, True)

    @property
    def title(self) -> str:
        """The text in the title bar."""
        return self._title

    @title.setter
    def title(self, text: str) -> None:
        if text != self._title:
            self._title = text
            glfw.set_window_title(self._handle, text)

    @contextlib.contextmanager
    def frame(self) -> Iterator[moderngl.Framebuffer]:
        """Bind the window's framebuffer at its present size; show it at the end."""
        screen = self.ctx.screen
        screen.use()
        screen.viewport = (0, 0, *self.size_px)
        yield screen
        glfw.swap_buffers(self._handle)

    def pixels(self) -> NDArray[np.uint8]:
        """Return what the last frame showed, (height, width, 3), sRGB."""
        width, height = self.size_px
        data = self.ctx.screen.read(viewport=(0, 0, width, height), components=3, alignment=1)
        return np.frombuffer(data, np.uint8).reshape(height, width, 3)[::-1].copy()

    def close(self) -> None:
        """Close the window and let go of everything."""
        self.ctx.release()
        glfw.destroy_window(self._handle)
        glfw.terminate()


def _decoded(text: bytes | str) -> str:
    return text.decode(errors="replace") if isinstance(text, bytes) else text
