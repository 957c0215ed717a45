"""Filling a page that has no picture."""

from __future__ import annotations

from dataclasses import replace

from stippler.editor.messages import WARNING
from stippler.editor.session import Session
from stippler.errors import ParameterError
from stippler.stippling.fill import PARAMETERS
from stippler.ui.panels.parameters import draw_parameters
from stippler.ui.widgets import Widgets


def draw_fill(widgets: Widgets, session: Session) -> None:
    """Draw the section."""
    widgets.heading("Fill")
    changes = draw_parameters(widgets, session.filling, PARAMETERS)
    try:
        session.filling = replace(session.filling, **changes)
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
