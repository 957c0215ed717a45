"""The view: how large the page is shown, how it is turned, and the lens over it."""

from __future__ import annotations

import math

from imgui_bundle import imgui

from stippler.editor.commands import Commands
from stippler.editor.view import View
from stippler.ui.look import LENS_DIAMETERS, LENSES, STRENGTHS, Look
from stippler.ui.theme import (
    ICON_DARK,
    ICON_FIT,
    ICON_LEFT,
    ICON_LIGHT,
    ICON_PRINT,
    ICON_RIGHT,
    LIGHT,
)
from stippler.ui.widgets import Widgets


def draw_view(widgets: Widgets, look: Look, view: View, commands: Commands) -> None:
    """Draw the section."""
    widgets.heading("View")
    light = look.theme is LIGHT
    if widgets.heading_button(
        "theme", ICON_LIGHT if light else ICON_DARK, f"{commands['view.theme'].hint}."
    ):
        commands["view.theme"].run()
    _draw_buttons(widgets, commands)
    _draw_turn(widgets, view, commands)
    _draw_helps(widgets, look, commands)
    widgets.rule()
    _draw_lens(widgets, look, commands)


def _draw_buttons(widgets: Widgets, commands: Commands) -> None:
    width = (imgui.get_content_region_avail().x - widgets.gap) / 2
    for name, label, icon, tip in (
        ("view.fit", "Fit", ICON_FIT, "show the whole page."),
        ("view.print_size", "Print size", ICON_PRINT, "as large as on paper."),
    ):
        if widgets.button(label, f"{commands[name].hint}: {tip}", icon=icon, width=width):
            commands[name].run()
        imgui.same_line(0.0, widgets.gap)
    imgui.new_line()


def _draw_turn(widgets: Widgets, view: View, commands: Commands) -> None:
    camera, side = view.camera, imgui.get_frame_height()
    degrees = round(math.degrees(camera.rotation_rad), 1)
    typed = widgets.length(
        "Turned",
        degrees + 0.0,
        "How far the page is turned on the screen, clockwise, in degrees. "
        "Shift, space and drag turns it freely.",
        unit="°",
        spare=2 * (side + widgets.gap),
    )
    if typed != degrees:
        view.turn_to(math.radians(typed))
    next_row = imgui.get_item_rect_max().y + imgui.get_style().item_spacing.y
    for name, icon in (("view.turn_left", ICON_LEFT), ("view.turn_right", ICON_RIGHT)):
        imgui.same_line(0.0, widgets.gap)
        if widgets.icon_button(commands[name].label, icon, f"{commands[name].hint}: by 15°."):
            commands[name].run()
    left = imgui.get_cursor_screen_pos().x
    imgui.set_cursor_screen_pos((left, next_row))  # square buttons would leave a larger gap
    imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + widgets.indent - widgets.margin)
    flip = commands["view.flip"]
    if widgets.check("Flipped", camera.flip, f"{flip.hint}: see the page in a mirror.") != (
        camera.flip
    ):
        flip.run()
    imgui.same_line(0.0, widgets.gap)
    upright = commands["view.upright"]
    if widgets.button(
        "Upright",
        f"{upright.hint}: neither turned nor flipped.",
        width=-1.0,
        enabled=bool(camera.rotation_rad or camera.flip),
    ):
        upright.run()


def _draw_helps(widgets: Widgets, look: Look, commands: Commands) -> None:
    """Offer what stands around the page: rulers, navigator, the picture's half."""
    for label, field, name in (
        ("Rulers", "rulers_shown", "view.rulers"),
        ("Navigator", "navigator_shown", "view.navigator"),
        ("Picture beside the drawing", "split_shown", "view.split"),
    ):
        command = commands[name]
        with widgets.off("" if command.enabled else "There is no picture open."):
            value = widgets.check(label, getattr(look, field), command.explained)
        setattr(look, field, value)
        if label == "Rulers" and not widgets.is_narrow:
            imgui.same_line(0.0, 2 * widgets.gap)


def _draw_lens(widgets: Widgets, look: Look, commands: Commands) -> None:
    widgets.heading("Lens")
    lens = LENSES.index(look.lens)
    tips = (
        "No lens.",
        f"{commands['view.reduce'].hint}: the drawing as from afar, to judge its tone. Ink and "
        "paper mix as light. Hold the key to look, tap it to keep the lens.",
        f"{commands['view.magnify'].hint}: the dots from near. Hold the key to look, tap it to "
        "keep the lens.",
    )
    look.lens = LENSES[widgets.segments("Show", ("Off", "Reduce", "Magnify"), lens, tips)]
    tip = "In the lens against the page; or turn the wheel while you hold the lens's key."
    if look.lens == "magnify":
        at = STRENGTHS.index(look.magnification)
        at = widgets.segments("Strength", [f"{n} ×" for n in STRENGTHS], at, [tip] * 3)
        look.magnification = STRENGTHS[at]
    else:
        at = STRENGTHS.index(look.reduction)
        at = widgets.segments("Strength", [f"1/{n}" for n in STRENGTHS], at, [tip] * 3)
        look.reduction = STRENGTHS[at]
    look.lens_diameter = widgets.slider(
        "Diameter", look.lens_diameter, *LENS_DIAMETERS, "Of the lens, in pixels.", "%.0f px"
    )
