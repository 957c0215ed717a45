"""Filling a page that has no picture."""

from __future__ import annotations

import random
from dataclasses import replace

from imgui_bundle import imgui

from stippler.editor.messages import WARNING
from stippler.editor.session import Session
from stippler.errors import ParameterError
from stippler.stippling.plan import ARRANGEMENTS
from stippler.ui.theme import ICON_DICE
from stippler.ui.widgets import Widgets


def draw_fill(widgets: Widgets, session: Session) -> None:
    """Draw the section."""
    widgets.heading("Fill")
    before = session.filling
    n_dots = widgets.number("Fill with", before.n_dots, "How many dots.")
    chosen = widgets.segments(
        "Layout",
        tuple(name.capitalize() for name in ARRANGEMENTS),
        ARRANGEMENTS.index(before.arrangement),
        ("Rows of dots at equal distances.", "Anywhere on the page; relax them to even them out."),
    )
    radius_mm = widgets.length("Dot radius", before.radius_mm, "In mm.")
    seed = before.seed
    if before.arrangement == "random":
        side = imgui.get_frame_height()
        tip = "Chooses where the dots lie."
        seed = widgets.number("Fill seed", seed, tip, spare=side + 8.0 * widgets.scale)
        imgui.same_line()
        if widgets.icon_button("Another fill seed", ICON_DICE, "Another seed, by chance."):
            seed = random.randrange(1, 1_000_000)
    try:
        session.filling = replace(
            before,
            n_dots=n_dots,
            arrangement=ARRANGEMENTS[chosen],
            radius_mm=radius_mm,
            seed=seed,
        )
    except ParameterError as error:
        session.messages.say(str(error), WARNING)
    if widgets.button(
        "Fill the page",
        "Adds the dots to those that are there; one step to undo.",
        width=-1.0,
        primary=session.n_dots == 0,
        enabled=session.paintable,
    ):
        session.fill()
