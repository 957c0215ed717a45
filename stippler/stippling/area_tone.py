"""Tone of each of some areas that are drawn as one.

Sizes are solved in whole cells. A border between areas that see each other cuts cells, whose ink
is not spread evenly, so a small area has too much or too little of it. One factor for the sizes of
all its dots makes up for that.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.outline_grid import OutlineGrid
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tone.ink_of_areas import ink_beyond, ink_in_cells
from stippler.stippling.compartments import Compartments, Shape
from stippler.stippling.field_sums import Weights
from stippler.stippling.near_lines import NearLines
from stippler.stippling.tessellation import Tessellation

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

_FINE = 2e-3  # of an area's ink that may lack or be too much
_MET = 4e-4  # of it, once an area's sizes are changed
_MOST = 1.05  # times the size of an area's dots, at most
_ROUNDS = 12


def sizes_of_areas(
    areas: Sequence[Shape],
    position: Floats,
    radii: Floats,
    ink_of: Callable[[Floats], Floats],
    moved: NDArray[np.bool_],
    limits: tuple[float, float],
    darkness: Weights,
) -> Floats:
    """Return sizes by which each area lays down the ink that it asks for.

    Areas whose tone is met keep theirs to the bit; so do those that the range of sizes, or few
    dots, do not let meet it.

    Parameters
    ----------
    areas : sequence of polygons
        None overlaps another.
    position : (n, 2) float64
        In the areas' unit, those of others that may reach into them included.
    radii : (n,) float64
    ink_of : callable
        What dots of given sizes lay down in their cells, (n,) float64.
    moved : (n,) bool
        Whose sizes may change.
    limits : (float, float)
        The least and the largest radius.
    darkness : Weights
        Of the picture.
    """
    ink = _Ink(Compartments.of(areas), position, radii, ink_of)
    asked = ink.asked(darkness)
    area = np.where(moved, ink.area_of_dot, -1)
    factor, is_left = np.ones(len(asked)), ~(asked > 0.0)
    mine = area >= 0

    def sizes() -> Floats:
        found = radii.copy()
        changed = np.flatnonzero(mine & (factor[area] != 1.0))
        found[changed] = np.clip(radii[changed] * factor[area[changed]], *limits)
        return found

    found = radii
    for _ in range(_ROUNDS):
        laid = ink.laid(found)
        off = np.divide(laid, asked, out=np.ones_like(asked), where=asked > 0.0) - 1.0
        wrong = (np.abs(off) > np.where(factor == 1.0, _FINE, _MET)) & ~is_left
        if not wrong.any():
            break
        factor[wrong] /= np.sqrt(np.maximum(1.0 + off[wrong], 0.25))
        lost = wrong & (np.abs(np.log(factor)) > np.log(_MOST))
        factor[lost], is_left[lost] = 1.0, True
        found = sizes()
    return found


class _Ink:
    """What dots lay down in each of some areas, by their sizes."""

    def __init__(
        self,
        parts: Compartments,
        position: Floats,
        radii: Floats,
        ink_of: Callable[[Floats], Floats],
    ) -> None:
        self._parts, self._ink_of = parts, ink_of
        self._n_areas = int(parts.shape_of[-1]) + 1
        found = OutlineGrid(parts.polygons).find(position)
        self.area_of_dot = np.where(found >= 0, parts.shape_of[found], -1)
        largest = _MOST * float(radii.max(initial=0.0))
        lines = shapely.get_parts(shapely.boundary(parts.polygons)).tolist()
        away = NearLines(lines, 3.0 * largest).nearest(position).away
        around = np.flatnonzero(np.isfinite(away))  # who may cut the disc of one that touches
        touching = np.flatnonzero(away[around] < _MOST * radii[around])
        self._cut, self._cell_of = around[touching], touching.astype(np.int64)
        self._cells = _cells_of(position[around], 2.0 * largest)
        tree = shapely.STRtree(shapely.linestrings(parts.edges.reshape(-1, 2, 2)))
        dot, edge = tree.query(
            shapely.points(position[self._cut]), "dwithin", _MOST * radii[self._cut]
        )
        self._dot, self._at = self._cut[dot], self._cell_of[dot]
        self._area_beyond = parts.shape_of[parts.compartment_of_edge[edge]]
        self._border = parts.edges[edge] - np.tile(position[self._dot], 2)

    def asked(self, darkness: Weights) -> Floats:
        """Return how much ink each area asks for."""
        parts = self._parts
        inside = shapely.get_coordinates(shapely.point_on_surface(parts.polygons))
        alone = Tessellation.of(inside, parts.polygons, np.arange(len(parts)), darkness)
        return np.asarray(np.bincount(parts.shape_of, alone.mass, self._n_areas))

    def laid(self, radii: Floats) -> Floats:
        """Return how much ink dots of these sizes lay down in each."""
        ink = self._ink_of(radii)
        mine, n = self.area_of_dot >= 0, self._n_areas
        if not len(self._cut):
            return np.asarray(np.bincount(self.area_of_dot[mine], ink[mine], n))
        cut, beyond = np.empty(len(self._cut)), np.empty(len(self._dot))
        first, corner, following = self._cells
        parallel_for(
            ink_in_cells, len(cut), first, corner, following, self._cell_of, radii[self._cut], cut
        )
        ink[self._cut] = cut
        parallel_for(
            ink_beyond, len(beyond), first, corner, self._at, self._border, radii[self._dot], beyond
        )
        whole = np.bincount(self.area_of_dot[mine], ink[mine], n)
        return np.asarray(whole - np.bincount(self._area_beyond, beyond, n))


def _cells_of(
    position: Floats, reach: float
) -> tuple[NDArray[np.int32], Floats, NDArray[np.int32]]:
    """Return the sides of dots' cells, true as far as a reach, as `ink_in_cells` takes them."""
    if not len(position):
        return np.zeros(1, np.int32), np.empty((0, 2)), np.empty(0, np.int32)
    low, high = position.min(axis=0) - reach, position.max(axis=0) + reach
    cells = Tessellation.of(position, shapely.box(*low, *high))
    return cells.start, cells.corner, cells.following
