"""The work: starting, pausing and stopping it, and how far it is."""

from __future__ import annotations

from imgui_bundle import imgui

from stippler.editor.commands import Commands
from stippler.editor.session import Session
from stippler.jobs import work
from stippler.ui.theme import ICON_PAUSE, ICON_PLAY, ICON_STOP
from stippler.ui.widgets import Widgets

HEIGHT = 114.0
"""Of the section, in the theme's pixels."""

_STAGES = {
    work.READ: "reading the picture",
    work.PREPARE: "preparing kernels (once)",
    "first dots": "first dots",
    "relax": "relaxing",
    "tone": "matching the tone",
    "fill": "filling",
    "done": "done",
}
_OUTCOMES = {"empty": "", "done": "done", "stopped": "stopped", "failed": "failed"}


def draw_work(widgets: Widgets, session: Session, commands: Commands) -> None:
    """Draw the section."""
    imgui.separator()
    _draw_buttons(widgets, session, commands)
    _draw_progress(widgets, session)


def _draw_buttons(widgets: Widgets, session: Session, commands: Commands) -> None:
    label = "Restart" if session.busy else "Start"
    if widgets.button(
        label,
        f"{commands['work.start'].hint}: stipple the picture with the values above.",
        icon=ICON_PLAY,
        width=-1.0,
        primary=not session.busy or session.outdated,
        enabled=session.source is not None or session.busy,
    ):
        commands["work.start"].run()
    width = (imgui.get_content_region_avail().x - 2 * widgets.gap) / 3
    paused = session.phase == "paused"
    if widgets.button(
        "Resume" if paused else "Pause",
        commands["work.pause"].hint,
        icon=ICON_PLAY if paused else ICON_PAUSE,
        width=width,
        primary=paused,
        enabled=session.busy,
    ):
        commands["work.pause"].run()
    imgui.same_line(0.0, widgets.gap)
    if widgets.button(
        "Stop",
        "End the work; the dots that are there stay.",
        icon=ICON_STOP,
        width=width,
        enabled=session.busy,
    ):
        session.stop()
    imgui.same_line(0.0, widgets.gap)
    if widgets.button(
        "Relax all",
        f"{commands['work.relax'].hint}: moves the dots that are there, by the iterations above; "
        "you can paint meanwhile.",
        width=width,
        enabled=session.paintable and session.n_dots > 0,
    ):
        commands["work.relax"].run()


def _draw_progress(widgets: Widgets, session: Session) -> None:
    """Draw the bar and its line; they keep their room while there is nothing to tell."""
    if session.busy:
        share = session.done / session.total if session.total else -imgui.get_time()
        widgets.progress(share, _progress_text(session))
    elif session.outdated and session.n_dots:
        widgets.progress(0.0, "values changed; start to use them")
    else:
        widgets.progress(0.0, _OUTCOMES[session.phase])


def _progress_text(session: Session) -> str:
    text = _STAGES.get(session.stage, session.stage)
    if session.stage == "relax":
        text = f"{text}, step {session.done:,} of {session.total:,}"
    return f"{text} (paused)" if session.phase == "paused" else text
