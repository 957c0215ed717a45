"""The brush in use: its name, tip and parameters; and what can be done to a selection."""

from __future__ import annotations

import contextlib
import math
from dataclasses import replace
from typing import Any

from imgui_bundle import imgui

from stippler.brushes.brush import LARGEST_MM, SMALLEST_MM, Brush
from stippler.brushes.kinds import Parameter
from stippler.brushes.tip import TIP_SHAPES, Tip
from stippler.editor.commands import Commands
from stippler.editor.painting import Painting
from stippler.errors import ParameterError
from stippler.ui.panels.tip_editor import draw_tip_editor
from stippler.ui.widgets import Widgets

_RESIZE_PERCENT = 10.0
_SMOOTHINGS = ("none", "rope", "window")
_PRESSURES = ("none", "speed", "key")
_PRESSURE_LABELS = ("Always full", "Slower is stronger", "Alt makes it light")


def draw_brush(widgets: Widgets, painting: Painting, commands: Commands) -> None:
    """Draw the panel."""
    toolbox = painting.toolbox
    brush = toolbox.brush
    if brush is None:
        widgets.heading("No brush")
        widgets.caption("Choose a brush in the strip at the left, or by its letter.")
        return
    widgets.heading(brush.about.label)
    widgets.caption(brush.about.tip)
    _draw_presets(widgets, painting)
    brush = toolbox.brush or brush
    changes: dict[str, Any] = {}
    if brush.about.rhythm != "select":
        _draw_radius(widgets, brush, changes)
    values = dict(brush.values)
    for parameter in brush.about.parameters:
        if parameter.only is None or brush.value(parameter.only[0]) in parameter.only[1]:
            values[parameter.name] = _draw_parameter(widgets, brush, parameter)
    if any(brush.value(name) != value for name, value in values.items()):
        changes["values"] = values
    if brush.about.rhythm in ("arc", "time"):
        widgets.rule()
        _draw_tip(widgets, brush, changes)
        widgets.rule()
        _draw_stroke(widgets, brush, changes)
    if changes:
        with contextlib.suppress(ParameterError):  # half typed; the field shows the old one again
            toolbox.set_brush(replace(brush, **changes))
    if brush.about.rhythm == "select":
        widgets.rule()
        _draw_selection(widgets, painting, commands)


def _draw_presets(widgets: Widgets, painting: Painting) -> None:
    toolbox = painting.toolbox
    brush = toolbox.brush
    assert brush is not None
    same = [k for k, other in enumerate(toolbox.brushes) if other.kind == brush.kind]
    if len(same) > 1:
        names = [toolbox.brushes[k].name for k in same]
        chosen = widgets.choice(
            "Preset", names, same.index(toolbox.chosen), "Brushes of this type that you have made."
        )
        toolbox.choose(same[chosen])
        brush = toolbox.brush or brush
    widgets.label("Name")
    _, name = imgui.input_text("##Name", brush.name)
    widgets.note("Name")
    widgets.tip("How the history and the list of presets call this brush.")
    if name.strip() and name != brush.name:
        toolbox.set_brush(replace(brush, name=name[:60]))
    gap = 8.0 * widgets.scale
    width = (imgui.get_content_region_avail().x - gap) / 2
    if widgets.button(
        "Copy brush", "Makes another brush of this type, kept for the next time.", width=width
    ):
        toolbox.copy_brush()
    imgui.same_line(0.0, gap)
    if widgets.button("Delete brush", "Forgets this brush.", width=width, enabled=len(same) > 1):
        toolbox.delete_brush()
    widgets.rule()


def _draw_radius(widgets: Widgets, brush: Brush, changes: dict[str, Any]) -> None:
    widgets.label("Radius")
    flags = imgui.SliderFlags_.logarithmic | imgui.SliderFlags_.always_clamp
    _, radius = imgui.slider_float(
        "##Brush radius", brush.radius_mm, SMALLEST_MM, LARGEST_MM / 5, "%.2f mm", flags
    )
    widgets.note("Brush radius")
    widgets.tip("Of the tip, in mm on the page: [ and ], Shift and drag, Ctrl or Alt and wheel.")
    if radius != brush.radius_mm and SMALLEST_MM <= radius <= LARGEST_MM:
        changes["radius_mm"] = radius


def _draw_parameter(widgets: Widgets, brush: Brush, about: Parameter) -> Any:
    value = brush.value(about.name)
    if about.options:
        labels = [option.capitalize() for option in about.options]
        return about.options[
            widgets.choice(about.label, labels, about.options.index(value), about.tip)
        ]
    if isinstance(about.default, bool):
        return widgets.check(about.label, value, about.tip)
    form = f"%.{0 if about.high - about.low > 99 else 2}f {about.unit.replace('%', '%%')}"
    return widgets.slider(about.label, value, about.low, about.high, about.tip, form.rstrip())


def _draw_tip(widgets: Widgets, brush: Brush, changes: dict[str, Any]) -> None:
    tip = brush.tip
    labels = [shape.capitalize() for shape in TIP_SHAPES]
    shape = TIP_SHAPES[
        widgets.choice("Tip", labels, TIP_SHAPES.index(tip.shape), "Outline of the brush.")
    ]
    wanted: dict[str, Any] = {"shape": shape}
    if shape == "polygon":
        wanted["corners"] = draw_tip_editor(widgets, tip.corners)
    wanted["hardness"] = (
        widgets.slider(
            "Hardness", 100 * tip.hardness, 0, 100,
            "Share of the way to the outline with the full effect, in percent.", "%.0f %%",
        )
        / 100
    )  # fmt: skip
    if shape == "ellipse":
        wanted["aspect"] = widgets.slider(
            "Aspect", tip.aspect, 0.05, 1.0, "Short axis over long axis.", "%.2f"
        )
    if shape != "circle":
        degrees = widgets.slider(
            "Turn", math.degrees(tip.angle_rad), -180, 180, "Of the tip, clockwise.", "%.0f°"
        )
        wanted["angle_rad"] = math.radians(degrees)
    new: Tip = replace(tip, **wanted)
    if abs(new.hardness - tip.hardness) > 1e-6 or replace(new, hardness=tip.hardness) != tip:
        changes["tip"] = new


def _draw_stroke(widgets: Widgets, brush: Brush, changes: dict[str, Any]) -> None:
    if brush.about.rhythm == "arc":
        spacing = widgets.slider(
            "Spacing", 100 * brush.spacing, 2, 200,
            "Way between two stamps, in percent of the radius.", "%.0f %%",
        )  # fmt: skip
        if abs(spacing - 100 * brush.spacing) > 1e-3:
            changes["spacing"] = spacing / 100
    chosen = widgets.segments(
        "Smoothing",
        ("None", "Rope", "Window"),
        _SMOOTHINGS.index(brush.smoothing),
        (
            "The brush follows the pointer.",
            "The pointer pulls the brush by a rope; while that hangs loose the brush rests.",
            "The brush takes the mean of the last stretch of the pointer's path.",
        ),
    )
    if _SMOOTHINGS[chosen] != brush.smoothing:
        changes["smoothing"] = _SMOOTHINGS[chosen]
    if brush.smoothing != "none":
        length = widgets.slider(
            "Length", brush.smoothing_mm, 0.1, 50, "Of rope or window, in mm.", "%.1f mm"
        )
        if length != brush.smoothing_mm:
            changes["smoothing_mm"] = length
    chosen = widgets.choice(
        "Pressure",
        _PRESSURE_LABELS,
        _PRESSURES.index(brush.pressure),
        "What stands in for a pen's pressure; the mouse has none.",
    )
    if _PRESSURES[chosen] != brush.pressure:
        changes["pressure"] = _PRESSURES[chosen]


def _draw_selection(widgets: Widgets, painting: Painting, commands: Commands) -> None:
    n = painting.n_selected
    widgets.caption(f"{n:,} dots selected" if n else "No dots selected")
    gap = 8.0 * widgets.scale
    width = (imgui.get_content_region_avail().x - gap) / 2
    actions = (
        ("Delete", commands["selection.delete"].hint, painting.delete),
        ("Duplicate", commands["selection.duplicate"].hint, painting.duplicate),
        ("Fix dots", "They stay where they are from now on.", lambda: painting.fix(True)),
        ("Free dots", "They may move again.", lambda: painting.fix(False)),
        ("Relax dots", "One step of relaxation.", painting.relax),
        ("Jitter dots", "By up to a fifth of their mean distance.", painting.jitter),
        ("Larger", "By 10 percent.", lambda: painting.resize(_RESIZE_PERCENT)),
        ("Smaller", "By 10 percent.", lambda: painting.resize(-_RESIZE_PERCENT)),
    )
    for k, (label, tip, act) in enumerate(actions):
        if k % 2:
            imgui.same_line(0.0, gap)
        if widgets.button(label, tip, width=width, enabled=n > 0):
            act()
    widgets.caption("Drag a selected dot to move them all.")
