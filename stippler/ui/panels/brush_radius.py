"""The radius of a brush as a number: in mm on the page, typed in pixels of the screen, too."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.brushes.brush import LARGEST_MM, SMALLEST_MM
from stippler.editor.number_steps import Scale
from stippler.editor.tools.toolbox import Toolbox
from stippler.ui.number_control import About, draw_number
from stippler.ui.widgets import Widgets

_LARGEST_MM = LARGEST_MM / 5  # by hand: keys and the wheel go on
_TIP = (
    "Of the tip, in mm on the page; 40 px is of the screen, at the zoom as it is. "
    "[ and ], Shift and drag, Ctrl or Alt and wheel change it, too."
)


def draw_radius(
    widgets: Widgets, radius_mm: float, px_per_mm: float, *, label: str, name: str, width: float
) -> float:
    """Draw the control in a width; return the radius, or what it was changed to."""
    if label:
        widgets.label(label)
    imgui.set_next_item_width(width)
    about = About(
        Scale("mm", None, 0.0, SMALLEST_MM, max(_LARGEST_MM, radius_mm)),
        geometric=True,
        units={"px": 1.0 / px_per_mm},
    )
    return draw_number(widgets, label, radius_mm, about, _TIP, name)


def tool_hint(toolbox: Toolbox, px_per_mm: float) -> str:
    """Return what the tool at hand does, and how large its tip is on the screen."""
    if toolbox.tool is None:
        return ""
    brush = toolbox.brush
    if brush is None or not brush.about.has_tip:
        return f"{toolbox.tool.label}: {toolbox.tool.tip}"
    px = 2.0 * brush.radius_mm * px_per_mm
    size = f"{px:,.0f}" if px >= 10.0 else f"{px:.1f}"
    return f"{toolbox.tool.label}, {size} px wide on the screen: {toolbox.tool.tip}"
