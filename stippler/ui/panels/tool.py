"""The tool at hand: its parameters and commands; of a brush, its name, tip and stroke, too."""

from __future__ import annotations

import contextlib
import math
from dataclasses import replace
from typing import Any

from imgui_bundle import imgui

from stippler.brushes.brush import Brush
from stippler.brushes.kinds import Value
from stippler.brushes.tip import TIP_SHAPES, Tip
from stippler.drawing.parameter import Kind, Parameter
from stippler.editor.commands import Commands
from stippler.editor.tools.brush_shelf import BrushShelf
from stippler.editor.tools.brush_tool import BrushTool
from stippler.editor.tools.tool import Tool
from stippler.editor.tools.toolbox import Toolbox
from stippler.errors import ParameterError
from stippler.ui.panels.brush_radius import draw_radius
from stippler.ui.panels.tip_editor import draw_tip_editor
from stippler.ui.widgets import Widgets

_SMOOTHINGS = ("none", "rope", "window")
_PRESSURES = ("none", "speed", "key")
_PRESSURE_LABELS = ("Always full", "Slower is stronger", "Alt makes it light")


def draw_tool(
    widgets: Widgets, toolbox: Toolbox, commands: Commands, n_selected: int, px_per_mm: float
) -> None:
    """Draw the panel: what the tool is called and does, its values, and its commands.

    `px_per_mm` is of the screen as it is zoomed: a tip's size can be typed in its pixels.
    """
    tool = toolbox.tool
    if tool is None:
        widgets.heading("No tool")
        widgets.caption("Choose a tool in the strip at the left, or by its letter.")
        return
    widgets.heading(tool.label)
    widgets.caption(tool.tip)
    if isinstance(tool, BrushTool):
        _draw_brush(widgets, toolbox, tool, px_per_mm)
    else:
        for name, value in _draw_parameters(widgets, tool).items():
            tool.set(name, value)
    if tool.commands:
        widgets.rule()
        dots = f"{n_selected:,} dots selected" if n_selected else "No dots selected"
        widgets.caption(tool.chosen_text or dots)
        _draw_commands(widgets, commands, tool.commands)
    for heading, names in tool.groups:
        widgets.rule()
        widgets.heading(heading)
        _draw_commands(widgets, commands, names)


def _draw_parameters(widgets: Widgets, tool: Tool) -> dict[str, Value]:
    """Draw a tool's parameters; return those that were changed."""
    changed = {}
    for parameter in tool.parameters:
        if parameter.only is None or tool.value(parameter.only[0]) in parameter.only[1]:
            before = tool.value(parameter.name)
            after = _draw_parameter(widgets, before, parameter)
            if after != before:
                changed[parameter.name] = after
    return changed


def _draw_brush(widgets: Widgets, toolbox: Toolbox, tool: BrushTool, px_per_mm: float) -> None:
    _draw_presets(widgets, toolbox.shelf, tool)
    brush = tool.brush
    changes: dict[str, Any] = {}
    radius_mm = draw_radius(
        widgets, brush.radius_mm, px_per_mm, label="Radius", name="Brush radius", width=-1.0
    )
    if radius_mm != brush.radius_mm:
        changes["radius_mm"] = radius_mm
    if values := _draw_parameters(widgets, tool):
        changes["values"] = {**brush.values, **values}
    if tool.kind.has_tip:
        widgets.rule()
        _draw_tip(widgets, brush, changes)
        widgets.rule()
        _draw_stroke(widgets, brush, changes)
    if changes:
        with contextlib.suppress(ParameterError):  # half typed; the field shows the old one again
            tool.brush = replace(brush, **changes)


def _draw_presets(widgets: Widgets, shelf: BrushShelf, tool: BrushTool) -> None:
    kind = tool.kind.name
    names = [brush.name for brush in shelf.of(kind)]
    if len(names) > 1:
        chosen = widgets.choice(
            "Preset", names, shelf.place(kind), "Brushes of this type that you have made."
        )
        shelf.use(kind, chosen)
    brush = tool.brush
    widgets.label("Name")
    _, name = imgui.input_text("##Name", brush.name)
    widgets.note("Name")
    widgets.tip("How the history and the list of presets call this brush.")
    if name.strip() and name != brush.name:
        tool.brush = replace(brush, name=name[:60])
    width = (imgui.get_content_region_avail().x - 2 * widgets.gap) / 3
    if widgets.button(
        "Copy",
        "Makes another brush of this type, kept for the next time.",
        name="Copy brush",
        width=width,
    ):
        shelf.copy(kind)
    imgui.same_line(0.0, widgets.gap)
    if widgets.button(
        "Reset", "Tip and values as they were at first.", name="Reset brush", width=width
    ):
        shelf.reset(kind)
    imgui.same_line(0.0, widgets.gap)
    if widgets.button(
        "Delete",
        "Forgets this brush; the command Restore deleted brush brings it back.",
        name="Delete brush",
        width=width,
        enabled=len(names) > 1,
    ):
        shelf.delete(kind)
    widgets.rule()


def _draw_parameter(widgets: Widgets, value: Any, about: Parameter) -> Any:
    if about.kind is Kind.CHOICE:
        labels = [choice.label for choice in about.choices]
        k = widgets.choice(about.label, labels, about.values.index(value), about.help)
        return about.values[k]
    if about.kind is Kind.FLAG:
        return widgets.check(about.label, value, about.help)
    form = f"%.{about.decimals}f {about.unit.replace('%', '%%')}"
    return widgets.slider(about.label, value, about.low, about.high, about.help, form.rstrip())


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
        ("None", "On a rope", "Average"),
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
            "Length",
            brush.smoothing_mm,
            0.1,
            50,
            "Of the rope, or of the averaged stretch.",
            "%.1f mm",
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


def _draw_commands(widgets: Widgets, commands: Commands, names: tuple[str, ...]) -> None:
    half = (imgui.get_content_region_avail().x - widgets.gap) / 2
    for k, name in enumerate(names):
        command = commands[name]
        if k % 2:
            imgui.same_line(0.0, widgets.gap)
        is_on = command.is_on is not None and command.is_on()
        if widgets.button(
            command.short, command.explained, width=half, primary=is_on, enabled=command.enabled
        ):
            command.run()
