"""Commands on the view and the panels."""

from __future__ import annotations

import math
from collections.abc import Iterator

from stippler.editor.commands import CTRL, SHIFT, Command, Key
from stippler.editor.messages import WARNING
from stippler.ui.actions.parts import Parts
from stippler.ui.preferences import SCALES

_TEXT_STEP, _ZOOM = 1.1, 1.25
_TURN_RAD = math.radians(15.0)


def view_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on how the page is seen."""
    look, view, session, window = parts.look, parts.view, parts.session, parts.window

    def show_selection() -> None:
        box = parts.painting.selected_box()
        if box is None:
            session.messages.say("no dots are selected", WARNING)
        else:
            view.show_box(*box)

    def zoom(factor: float) -> None:
        width, height = view.size_px
        view.zoom(factor, (width / 2, height / 2))

    def show_marks() -> None:
        look.marks_shown = not look.marks_shown

    def show_reference() -> None:
        look.reference_shown = not look.reference_shown

    def show_dots() -> None:
        look.dots_shown = not look.dots_shown

    def print_size() -> None:
        view.print_size(window.px_per_mm)

    def scale_text(factor: float) -> None:
        scale = (look.scale or window.scale) * factor
        look.scale = round(min(max(scale, SCALES[0]), SCALES[1]), 2)
        session.messages.say(f"text and controls at {100 * look.scale:.0f} %")

    yield Command("view.fit", "Fit", view.fit, (Key("f"), Key("home")))
    yield Command("view.print_size", "Print size", print_size, (Key("1"),))
    yield Command("view.zoom_in", "Zoom in", lambda: zoom(_ZOOM),
                  (Key("="), Key("+"), Key("=", CTRL), Key("+", CTRL), Key("kp_add")),
                  repeats=True)  # fmt: skip
    yield Command("view.zoom_out", "Zoom out", lambda: zoom(1 / _ZOOM),
                  (Key("-"), Key("-", CTRL), Key("kp_subtract")), repeats=True)  # fmt: skip
    yield Command("view.selection", "Zoom to the selection", show_selection,
                  (Key("f", SHIFT),))  # fmt: skip
    yield Command("view.reference", "Show or hide the picture", show_reference, (Key("r"),),
                  is_on=lambda: look.reference_shown)  # fmt: skip
    yield Command("view.dots", "Show or hide the dots", show_dots, (Key("d"),),
                  is_on=lambda: look.dots_shown)  # fmt: skip
    yield Command("view.marks", "Show or hide marks", show_marks, (Key("h", CTRL),),
                  is_on=lambda: look.marks_shown,
                  tip="the colours of fixed and selected dots.")  # fmt: skip
    yield Command("view.full_screen", "Full screen", window.turn_full_screen, (Key("f11"),),
                  is_on=lambda: window.is_full_screen)  # fmt: skip
    yield from _comparing_commands(parts)
    yield from _turning_commands(parts)
    yield from _lens_commands(parts)
    yield Command("view.theme", "Light or dark", look.turn_theme, (Key("t"),))
    yield Command("view.larger", "Larger text and controls", lambda: scale_text(_TEXT_STEP))
    yield Command("view.smaller", "Smaller text and controls", lambda: scale_text(1 / _TEXT_STEP))


def _comparing_commands(parts: Parts) -> Iterator[Command]:
    look, session, peek = parts.look, parts.session, parts.peek

    def turn(name: str) -> None:
        setattr(look, name, not getattr(look, name))

    def has_picture() -> bool:
        return session.reference is not None

    def can_undo() -> bool:
        return session.document is not None and session.document.history.undone is not None

    yield Command("view.peek", "Look at the picture alone", peek.show_picture, (Key("d", SHIFT),),
                  can=has_picture, is_on=lambda: look.peek == "picture",
                  tip="for as long as the key is held.")  # fmt: skip
    yield Command("view.before", "Look at the drawing before the last step", peek.show_before,
                  (Key("z", SHIFT),), can=can_undo, is_on=lambda: look.peek == "before",
                  tip="for as long as the key is held.")  # fmt: skip
    yield Command("view.split", "Picture beside the drawing", lambda: turn("split_shown"),
                  (Key("r", SHIFT),), can=has_picture, is_on=lambda: look.split_shown,
                  tip="the picture in the left half, the drawing in the right.")  # fmt: skip
    yield Command("view.rulers", "Rulers", lambda: turn("rulers_shown"), (Key("r", CTRL),),
                  is_on=lambda: look.rulers_shown, tip="in mm, along the canvas.")  # fmt: skip
    yield Command("view.navigator", "Navigator", lambda: turn("navigator_shown"),
                  is_on=lambda: look.navigator_shown,
                  tip="the whole page in a corner of the canvas.")  # fmt: skip


def _turning_commands(parts: Parts) -> Iterator[Command]:
    view = parts.view
    yield Command("view.turn_left", "Turn left", lambda: view.turn(-_TURN_RAD), (Key(","),))
    yield Command("view.turn_right", "Turn right", lambda: view.turn(_TURN_RAD), (Key("."),))
    yield Command("view.flip", "Flip", view.flip, (Key("y"), Key("\\")))
    yield Command("view.upright", "Upright", view.upright, (Key("0"),))


def _lens_commands(parts: Parts) -> Iterator[Command]:
    look, lens = parts.look, parts.lens_key
    for name, label, key in (
        ("reduce", "Reduction lens", Key("z")),
        ("magnify", "Magnifying lens", Key("q")),
    ):
        yield Command(
            f"view.{name}",
            label,
            lambda name=name: lens.switch(name),  # type: ignore[misc]
            (key,),
            is_on=lambda name=name: look.lens == name,  # type: ignore[misc]
        )


def panel_commands(parts: Parts) -> Iterator[Command]:
    """Yield commands on panels."""
    panels = parts.panels
    for name in panels.names:
        yield Command(
            f"panel.{name.lower().replace(' ', '_')}",
            name,
            lambda name=name: panels.toggle(name),  # type: ignore[misc]
            is_on=lambda name=name: panels.is_open(name),  # type: ignore[misc]
        )
    yield Command("panel.hide", "Hide or show all panels", panels.turn_hidden, (Key("tab"),),
                  is_on=lambda: not panels.are_hidden)  # fmt: skip
    yield Command("panel.focus", "Keyboard to the panels, and back", parts.turn_focus,
                  (Key("f6"),))  # fmt: skip
    yield Command("panel.reset", "Reset the panels", parts.reset_panels)
