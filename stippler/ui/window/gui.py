"""ImGui on a window: its context, its backends, and frames that survive an exception."""

from __future__ import annotations

import re
from collections.abc import Callable

from imgui_bundle import imgui

from stippler.editor.events import Event, Gone, KeyDown, KeyUp
from stippler.editor.keymap import is_modifier
from stippler.ui import theme
from stippler.ui.fields import Fields
from stippler.ui.look import Look
from stippler.ui.number_control import Numbers
from stippler.ui.theme import Theme
from stippler.ui.window.imgui_input import feed
from stippler.ui.window.window import Window

_NAVIGATES = frozenset(
    ("up", "down", "left", "right", "space", "enter", "kp_enter", "tab", "escape", "page_up",
     "page_down", "home", "end", "-", ".", ",", *"0123456789")
)  # fmt: skip
"""Keys that are a panel's while one of its controls has the focus of the keyboard."""
_EDITS = frozenset(
    ("a", "c", "v", "x", "y", "z", "left", "right", "home", "end", "backspace", "delete", "insert",
     "left_control", "right_control", "left_alt", "right_alt", "left_shift", "right_shift")
)  # fmt: skip
"""Keys that, with Ctrl, edit the text of a field."""


_TOOLTIP_LATE_S = 0.01  # so that the frame that is to show it is not too early
_TOOLTIP_FRAMES = 4  # at rest, until it is there: ImGui takes note, measures it unseen, shows it
_TOOLTIP_FRAME_S = 0.03


def _context() -> imgui.internal.Context:
    """Return ImGui's own state, which there is for as long as there is a `Gui`."""
    context = imgui.get_current_context()
    assert context is not None
    return context


def _rest_left_s() -> float:
    """Return how long the pointer has yet to rest where it is for a tooltip; 0 or less: no more."""
    context, style = _context(), imgui.get_style()
    return float(
        max(
            style.hover_delay_normal - context.hover_item_delay_timer,
            style.hover_stationary_delay - context.mouse_stationary_timer,
        )
    )


class Gui:
    """ImGui's context on one window; there is one at a time.

    Attributes
    ----------
    fonts : Fonts
    numbers : Numbers
        Which number of the panels has the keyboard.
    fields : Fields
        The controls that panels have.
    escape_level : int
        How many popups are open in a frame in which Esc is pressed, of which it is for the topmost;
        else 0.
    """

    def __init__(
        self, window: Window, look: Look, layout: str = "", layout_scale: float = 0.0
    ) -> None:
        self._window = window
        self._theme: Theme | None = None
        self._scale = 0.0
        self.escape_level = 0
        self._holds_enter = False  # for a number that a chord has ended
        self._n_rested = 0  # frames since the pointer has rested on a control for long enough
        self.numbers = Numbers()
        self.fields = Fields()
        self._context = imgui.create_context()
        io = imgui.get_io()
        io.set_ini_filename("")
        io.set_log_filename("")
        io.config_ini_settings_save_last_used_date = False
        io.config_flags |= (
            imgui.ConfigFlags_.docking_enable | imgui.ConfigFlags_.nav_enable_keyboard
        )
        io.config_windows_move_from_title_bar_only = True
        io.config_docking_always_tab_bar = False
        io.config_input_trickle_event_queue = False  # batches are parted by the editor
        # An exception inside a panel leaves windows open; ImGui closes them and goes on.
        io.config_error_recovery_enable_assert = False
        io.config_error_recovery_enable_tooltip = False
        io.config_error_recovery_enable_debug_log = True  # ImGui insists on one of the three
        self.fonts = theme.load_fonts()
        self.dress(look)
        if layout:
            self.place_panels(rescaled(layout, self._scale / (layout_scale or self._scale)))
        self.join()

    def join(self) -> None:
        """Draw in the window's context from now on."""
        # Our own callbacks have the input; a backend that knows the pointer's window asks for none.
        imgui.backends.glfw_init_for_opengl(self._window.address, False)
        imgui.backends.glfw_cursor_enter_callback(self._window.address, 1)
        self.feed(Gone())
        imgui.backends.opengl3_init("#version 330")

    def leave(self) -> None:
        """Let go of what is in the window's context; panels stay as they are."""
        imgui.backends.opengl3_shutdown()
        imgui.backends.glfw_shutdown()

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
        """Units for each of the theme's pixels."""
        return self._scale

    @property
    def wants_pointer(self) -> bool:
        """Whether the pointer is over a panel, or drags something of one."""
        return bool(imgui.get_io().want_capture_mouse)

    @property
    def tooltip_in_s(self) -> float:
        """How long the pointer has yet to rest for a tooltip; 0 where none is to come."""
        if not _context().hover_item_delay_id:
            return 0.0
        if (left_s := _rest_left_s()) > 0.0:
            return left_s + _TOOLTIP_LATE_S
        return _TOOLTIP_FRAME_S if self._n_rested < _TOOLTIP_FRAMES else 0.0

    @property
    def wants_keys(self) -> bool:
        """Whether a text field has the keyboard."""
        return bool(imgui.get_io().want_text_input)

    def feed(self, event: Event) -> bool:
        """Hand an event to ImGui, for its next frame; return whether it is a key for panels.

        Keys for the canvas are kept from ImGui, or arrows would walk through panels.
        """
        if self.numbers.take(event, is_typing=self.wants_keys):
            return isinstance(event, KeyDown)
        if isinstance(event, KeyDown):
            if not (self.wants(event) or is_modifier(event.key)):
                return False
            if event.key == "escape":
                self.escape_level = _context().open_popup_stack.size()
        feed(event, self._window.ratio)
        return isinstance(event, KeyDown)

    def ends_number(self, event: Event) -> bool:
        """Whether a chord is to count after the number that is typed: that is entered, then."""
        if not (isinstance(event, KeyDown) and self.numbers.open) or event.key in _EDITS:
            return False
        if not (event.mods.ctrl or event.mods.alt) or _context().open_popup_stack.size():
            return False
        if self.numbers.is_active:
            feed(KeyDown("enter"), self._window.ratio)
            self._holds_enter = True
        else:
            self.numbers.is_entered = True
        return True

    def wants(self, event: KeyDown) -> bool:
        """Return whether a key is for panels: a field, a list or menu, or what has the focus."""
        context = _context()
        if self.wants_keys or context.active_id or context.open_popup_stack.size():
            return True
        has_focus = context.nav_cursor_visible and context.nav_window is not None
        chord = event.mods.ctrl or event.mods.alt
        return has_focus and event.key in _NAVIGATES and not chord

    def frame(self, draw_ui: Callable[[], None]) -> Exception | None:
        """Let `draw_ui` build one frame; return what it raised, after closing the frame."""
        imgui.backends.opengl3_new_frame()
        imgui.backends.glfw_new_frame()
        io = imgui.get_io()
        io.display_size = imgui.ImVec2(*self._window.size_units)
        io.display_framebuffer_scale = imgui.ImVec2(*self._window.ratio)
        imgui.new_frame()
        self.numbers.begin(over_panels=self.wants_pointer)
        failure: Exception | None = None
        try:
            draw_ui()
        except Exception as error:  # noqa: BLE001 - a faulty panel must not end the editor
            failure = error
        finally:
            imgui.end_frame()
        self._count_rest()
        self.escape_level = 0
        if self._holds_enter:
            self._holds_enter = False
            feed(KeyUp("enter"), self._window.ratio)
        imgui.render()
        return failure

    def _count_rest(self) -> None:
        """Count frames, not time: one may come late, and the next is needed all the same."""
        rests = bool(_context().hover_item_delay_id) and _rest_left_s() <= 0.0
        self._n_rested = self._n_rested + 1 if rests else 0

    def draw(self) -> None:
        """Draw the frame into the framebuffer in use."""
        imgui.backends.opengl3_render_draw_data(imgui.get_draw_data())

    def close(self) -> None:
        """Let go of ImGui's GL objects and context."""
        self.leave()
        imgui.destroy_context(self._context)


def rescaled(layout: str, factor: float) -> str:
    """Return a layout whose places and sizes are larger by a factor."""

    def scale(found: re.Match[str]) -> str:
        x, y = (round(int(value) * factor) for value in found.group(2, 3))
        return f"{found.group(1)}={x},{y}"

    return re.sub(r"\b(Pos|Size|SizeRef)=(-?\d+),(-?\d+)", scale, layout)
