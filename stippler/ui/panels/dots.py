"""The dots: how many, how large, how they are set and evened out."""

from __future__ import annotations

from typing import Any

from imgui_bundle import imgui

from stippler.drawing.style import DEFAULT_DOTS, PARAMETERS, parameter_of
from stippler.editor.commands import Commands
from stippler.editor.session import Session
from stippler.ui.panels.fill import draw_fill
from stippler.ui.panels.parameters import draw_parameter, draw_parameters, draw_range
from stippler.ui.popups.styles import said_style
from stippler.ui.widgets import Widgets

_USUAL_RANGE_MM = (0.12, 0.24)
_APART = ("n_dots", "density_per_cm2", "size_range_mm")  # one may follow from the other
_USUAL = tuple(p for p in PARAMETERS if p.name not in _APART and not p.is_more)
_MORE = tuple(p for p in PARAMETERS if p.name not in _APART and p.is_more)
_OF_BLANKS = ("iterations",)  # what counts on a page without a picture


def draw_dots(widgets: Widgets, session: Session, commands: Commands) -> None:
    """Draw the section; on a page without a picture, filling it stands first."""
    style = session.style
    changes: dict[str, Any] = {}
    if session.drawing is not None and session.reference is None:
        draw_fill(widgets, session)
        widgets.rule()
        widgets.heading("Dots")
        some = [one for one in PARAMETERS if one.name in _OF_BLANKS]
        changes |= draw_parameters(widgets, style, some)
    else:
        widgets.heading("Dots")
        _draw_style(widgets, session, commands)
        _draw_number(widgets, session, changes)
        _draw_sizes(widgets, session, changes)
        changes |= draw_parameters(widgets, style, _USUAL)
        if widgets.more("dots"):
            changes |= draw_parameters(widgets, style, _MORE)
        if changes.get("first_dots", style.first_dots) != "pulse-density":
            changes["sizes"] = "tone"
    changed = {name: value for name, value in changes.items() if value != getattr(style, name)}
    if changed:
        session.edit_style(**changed)


def _draw_style(widgets: Widgets, session: Session, commands: Commands) -> None:
    widgets.label("Style")
    command = commands["work.style"]
    if widgets.button(
        said_style(session.style),
        f"{command.hint}: skin, stone, fur and others, each with a picture of it.",
        name="style", width=-1.0,
    ):  # fmt: skip
        command.run()


def _draw_number(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    style, about = session.style, parameter_of("n_dots")
    by_density = widgets.segments(
        "Count", ("In all", "Per cm²"), int(style.density_per_cm2 is not None),
        ("A number of dots for the whole area.", "As many as make so many a square centimetre."),
    )  # fmt: skip
    if by_density:
        _draw_density(widgets, session, changes)
        return
    if style.density_per_cm2 is not None:
        changes["density_per_cm2"] = None
    follows = style.n_dots is None and style.size_range_mm is not None
    shown = style.n_dots or session.n_dots or DEFAULT_DOTS
    imgui.begin_disabled(follows)
    why = "Follows from the sizes now." if follows else "Unless given, as many as suit the page."
    typed = widgets.number(about.label, shown, f"How many dots. {why}")
    imgui.end_disabled()
    if not follows and typed != shown:
        changes["n_dots"] = typed


def _draw_density(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    style, about = session.style, parameter_of("density_per_cm2")
    page = session.drawing.page if session.drawing is not None else None
    usual = 100.0
    if page is not None and session.n_dots:
        usual = float(f"{100.0 * session.n_dots / (page.width_mm * page.height_mm):.3g}")
    changes["n_dots"] = None
    changes["density_per_cm2"] = draw_parameter(widgets, about, style.density_per_cm2 or usual)


def _draw_sizes(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    style = session.style
    chosen = widgets.segments(
        "Sizes",
        ("Automatic", "In mm"),
        int(style.size_range_mm is not None),
        (
            "Radii in a range of 1:2 that meets the picture's tone with the number of dots.",
            "Radii in a range that you give, as your pens or your printer draw them.",
        ),
    )
    if chosen == 0:
        if style.size_range_mm is not None:
            changes["size_range_mm"] = None
        return
    about = parameter_of("size_range_mm")
    changes["size_range_mm"] = draw_range(widgets, about, style.size_range_mm or _USUAL_RANGE_MM)
    imgui.dummy((0.0, 0.0))
    imgui.same_line(widgets.indent)
    free = widgets.check(
        "As many dots as it takes", style.n_dots is None, "The number follows from sizes and tone."
    )
    if free != (style.n_dots is None) and style.density_per_cm2 is None:
        changes["n_dots"] = None if free else session.n_dots or DEFAULT_DOTS
