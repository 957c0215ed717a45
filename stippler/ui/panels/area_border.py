"""What its border is to the dots of an area: a choice for the chosen ones."""

from __future__ import annotations

from stippler.drawing.drawing import Drawing
from stippler.drawing.style import parameter_of
from stippler.editor.area_acts import AreaActs
from stippler.ui.widgets import Widgets


def draw_border_policy(widgets: Widgets, acts: AreaActs, drawing: Drawing, ids: list[int]) -> None:
    """Draw the choice; what is chosen holds for all areas of the same styles."""
    about = parameter_of("border")
    choices = about.choices
    now = about.values.index(drawing.style_of(ids[0]).border)
    told = " ".join(f"{one.label}: {one.help}" for one in choices)
    chosen = widgets.choice(
        about.label, [one.label for one in choices], now,
        f"{told} It is of the style, so it holds for all areas that share it.",
    )  # fmt: skip
    if chosen != now:
        acts.set_border(ids, choices[chosen].value)
