"""The lines: their list, the values of those chosen, and rows of dots."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from stippler.editor.commands import Commands
from stippler.editor.lines import (
    ALONG,
    BORDER,
    EDGES,
    HATCHING,
    HOLDS,
    PLACES,
    SIDES,
    Lines,
    RowValues,
)
from stippler.ui.widgets import Widgets

if TYPE_CHECKING:
    from stippler.drawing.line import Line

_LIST_ROWS = 6
_PLACE_LABELS = ("Along the lines", "Along their edges", "Along a border", "Hatching")
_MEETINGS = ("ignore", "distance", "adhere")


def draw_lines(widgets: Widgets, lines: Lines, commands: Commands) -> None:
    """Draw the panel."""
    widgets.heading("Lines")
    table = lines.all
    if not table:
        widgets.caption("No lines yet.")
    else:
        _draw_list(widgets, lines, table)
        if chosen := lines.chosen:
            _draw_values(widgets, lines, chosen, table[chosen[0]])
            _draw_commands(widgets, commands)
        else:
            widgets.caption("Choose a line to change it.")
    widgets.rule()
    _draw_row(widgets, lines, commands)


def _draw_list(widgets: Widgets, lines: Lines, table: dict[int, Line]) -> None:
    height = imgui.get_frame_height_with_spacing() * min(len(table), _LIST_ROWS) + 6 * widgets.scale
    imgui.begin_child("##lines", (0.0, height), imgui.ChildFlags_.borders)
    side, chosen = imgui.get_frame_height(), set(lines.chosen)
    for k, line in table.items():
        imgui.push_id(str(k))
        _, colour = imgui.color_edit3(
            "##colour", _rgb(line.colour), imgui.ColorEditFlags_.no_inputs
        )
        if imgui.is_item_deactivated_after_edit() or _hex(colour) != line.colour:
            lines.change([k], colour=_hex(colour))
        imgui.same_line()
        more = imgui.get_io().key_shift
        room = imgui.get_content_region_avail().x - 2 * (side + widgets.gap)
        kind = "" if line.is_inked else " – guide" if not line.printed else ""
        faint = line.hidden
        if faint:
            imgui.push_style_color(imgui.Col_.text, (*widgets.theme.faint, 1.0))
        imgui.push_style_var(imgui.StyleVar_.selectable_text_align, (0.0, 0.5))
        if imgui.selectable(f"{line.name}{kind}##name", k in chosen, size=(room, side))[0]:
            lines.choose(k, more=more)
        imgui.pop_style_var()
        if faint:
            imgui.pop_style_color()
        widgets.note(f"line {line.name}")
        imgui.same_line()
        shown = widgets.check("", not line.hidden, "Shown and exported.", name=f"show {line.name}")
        if shown == line.hidden:
            lines.change([k], hidden=not shown)
        imgui.same_line()
        locked = widgets.check(
            "", line.locked, "Locked against the hand.", name=f"lock {line.name}"
        )
        if locked != line.locked:
            lines.change([k], locked=locked)
        imgui.pop_id()
    imgui.end_child()


def _draw_values(widgets: Widgets, lines: Lines, chosen: list[int], line: Line) -> None:
    """Draw the values of the first chosen line; a change is for all of them."""
    if len(chosen) == 1:
        widgets.label("Name")
        _, name = imgui.input_text("##line name", line.name)
        widgets.note("Line name")
        if imgui.is_item_deactivated_after_edit() and name.strip() and name != line.name:
            lines.change(chosen, name=name.strip()[:60])
    else:
        widgets.caption(f"{len(chosen)} lines")
    start = widgets.length("Its width", line.width_mm[0], "Where it begins; 0 is no ink.")
    end = widgets.length("Its end", line.width_mm[1], "Another width tapers the line.")
    if (start, end) != line.width_mm:
        if end == line.width_mm[1] == line.width_mm[0]:
            end = start  # one width stays one width
        lines.change(chosen, width_mm=(start, end))
    drawn = ("Drawn and exported.", "Only dots see it.")
    printed = widgets.segments("Drawn", ("In ink", "Guide"), int(not line.printed), drawn) == 0
    if printed != line.printed:
        lines.change(chosen, printed=printed)
    tips = (
        "Dots take no notice of it.",
        "Dots keep a distance from its edge.",
        "Dots within reach line up on it and stay on it.",
    )
    labels = ("Ignore", "Keep off", "Adhere")
    meeting = _MEETINGS[widgets.segments("Dots do", labels, _MEETINGS.index(line.meeting), tips)]
    if meeting != line.meeting:
        lines.change(chosen, meeting=meeting)
    _draw_meeting(widgets, lines, chosen, line)
    n = sum(lines.n_on(k) for k in chosen)
    length = sum(lines.all[k].length_mm for k in chosen)
    widgets.caption(f"{length:.1f} mm long, {n:,} dots on it")


def _draw_meeting(widgets: Widgets, lines: Lines, chosen: list[int], line: Line) -> None:
    """Draw from how far dots keep off or adhere."""
    if line.meeting == "distance":
        distance = widgets.length("Keep off", line.distance_mm, "From its edge.")
        if distance != line.distance_mm:
            lines.change(chosen, distance_mm=distance)
    if line.meeting == "adhere":
        reach = widgets.length("Its reach", line.reach_mm, "From how far dots line up.")
        if reach != line.reach_mm:
            lines.change(chosen, reach_mm=reach)


def _draw_commands(widgets: Widgets, commands: Commands) -> None:
    width = (imgui.get_content_region_avail().x - widgets.gap) / 2
    for j, name in enumerate(("line.line_up", "line.spread", "line.release", "line.delete")):
        command = commands[name]
        if j % 2:
            imgui.same_line(0.0, widgets.gap)
        if widgets.button(command.short, command.explained, width=width, enabled=command.enabled):
            command.run()


def _draw_row(widgets: Widgets, lines: Lines, commands: Commands) -> None:
    widgets.heading("Row of dots")
    row = lines.row
    place = PLACES[
        widgets.choice("Where", _PLACE_LABELS, PLACES.index(row.place),
                       "On the chosen lines, on both their edges, along an area's border, or on "
                       "parallel lines that fill an area.")
    ]  # fmt: skip
    row = replace(row, place=place)
    if place in (BORDER, HATCHING):
        _draw_area(widgets, lines)
    if place == BORDER:
        labels = tuple(side.capitalize() for side in SIDES)
        tips = ("Within the area.", "On the border itself.", "Around the area.")
        side = SIDES[widgets.segments("Side", labels, SIDES.index(row.side), tips)]
        row = replace(row, side=side)
        if side != "on":
            row = replace(row, away_mm=widgets.length("From it", row.away_mm, "From the border."))
    if place == HATCHING:
        row = replace(
            row,
            lines_mm=widgets.length("Line gap", row.lines_mm, "Between two lines."),
            angle_deg=widgets.length("Angle", row.angle_deg, "Of the lines, clockwise.", "°"),
        )
    row = _draw_spacing(widgets, row)
    tip = "Denser where the picture is darker."
    lines.row = replace(row, by_tone=widgets.check("Follow the picture", row.by_tone, tip))
    command = commands["line.row"]
    if widgets.button("Lay the row", command.explained, width=-1.0, primary=lines.can_row,
                      enabled=command.enabled):  # fmt: skip
        command.run()
    if not lines.can_row and place in (ALONG, EDGES):
        widgets.caption("Choose a line first.")


def _draw_spacing(widgets: Widgets, row: RowValues) -> RowValues:
    """Draw how dots lie in a row, and what becomes of them."""
    how = widgets.segments("Spaced", ("By distance", "By number"), int(row.by_number),
                           ("At about this distance.", "So many in each row."))  # fmt: skip
    row = replace(row, by_number=how == 1)
    if row.by_number:
        row = replace(row, n_dots=max(widgets.number("Dots in it", row.n_dots, "In each row."), 1))
    else:
        row = replace(row, distance_mm=widgets.length("Dot gap", row.distance_mm, "Along the row."))
    row = replace(row, radius_mm=widgets.length("Dot radius", row.radius_mm, "Their own size."))
    tips = (
        "On lines they are held by them and go along; elsewhere they are fixed.",
        "They stay where they are.",
        "They move like all others.",
    )
    labels = ("Held", "Fixed", "Free")
    row = replace(
        row, hold=HOLDS[widgets.segments("They are", labels, HOLDS.index(row.hold), tips)]
    )
    return row


def _draw_area(widgets: Widgets, lines: Lines) -> None:
    """Offer the areas by their names."""
    document = lines.document
    areas = document.drawing.areas if document is not None else {}
    ids = list(areas)
    if not ids:
        return
    at = ids.index(lines.area) if lines.area in ids else 0
    names = [f"{areas[k].name} ({k})" for k in ids]
    lines.area = ids[widgets.choice("Area", names, at, "Whose border or inside.")]


def _rgb(colour: str) -> list[float]:
    return [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]


def _hex(colour: list[float]) -> str:
    return "#" + "".join(f"{round(255 * min(max(c, 0.0), 1.0)):02x}" for c in colour)
