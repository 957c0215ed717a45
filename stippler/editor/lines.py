"""Lines by panel and menu: their values, the dots on them, rows of dots."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from stippler.editor.line_edits import (
    hold,
    lines_of,
    meet,
    release,
    rows_on,
    set_line,
    spread_held,
    tone_of,
)
from stippler.editor.messages import INFO, WARNING
from stippler.editor.painting import Painting
from stippler.editor.session import Session
from stippler.errors import StipplerError

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.line import Line

ALONG, EDGES, BORDER, HATCHING = "line", "edges", "border", "hatching"
PLACES = (ALONG, EDGES, BORDER, HATCHING)
"""Where a row of dots lies: on a line, on its two edges, on an area's border, on parallel lines."""

SIDES = ("inside", "on", "outside")
HOLDS = ("held", "fixed", "free")
"""What becomes of a row's dots: held by their line, or fixed where there is none; free."""


@dataclass(frozen=True, slots=True)
class RowValues:
    """How a row of dots is laid.

    Attributes
    ----------
    by_number : bool
        So many dots in each row; else at a distance.
    side, away_mm
        On which side of a border, and how far from it.
    by_tone : bool
        Denser where the reference is darker.
    """

    place: str = ALONG
    by_number: bool = False
    n_dots: int = 20
    distance_mm: float = 0.8
    radius_mm: float = 0.2
    side: str = "inside"
    away_mm: float = 0.3
    lines_mm: float = 1.5
    angle_deg: float = 45.0
    hold: str = "held"
    by_tone: bool = False


class Lines:
    """The lines of a session's drawing.

    Attributes
    ----------
    row : RowValues
        As the panel shows them.
    area : int
        Whose border or inside rows go by.
    """

    def __init__(self, session: Session, painting: Painting) -> None:
        self._session, self._painting = session, painting
        self.row = RowValues()
        self.area = 0

    @property
    def document(self) -> Document | None:
        """The open drawing, where it can be edited."""
        return self._session.document if self._session.paintable else None

    @property
    def all(self) -> dict[int, Line]:
        """The lines by their ids."""
        return lines_of(self._session.document) if self._session.document is not None else {}

    @property
    def chosen(self) -> list[int]:
        """The chosen ones."""
        return self._painting.toolbox.lines.alive(self._session.document)

    def choose(self, k: int | None, *, more: bool = False) -> None:
        """Choose a line."""
        from stippler.editor.events import Mods

        self._painting.toolbox.lines.choose(k, Mods(shift=more))

    def n_on(self, k: int) -> int:
        """Return how many dots a line holds."""
        return len(rows_on(self._session.document, k)) if self._session.document else 0

    # --- their values -------------------------------------------------------------------------

    def change(self, ids: list[int], **values: Any) -> None:
        """Change values of lines; dots meet them then as they say. One step."""
        table = self.all
        try:
            changed = {k: replace(table[k], **values) for k in ids}
        except StipplerError as error:
            self._session.messages.say(str(error), WARNING)
            return
        changed = {k: line for k, line in changed.items() if line != table[k]}
        if not changed:
            return
        meets = {"meeting", "distance_mm", "reach_mm", "width_mm"} & set(values)

        def act(document: Document) -> None:
            for k, line in changed.items():
                set_line(document, k, line)
                if meets:
                    meet(document, k, self._session.messages.say)

        what = "lines" if len(changed) > 1 else "line"
        self._painting.act(f"Change {what}", act)

    def delete(self) -> None:
        """Take the chosen lines out; their dots are free then."""
        chosen = self.chosen

        def act(document: Document) -> None:
            for k in chosen:
                set_line(document, k, None)

        self._painting.act("Delete lines" if len(chosen) > 1 else "Delete line", act)

    # --- their dots ---------------------------------------------------------------------------

    def line_up(self) -> None:
        """Bring dots within reach onto the chosen lines, which hold them from then on."""
        chosen = self.chosen

        def act(document: Document) -> None:
            for k in chosen:
                line = lines_of(document)[k]
                if line.meeting != "adhere":
                    set_line(document, k, replace(line, meeting="adhere"))
                meet(document, k)

        self._painting.act("Line up dots", act)
        held = sum(self.n_on(k) for k in chosen)
        self._session.messages.say(f"{held:,} dots on {len(chosen)} lines", INFO)

    def spread(self) -> None:
        """Spread the dots on all lines evenly, by the tone."""
        self._painting.act("Spread dots on lines", lambda document: _spread(document))

    def release(self) -> None:
        """Free the dots on the chosen lines."""
        chosen = self.chosen

        def act(document: Document) -> None:
            for k in chosen:
                release(document, rows_on(document, k))

        self._painting.act("Free dots of lines", act)

    # --- rows -----------------------------------------------------------------------------------

    @property
    def can_row(self) -> bool:
        """Whether a row could be laid."""
        needs = self.row.place in (ALONG, EDGES)
        return self.document is not None and (bool(self.chosen) or not needs)

    def lay_row(self) -> None:
        """Lay the row that the values ask for, as one step."""
        values, before = self.row, self._session.n_dots

        def act(document: Document) -> None:
            for line, k in self._row_lines(document, values):
                _lay(document, line, k, values)

        self._painting.act("Row of dots", act)
        if (n := self._session.n_dots - before) > 0:
            self._session.messages.say(f"{n:,} dots laid", INFO)

    def _row_lines(
        self, document: Document, values: RowValues
    ) -> Iterator[tuple[Line, int | None]]:
        """Yield the lines that rows go along, and the ids of those in the drawing."""
        from stippler.stippling.lines import border_lines, hatch_lines

        if values.place in (ALONG, EDGES):
            for k in self.chosen:
                line = lines_of(document)[k]
                if values.place == ALONG:
                    yield line, k
                else:
                    yield from ((edge, None) for edge in line.edges())
            return
        area = self.area if self.area in document.drawing.areas else 0
        part = document.partition.part_of(area)
        if values.place == BORDER:
            rows = border_lines(part, values.side, values.away_mm)
        else:
            rows = hatch_lines(part, values.lines_mm, float(np.radians(values.angle_deg)))
        yield from ((one, None) for one in rows)


def _spread(document: Document) -> None:
    spread_held(document)


def _lay(document: Document, line: Line, k: int | None, values: RowValues) -> None:
    from stippler.drawing.dots import FIXED, Dots
    from stippler.stippling.lines import row_along

    tone = tone_of(document) if values.by_tone else None
    n = values.n_dots if values.by_number else None
    along = row_along(line, n, None if values.by_number else values.distance_mm, tone)
    at = line.at(along)
    page = document.drawing.page
    inside = ((at >= 0.0) & (at <= (page.width_mm, page.height_mm))).all(axis=1)
    rows = document.insert(Dots.round(at[inside], values.radius_mm))
    if values.hold == "free" or not len(rows):
        return
    if k is not None and len(rows) == int(inside.sum()):
        hold(document, rows, k, along[inside])
    else:
        document.change("constraint", rows, np.full(len(rows), FIXED, np.int8))
