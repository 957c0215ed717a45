"""ImGui on a window: its context, its backends, and frames that survive an exception."""

from __future__ import annotations

import re
from collections.abc import Callable

from imgui_bundle import imgui

from stippler.ui import theme
from stippler.ui.look import Look
from stippler.ui.theme import Theme
from stippler.ui.window.window import Window


class Gui:
    """ImGui's context on one window; there is one at a time.

    Attributes
    ----------
    fonts : Fonts
    """

    def __init__(
        self, window: Window, look: Look, layout: str = "", layout_scale: float = 0.0
    ) -> None:
        self._window = window
        self._theme: Theme | None = None
        self._scale = 0.0
        self._context = imgui.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")
        io.set_log_filename("")
        io.config_ini_settings_save_last_used_date = False
        io.config_flags |= imgui.ConfigFlags_.docking_enable
        io.config_windows_move_from_title_bar_only = True
        io.config_docking_always_tab_bar = False
        # An exception inside a panel leaves windows open; ImGui closes them and goes on.
        io.config_error_recovery_enable_assert = False
        io.config_error_recovery_enable_tooltip = False
        io.config_error_recovery_enable_debug_log = True  # ImGui insists on one of the three
        self.fonts = theme.load_fonts()
        self.dress(look)
        if layout:
            self.place_panels(rescaled(layout, self._scale / (layout_scale or self._scale)))
        imgui.backends.glfw_init_for_opengl(window.address, True)
        imgui.backends.opengl3_init("#version 330")

    def dress(self, look: Look) -> None:
        """Use a theme and a scale; nothing happens if both are in use."""
        scale = look.scale or self._window.scale
        if self._scale and scale != self._scale:
            self.place_panels(rescaled(self.layout, scale / self._scale))
        if look.theme is not self._theme or scale != self._scale:
            self._theme, self._scale = look.theme, scale
            theme.apply(look.theme, scale)

    @property
    def layout(self) -> str:
        """Where the panels are, as ImGui writes it down."""
        return imgui.save_ini_settings_to_memory()

    def place_panels(self, layout: str) -> None:
        """Put the panels where they were; between two frames."""
        imgui.load_ini_settings_from_memory(layout)

    @property
    def scale(self) -> float:
        """Pixels for each of the theme's."""
        return self._scale

    @property
    def wants_pointer(self) -> bool:
        """Whether the pointer is over a panel, or drags something of one."""
        return bool(imgui.get_io().want_capture_mouse)

    @property
    def wants_keys(self) -> bool:
        """Whether a text field has the keyboard."""
        return bool(imgui.get_io().want_text_input)

    def frame(self, draw_ui: Callable[[], None]) -> Exception | None:
        """Let `draw_ui` build one frame; return what it raised, after closing the frame."""
        imgui.backends.opengl3_new_frame()
        imgui.backends.glfw_new_frame()
        imgui.new_frame()
        failure: Exception | None = None
        try:
            draw_ui()
        except Exception as error:  # noqa: BLE001 - a faulty panel must not end the editor
            failure = error
        finally:
            imgui.end_frame()
        imgui.render()
        return failure

    def draw(self) -> None:
        """Draw the frame into the framebuffer in use."""
        imgui.backends.opengl3_render_draw_data(imgui.get_draw_data())

    def close(self) -> None:
        """Let go of ImGui's GL objects and context."""
        imgui.backends.opengl3_shutdown()
        imgui.backends.glfw_shutdown()
        imgui.destroy_context(self._context)


def rescaled(layout: str, factor: float) -> str:
    """Return a layout whose places and sizes are larger by a factor."""

    def scale(found: re.Match[str]) -> str:
        x, y = (round(int(value) * factor) for value in found.group(2, 3))
        return f"{found.group(1)}={x},{y}"

    return re.sub(r"\b(Pos|Size|SizeRef)=(-?\d+),(-?\d+)", scale, layout)
