"""ImGui on a window: its context, its backends, and frames that survive an exception."""

from __future__ import annotations

from collections.abc import Callable

from imgui_bundle import imgui

from stippler.ui import theme
from stippler.ui.window import Window


class Gui:
    """ImGui's context on one window; there is one at a time.

    Attributes
    ----------
    fonts : Fonts
    """

    def __init__(self, window: Window, look: theme.Theme) -> None:
        self._window = window
        self._look: theme.Theme | None = None
        self._scale = 0.0
        self._context = imgui.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")
        io.set_log_filename("")
        io.config_flags |= imgui.ConfigFlags_.docking_enable
        io.config_windows_move_from_title_bar_only = True
        io.config_docking_always_tab_bar = False
        # An exception inside a panel leaves windows open; ImGui closes them and goes on.
        io.config_error_recovery_enable_assert = False
        io.config_error_recovery_enable_tooltip = False
        io.config_error_recovery_enable_debug_log = True  # ImGui insists on one of the three
        self.fonts = theme.load_fonts()
        self.dress(look)
        imgui.backends.glfw_init_for_opengl(window.address, True)
        imgui.backends.opengl3_init("#version 330")

    def dress(self, look: theme.Theme) -> None:
        """Use a theme at the window's present scale; nothing happens if both are in use."""
        scale = self._window.scale
        if look is not self._look or scale != self._scale:
            self._look, self._scale = look, scale
            theme.apply(look, scale)

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
