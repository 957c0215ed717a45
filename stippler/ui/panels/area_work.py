"""Processing the chosen areas: stipple, fill, relax, resize, clear, and how far that is."""

from __future__ import annotations

import contextlib
from dataclasses import replace

from imgui_bundle import imgui

from stippler.editor.activity import Processing
from stippler.editor.area_acts import AreaActs
from stippler.editor.commands import Commands
from stippler.errors import ParameterError
from stippler.ui.widgets import Widgets

_NAMES = ("area.stipple", "area.relax", "area.fill", "area.clear", "area.enlarge", "area.reduce")


def draw_area_work(widgets: Widgets, acts: AreaActs, commands: Commands) -> None:
    """Draw the section."""
    session = acts.session
    n = len(acts.choice.ids)
    widgets.heading("Process this area" if n < 2 else f"Process these {n} areas")
    buttons(widgets, commands, _NAMES)
    filling = session.filling
    n_dots = widgets.number("Fill with", filling.n_dots, "How many dots Fill adds to each area.")
    with contextlib.suppress(ParameterError):  # out of range; the field shows the old one again
        session.filling = replace(filling, n_dots=n_dots)
    if session.busy:
        share = session.done / session.total if session.total else -imgui.get_time()
        widgets.progress(share, _text(acts))
        if widgets.button("Stop", "Ends it; areas that are done stay.", name="stop areas"):
            session.stop()


def _text(acts: AreaActs) -> str:
    session, job = acts.session, acts.session.activity
    text = f"{session.stage} {session.done:,} of {session.total:,}".strip()
    if not isinstance(job, Processing) or session.document is None:
        return text
    n, of = min(job.n_taken + 1, len(job.areas)), len(job.areas)
    area = session.document.drawing.areas.get(job.areas[n - 1])
    name = area.name if area is not None else ""
    return f"{name} ({n} of {of}): {text}" if of > 1 else f"{name}: {text}"


def buttons(widgets: Widgets, commands: Commands, names: tuple[str, ...]) -> None:
    """Draw a button for each of some commands, two a row."""
    width = (imgui.get_content_region_avail().x - widgets.gap) / 2
    for i, name in enumerate(names):
        command = commands[name]
        if i % 2:
            imgui.same_line(0.0, widgets.gap)
        if widgets.button(
            command.short, command.explained, name=name, width=width, enabled=command.enabled
        ):
            command.run()
