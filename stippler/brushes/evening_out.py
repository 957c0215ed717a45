"""How the relaxation brush and *Relax* of a selection even dots out: by their areas' spacing.

Spaced evenly by the tone, dots keep it: they are as dense as the picture asks for with sizes like
theirs, and sizes that were solved for the tone follow the ink that their cells come to ask for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.brushes.local_cells import (
    Box,
    Place,
    box_around,
    centroids_of,
    lacks,
    places_of,
    tone_in,
    wider,
)
from stippler.drawing.document import Document
from stippler.drawing.store import Rows
from stippler.stippling.space_local import LocalSpacing, Spaced
from stippler.stippling.spacing import AT_LAST

Floats = NDArray[np.float64]

BESIDE = 1.0  # spacings
SMALL = 0.1  # of the distance that dots are to have; so is what follows
AT_REST = 0.005

RULES = AT_LAST
"""Those that finished drawings meet with room to spare: dots at rest stay where they are."""


@dataclass(slots=True, eq=False)
class Evened:
    """Where dots are to go.

    Attributes
    ----------
    moved_mm : (k, 2) float64
    is_solved : (k,) bool
        Whether they have sizes that were solved for the tone.
    """

    moved_mm: Floats
    is_solved: NDArray[np.bool_]


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
    out = Evened(np.array(document.dots.position_mm[rows]), np.zeros(len(rows), np.bool_))
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
            out.moved_mm[mine] = _calmed(spaced)
            out.is_solved[mine] = spaced.is_solved & has_tone
            lacking = lacks(document, spaced.at_mm, spaced.reach_mm, around)
            beyond.append((spaced.at_mm[lacking], spaced.reach_mm[lacking]))
        if not beyond:
            break
        more = wider(*(np.concatenate(parts) for parts in zip(*beyond, strict=True)))
        if more is None:
            break
        around = _both(around, more)  # it only grows, so that this comes to an end
    if by_tone and drawing.reference is not None:
        held = _beside(document, document.dots.position_mm[rows])
        if held is not None:
            out.moved_mm[held] = document.dots.position_mm[rows[held]]
    return out


def _calmed(spaced: Spaced) -> Floats:
    """Return where dots go that take half of each small step, and none that is next to nothing.

    Where not all that neighbours want can be had, as beside dots that stand still, whole steps
    would overshoot for ever.
    """
    at = spaced.at_mm[: len(spaced.moved_mm)]  # dots at one place have been parted
    way = spaced.moved_mm - at
    part = np.sqrt(np.square(way).sum(axis=1)) / spaced.apart_mm
    share = np.where(part < AT_REST, 0.0, 0.5 + 0.5 * np.minimum(np.square(part / SMALL), 1.0))
    calm: Floats = at + share[:, None] * way
    return calm


def _both(box: Box, other: Box) -> Box:
    """Return the box around two."""
    return (
        min(box[0], other[0]), min(box[1], other[1]), max(box[2], other[2]), max(box[3], other[3]),
    )  # fmt: skip


def _beside(document: Document, at: Floats) -> NDArray[np.bool_] | None:
    """Tell which places are so near to the edge of the page that its bleed held dots there."""
    page = document.drawing.page
    width, height = page.width_mm, page.height_mm
    reach = BESIDE * math.sqrt(width * height / max(len(document.dots), 1))
    x, y = at.T
    if min(x.min(), y.min(), width - x.max(), height - y.max()) >= reach:
        return None
    near = np.minimum(np.minimum(x, width - x), np.minimum(y, height - y)) < reach
    return np.asarray(near, np.bool_)


def _spaced(document: Document, place: Place, around: Box, by_tone: bool) -> tuple[Spaced, bool]:
    """Take a step in one area; tell, too, whether sizes go by the tone there."""
    dots, style = document.dots, document.drawing.style_of(place.area)
    field = tone_in(document, place.area, around) if by_tone and style.weighted else None
    radii = is_met = None
    at = dots.position_mm[place.rows]
    if field is not None:
        radii = dots.radius_mm[place.rows].astype(np.float64)
        is_met = _beside(document, at)  # the edge cuts off what bled over it
    engine = LocalSpacing(at, place.outlines, density=field, movable=place.movable)
    has_tone = field is not None and style.sizes == "tone"
    return engine.space(place.mine, RULES, radii, is_met), has_tone
