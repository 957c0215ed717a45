"""What commands work on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from stippler.editor.area_acts import AreaActs
from stippler.editor.lines import Lines
from stippler.editor.painting import Painting
from stippler.editor.patterns import Patterns
from stippler.editor.pointer import Pointer
from stippler.editor.selecting import Selecting
from stippler.editor.session import Session
from stippler.editor.view import View
from stippler.ui.canvas.lens import LensKey
from stippler.ui.canvas.peek import Peek
from stippler.ui.look import Look
from stippler.ui.panels.docks import Panels
from stippler.ui.popups.popups import Popups
from stippler.ui.window.window import Window


@dataclass(frozen=True, slots=True)
class Parts:
    """The parts of the editor that commands work on; made once, when all of them are there.

    Attributes
    ----------
    show_panel : callable
        Brings a panel to the front.
    reset_panels : callable
        Shows every panel where it was at first.
    turn_focus : callable
        Gives the panel in front the keyboard, or the canvas.
    peek : Peek
        Shows the picture, or the drawing before its last step, while a key is held.
    """

    window: Window
    session: Session
    painting: Painting
    selecting: Selecting
    lines: Lines
    patterns: Patterns
    area_acts: AreaActs
    pointer: Pointer
    view: View
    look: Look
    lens_key: LensKey
    panels: Panels
    popups: Popups
    show_panel: Callable[[str], None]
    reset_panels: Callable[[], None]
    turn_focus: Callable[[], None]
    peek: Peek
