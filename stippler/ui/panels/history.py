"""The history: every step with its undoing, a click away."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.editor.commands import Commands
from stippler.editor.painting import Painting
from stippler.editor.session import Session
from stippler.ui.widgets import Widgets


def draw_history(
    widgets: Widgets, session: Session, painting: Painting, commands: Commands
) -> None:
    """Draw the panel."""
    widgets.heading("History")
    if session.document is None:
        widgets.caption("Nothing has been done yet.")
        return
    history = session.document.history
    gap = 8.0 * widgets.scale
    width = (imgui.get_content_region_avail().x - gap) / 2
    can = session.paintable and not painting.is_busy
    if widgets.button(
        "Undo", commands["edit.undo"].hint, width=width, enabled=can and history.undone is not None
    ):
        painting.undo()
    imgui.same_line(0.0, gap)
    if widgets.button(
        "Redo", commands["edit.redo"].hint, width=width, enabled=can and history.redone is not None
    ):
        painting.redo()
    imgui.dummy((0.0, 2.0 * widgets.scale))
    wanted = _draw_steps(widgets, session)
    if wanted is not None and can:
        painting.go_to(wanted)


def _draw_steps(widgets: Widgets, session: Session) -> int | None:
    """List the steps, the last done one marked; return how many a click wants in effect."""
    assert session.document is not None
    history = session.document.history
    wanted = None
    imgui.begin_child("##steps", (0.0, 0.0))
    clipper = imgui.ListClipper()
    clipper.begin(len(history.steps) + 1)
    while clipper.step():
        for k in range(clipper.display_start, clipper.display_end):
            label = "Beginning"
            if k:
                step = history.steps[k - 1]
                label = f"{step.label}  ({step.n_dots:,})" if step.n_dots else f"{step.label} …"
            undone = k > history.n_done
            if undone:
                imgui.push_style_color(imgui.Col_.text, (*widgets.theme.faint, 1.0))
            if imgui.selectable(f"{label}##{k}", k == history.n_done)[0]:
                wanted = k
            if undone:
                imgui.pop_style_color()
            widgets.note(f"step {k}")
    imgui.end_child()
    return wanted
