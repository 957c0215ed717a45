"""What a person does with areas: stipple, fill, relax, resize and clear them.

All other areas stay untouched to the bit. Each function takes the session and the ids of areas;
what cannot be done is said in the session's messages, and then nothing has changed. Areas that
are locked are left alone.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from stippler.drawing import records
from stippler.drawing.one_step import as_one_step
from stippler.editor.activity import Processing
from stippler.editor.messages import WARNING
from stippler.errors import StipplerError

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.editor.session import Session

_SIZES = (1.0, 1000.0)  # percent


def process(session: Session, areas: Sequence[int]) -> bool:
    """Stipple areas anew, each in its own style and as a step of its own; return whether it began.

    They are made one after the other, by the worker; `session.stop` keeps those that are done and
    leaves the others as they were. Fixed dots stay.
    """
    document = _ready(session)
    chosen = [] if document is None else _unlocked(session, document, areas)
    if document is None or not chosen:
        return False
    from stippler.jobs.preflight import processing_warning
    from stippler.jobs.processing import process_areas, tasks_of

    session.supersede()
    try:
        tasks, left_out = tasks_of(document, chosen)
    except StipplerError as error:
        session.messages.say(str(error), WARNING)
        return False
    for note in left_out:
        session.messages.say(note, WARNING)
    styles = [document.drawing.style_of(area) for area in chosen]
    if text := processing_warning(document.drawing, styles):
        session.messages.say(text, WARNING)
    source = session.source
    session.launch(
        lambda: process_areas(tasks),
        lambda k: Processing(k, "first dots", source, tuple(a for t in tasks for a in t.areas)),
    )
    return True


def start_all(session: Session) -> bool:
    """Stipple all areas anew: the page with the values that the panels show, the others as before.

    Those values are a step of their own.
    """
    document = _ready(session)
    if document is None:
        return False
    drawing, reference = document.drawing, document.drawing.reference

    def take_values(document: Document) -> None:
        document.set(records.STYLE, drawing.areas[0].style, session.style)
        if reference is not None:
            document.set(records.REFERENCE, 0, reference.adjusted(session.adjustment))

    as_one_step(document, "Style", take_values)
    return process(session, sorted(drawing.areas))


def relax(session: Session, areas: Collection[int], steps: int | None = None) -> None:
    """Relax the free dots of areas, as one step; it can be edited meanwhile."""
    document = _ready(session)
    chosen = [] if document is None else _unlocked(session, document, areas)
    if chosen:
        style = session.style
        steps = style.iterations or 20 if steps is None else steps
        session.relax(steps, weighted=style.weighted, areas=chosen)


def fill(session: Session, areas: Collection[int]) -> None:
    """Add dots to areas, as many in each as `session.filling` says, as one step."""
    document = _ready(session)
    chosen = [] if document is None else _unlocked(session, document, areas)
    if chosen:
        session.fill(chosen)


def resize(session: Session, areas: Collection[int], percent: float) -> bool:
    """Make the free dots of areas larger or smaller, as one step; return whether any changed."""
    import numpy as np

    document = _ready(session)
    chosen = [] if document is None else _unlocked(session, document, areas)
    if document is None or not chosen:
        return False
    if not _SIZES[0] <= percent <= _SIZES[1]:
        low, high = _SIZES
        session.messages.say(f"{percent:g} % is no size: give {low:g} to {high:,.0f} %", WARNING)
        return False
    dots = document.dots
    rows = np.flatnonzero(np.isin(dots.area, chosen) & ~dots.fixed)
    sizes = dots.radius_mm[rows] * np.float32(percent / 100.0)
    edit = as_one_step(document, "Resize areas", lambda d: d.change("radius_mm", rows, sizes))
    return not edit.is_empty


def clear(session: Session, areas: Collection[int]) -> bool:
    """Remove the free dots of areas, as one step; return whether there were any."""
    import numpy as np

    document = _ready(session)
    chosen = [] if document is None else _unlocked(session, document, areas)
    if document is None or not chosen:
        return False
    dots = document.dots
    rows = np.flatnonzero(np.isin(dots.area, chosen) & ~dots.fixed)
    return not as_one_step(document, "Clear areas", lambda d: d.remove(rows)).is_empty


def _ready(session: Session) -> Document | None:
    """Return the drawing if its dots can be edited now; a run over them ends."""
    document = session.document
    if document is None or not session.paintable or document.in_stroke:
        session.messages.say("the areas are busy: wait, or stop the work first", WARNING)
        return None
    return document


def _unlocked(session: Session, document: Document, areas: Collection[int]) -> list[int]:
    """Return those of some areas that may be changed; say so where there is none."""
    there = [k for k in dict.fromkeys(areas) if k in document.drawing.areas]
    free = [k for k in there if not document.drawing.areas[k].locked]
    if not free:
        what = "is locked" if there else "is chosen"
        session.messages.say(f"no area to work on: {'each' if there else 'none'} {what}", WARNING)
    return free
