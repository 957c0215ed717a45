"""The status bar: where the pointer is, what there is, how fast it goes."""

from __future__ import annotations

import math
from dataclasses import dataclass

from imgui_bundle import imgui

from stippler.camera import Camera, Point
from stippler.editor.commands import Commands
from stippler.editor.messages import INFO
from stippler.editor.number_steps import Scale
from stippler.editor.rates import FrameRate
from stippler.editor.session import Session
from stippler.ui.number_control import About, draw_number
from stippler.ui.panels.progress import progress_share, progress_text
from stippler.ui.theme import ICON_PAUSE, ICON_PLAY, ICON_STOP, SMALL_PX, STATUS_HEIGHT
from stippler.ui.widgets import Widgets

PANEL = "Status bar"
_ZOOM, _BAR = 74.0, 110.0  # the theme's pixels
_KEPT = 2  # fields that stay, however long the text
_FLAGS = (
    imgui.WindowFlags_.no_decoration
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_nav_focus
)

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


def draw_status(
    widgets: Widgets,
    session: Session,
    sight: Sight,
    frames: FrameRate,
    commands: Commands,
    hint: str = "",
) -> float | None:
    """Draw the bar along the lower edge of the window; return a zoom that was typed into it.

    Parameters
    ----------
    hint : str
        Said where there is nothing else to say.
    """
    viewport = imgui.get_main_viewport()
    height = STATUS_HEIGHT * widgets.scale
    imgui.set_next_window_pos((viewport.pos.x, viewport.pos.y + viewport.size.y - height))
    imgui.set_next_window_size((viewport.size.x, height))
    imgui.push_style_var(imgui.StyleVar_.window_padding, (16.0 * widgets.scale, 0.0))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_var(imgui.StyleVar_.window_border_size, 0.0)
    imgui.begin("##status", None, _FLAGS)
    imgui.pop_style_var(3)
    widgets.fields.panel = PANEL
    top = imgui.get_window_pos()
    line = imgui.get_color_u32(imgui.Col_.border)
    imgui.get_window_draw_list().add_line(top, (top.x + viewport.size.x, top.y), line)
    imgui.push_font(None, SMALL_PX)
    imgui.push_style_var(imgui.StyleVar_.frame_padding, (4.0 * widgets.scale, 2.0 * widgets.scale))
    left = _draw_work(widgets, session, commands, height) if session.busy else 0.0
    imgui.set_cursor_pos_y((height - imgui.get_text_line_height()) / 2)
    fields = _fields(session, sight, frames)
    least = sum(width for _, width, _ in fields[:_KEPT]) + _ZOOM
    room = (imgui.get_window_width() - 32.0 * widgets.scale) / widgets.scale - left
    text = _said(session) or ("" if session.busy else _summary(session, hint))
    text = _shortened(text, (room - least - 16.0) * widgets.scale)
    imgui.text_unformatted(text)
    room -= imgui.calc_text_size(text).x / widgets.scale + 16.0
    typed = _draw_fields(widgets, fitting(fields, room - _ZOOM), sight.zoom, height)
    imgui.pop_style_var()
    imgui.pop_font()
    widgets.fields.panel = ""
    imgui.end()
    return typed


def _draw_work(widgets: Widgets, session: Session, commands: Commands, height: float) -> float:
    """Draw what goes on, and how to end it; return how much room it took, in the theme's pixels."""
    scale = widgets.scale
    imgui.set_cursor_pos_y((height - imgui.get_frame_height()) / 2)
    began = imgui.get_cursor_pos_x()
    tip = "Ends the work; the dots that are there stay."
    if widgets.icon_button("status stop", ICON_STOP, f"{commands['work.stop'].hint}: {tip}"):
        session.stop()
        imgui.same_line()
        return 0.0
    paused = session.phase == "paused"
    imgui.same_line(0.0, 4.0 * scale)
    icon = ICON_PLAY if paused else ICON_PAUSE
    if widgets.icon_button("status pause", icon, f"{commands['work.pause'].hint}."):
        commands["work.pause"].run()
    imgui.same_line(0.0, 8.0 * scale)
    at, bar = imgui.get_cursor_screen_pos(), (_BAR * scale, 5.0 * scale)
    imgui.set_cursor_screen_pos((at.x, at.y + (imgui.get_frame_height() - bar[1]) / 2))
    imgui.push_style_var(imgui.StyleVar_.frame_padding, (0.0, 0.0))
    imgui.progress_bar(progress_share(session), bar, "")
    imgui.pop_style_var()
    widgets.note("status progress")
    imgui.same_line(0.0, 8.0 * scale)
    imgui.set_cursor_pos_y((height - imgui.get_text_line_height()) / 2)
    room = imgui.get_window_width() - imgui.get_cursor_pos_x() - 190.0 * scale
    text = _shortened(progress_text(session), room)
    imgui.text_unformatted(text)
    imgui.same_line(0.0, 16.0 * scale)
    return (imgui.get_cursor_pos_x() - began) / scale


def _said(session: Session) -> str:
    """Return what was said last, while it is to be shown here."""
    message = session.messages.current
    return message.text if message is not None and message.level == INFO else ""


def _shortened(text: str, room: float) -> str:
    """Leave out the end of a text that is too wide."""
    if not text or imgui.calc_text_size(text).x <= room:
        return text
    while len(text) > 1 and imgui.calc_text_size(f"{text}…").x > room:
        text = text[:-1]
    return f"{text.rstrip()}…" if len(text) > 3 else ""


def _summary(session: Session, hint: str) -> str:
    return hint or session.name


def _fields(session: Session, sight: Sight, frames: FrameRate) -> list[Field]:
    """Return what there is to tell, from the left; what matters least comes last."""
    at = sight.pointer_mm
    place = f"{at[0]:.1f}, {at[1]:.1f} mm" if at else "–"
    dots = f"{session.n_dots:,} dot{'s'[: session.n_dots != 1]}" + (
        "" if sight.dots_shown else ", hidden"
    )
    turned = _turned(sight.camera)
    return [
        *([(turned, 112, "How the page lies on the screen.")] if turned else []),
        (place, 118, "Position of the pointer on the page, in mm from its top left corner."),
        (dots, 96 if sight.dots_shown else 146, "Dots in the drawing."),
        *(_rates(session, frames) if session.busy else []),
    ]


def _rates(session: Session, frames: FrameRate) -> list[Field]:
    """Return how quickly it goes, which is of use only while something goes on."""
    steps = f"{session.steps_per_s:.0f} steps/s" if session.steps_per_s else "–"
    rate = f"{frames.per_s:.0f} frames/s" if frames.per_s else "–"
    return [
        (steps, 84, "Steps of the work a second."),
        (rate, 84, "Frames drawn a second; none are drawn while nothing changes."),
    ]


def _turned(camera: Camera) -> str:
    degrees = round(math.degrees(camera.rotation_rad), 1)
    turned = [f"turned {degrees:g}°".replace("-", "−")] if degrees else []
    return ", ".join(turned + ["flipped"] * camera.flip)


def fitting(fields: list[Field], room: float) -> list[Field]:
    """Leave out the last fields, whose columns find no room beside the text at the left."""
    fields = list(fields)
    while fields and sum(width for _, width, _ in fields) > room:
        fields.pop()
    return fields


def _draw_fields(widgets: Widgets, fields: list[Field], zoom: float, height: float) -> float | None:
    """Draw fields at the right, the zoom last; return a zoom that was typed."""
    scale = widgets.scale
    right = imgui.get_window_width() - (16.0 + _ZOOM) * scale
    left = right - sum(width for _, width, _ in fields) * scale
    for text, width, tip in fields:
        left += width * scale
        imgui.same_line(left - imgui.calc_text_size(text).x)
        imgui.text_colored((*widgets.theme.faint, 1.0), text)
        widgets.tip(tip)
    imgui.same_line(right + 8.0 * scale)
    imgui.set_cursor_pos_y((height - imgui.get_frame_height()) / 2)
    imgui.set_next_item_width((_ZOOM - 8.0) * scale)
    decimals = 0 if zoom >= 0.095 else 1
    percent = round(100.0 * zoom, decimals)
    about = About(Scale("%", decimals, 0.0, 0.01, 1e7), slides=False)
    tip = (
        "Size on the screen; 100 % is the size on paper (1:1). Click to type a percentage, or turn "
        "the wheel."
    )
    typed = draw_number(widgets, "Zoom", percent, about, tip)
    return typed / 100.0 if typed != percent else None
