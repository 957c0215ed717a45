"""The picture: what is open, how tone is taken from it, and where the drawing goes."""

from __future__ import annotations

import math

from imgui_bundle import imgui

from stippler.drawing.page import MAX_PAGE_MM
from stippler.drawing.picture_values import TONE, WIDTH
from stippler.editor.commands import Commands
from stippler.editor.session import Session
from stippler.ui.panels.parameters import draw_parameter
from stippler.ui.theme import ICON_NEW, ICON_OPEN, ICON_SAVE
from stippler.ui.widgets import Widgets


def draw_picture(widgets: Widgets, session: Session, commands: Commands) -> None:
    """Draw the section."""
    widgets.heading("Picture")
    _draw_name(widgets, session)
    width = (imgui.get_content_region_avail().x - 2 * widgets.gap) / 3
    if widgets.button(
        "New",
        f"{commands['file.new'].hint}: an empty page, without a picture.",
        icon=ICON_NEW,
        width=width,
    ):
        commands["file.new"].run()
    imgui.same_line(0.0, widgets.gap)
    if widgets.button(
        "Open",
        f"{commands['file.open'].hint}; or drop one on the window.",
        icon=ICON_OPEN,
        width=width,
    ):
        commands["file.open"].run()
    imgui.same_line(0.0, widgets.gap)
    if widgets.button(
        "Export",
        f"{commands['file.export_as'].hint}: for print, screens, plotters and other programs.",
        icon=ICON_SAVE,
        width=width,
        enabled=session.n_dots > 0,
    ):
        commands["file.export_as"].run()
    is_blank = session.drawing is not None and session.source is None and not session.busy
    why = "This page has no picture, so it has no effect now; it counts for the next picture."
    with widgets.off(why if is_blank else ""):
        session.tone = draw_parameter(widgets, TONE, session.tone)
        typed = draw_parameter(widgets, WIDTH, session.width_mm)
    if math.isfinite(typed) and typed > 0:
        session.width_mm = min(typed, MAX_PAGE_MM)
    if is_blank:
        widgets.caption("Tone and width are a picture's; this page has none.")


def _draw_name(widgets: Widgets, session: Session) -> None:
    if not session.name:
        imgui.text_colored((*widgets.theme.faint, 1.0), "No picture")
        widgets.caption("drop one on the window")
        return
    imgui.text_unformatted(_shortened(session.name, imgui.get_content_region_avail().x))
    widgets.tip(session.name)
    reference = session.reference
    if reference is not None:
        rows, columns = reference.source.levels.shape
        widgets.caption(
            f"{columns:,} × {rows:,} px  ·  {reference.width_mm:.4g} × {reference.height_mm:.4g} mm"
        )
        for note in session.notes:
            widgets.caption(note)
    elif session.drawing is None or (session.busy and not session.relaxing):
        widgets.caption("being read …")
    else:
        page = session.drawing.page
        widgets.caption(f"no picture  ·  {page.width_mm:.4g} × {page.height_mm:.4g} mm")


def _shortened(text: str, width: float) -> str:
    """Leave out the middle of a text that is too wide."""
    if imgui.calc_text_size(text).x <= width:
        return text
    keep = len(text) - 1
    while keep > 4:
        head, tail = text[: (keep + 1) // 2], text[len(text) - keep // 2 :]
        if imgui.calc_text_size(f"{head}…{tail}").x <= width:
            return f"{head}…{tail}"
        keep -= 1
    return text[:4]
