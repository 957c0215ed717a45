"""The status bar: where the pointer is, what there is, how fast it goes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from imgui_bundle import imgui

from stippler.camera import Camera, Point
from stippler.editor.messages import INFO
from stippler.editor.rates import FrameRate
from stippler.editor.session import Session
from stippler.ui.theme import SMALL_PX, STATUS_HEIGHT
from stippler.ui.widgets import Widgets

Field = tuple[str, float, str]  # text, width of its column in the theme's pixels, explanation


@dataclass(frozen=True, slots=True)
class Sight:
    """How the page is seen.

    Attributes
    ----------
    pointer_mm : (x, y) or None
        On the page; None while the pointer is elsewhere.
    zoom : float
        Size on the screen over size on paper.
    dots_shown : bool
    """

    camera: Camera
    pointer_mm: Point | None
    zoom: float
    dots_shown: bool


def draw_status(widgets: Widgets, session: Session, sight: Sight, frames: FrameRate) -> None:
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
    text = message.text if message and said else _summary(session)
    imgui.text_unformatted(text)
    room = imgui.get_window_width() / widgets.scale - 48.0  # both margins, and one between
    room -= imgui.calc_text_size(text).x / widgets.scale
    _draw_fields(widgets, fitting(_fields(session, sight, frames), room))
    imgui.pop_font()
    imgui.end()
    imgui.pop_style_var(3)


def _summary(session: Session) -> str:
    if session.phase == "paused":
        return "paused"
    return session.name


def _fields(session: Session, sight: Sight, frames: FrameRate) -> list[Field]:
    """Return what there is to tell, from the left; what matters least comes last."""
    at = sight.pointer_mm
    place = f"{at[0]:.1f}, {at[1]:.1f} mm" if at else "–"
    dots = f"{session.n_dots:,} dot{'s'[: session.n_dots != 1]}" + (
        "" if sight.dots_shown else ", hidden"
    )
    steps = f"{session.steps_per_s:.0f} steps/s" if session.steps_per_s else "–"
    rate = f"{frames.per_s:.0f} frames/s" if frames.per_s else "–"
    turned = _turned(sight.camera)
    return [
        *([(turned, 112, "How the page lies on the screen.")] if turned else []),
        (place, 118, "Position of the pointer on the page, in mm from its top left corner."),
        (dots, 96 if sight.dots_shown else 146, "Dots in the drawing."),
        (_zoom(sight.zoom), 60, "Size on the screen; 1:1 is the size on paper."),
        (rate, 84, "Frames drawn a second; none are drawn while nothing changes."),
        (steps, 84, "Relaxation steps a second, in the last work."),
    ]


def _turned(camera: Camera) -> str:
    degrees = round(math.degrees(camera.rotation_rad), 1)
    turned = [f"turned {degrees:g}°".replace("-", "−")] if degrees else []
    return ", ".join(turned + ["flipped"] * camera.flip)


def _zoom(zoom: float) -> str:
    return "1:1" if abs(zoom - 1.0) < 5e-4 else f"{zoom:.0%}"


def fitting(fields: list[Field], room: float) -> list[Field]:
    """Leave out the last fields, whose columns find no room beside the text at the left."""
    fields = list(fields)
    while fields and sum(width for _, width, _ in fields) > room:
        fields.pop()
    return fields


def _draw_fields(widgets: Widgets, fields: list[Field]) -> None:
    right = imgui.get_window_width() - 16.0 * widgets.scale
    left = right - sum(width for _, width, _ in fields) * widgets.scale
    for text, width, tip in fields:
        left += width * widgets.scale
        imgui.same_line(left - imgui.calc_text_size(text).x)
        imgui.text_colored((*widgets.theme.faint, 1.0), text)
        widgets.tip(tip)
