"""Dots at one and the same place have one cell between them: they are parted by very little."""

from __future__ import annotations

import math

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.stippling.compartments import Compartments

Floats = NDArray[np.float64]

_APART = 1e-3  # of the mean spacing
_TURN_RAD = 2.399963229728653  # the golden angle
_TURNS = 16


def part_coinciding(
    xy: Floats, compartment_of_dot: NDArray[np.int32], parts: Compartments, fixed: NDArray[np.bool_]
) -> None:
    """Move free dots off dots that were given before them at the same place, in `xy`."""
    x = np.sort(xy[:, 0])
    shared = x[1:][x[1:] == x[:-1]]
    if not len(shared):
        return
    at = np.minimum(np.searchsorted(shared, xy[:, 0]), len(shared) - 1)
    some = np.flatnonzero(shared[at] == xy[:, 0])
    x, y, owner = xy[some, 0], xy[some, 1], compartment_of_dot[some]
    order = np.lexsort((y, x, owner))  # stable: as given in groups
    x, y, owner, order = x[order], y[order], owner[order], some[order]
    same = (x[1:] == x[:-1]) & (y[1:] == y[:-1]) & (owner[1:] == owner[:-1])
    if not same.any():
        return
    group = np.concatenate([[0], np.cumsum(~same)])
    sizes = np.bincount(group)
    ends = np.cumsum(sizes)
    for g in np.flatnonzero(sizes > 1):
        rows = order[ends[g] - sizes[g] : ends[g]]
        c = compartment_of_dot[rows[0]]
        spacing = math.sqrt(parts.area[c] / np.count_nonzero(compartment_of_dot == c))
        free = rows[~fixed[rows]]
        movable = free if len(free) < len(rows) else free[1:]
        if len(movable):
            xy[movable] = _places_beside(parts, int(c), xy[rows[0]], len(movable), _APART * spacing)


def _places_beside(parts: Compartments, c: int, at: Floats, count: int, distance: float) -> Floats:
    """Return places around one, all different, at less than about a distance times their root."""
    polygon = parts.polygons[c]
    shapely.prepare(polygon)
    k = np.arange(1, count + 1)[:, None]
    turn = np.arange(_TURNS)
    angle = _TURN_RAD * (k + turn)
    radius = distance * np.sqrt(k) / (1 + turn // 8) ** 2
    tried = at + np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    fits = shapely.contains_xy(polygon, tried[..., 0], tried[..., 1])
    out: Floats = tried[np.arange(count), fits.argmax(axis=1)]
    left = np.flatnonzero(~fits.any(axis=1))
    if len(left):  # a sharp corner: along the middle of it
        x, y = at
        corner = shapely.clip_by_rect(
            polygon, x - distance, y - distance, x + distance, y + distance
        )
        nearest = min(shapely.get_parts(corner), key=shapely.points(at).distance, default=corner)
        if not nearest.is_empty:
            towards = shapely.get_coordinates(shapely.point_on_surface(nearest))[0] - at
            out[left] = at + np.linspace(0.0, 1.0, len(left) + 2)[1:-1, None] * towards
        inside = shapely.intersects_xy(polygon, *out[left].T)
        out[left[~inside]] = at
    return out
