"""What its border is to the dots of an area: a choice for the chosen ones."""

from __future__ import annotations

from stippler.drawing.drawing import Drawing
from stippler.drawing.style import AS_STYLE, parameter_of
from stippler.editor.area_acts import AreaActs
from stippler.ui.widgets import Widgets


def draw_border_policy(widgets: Widgets, acts: AreaActs, drawing: Drawing, ids: list[int]) -> None:
    """Draw the choice, which is the areas' own; or theirs is that of their styles."""
    about = parameter_of("border")
    choices = about.choices
    of_style = choices[about.values.index(drawing.style_of(ids[0]).border)].label
    values = (AS_STYLE, *about.values)
    now = values.index(drawing.areas[ids[0]].border)
    told = " ".join(f"{one.label}: {one.help}" for one in choices)
    chosen = widgets.choice(
        about.label, [f"As its style: {of_style}", *(one.label for one in choices)], now,
        f"{told} The chosen areas have it whatever their style says.",
    )  # fmt: skip
    if chosen != now:
        acts.set_border(ids, values[chosen])
