"""In the export dialog: the press dots are solved for, its calibration, and faults in print."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from stippler.editor.export_choices import Choices
from stippler.editor.numbers import parse_number
from stippler.errors import ParameterError, StipplerError
from stippler.files.write.formats import PLATE
from stippler.ui.popups.export_fields import draw_option, number_field, text_field
from stippler.ui.widgets import Widgets

if TYPE_CHECKING:
    from stippler.files.checks import Findings

_NONE = "None"


class PressSection:
    """Chooses a press, and calibrates one by numbers that are typed in.

    Parameters
    ----------
    show_sheet : callable
        Opens the calibration sheet as a drawing, to be exported and printed.
    """

    def __init__(self, show_sheet: Callable[[], None]) -> None:
        self._show_sheet = show_sheet
        self._is_open = False
        self._name, self._measured = "", ""

    def draw(self, widgets: Widgets, choices: Choices) -> None:
        """Draw the section."""
        from stippler.files.presses import presses

        widgets.heading("Press")
        known = presses()
        names = [_NONE, *known]
        now = str(choices.given.get("press") or _NONE)
        at = names.index(now) if now in names else 0
        tip = "A press, pen or printer that was calibrated: dots are solved for its ink."
        new = widgets.choice("Printed by", names, at, tip)
        if new != at:
            choices.set("press", names[new] if new else None)
        press = known.get(names[new])
        if press is not None:
            least = f", least dot {press.least_dot_mm:g} mm" if press.least_dot_mm else ""
            widgets.caption(f"Edges grow by {press.gain_mm:g} mm{least}. {press.dated}")
        for name in ("gain", "least_dot"):
            option = next(one for one in PLATE if one.name == name)
            draw_option(widgets, choices, option, shown=choices.given.get(name))
        if widgets.button("Calibrate", "Type in what a printed sheet of patches measured."):
            self._is_open = not self._is_open
        if self._is_open:
            self._draw_form(widgets, choices)

    def _draw_form(self, widgets: Widgets, choices: Choices) -> None:
        from stippler.files.checks import SHEET_STEPS

        steps = ", ".join(f"{100 * share:.0f}" for share in SHEET_STEPS)
        widgets.caption(
            f"Print the sheet as you will print, and measure the ink of its patches ({steps} %), "
            "lightest first."
        )
        if widgets.button("Open the sheet", "As a drawing, to export and print."):
            self._show_sheet()
        text_field(widgets, "Name", self._name, "Of the press and paper.", self._take_name)
        text_field(
            widgets, "Measured", self._measured, "Percent of ink, with spaces between.", self._take
        )
        if widgets.button("Keep press", "Finds by how much edges grow, and keeps that.",
                          primary=True):  # fmt: skip
            try:
                self._keep(choices)
            except StipplerError as error:
                widgets.refuse(str(error))

    def _take_name(self, text: str) -> None:
        self._name = text

    def _take(self, text: str) -> None:
        self._measured = text

    def _keep(self, choices: Choices) -> None:
        from stippler.files.presses import calibrated, keep_press

        try:
            shares = [parse_number(text) / 100 for text in self._measured.replace(";", " ").split()]
        except ParameterError:
            raise ParameterError(
                f"{self._measured!r} are no numbers", "measured", "give seven, such as 12 23 34 ..."
            ) from None
        keep_press(calibrated(self._name.strip(), shares))
        choices.set("press", self._name.strip())
        self._is_open = False


def draw_checks(
    widgets: Widgets,
    choices: Choices,
    findings: Findings | None,
    acts: tuple[Callable[[], None], Callable[[], None]],
) -> None:
    """Draw what print can do, what it would spoil, and what shows and repairs that.

    Parameters
    ----------
    acts : (show, repair)
    """
    widgets.heading("Before print")
    try:
        process = choices.process()
    except StipplerError as error:
        widgets.caption(str(error), widgets.theme.alarm)
        return

    def set_value(name: str) -> Callable[[float | None], None]:
        def take(value: float | None) -> None:
            from dataclasses import replace

            if value is not None:
                replace(process, **{name: value})  # says why it cannot be used
            setattr(choices, name, value)

        return take

    for name, label, tip in (
        ("least_dot_mm", "Smallest dot", "Diameter below which print loses dots."),
        ("least_gap_mm", "Smallest gap", "White between dots below which it fills up."),
        ("gain_mm", "Ink spreads", "How much edges grow in print."),
    ):
        number_field(widgets, label, getattr(process, name), "mm", tip, set_value(name))
    if findings is None:
        widgets.caption("looking …")
        return
    lines = findings.lines()
    for line in lines or ["Nothing that print would spoil"]:
        widgets.caption(line, widgets.theme.accent if lines else None)
    imgui.begin_disabled(findings.n == 0)
    show, repair = acts
    if widgets.button("Show faults", "In the drawing, one after the other; this closes."):
        show()
    imgui.same_line(0.0, widgets.gap)
    if widgets.button("Repair", "Enlarges and thins out, parts, moves in; tone stays. One step."):
        repair()
    imgui.end_disabled()
