"""Level of detail: the open drawing at another size or number of dots, as one step."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from stippler.editor.activity import Activity, Desk, Job
from stippler.editor.messages import INFO, WARNING
from stippler.errors import StipplerError
from stippler.jobs.work import Work

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.drawing import Drawing
    from stippler.editor.session import Session

_STAGE = "scale"


def scale(
    session: Session,
    percent: float,
    n_dots: int | None,
    least_radius_mm: float,
    areas: Collection[int] = (),
) -> bool:
    """Begin to scale the drawing, or areas of it; return whether it began.

    What cannot be done is said.
    """
    from stippler.stippling.scale import Scaling, patterns_aside, scaled_drawing

    document = session.document
    if document is None or not session.paintable or document.in_stroke:
        session.messages.say("there is no drawing to scale now", WARNING)
        return False
    try:
        values = Scaling(percent / 100.0, n_dots, least_radius_mm)
    except StipplerError as error:
        session.messages.say(str(error), WARNING)
        return False
    session.supersede()
    frozen = document.drawing.snapshot()
    for note in patterns_aside(frozen):
        session.messages.say(note, WARNING)

    def run() -> Iterator[Work]:
        from stippler.drawing.document import Document
        from stippler.stippling.scale_areas import scaled_areas

        yield Work(_STAGE)
        made = scaled_areas(frozen, areas, values) if areas else scaled_drawing(frozen, values)
        yield Work(_STAGE, 1, 1, document=Document(made))

    names = " and ".join(frozen.areas[k].name for k in areas)
    session.launch(run, lambda k: Scaled(k, _STAGE, label=f"Scale {names or 'drawing'}"))
    return True


@dataclass(slots=True)
class Scaled(Job):
    """The drawing is being scaled; it stays as it was until that is done."""

    label: str = "Scale drawing"

    def take(self, desk: Desk, work: Work) -> Activity:
        """Put the scaled drawing in the place of the one that is open, as one step."""
        self._note(work)
        if work.document is not None and desk.document is not None:
            before = len(desk.document.dots)
            become(desk.document, work.document.drawing, self.label)
            page, n = desk.document.drawing.page, len(desk.document.dots)
            told = f"{page.width_mm:.4g} × {page.height_mm:.4g} mm, {before:,} → {n:,} dots"
            desk.messages.say(told, INFO)
        return self  # type: ignore[return-value]

    def end(self, desk: Desk, outcome: str) -> None:
        """Leave it at that."""


def become(document: Document, drawing: Drawing, label: str) -> None:
    """Make a document's drawing another one, as one step; dots of the same id are the same."""
    from stippler.drawing import records
    from stippler.drawing.one_step import as_one_step
    from stippler.drawing.replace_dots import replace_dots

    def act(document: Document) -> None:
        for kind in records.KINDS:
            old = document.drawing
            if kind in records.SINGLE:
                ids = [0]
            else:
                ids = sorted({*old.table(kind), *drawing.table(kind)})
            for k in ids:
                value = drawing.get(kind, k)
                if value is not old.get(kind, k):
                    document.set(kind, k, value)
        replace_dots(document, document.dots.id.copy(), drawing.dots)

    as_one_step(document, label, act)
