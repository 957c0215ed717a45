"""A file that takes a while to be written: how far it is, and giving it up."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.editor.exports import Exports, bytes_text
from stippler.names import shown
from stippler.ui.widgets import Rect, Widgets

SHOWN_AFTER_S = 0.3
_WIDTH = 380.0
_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_focus_on_appearing
)


class WritingNotice:
    """Shows above the lower edge of the canvas what is being written, once that takes a while."""

    def __init__(self) -> None:
        self._since_s: float | None = None

    def draw(self, widgets: Widgets, exports: Exports, canvas: Rect) -> None:
        """Draw it, if a file is being written."""
        now_s = float(imgui.get_time())
        if not exports.busy or exports.writing is None:
            self._since_s = None
            return
        self._since_s = now_s if self._since_s is None else self._since_s
        if now_s - self._since_s < SHOWN_AFTER_S:
            return
        scale = widgets.scale
        x0, _, x1, y1 = canvas
        width = min(_WIDTH * scale, x1 - x0)
        imgui.set_next_window_pos(
            ((x0 + x1) / 2, y1 - 20.0 * scale), imgui.Cond_.always, (0.5, 1.0)
        )
        imgui.set_next_window_size((width, 0.0))
        imgui.push_style_var(imgui.StyleVar_.window_padding, (14.0 * scale, 11.0 * scale))
        imgui.begin("##writing", None, _FLAGS | imgui.WindowFlags_.always_auto_resize)
        button = 84.0 * scale
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(f"Writing {shown(exports.writing.name)}")
        imgui.same_line(width - button - 14.0 * scale)
        if widgets.button(
            "Give up", "Writes nothing; a file that was there stays.", name="give up writing",
            width=button, enabled=not exports.is_given_up,
        ):  # fmt: skip
            exports.give_up()
        share = exports.share
        told = "ending …" if exports.is_given_up else bytes_text(exports.n_bytes)
        widgets.progress(-now_s if share is None else share, told)
        imgui.end()
        imgui.pop_style_var()
