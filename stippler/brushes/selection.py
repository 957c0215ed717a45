"""Chosen dots: by outline or area, and what can be done to all of them at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.brushes.evening_out import evened_out
from stippler.brushes.followed_sizes import FollowedSizes
from stippler.brushes.jitter import jitter
from stippler.brushes.shape import reshape, resized
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, FREE, NO_CURVE, Dots
from stippler.drawing.store import Rows

Ids = NDArray[np.int64]
Point = tuple[float, float]

JITTER_SHARE = 0.2
_DUPLICATE_SHIFT_MM = 2.0


def in_outline(document: Document, corners: Sequence[Point]) -> Ids:
    """Return the ids of the dots inside a closed line, which may cross itself."""
    if len(corners) < 3:
        return np.empty(0, np.int64)
    polygon = shapely.make_valid(shapely.Polygon(corners))
    if polygon.is_empty or polygon.area == 0.0:
        return np.empty(0, np.int64)
    rows = document.in_box(polygon.bounds)
    shapely.prepare(polygon)
    xy = document.dots.position_mm[rows]
    return np.asarray(document.dots.id[rows[shapely.intersects_xy(polygon, xy[:, 0], xy[:, 1])]])


def in_area(document: Document, at: Point) -> Ids:
    """Return the ids of all dots of the area under a point."""
    area = document.partition.area_at(np.array([at]))[0]
    return np.asarray(document.dots.id[document.dots.area == area])


def alive(document: Document, ids: Ids) -> Rows:
    """Return the rows of the dots that are still there; sorted."""
    rows = document.rows(ids)
    return np.sort(rows[rows >= 0])


def move(document: Document, ids: Ids, step_mm: Point) -> None:
    """Move the free dots; each as far as its area lets it."""
    rows = alive(document, ids)
    document.move(rows, document.dots.position_mm[rows] + step_mm, hops=True)


def delete(document: Document, ids: Ids) -> None:
    """Remove the dots."""
    document.remove(alive(document, ids))


def duplicate(document: Document, ids: Ids) -> Ids:
    """Add a free copy of each dot a little to the side; return the copies' ids."""
    dots = document.dots.take(alive(document, ids))
    dots.position_mm += _DUPLICATE_SHIFT_MM
    return _inserted_free(document, dots)


def paste(document: Document, copied: Dots, at_mm: Point | None, n: int) -> Ids:
    """Add copied dots about a point, or n steps beside where they were; return their ids.

    Those that would lie off the page are left out.
    """
    dots = copied.copy()
    low, high = dots.position_mm.min(axis=0), dots.position_mm.max(axis=0)
    shift = (n * _DUPLICATE_SHIFT_MM,) * 2 if at_mm is None else at_mm - (low + high) / 2
    dots.position_mm += shift
    return _inserted_free(document, dots)


def _inserted_free(document: Document, dots: Dots) -> Ids:
    """Add copies that nothing holds, clear of lines that dots keep off; return their ids."""
    dots.constraint[:], dots.curve[:], dots.parameter[:] = FREE, NO_CURVE, 0.0
    if (lines := document.meetings) is not None:
        places, held = lines.keep_off(dots.position_mm)
        dots.position_mm[:] = places
        dots = dots.take(held)
    rows = document.insert(dots)
    return np.array(document.dots.id[rows])


def fix(document: Document, ids: Ids, fixed: bool) -> None:
    """Fix or free the dots."""
    hold(document, alive(document, ids), fixed)


def hold(document: Document, rows: Rows, fixed: bool) -> None:
    """Fix free dots where they are, or free those that are held, by a place or a curve."""
    held = document.dots.is_fixed(rows)
    rows = rows[held != fixed]
    document.change("constraint", rows, np.full(len(rows), FIXED if fixed else FREE, np.int8))
    if not fixed:
        rows = rows[document.dots.curve[rows] != NO_CURVE]
        document.change("curve", rows, np.full(len(rows), NO_CURVE, np.int32))
        document.change("parameter", rows, np.zeros(len(rows)))


def relax(document: Document, ids: Ids) -> None:
    """Even the free dots out by one step; they keep the tone, where there is a picture."""
    rows = alive(document, ids)
    rows = rows[~document.dots.is_fixed(rows)]
    if not len(rows):
        return
    evened, sizes = evened_out(document, rows, by_tone=True), FollowedSizes()
    sizes.note(document, rows, evened)
    document.move(rows, evened.moved_mm)
    sizes.solve(document)


def shake(document: Document, ids: Ids, rng: np.random.Generator) -> None:
    """Move the free dots at random, by a share of their mean distance."""
    rows = alive(document, ids)
    rows = rows[~document.dots.is_fixed(rows)]
    if not len(rows):
        return
    page = document.drawing.page
    scale = float(document.nearest_distances(rows, page.width_mm).mean()) * JITTER_SHARE
    position = document.dots.position_mm[rows]
    document.move(rows, jitter(position, np.ones(len(rows)), scale, rng))


def resize(document: Document, ids: Ids, percent: float) -> None:
    """Enlarge the dots, or reduce them below 0."""
    reshape(document, alive(document, ids), resized(percent))
