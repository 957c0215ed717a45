"""How the relaxation brush and *Relax* of a selection even dots out: by their areas' spacing.

Spaced evenly by the tone, dots keep it: they are as dense as the picture asks for with sizes like
theirs, and sizes that were solved for the tone follow the ink that their cells come to ask for.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stippler.brushes.local_cells import (
    Box,
    Place,
    box_around,
    centroids_of,
    darkness_in,
    lacks,
    places_of,
    wider,
)
from stippler.drawing.document import Document
from stippler.drawing.shape_change import MAX_RADIUS_MM, MIN_RADIUS_MM
from stippler.drawing.store import Rows
from stippler.stippling.space_local import LocalSpacing, Spaced
from stippler.stippling.spacing import AT_LAST
from stippler.stippling.style_tone import curves_of

Floats = NDArray[np.float64]

BESIDE = 1.0  # spacings

RULES = AT_LAST
"""Those that finished drawings meet with room to spare: dots at rest stay where they are."""


@dataclass(slots=True, eq=False)
class Evened:
    """Where dots are to go.

    Attributes
    ----------
    moved_mm : (k, 2) float64
    ink_mm2, per_ink : (k,) float64
        As in `Spaced`; 0 too where sizes do not go by the tone.
    """

    moved_mm: Floats
    ink_mm2: Floats
    per_ink: Floats


def evened_out(document: Document, rows: Rows, by_tone: bool) -> Evened:
    """Return where a step takes free dots, all others standing still.

    Parameters
    ----------
    rows
        Sorted.
    by_tone : bool
        Whether dots keep the tone of the picture, if there is one; else they get equally dense.
    """
    drawing = document.drawing
    out = Evened(np.array(document.dots.position_mm[rows]), *np.zeros((2, len(rows))))
    where, around = np.arange(len(rows)), None
    others = [k for k in drawing.areas if drawing.style_of(k).relaxation != "even"]
    if others:
        is_other = np.isin(document.dots.area[rows], others)
        reference = drawing.reference if by_tone else None
        out.moved_mm[is_other] = centroids_of(document, rows[is_other], reference)
        where = np.flatnonzero(~is_other)
    while len(where):
        at = document.dots.position_mm[rows[where]]
        around = box_around(document, at, around)
        beyond: list[tuple[Floats, Floats]] = []
        for place in places_of(document, rows[where], around):
            spaced, has_tone = _spaced(document, place, around, by_tone)
            mine = where[place.which]
            out.moved_mm[mine] = spaced.moved_mm
            if has_tone:
                out.ink_mm2[mine], out.per_ink[mine] = spaced.ink_mm2, spaced.per_ink
            lacking = lacks(document, spaced.at_mm, spaced.reach_mm, around)
            beyond.append((spaced.at_mm[lacking], spaced.reach_mm[lacking]))
        if not beyond:
            break
        more = wider(*(np.concatenate(parts) for parts in zip(*beyond, strict=True)))
        if more is None:
            break
        around = _both(around, more)  # it only grows, so that this comes to an end
    if by_tone and drawing.reference is not None:
        held = _beside(document, rows)
        out.moved_mm[held] = document.dots.position_mm[rows[held]]
    return out


def _both(box: Box, other: Box) -> Box:
    """Return the box around two."""
    return (
        min(box[0], other[0]), min(box[1], other[1]), max(box[2], other[2]), max(box[3], other[3]),
    )  # fmt: skip


def _beside(document: Document, rows: Rows) -> NDArray[np.bool_]:
    """Tell which dots lie so near to the edge of the page that its bleed held them."""
    page = document.drawing.page
    size = np.array([page.width_mm, page.height_mm])
    spacing = np.sqrt(size.prod() / max(len(document.dots), 1))
    at = document.dots.position_mm[rows]
    return np.asarray(np.minimum(at, size - at).min(axis=1) < BESIDE * spacing, np.bool_)


def _spaced(document: Document, place: Place, around: Box, by_tone: bool) -> tuple[Spaced, bool]:
    """Take a step in one area; tell, too, whether sizes go by the tone there."""
    drawing, dots = document.drawing, document.dots
    style = drawing.style_of(place.area)
    reference = drawing.reference if by_tone and style.weighted else None
    field = radii = None
    if reference is not None:
        seen = darkness_in(reference, around)
        for curve in curves_of(style):
            seen = replace(seen, values=curve(seen.values))
        field, radii = seen, dots.radius_mm[place.rows].astype(np.float64)
    engine = LocalSpacing(
        dots.position_mm[place.rows], place.outlines, density=field, movable=place.movable
    )
    has_tone = reference is not None and style.sizes == "tone"
    return engine.space(place.mine, RULES, radii), has_tone


class FollowedSizes:
    """Sizes that were solved for the tone before their dots moved, to be solved once more after.

    While dots neither come nor go.
    """

    def __init__(self) -> None:
        self._per_ink = np.empty(0)  # by row: NaN where nothing is noted, 0 where it is to stay

    def note(self, document: Document, rows: Rows, evened: Evened) -> None:
        """Take note of sizes before dots move; what was noted first counts."""
        if not len(self._per_ink):
            self._per_ink = np.full(len(document.dots), np.nan)
        fresh = np.isnan(self._per_ink[rows])
        self._per_ink[rows[fresh]] = evened.per_ink[fresh]

    def solve(self, document: Document) -> None:
        """Give them the sizes that the ink of their cells asks for now."""
        rows = np.flatnonzero(self._per_ink > 0.0)
        if not len(rows):
            return
        ink = evened_out(document, rows, by_tone=True).ink_mm2
        rows, ink = rows[ink > 0.0], ink[ink > 0.0]
        radius = np.sqrt(self._per_ink[rows] * ink)
        radius = np.clip(radius, MIN_RADIUS_MM, MAX_RADIUS_MM).astype(np.float32)
        document.change("radius_mm", rows, radius)
