"""The work: starting, pausing and stopping it, and how far it is."""

from __future__ import annotations

import math

from imgui_bundle import imgui

from stippler.editor.commands import Commands
from stippler.editor.session import Session
from stippler.jobs import work
from stippler.ui.theme import ICON_PAUSE, ICON_PLAY, ICON_RELAX, ICON_STOP
from stippler.ui.widgets import Widgets

HEIGHT, LOW = 114.0, 46.0
"""Of the section, in the theme's pixels; and where there is little room."""

_PREPARING_S = 80.0  # what two cores take to prepare, more or less
_STAGES = {
    work.READ: "reading the picture",
    work.PREPARE: "getting ready for the first time, a minute or two",
    "first dots": "placing dots",
    "relax": "evening out",
    "tone": "matching the tone",
    "fill": "filling",
    "done": "done",
}
_OUTCOMES = {"empty": "", "done": "done", "stopped": "stopped", "failed": "failed"}


def draw_work(
    widgets: Widgets, session: Session, commands: Commands, *, is_low: bool = False
) -> None:
    """Draw the section; where there is little room, in one line of signs."""
    imgui.separator()
    if is_low:
        _draw_line(widgets, session, commands)
        return
    _draw_buttons(widgets, session, commands)
    _draw_progress(widgets, session)


def _draw_line(widgets: Widgets, session: Session, commands: Commands) -> None:
    side, paused = imgui.get_frame_height(), session.phase == "paused"
    if widgets.button(
        "Restart" if session.busy else "Start",
        _start_tip(session, commands),
        icon=ICON_PLAY,
        width=imgui.get_content_region_avail().x - 3 * (side + widgets.gap),
        primary=not session.busy or session.outdated,
        enabled=session.source is not None or session.busy,
    ):
        commands["work.start"].run()
    for name, icon, tip in (
        ("work.pause", ICON_PLAY if paused else ICON_PAUSE, commands["work.pause"].explained),
        ("work.stop", ICON_STOP, _STOP_TIP),
        ("work.relax", ICON_RELAX, _relax_tip(commands)),
    ):
        imgui.same_line(0.0, widgets.gap)
        command = commands[name]
        imgui.begin_disabled(not command.enabled)
        if widgets.icon_button(command.short, icon, tip):
            command.run()
        imgui.end_disabled()


_STOP_TIP = "End the work; the dots that are there stay."


def _start_tip(session: Session, commands: Commands) -> str:
    if session.source is None and not session.busy:
        return "Open a picture first: there is nothing to make dots of."
    return f"{commands['work.start'].hint}: stipple the picture with the values above."


def _relax_tip(commands: Commands) -> str:
    return (
        f"{commands['work.relax'].hint}: moves the dots that are there, by the steps above; "
        "you can paint meanwhile."
    )


def _draw_buttons(widgets: Widgets, session: Session, commands: Commands) -> None:
    label = "Restart" if session.busy else "Start"
    if widgets.button(
        label,
        _start_tip(session, commands),
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
        _STOP_TIP,
        icon=ICON_STOP,
        width=width,
        enabled=session.busy,
    ):
        session.stop()
    imgui.same_line(0.0, widgets.gap)
    if widgets.button(
        "Relax all",
        _relax_tip(commands),
        width=width,
        enabled=session.paintable and session.n_dots > 0,
    ):
        commands["work.relax"].run()


def _draw_progress(widgets: Widgets, session: Session) -> None:
    """Draw the bar and its line; they keep their room while there is nothing to tell."""
    if session.busy:
        widgets.progress(progress_share(session), progress_text(session))
    elif session.outdated and session.n_dots:
        widgets.progress(0.0, "values changed; start to use them")
    else:
        widgets.progress(0.0, _OUTCOMES[session.phase])


def progress_share(session: Session) -> float:
    """Return how much of the stage is done; a share below 0 is unknown.

    Getting ready goes by time: it counts in a few large steps, between which a bar would stand.
    """
    if session.stage == work.PREPARE:
        waited = 1.0 - math.exp(-1.6 * session.stage_s / _PREPARING_S)
        return max(waited, session.done / session.total if session.total else 0.0)
    return session.done / session.total if session.total else -imgui.get_time()


def progress_text(session: Session) -> str:
    """Return what is being done, in a few words."""
    text = _STAGES.get(session.stage, session.stage)
    if session.stage == work.PREPARE and session.total > 1:
        text = f"{text}: {session.done} of {session.total}"
    if session.stage == "relax":
        text = f"{text}, step {session.done:,} of {session.total:,}"
    return f"{text} (paused)" if session.phase == "paused" else text
