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
        "Show the picture", look.reference_shown, f"{commands['view.reference'].hint}."
    )
    if look.reference_shown:
        percent = widgets.slider(
            "Opacity",
            look.opacity * 100,
            0,
            100,
            "Of the picture under the dots, in percent.",
            "%.0f %%",
        )
        look.opacity = percent / 100
    light = look.theme is LIGHT
    widgets.label("Desk")
    if widgets.button(
        "Light" if light else "Dark",
        commands["view.theme"].hint,
        icon=ICON_LIGHT if light else ICON_DARK,
        width=-1.0,
    ):
        commands["view.theme"].run()
