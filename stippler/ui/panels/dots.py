"""The dots: how many, how large, how they are set and relaxed."""

from __future__ import annotations

import random
from typing import Any

from imgui_bundle import imgui

from stippler.drawing.pens import PENS
from stippler.editor.session import Session
from stippler.stippling.plan import FIRST_DOTS, GROWTHS, SIZES, SPACINGS, STARTS
from stippler.ui.panels.fill import draw_fill
from stippler.ui.theme import ICON_DICE
from stippler.ui.widgets import Widgets

_FIRST_DOTS_LABELS = ("Pulse density", "Floyd–Steinberg", "Random", "Hexagonal")
_SPACING_LABELS = ("Even, without rows", "Lloyd", "Mean of neighbours", "Springs")
_RADII_MM = (0.02, 2.0)  # what the slider offers; typing takes more
_USUAL_RANGE_MM = (0.12, 0.24)
_USUAL_DOTS = 20_000


def draw_dots(widgets: Widgets, session: Session) -> None:
    """Draw the section; on a page without a picture, filling it stands first."""
    plan = session.plan
    changes: dict[str, Any] = {}
    blank = session.drawing is not None and session.reference is None
    if blank:
        draw_fill(widgets, session)
        widgets.rule()
        widgets.heading("Dots")
    else:
        widgets.heading("Dots")
        _draw_first_dots(widgets, session, changes)
    changes["iterations"] = widgets.number(
        "Iterations",
        plan.iterations,
        "Relaxation steps: each makes the spacing more even. 10 to 20 suffice.",
    )
    if not blank:
        _draw_relaxation(widgets, session, changes)
        _draw_pen(widgets, session, changes)
        _draw_seed(widgets, session, changes)
    changed = {name: value for name, value in changes.items() if value != getattr(plan, name)}
    if changed:
        session.edit_plan(**changed)


def _draw_first_dots(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    plan = session.plan
    _draw_number(widgets, session, changes)
    _draw_sizes(widgets, session, changes)
    chosen = FIRST_DOTS[
        widgets.choice(
            "First dots",
            _FIRST_DOTS_LABELS,
            FIRST_DOTS.index(plan.first_dots),
            "How the dots are set before they relax. Pulse density follows the picture best.",
        )
    ]
    changes["first_dots"] = chosen
    if plan.first_dots == "pulse-density":
        _draw_pulses(widgets, session, changes)
    if chosen != "pulse-density":
        changes["sizes"] = "tone"


def _draw_relaxation(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    by_tone = widgets.segments(
        "Relax",
        ("By tone", "Evenly"),
        int(not session.plan.weighted),
        (
            "Dots move to the centre of mass of their cells: dark parts stay dense.",
            "Dots move to the middle of their cells, as in the paper: light parts fill up.",
        ),
    )
    changes["weighted"] = by_tone == 0
    spacing = widgets.choice(
        "Spacing",
        _SPACING_LABELS,
        SPACINGS.index(session.plan.spacing),
        "Even dots come to rest without rows. Lloyd's relaxation alone grows rows, like cloth; "
        "the last two are the paper's comparisons.",
    )
    changes["spacing"] = SPACINGS[spacing]


def _draw_pen(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    pens = [pen.name for pen in PENS]
    chosen = widgets.choice(
        "Pen",
        [pen.label for pen in PENS],
        pens.index(session.plan.pen),
        "The shapes of the dots; the Shape panel shows the pens, and changes dots that are there.",
    )
    changes["pen"] = pens[chosen]


def _draw_pulses(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    plan = session.plan
    growth = widgets.segments(
        "Regions",
        tuple(name.capitalize() for name in GROWTHS),
        GROWTHS.index(plan.growth),
        ("Each dot's region grows as a disc.", "Each dot's region grows as a triangle."),
    )
    start = widgets.segments(
        "Begin at",
        tuple(name.capitalize() for name in STARTS),
        STARTS.index(plan.start),
        ("The page is filled from its top.", "The outermost dots line up with the ink's border."),
    )
    sizes = widgets.segments(
        "Sizes by",
        ("Tone", "Region"),
        SIZES.index(plan.sizes),
        (
            "Dots are as large as it takes for the ink to meet the tone.",
            "As in the paper: dots whose regions stay small are enlarged, dots whose regions get "
            "large are reduced, and the largest regions get none.",
        ),
    )
    changes["growth"], changes["start"] = GROWTHS[growth], STARTS[start]
    changes["sizes"] = SIZES[sizes]


def _draw_number(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    plan = session.plan
    follows = plan.n_dots is None and plan.size_range_mm is not None
    shown = plan.n_dots or session.n_dots or _USUAL_DOTS
    imgui.begin_disabled(follows)
    typed = widgets.number(
        "Number",
        shown,
        "How many dots. "
        + (
            "Follows from the sizes now."
            if follows
            else "Unless you give one, as many as suit the page."
        ),
    )
    imgui.end_disabled()
    if not follows and typed != shown:
        changes["n_dots"] = typed


def _draw_sizes(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    plan = session.plan
    chosen = widgets.segments(
        "Sizes",
        ("Automatic", "In mm"),
        int(plan.size_range_mm is not None),
        (
            "Radii in a range of 1:2 that meets the picture's tone with the number of dots.",
            "Radii in a range that you give, as your pens or your printer draw them.",
        ),
    )
    if chosen == 0:
        if plan.size_range_mm is not None:
            changes["size_range_mm"] = None
        return
    low, high = plan.size_range_mm or _USUAL_RANGE_MM
    widgets.label("Radius")
    _, low, high = imgui.drag_float_range2(
        "##Radius",
        low,
        high,
        0.002,
        *_RADII_MM,
        "%.3f mm",
        "%.3f mm",
        imgui.SliderFlags_.always_clamp,
    )
    widgets.note("Radius")
    widgets.tip("Smallest and largest radius in mm. Drag; a double click types.")
    changes["size_range_mm"] = (round(low, 4), round(max(low, high), 4))
    imgui.dummy((0.0, 0.0))
    imgui.same_line(widgets.indent)
    free = widgets.check(
        "As many dots as it takes", plan.n_dots is None, "The number follows from sizes and tone."
    )
    if free != (plan.n_dots is None):
        changes["n_dots"] = None if free else session.n_dots or _USUAL_DOTS


def _draw_seed(widgets: Widgets, session: Session, changes: dict[str, Any]) -> None:
    side = imgui.get_frame_height()
    changes["seed"] = widgets.number(
        "Seed",
        session.plan.seed,
        "Chooses what is left to chance; the same seed gives the same drawing.",
        spare=side + 8.0 * widgets.scale,
    )
    imgui.same_line()
    if widgets.icon_button("Another seed", ICON_DICE, "Another seed, by chance."):
        changes["seed"] = random.randrange(1, 1_000_000)
