"""Controls for parameters, made from where those are declared."""

from __future__ import annotations

import math
import random
from collections.abc import Iterable
from typing import Any

from imgui_bundle import imgui

from stippler.drawing.parameter import Kind, Parameter
from stippler.ui.theme import ICON_DICE
from stippler.ui.widgets import Widgets

_RADII_MM = (0.02, 2.0)  # what a range offers to drag; typing takes more
_SIDE_BY_SIDE = 3  # choices; more of them, or long ones, stand in a list
_LONGEST = 24  # letters in all that fit side by side


def draw_parameters(
    widgets: Widgets, values: object, parameters: Iterable[Parameter]
) -> dict[str, Any]:
    """Draw the controls of those parameters that count; return what was changed."""
    changes = {}
    for about in parameters:
        if about.counts(values):
            old = getattr(values, about.name)
            new = draw_parameter(widgets, about, old)
            if new != old:
                changes[about.name] = new
    return changes


def draw_parameter(widgets: Widgets, about: Parameter, value: Any) -> Any:
    """Draw one control; return its value."""
    if about.kind is Kind.CHOICE:
        return _draw_choice(widgets, about, value)
    if about.kind is Kind.FLAG:
        return widgets.check(about.label, value, about.help)
    if about.kind is Kind.RANGE:
        return draw_range(widgets, about, value)
    if about.name == "seed":
        return _draw_seed(widgets, about, value)
    if about.kind is Kind.WHOLE:
        return widgets.number(about.label, value, about.help)
    if about.is_dragged:
        form = f"%.{about.decimals}f {about.unit.replace('%', '%%')}".rstrip()
        new = widgets.slider(about.label, value, about.low, about.high, about.help, form)
        return value if math.isclose(new, value, rel_tol=1e-6, abs_tol=1e-9) else round(new, 6)
    return widgets.length(about.label, value, about.help, about.unit)


def draw_range(widgets: Widgets, about: Parameter, value: tuple[float, float]) -> Any:
    """Draw the two ends of a range; return them."""
    tip = f"Smallest and largest, in {about.unit}."
    low, high = widgets.span(about.label, value, _RADII_MM, about.unit, tip)
    return round(low, 4), round(max(low, high), 4)


def _draw_choice(widgets: Widgets, about: Parameter, value: str) -> str:
    labels = [choice.label for choice in about.choices]
    chosen = about.values.index(value)
    if len(labels) <= _SIDE_BY_SIDE and sum(map(len, labels)) <= _LONGEST:
        tips = [choice.help or about.help for choice in about.choices]
        return about.values[widgets.segments(about.label, labels, chosen, tips)]
    notes = [f"{choice.label}: {choice.help}" for choice in about.choices if choice.help]
    return about.values[
        widgets.choice(about.label, labels, chosen, "\n".join([about.help, *notes]))
    ]


def _draw_seed(widgets: Widgets, about: Parameter, value: int) -> int:
    side = imgui.get_frame_height()
    spare = side + 8.0 * widgets.scale
    value = widgets.number(about.label, value, about.help, spare=spare)
    imgui.same_line()
    what = about.label.lower()
    if widgets.icon_button(f"Another {what}", ICON_DICE, "Another one, by chance."):
        return random.randrange(1, 1_000_000)
    return value
