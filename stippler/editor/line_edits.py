"""Edits of lines within a stroke of a document: what adheres goes along, others give way."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import FREE, NO_CURVE, ON_CURVE
from stippler.editor.messages import INFO

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.line import Line
    from stippler.drawing.store import Rows

Points = NDArray[np.float64]

_STILL_MM = 1e-6
_SPACINGS = 4.0  # beyond a line's reach, within which dots tell how many fit on it
_DRAWN_IN = 12  # halvings of a dot's way to a line


def lines_of(document: Document) -> dict[int, Line]:
    """Return the lines of a document by their ids."""
    from stippler.drawing import records  # late, for the sake of the first frame

    found: dict[int, Line] = document.drawing.table(records.LINE)
    return found


def rows_on(document: Document, k: int) -> Rows:
    """Return the rows of the dots that a line holds."""
    dots = document.dots
    return np.flatnonzero((dots.constraint == ON_CURVE) & (dots.curve == k))


def add_line(document: Document, line: Line) -> int:
    """Add a line; its name gets a number if it has none."""
    from stippler.drawing import records

    k = document.drawing.first_free(records.LINE)
    return document.add(records.LINE, line if line.name else replace(line, name=f"line {k}"))


def set_line(document: Document, k: int, line: Line | None) -> None:
    """Change a line, or take it out: dots that it holds go along, or are free from then on."""
    from stippler.drawing import records

    old = lines_of(document).get(k)
    document.set(records.LINE, k, line)
    rows = rows_on(document, k)
    if not len(rows) or old is None:
        return
    if line is None:
        release(document, rows)
    elif line.path != old.path:
        along = document.dots.parameter[rows] * (line.length_mm / old.length_mm)
        put(document, rows, line, along)


def put(document: Document, rows: Rows, line: Line, along: Points) -> None:
    """Bring dots that a line holds to arc lengths along it; none leaves the page."""
    at = line.at(along)
    page = document.drawing.page
    inside = ((at >= 0.0) & (at <= (page.width_mm, page.height_mm))).all(axis=1)
    document.change("parameter", rows, along)
    document.change("position_mm", rows[inside], at[inside])
    document.own_by_place(rows[inside])


def hold(document: Document, rows: Rows, k: int, along: Points) -> None:
    """Let a line hold dots from now on, at arc lengths along it."""
    n = len(rows)
    document.change("constraint", rows, np.full(n, ON_CURVE, np.int8))
    document.change("curve", rows, np.full(n, k, np.int32))
    put(document, rows, lines_of(document)[k], along)


def release(document: Document, rows: Rows) -> None:
    """Free dots that lines hold."""
    n = len(rows)
    document.change("constraint", rows, np.full(n, FREE, np.int8))
    document.change("curve", rows, np.full(n, NO_CURVE, np.int32))
    document.change("parameter", rows, np.zeros(n))


def meet(document: Document, k: int, say: Callable[[str, str], None] | None = None) -> int:
    """Let dots meet a line as it says: line up on it, or keep their distance; return how many did.

    Dots that it held and is to be kept away from are free then. Free ones that find no place to
    keep off are taken away; `say` is told of these.
    """
    from stippler.drawing.line import ADHERE, DISTANCE

    line = lines_of(document)[k]
    if line.meeting == ADHERE:
        return _line_up(document, k, line)
    if line.meeting != DISTANCE or line.hidden:
        return 0
    if len(held := rows_on(document, k)):
        release(document, held)
    return clear_zones(document, _near(document, line, line.distance_mm), say)


def clear_zones(
    document: Document, rows: Rows, say: Callable[[str, str], None] | None = None
) -> int:
    """Move free dots out of the zones of all lines; return how many moved.

    Where no place keeps all distances within its area a dot is taken away, and that is said.
    """
    lines = document.meetings
    rows = rows[rows >= 0]
    rows = rows[document.dots.constraint[rows] == FREE]
    if lines is None or not len(rows):
        return 0
    before = document.dots.position_mm[rows].copy()
    inside = ~lines.are_off(before)
    rows, before = rows[inside], before[inside]
    document.move(rows, before, hops=True)
    after = document.dots.position_mm[rows]
    n_moved, lost = int((after != before).any(axis=1).sum()), rows[~lines.are_off(after)]
    n_before = len(document.dots)
    document.remove(lost)
    n_gone = n_before - len(document.dots)
    if n_gone and say is not None:
        say(f"{n_gone:,} dots found no place off lines and were taken away", INFO)
    return n_moved


def _near(document: Document, line: Line, reach_mm: float) -> Rows:
    """Return the rows of free dots about a line, and of those that it could hold."""
    at, reach = line.path.points_mm, reach_mm + max(line.width_mm) / 2
    low, high = at.min(axis=0) - reach, at.max(axis=0) + reach
    rows = document.in_box((float(low[0]), float(low[1]), float(high[0]), float(high[1])))
    return np.asarray(rows[document.dots.constraint[rows] == FREE])


def _line_up(document: Document, k: int, line: Line) -> int:
    """Bring the nearest free dots within reach onto a line, as many as fit, and spread them."""
    import shapely

    from stippler.drawing.line_index import LineIndex
    from stippler.stippling.on_lines import OnLines
    from stippler.stippling.task import MetLines

    page, n_dots = document.drawing.page, max(len(document.dots), 1)
    around = _SPACINGS * float(np.sqrt(page.width_mm * page.height_mm / n_dots))
    far = line.reach_mm + around
    near, mine = _near(document, line, far), rows_on(document, k)
    near = near[LineIndex([line], far).nearest(document.dots.position_mm[near])[2] <= far]
    rows = np.concatenate([mine, near])
    held = np.arange(len(rows)) < len(mine)
    met = MetLines((line,), (k,), np.where(held, 0, -1).astype(np.int32),
                   np.where(held, document.dots.parameter[rows], 0.0), ~held)  # fmt: skip
    at = document.dots.position_mm[rows].copy()
    part = shapely.box(0.0, 0.0, page.width_mm, page.height_mm)
    chooser = OnLines(met, at, [part], tone_of(document))
    if chooser.is_idle:
        return 0
    for _ in range(_DRAWN_IN):
        at = chooser(at, at.copy())
    on = chooser.on
    hold(document, rows[on], k, chooser.along[on])
    return int(on.sum()) - int((on & held).sum())


def tone_of(document: Document) -> Callable[[Points], Points] | None:
    """Return how dense dots are to lie at places, by the reference; None where there is none."""
    from stippler.stippling.lines import tone_along

    return tone_along(document.drawing.reference)


def spread_held(document: Document) -> int:
    """Spread all dots that lines hold evenly along them, by the tone; return how many moved."""
    from stippler.stippling.lines import spread_all

    dots, lines = document.dots, lines_of(document)
    rows = np.flatnonzero((dots.constraint == ON_CURVE) & np.isin(dots.curve, list(lines)))
    if not len(rows):
        return 0
    ids = sorted(set(dots.curve[rows].tolist()))
    which = np.searchsorted(ids, dots.curve[rows])
    before = dots.parameter[rows].copy()
    along, _ = spread_all([lines[k] for k in ids], which, before, tone_of(document))
    far = np.abs(along - before) > _STILL_MM
    for j, k in enumerate(ids):
        mine = far & (which == j)
        put(document, rows[mine], lines[k], along[mine])
    return int(far.sum())
