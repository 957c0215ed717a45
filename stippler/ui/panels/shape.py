"""The shape of all dots, or of the chosen ones: pens, size, form and direction."""

from __future__ import annotations

import math
from collections.abc import Callable

from imgui_bundle import imgui

from stippler.drawing.dots import MAX_ELONGATION
from stippler.drawing.pens import PENS
from stippler.drawing.shape_change import LinearChange, ShapeChange, to
from stippler.editor.shaping import DIRECTIONS, Shaping
from stippler.ui.canvas.pen_samples import PenSamples
from stippler.ui.widgets import Widgets

_PEN_HEIGHT, _PEN_INDENT = 32.0, 112.0
_SIZES = (25.0, 400.0)  # percent
_DIRECTION_LABELS = ("Their own", "An angle", "Any", "The picture's edges")


def draw_shape(widgets: Widgets, shaping: Shaping, samples: PenSamples) -> None:
    """Draw the panel."""
    widgets.heading("Shape")
    widgets.caption("Seen as you drag; Esc puts it back.")
    chosen = widgets.segments(
        "For",
        ("All dots", "Selection"),
        int(shaping.selected),
        ("Every dot of the drawing.", "The dots chosen with the selection tool."),
    )
    shaping.selected = chosen == 1
    n = shaping.averages.n
    widgets.caption(f"{n:,} dots" if n else "No dots selected" if shaping.selected else "No dots")
    imgui.begin_disabled(not shaping.can)
    widgets.rule()
    _draw_pens(widgets, shaping, samples)
    widgets.rule()
    _draw_form(widgets, shaping)
    widgets.rule()
    _draw_direction(widgets, shaping)
    imgui.end_disabled()


def _draw_pens(widgets: Widgets, shaping: Shaping, samples: PenSamples) -> None:
    hovered = False
    for k, pen in enumerate(PENS):
        imgui.align_text_to_frame_padding()
        imgui.text_colored((*widgets.theme.faint, 1.0), pen.label)
        imgui.same_line(_PEN_INDENT * widgets.scale)
        size = (imgui.get_content_region_avail().x, _PEN_HEIGHT * widgets.scale)
        samples.show(k, size, widgets.theme, widgets.scale)
        widgets.note(pen.label)
        if shaping.can and imgui.is_item_hovered():
            hovered = True
            _frame(widgets)
            shaping.hold("pen", 0.0, pen.change)
            if imgui.is_mouse_clicked(imgui.MouseButton_.left):
                shaping.make(f"{pen.label}:", pen.change)
    if not hovered and shaping.holder == "pen":
        shaping.let_go()


def _frame(widgets: Widgets) -> None:
    """Mark the last item."""
    colour = int(imgui.color_convert_float4_to_u32((*widgets.theme.accent, 1.0)))
    imgui.get_window_draw_list().add_rect(
        imgui.get_item_rect_min(), imgui.get_item_rect_max(), colour, 2.0, 2.0 * widgets.scale
    )


def _draw_form(widgets: Widgets, shaping: Shaping) -> None:
    now = shaping.averages
    _slider(
        widgets, shaping, ("Size", "Resize"), 100.0, _SIZES,
        "Of each dot, in percent of its radius now.", "%.0f %%",
        lambda v: ShapeChange(radius=LinearChange(v / 100.0)), imgui.SliderFlags_.logarithmic,
    )  # fmt: skip
    _slider(
        widgets, shaping, ("Elongation", "Elongate"), now.elongation, (1.0, MAX_ELONGATION),
        "Long axis over short axis; the area stays. Shown is the mean.", "%.2f",
        lambda v: ShapeChange(elongation=to(v), **shaping.facing()),
    )  # fmt: skip
    _slider(
        widgets, shaping, ("Roughness", "Roughen"), now.roughness, (0.0, 1.0),
        "0 is a smooth outline, 1 as torn as can be; the area stays. Shown is the mean.", "%.2f",
        lambda v: ShapeChange(roughness=to(v)),
    )  # fmt: skip


def _draw_direction(widgets: Widgets, shaping: Shaping) -> None:
    was = DIRECTIONS.index(shaping.direction)
    options = _DIRECTION_LABELS if shaping.has_edges else _DIRECTION_LABELS[:-1]
    chosen = widgets.choice(
        "Direction", options, min(was, len(options) - 1), "Where elongated dots point."
    )
    shaping.direction = DIRECTIONS[chosen]
    if chosen != was and shaping.direction != "own":
        shaping.make("Turn", ShapeChange(**shaping.facing()))
    if shaping.direction == "angle":
        _turning(widgets, shaping, "Angle", "angle_rad", (-90.0, 90.0), "Clockwise from the right.")
    if shaping.direction in ("angle", "edges"):
        tip = "Each dot turns away by an angle of its own of up to so much."
        _turning(widgets, shaping, "Scatter", "scatter_rad", (0.0, 90.0), tip)


def _turning(
    widgets: Widgets,
    shaping: Shaping,
    label: str,
    field: str,
    limits: tuple[float, float],
    tip: str,
) -> None:
    """Offer an angle that dots take while it is dragged."""

    def change(degrees: float) -> ShapeChange:
        return ShapeChange(**(shaping.facing() | {field: math.radians(degrees)}))

    rest = math.degrees(getattr(shaping, field))
    made = _slider(widgets, shaping, (label, "Turn"), rest, limits, tip, "%.0f°", change)
    if made is not None:
        setattr(shaping, field, math.radians(made))


def _slider(
    widgets: Widgets,
    shaping: Shaping,
    names: tuple[str, str],
    rest: float,
    limits: tuple[float, float],
    tip: str,
    form: str,
    change: Callable[[float], ShapeChange],
    flags: int = 0,
) -> float | None:
    """Offer a value: shown while it is dragged, made when it is let go, and then returned.

    Parameters
    ----------
    names : (label, what)
        Of the control, and of the step in the history.
    rest : float
        What it shows while nobody holds it.
    """
    label, what = names
    shown = shaping.value if shaping.holder == label else rest
    value = widgets.slider(label, shown, *limits, tip, form, flags)
    if value != shown and not imgui.is_item_active():  # typed, or stepped
        shaping.make(what, change(value))
        return value
    if value != shown:
        shaping.hold(label, value, change(value))
    if imgui.is_item_deactivated() and shaping.holder == label:
        made = shaping.value
        shaping.make(what, change(made))
        return made
    return None
