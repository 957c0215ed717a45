"""The status bar: where the pointer is, what there is, how fast it goes."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.camera import Point
from stippler.ui.messages import INFO
from stippler.ui.rates import FrameRate
from stippler.ui.session import Session
from stippler.ui.theme import SMALL_PX, STATUS_HEIGHT
from stippler.ui.widgets import Widgets


def draw_status(
    widgets: Widgets, session: Session, pointer_mm: Point | None, zoom: float, frames: FrameRate
) -> None:
    """Draw the bar along the lower edge of the window."""
    viewport = imgui.get_main_viewport()
    height = STATUS_HEIGHT * widgets.scale
    imgui.set_next_window_pos((viewport.pos.x, viewport.pos.y + viewport.size.y - height))
    imgui.set_next_window_size((viewport.size.x, height))
    flags = (
        imgui.WindowFlags_.no_decoration
        | imgui.WindowFlags_.no_docking
        | imgui.WindowFlags_.no_move
        | imgui.WindowFlags_.no_saved_settings
        | imgui.WindowFlags_.no_nav
    )
    imgui.push_style_var(imgui.StyleVar_.window_padding, (16.0 * widgets.scale, 0.0))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    imgui.begin("##status", None, flags)
    top = imgui.get_window_pos()
    line = imgui.get_color_u32(imgui.Col_.border)
    imgui.get_window_draw_list().add_line(top, (top.x + viewport.size.x, top.y), line)
    imgui.push_font(None, SMALL_PX)
    imgui.set_cursor_pos_y((height - imgui.get_text_line_height()) / 2)
    message = session.messages.current
    said = message is not None and message.level == INFO
    imgui.text_unformatted(message.text if message and said else _summary(session))
    _draw_fields(widgets, _fields(session, pointer_mm, zoom, frames))
    imgui.pop_font()
    imgui.end()
    imgui.pop_style_var(3)


def _summary(session: Session) -> str:
    if session.phase == "paused":
        return "paused"
    return session.name


def _fields(
    session: Session, pointer_mm: Point | None, zoom: float, frames: FrameRate
) -> list[tuple[str, float, str]]:
    """Return text, width of its column and explanation, from the left."""
    place = f"{pointer_mm[0]:.1f}, {pointer_mm[1]:.1f} mm" if pointer_mm else "–"
    steps = f"{session.steps_per_s:.0f} steps/s" if session.steps_per_s else "–"
    rate = f"{frames.per_s:.0f} frames/s" if frames.per_s else "–"
    return [
        (place, 118, "Position of the pointer on the page, in mm from its top left corner."),
        (f"{session.n_dots:,} dots", 96, "Dots in the drawing."),
        (f"{zoom:.0%}", 60, "Size on the screen; 100 % is the size on paper."),
        (rate, 84, "Frames drawn a second; none are drawn while nothing changes."),
        (steps, 84, "Relaxation steps a second, in the last work."),
    ]


def _draw_fields(widgets: Widgets, fields: list[tuple[str, float, str]]) -> None:
    right = imgui.get_window_width() - 16.0 * widgets.scale
    left = right - sum(width for _, width, _ in fields) * widgets.scale
    for text, width, tip in fields:
        left += width * widgets.scale
        imgui.same_line(left - imgui.calc_text_size(text).x)
        imgui.text_colored((*widgets.theme.faint, 1.0), text)
        widgets.tip(tip)
