"""Chosen dots: by outline or area, and what can be done to all of them at once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.brushes.cells import centroids_of
from stippler.brushes.jitter import jitter
from stippler.brushes.shape import reshape, resized
from stippler.drawing.editing import Editing
from stippler.drawing.store import Rows

Ids = NDArray[np.int64]
Point = tuple[float, float]

JITTER_SHARE = 0.2
_DUPLICATE_SHIFT_MM = 2.0


def in_outline(editing: Editing, corners: Sequence[Point]) -> Ids:
    """Return the ids of the dots inside a closed line, which may cross itself."""
    if len(corners) < 3:
        return np.empty(0, np.int64)
    polygon = shapely.make_valid(shapely.Polygon(corners))
    if polygon.is_empty or polygon.area == 0.0:
        return np.empty(0, np.int64)
    rows = editing.in_box(polygon.bounds)
    shapely.prepare(polygon)
    xy = editing.dots.position_mm[rows]
    return np.asarray(editing.dots.id[rows[shapely.intersects_xy(polygon, xy[:, 0], xy[:, 1])]])


def in_area(editing: Editing, at: Point) -> Ids:
    """Return the ids of all dots of the area under a point."""
    area = editing.bounds.area_at(np.array([at]))[0]
    return np.asarray(editing.dots.id[editing.dots.area == area])


def alive(editing: Editing, ids: Ids) -> Rows:
    """Return the rows of the dots that are still there; sorted."""
    rows = editing.rows(ids)
    return np.sort(rows[rows >= 0])


def move(editing: Editing, ids: Ids, step_mm: Point) -> None:
    """Move the free dots; each as far as its area lets it."""
    rows = alive(editing, ids)
    editing.move(rows, editing.dots.position_mm[rows] + step_mm)


def delete(editing: Editing, ids: Ids) -> None:
    """Remove the dots."""
    editing.remove(alive(editing, ids))


def duplicate(editing: Editing, ids: Ids) -> Ids:
    """Add a free copy of each dot a little to the side; return the copies' ids."""
    dots = editing.dots.take(alive(editing, ids))
    dots.position_mm += _DUPLICATE_SHIFT_MM
    dots.fixed[:] = False
    rows = editing.insert(dots)
    return np.array(editing.dots.id[rows])


def fix(editing: Editing, ids: Ids, fixed: bool) -> None:
    """Fix or free the dots."""
    rows = alive(editing, ids)
    rows = rows[editing.dots.fixed[rows] != fixed]
    editing.change("fixed", rows, np.full(len(rows), fixed))


def relax(editing: Editing, ids: Ids) -> None:
    """Move the free dots to the centroids of their cells, once."""
    rows = alive(editing, ids)
    rows = rows[~editing.dots.fixed[rows]]
    if len(rows):
        editing.move(rows, centroids_of(editing, rows))


def shake(editing: Editing, ids: Ids, rng: np.random.Generator) -> None:
    """Move the free dots at random, by a share of their mean distance."""
    rows = alive(editing, ids)
    rows = rows[~editing.dots.fixed[rows]]
    if not len(rows):
        return
    page = editing.drawing.page
    scale = float(editing.nearest_distances(rows, page.width_mm).mean()) * JITTER_SHARE
    position = editing.dots.position_mm[rows]
    editing.move(rows, jitter(position, np.ones(len(rows)), scale, rng))


def resize(editing: Editing, ids: Ids, percent: float) -> None:
    """Enlarge the dots, or reduce them below 0."""
    reshape(editing, alive(editing, ids), resized(percent))
