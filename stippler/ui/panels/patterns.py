"""The pattern of an area: the sets to choose from, how it is bent, and its dots."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.drawing.pattern import BETWEEN, MOST_COPIES, Pattern
from stippler.editor.commands import Commands
from stippler.editor.patterns import Patterns
from stippler.ui.canvas.pattern_samples import PatternSamples
from stippler.ui.widgets import Widgets

_COLUMNS = 4


def draw_patterns(
    widgets: Widgets, patterns: Patterns, commands: Commands, samples: PatternSamples
) -> None:
    """Draw the section."""
    document = patterns.document
    if document is None:
        widgets.caption("Open a picture or begin a page first.")
        return
    area, laid = patterns.area, patterns.laid
    name = document.drawing.areas[area].name
    over = laid[1].polygons.name if laid else "no pattern"
    widgets.heading(f"{name[:1].upper()}{name[1:]}: {over}")
    if laid is None:
        patterns.size_mm = max(
            widgets.length("Size", patterns.size_mm, "Of one copy of the set."), 0.5
        )
    _draw_picker(widgets, patterns, samples, over)
    _draw_following(widgets, patterns)
    if laid is not None:
        widgets.rule()
        _draw_laid(widgets, patterns, laid[1])
        _draw_commands(widgets, commands)


def _draw_picker(widgets: Widgets, patterns: Patterns, samples: PatternSamples, over: str) -> None:
    """Draw a small picture of each set; a click lays it."""
    gap = 4.0 * widgets.scale
    side = (imgui.get_content_region_avail().x - (_COLUMNS - 1) * gap) / _COLUMNS
    for k, name in enumerate(patterns.names):
        if k % _COLUMNS:
            imgui.same_line(0.0, gap)
        imgui.push_id(name)
        corner = imgui.get_cursor_screen_pos()
        pressed = imgui.invisible_button("##set", (side, side))
        hovered = imgui.is_item_hovered()
        widgets.note(f"pattern {name}")
        widgets.tip(name.replace("-", " ").capitalize())
        imgui.set_cursor_screen_pos(corner)
        samples.show(patterns.set_named(name), side, widgets.theme)
        if name == over or hovered:
            colour = widgets.theme.accent if name == over else widgets.theme.faint
            end = (corner.x + side, corner.y + side)
            draw = imgui.get_window_draw_list()
            draw.add_rect(corner, end, widgets.packed(colour), 2.0, 2.0 * widgets.scale)
        imgui.pop_id()
        if pressed:
            patterns.put(name)


def _draw_following(widgets: Widgets, patterns: Patterns) -> None:
    document = patterns.document
    if document is None or document.drawing.reference is None:
        return
    patterns.band_mm = max(
        widgets.length("Bands", patterns.band_mm, "From one band to the next."), 0.05
    )
    width = (imgui.get_content_region_avail().x - widgets.gap) / 2
    tip = "Bands that run along the picture's contours of tone."
    if widgets.button("Along the tone", tip, width=width):
        patterns.follow("along")
    imgui.same_line(0.0, widgets.gap)
    if widgets.button("Across edges", "Bands that run across the picture's edges.", width=width):
        patterns.follow("across")


def _draw_laid(widgets: Widgets, patterns: Patterns, pattern: Pattern) -> None:
    tips = (
        "Between the polygons stays white.",
        "What is between them is one more compartment.",
    )
    known = BETWEEN[:2]
    at = known.index(pattern.between) if pattern.between in known else 1
    between = known[widgets.segments("Between", ("Free", "Toned"), at, tips)]
    if between != pattern.between and (at == 0 or between == known[0]):
        patterns.change(between=between)
    columns = widgets.number("Across", pattern.columns, "Copies of the set, side by side.")
    rows = widgets.number("Down", pattern.rows, "Copies of the set, one below the other.")
    if (columns, rows) != (pattern.columns, pattern.rows):
        patterns.change(
            columns=min(max(columns, 1), MOST_COPIES), rows=min(max(rows, 1), MOST_COPIES)
        )
    cage = pattern.deformation.cage
    n = (cage.rows, cage.columns) if cage else (4, 4)
    down = widgets.number("Cage down", n[0], "Points of the cage, 4 to 16.")
    across = widgets.number("Cage across", n[1], "Points of the cage, 4 to 16.")
    if (down, across) != n:
        patterns.refine(down, across)


def _draw_commands(widgets: Widgets, commands: Commands) -> None:
    width = (imgui.get_content_region_avail().x - widgets.gap) / 2
    kinds = ("fill", "relax", "straighten", "remove", "between")
    for j, kind in enumerate(kinds):
        command = commands[f"pattern.{kind}"]
        if j % 2:
            imgui.same_line(0.0, widgets.gap)
        if widgets.button(command.short, command.explained, width=width, enabled=command.enabled,
                          primary=j == 0):  # fmt: skip
            command.run()
