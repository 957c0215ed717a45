"""The reference: how it shows under the dots, and how it is adjusted before dots are made."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.drawing.adjustment import (
    GAMMA_RANGE,
    MAX_BRIGHTNESS,
    MIN_SPAN,
    NEUTRAL,
    Adjustment,
)
from stippler.editor.commands import Commands
from stippler.editor.session import Session
from stippler.ui.look import Look
from stippler.ui.panels.tone_histogram import ToneHistogram
from stippler.ui.widgets import Widgets

_histogram = ToneHistogram()


def draw_reference(widgets: Widgets, session: Session, look: Look, commands: Commands) -> None:
    """Draw the section."""
    widgets.heading("Picture")
    look.reference_shown = widgets.check(
        "Show picture", look.reference_shown, f"{commands['view.reference'].hint}."
    )
    if look.reference_shown:
        imgui.same_line(0.0, widgets.gap)
        look.opacity = widgets.share("Opacity", look.opacity, "Of the picture under the dots.")
    look.dots_shown = widgets.check("Show dots", look.dots_shown, f"{commands['view.dots'].hint}.")


def draw_tones(widgets: Widgets, session: Session, look: Look, commands: Commands) -> None:
    """Draw how the picture is adjusted before dots are made of it."""
    tip = "Brightness, contrast, gamma: these change the drawing."
    if session.reference is None or not widgets.more("tones", "Lighter, darker, contrast", tip):
        return
    widgets.caption("These change the drawing: dots are made of the picture as it is here.")
    before = session.adjustment
    shaped = _histogram.draw(widgets, session.reference, before)
    session.adjustment = _draw_adjustment(widgets, shaped)
    if session.adjustment != before:
        look.reference_shown = True  # else nothing would be seen to change
    reference = session.reference
    assert reference is not None
    if session.adjustment != reference.adjustment and widgets.button(
        "Use for the dots",
        f"{commands['work.start'].hint}: makes the dots anew, from the adjusted picture. "
        "Brushes go by it from then on.",
        width=-1.0,
        primary=True,
        enabled=session.source is not None,
    ):
        look.dots_shown = True
        commands["work.start"].run()


def _draw_adjustment(widgets: Widgets, now: Adjustment) -> Adjustment:
    white, black = _draw_points(widgets, now)
    percent = 100.0 * MAX_BRIGHTNESS
    brightness = widgets.slider(
        "Brightness",
        100.0 * now.brightness,
        -percent,
        percent,
        "Above 0 all gets lighter, and the lightest greys become bare paper; below 0 all gets "
        "darker but white. In percent.",
        "%+.0f %%",
    )
    contrast = widgets.slider(
        "Contrast",
        100.0 * now.contrast,
        -100.0,
        100.0,
        "Draws light and dark apart, or together; white and black stay. In percent.",
        "%+.0f %%",
    )
    gamma = widgets.slider(
        "Gamma",
        now.gamma,
        *GAMMA_RANGE,
        "Above 1 the middle greys get lighter, below 1 darker; white and black stay.",
        "%.2f",
        imgui.SliderFlags_.logarithmic,
    )
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + widgets.indent - widgets.margin)
    tip = "Black for white: dots where the picture is light."
    invert = widgets.check("Invert", now.invert, tip)
    imgui.same_line(0.0, widgets.gap)
    tip = "Takes the picture as it is."
    if widgets.button("Reset", tip, width=-1.0, enabled=now != NEUTRAL):
        return NEUTRAL
    return Adjustment(
        round(brightness) / 100, round(contrast) / 100, round(gamma, 2), invert, white, black
    )


def _draw_points(widgets: Widgets, now: Adjustment) -> tuple[float, float]:
    """Offer the white and the black point, kept apart."""
    percent = "%.0f %%"
    white = widgets.slider(
        "White from", 100.0 * now.white, 0.0, 95.0, "Lighter tones become bare paper.", percent
    )
    black = widgets.slider(
        "Black from", 100.0 * now.black, 5.0, 100.0, "Darker tones become black.", percent
    )
    if round(white) / 100 != now.white:
        white = min(white, 100.0 * (now.black - MIN_SPAN))
    black = max(black, white + 100.0 * MIN_SPAN)
    return round(white) / 100, min(round(black) / 100, 1.0)
