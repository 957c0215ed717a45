"""The window: GLFW, an OpenGL 3.3 context on it, and its input as events.

The offscreen window (GLFW's null platform with EGL) differs from the real one in the hints it is
made with and in nothing else.
"""

from __future__ import annotations

import contextlib
import ctypes
import math
import os
import threading
from collections.abc import Iterator
from typing import Any

from imgui_bundle import imgui  # noqa: F401  # isort: skip - first: glfw then uses its library
import glfw
import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.editor.events import Event
from stippler.errors import DisplayError
from stippler.ui.window.input import Input
from stippler.ui.window.placement import Place, place_of, put
from stippler.units import px_per_mm

_NULL_PLATFORM = 0x00060005  # GLFW_PLATFORM_NULL, which python's glfw does not name
_PLAUSIBLE_PX_PER_MM = (2.0, 30.0)  # 50 to 760 dpi; screens that tell less or more do not know
_ASK_AGAIN_S = 1.0
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
    ratio : float
        Pixels a unit of an offscreen window; real ones tell theirs.

    Attributes
    ----------
    input : Input
        What takes the system's callbacks, and scripted ones.
    """

    def __init__(
        self, title: str, place: Place, *, offscreen: bool = False, ratio: float = 1.0
    ) -> None:
        self._errors: list[str] = []
        self._title = title
        self._px_per_mm, self._asked_s = 1.0, -math.inf
        self._given_ratio = ratio if offscreen else 0.0
        # The null platform's waiting does not wait.
        self._woken = threading.Event() if offscreen else None
        glfw.set_error_callback(lambda _, text: self._errors.append(_decoded(text)))
        self._start(offscreen)
        try:
            self._place = self._before = place
            self._handle = self._placed(place)
            self.ctx = self._context()
        except BaseException:
            glfw.terminate()
            raise
        self.input = Input(self._handle, lambda: self.ratio)

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

    def _placed(self, place: Place) -> ctypes._Pointer[glfw._GLFWwindow]:
        """Open a window at its place, its context in use."""
        offscreen = self._woken is not None
        width, height = (round(side * (self._given_ratio or 1.0)) for side in place.size)
        handle = self._open(self._title, (width, height), offscreen)
        put(handle, place)
        glfw.make_context_current(handle)
        glfw.swap_interval(0 if offscreen else 1)
        return handle

    def _open(
        self, title: str, size: tuple[int, int], offscreen: bool
    ) -> ctypes._Pointer[glfw._GLFWwindow]:
        glfw.default_window_hints()
        glfw.window_hint(glfw.CONTEXT_VERSION_MAJOR, 3)
        glfw.window_hint(glfw.CONTEXT_VERSION_MINOR, 3)
        glfw.window_hint(glfw.OPENGL_PROFILE, glfw.OPENGL_CORE_PROFILE)
        glfw.window_hint(glfw.OPENGL_FORWARD_COMPAT, True)
        glfw.window_hint(glfw.CONTEXT_ROBUSTNESS, glfw.LOSE_CONTEXT_ON_RESET)
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
        status = context.load_opengl_function("glGetGraphicsResetStatus")
        self._reset_status = ctypes.CFUNCTYPE(ctypes.c_uint)(status) if status else None
        try:
            return moderngl.create_context(require=330, context=context)
        except Exception as error:
            raise DisplayError(f"OpenGL 3.3 is not there ({error})", do=_NO_GL) from error

    def _why(self) -> str:
        return self._errors[-1] if self._errors else "no reason given"

    @property
    def is_lost(self) -> bool:
        """Whether the driver has let go of the context and all that was in it."""
        return bool(self._reset_status()) if self._reset_status is not None else False

    def renew(self) -> None:
        """Make window and context anew, in the same place; what was on the GPU is gone.

        Input goes on; what was held down counts as let go.
        """
        is_full, place, before = self.is_full_screen, self.place, self._handle
        with contextlib.suppress(Exception):  # a lost context may refuse anything
            self.ctx.release()
        glfw.destroy_window(before)
        self._handle = self._placed(place)
        self.ctx = self._context()
        self.input.attach(self._handle)
        if is_full:
            self.turn_full_screen()

    # --- input ------------------------------------------------------------------------------

    def take_events(self) -> list[Event]:
        """Return what came in since the last call, oldest first."""
        return self.input.take()

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
    def size_units(self) -> tuple[float, float]:
        """Size in the units in which the system places windows; ImGui's, too."""
        (x, y), (width, height) = self.ratio, self.size_px
        return width / x, height / y

    @property
    def ratio(self) -> tuple[float, float]:
        """Pixels a unit, across and down: 1 on most systems, 1.5 or 2 on dense screens of some."""
        if self._given_ratio:
            return self._given_ratio, self._given_ratio
        width, height = glfw.get_window_size(self._handle)
        width_px, height_px = self.size_px
        return (
            width_px / width if width and width_px else 1.0,
            height_px / height if height and height_px else 1.0,
        )

    @property
    def scale(self) -> float:
        """How much larger than at 96 dpi text and controls should be, in units.

        The system tells it in pixels: where a unit has two of them, they are larger already.
        """
        if os.environ.get("STIPPLER_SCALE"):
            with contextlib.suppress(ValueError):
                return min(max(float(os.environ["STIPPLER_SCALE"]), 0.5), 4.0)
        scale = self._content_scale() / self.ratio[0]
        return scale if 0.5 <= scale <= 4.0 else 1.0

    def _content_scale(self) -> float:
        """Return pixels for each of 96 dpi, as the system tells it."""
        told = float(glfw.get_window_content_scale(self._handle)[0])
        return max(told, self._given_ratio)

    @property
    def px_per_mm(self) -> float:
        """Pixels a millimetre of the screen; 96 dpi times the scale where it does not tell.

        Every frame asks; the system is asked once a second.
        """
        now = self.now_s
        if now - self._asked_s > _ASK_AGAIN_S:
            self._px_per_mm, self._asked_s = self._told_px_per_mm(), now
        return self._px_per_mm

    def _told_px_per_mm(self) -> float:
        monitor = glfw.get_primary_monitor()
        if monitor:
            width_mm, _ = glfw.get_monitor_physical_size(monitor)
            mode = glfw.get_video_mode(monitor)
            if width_mm > 0 and mode:
                told = mode.size.width * self.ratio[0] / width_mm
                if _PLAUSIBLE_PX_PER_MM[0] <= told <= _PLAUSIBLE_PX_PER_MM[1]:
                    return float(told)
        return px_per_mm(96.0 * self.scale * self.ratio[0])

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
        return self._before if self.is_full_screen else place_of(self._handle, self._place)

    @property
    def is_full_screen(self) -> bool:
        """Whether it covers a monitor."""
        return bool(glfw.get_window_monitor(self._handle))

    def turn_full_screen(self) -> None:
        """Cover the monitor that it is on, or go back to where it was."""
        if self.is_full_screen:
            x, y = self._before.at or (80, 80)
            windowed: Any = None
            glfw.set_window_monitor(self._handle, windowed, x, y, *self._before.size, 0)
            return
        monitor = glfw.get_primary_monitor()
        mode = glfw.get_video_mode(monitor) if monitor else None
        if monitor and mode:
            self._before = self.place
            size = (mode.size.width, mode.size.height)
            glfw.set_window_monitor(self._handle, monitor, 0, 0, *size, mode.refresh_rate)

    def restore(self) -> None:
        """Show a minimised window again."""
        glfw.restore_window(self._handle)

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
