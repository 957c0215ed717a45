"""The view: the reference under the dots, and how large the page is shown."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.ui.commands import Commands
from stippler.ui.look import Look
from stippler.ui.theme import ICON_DARK, ICON_FIT, ICON_LIGHT, ICON_PRINT, LIGHT
from stippler.ui.widgets import Widgets


def draw_view(widgets: Widgets, look: Look, commands: Commands) -> None:
    """Draw the section."""
    widgets.heading("View")
    imgui.same_line(imgui.get_content_region_avail().x - imgui.get_frame_height() + widgets.margin)
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - 5.0 * widgets.scale)
    light = look.theme is LIGHT
    if widgets.icon_button(
        "theme", ICON_LIGHT if light else ICON_DARK, f"{commands['view.theme'].hint}."
    ):
        commands["view.theme"].run()
    width = (imgui.get_content_region_avail().x - widgets.gap) / 2
    for name, label, icon, tip in (
        ("view.fit", "Fit", ICON_FIT, "show the whole page."),
        ("view.print_size", "Print size", ICON_PRINT, "as large as on paper."),
    ):
        if widgets.button(label, f"{commands[name].hint}: {tip}", icon=icon, width=width):
            commands[name].run()
        imgui.same_line(0.0, widgets.gap)
    imgui.new_line()
    look.reference_shown = widgets.check(
        "Show picture", look.reference_shown, f"{commands['view.reference'].hint}."
    )
    if look.reference_shown:
        imgui.same_line(0.0, widgets.gap)
        look.opacity = widgets.share("Opacity", look.opacity, "Of the picture under the dots.")
