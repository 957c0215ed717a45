"""Tone of each of some areas, with what dots of others lay down in them.

Sizes are solved in cells that end at walls, and in whole cells where areas see each other. A disc
reaches over a wall, and a border that is seen through cuts it; neither is known to the cell, so an
area has too much ink or too little. One factor for the sizes of all its dots makes up for that.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.outline_grid import OutlineGrid
from stippler.drawing.partition import Outline
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tone.ink_of_areas import ink_in_areas, list_overlapping, list_touching
from stippler.kernels.tone.union_share import sort_discs
from stippler.stippling.compartments import Compartments
from stippler.stippling.field_sums import Weights
from stippler.stippling.near_lines import in_grid
from stippler.stippling.tessellation import Tessellation

Floats = NDArray[np.float64]
Rows = NDArray[np.int64]

_FINE = 2e-3  # of an area's ink that may lack or be too much
_MET = 4e-4  # of it, once an area's sizes are changed
_MOST = 1.06  # times the size of an area's dots, at most
_STEP = 0.03  # of their sizes in one round, at most
_ROUNDS = 8
_ASIDE = np.array([7.5e-5, 5.7e-5])  # of its radius: where a disc's anchor is, seen from the centre
_ODD = np.array([0.7548776662466927, 0.5698402909980532])  # of whose multiples none come together
_ASTRAY = 1e-6  # of its radius: so far a disc is moved, that no rims or borders meet in one point
_WIDER = 1e-5  # by which lists of discs that may overlap are longer than they need to be


def sizes_of_areas(
    outlines: Sequence[Outline],
    asked: Floats,
    position: Floats,
    radii: Floats,
    area_of_dot: NDArray[np.integer],
    limits: Floats,
    is_cut: NDArray[np.bool_],
) -> Floats:
    """Return sizes by which each area lays down the ink that it asks for.

    Areas whose tone is met keep theirs to the bit; so do those that the range of sizes, or few
    dots, do not let meet it. Where too little crosses an area's border to make it so, its dots are
    not looked at. O(n); the same bits for any number of threads.

    Parameters
    ----------
    outlines : sequence of polygons
        None overlaps another.
    asked : (k,) float64
        Ink of each, see `ink_asked`.
    position : (n, 2) float64
        In the outlines' unit, those of others that may reach into them included.
    radii : (n,) float64
    area_of_dot : (n,) int
        Whose dot it is; below 0 one whose size stays.
    limits : (k, 2) float64
        The least and the largest radius in each.
    is_cut : (k,) bool
        Areas whose own dots' cells do not end at their borders: what of them is beyond is lost.
    """
    mine = np.flatnonzero(area_of_dot >= 0)
    area = area_of_dot[mine]
    reach = radii.copy()
    reach[mine] *= _MOST
    borders = Borders(outlines, position, reach)
    may_be_off = borders.crossed(radii, is_cut) > _FINE * asked
    if not may_be_off.any():
        return radii
    ink = InkOfDiscs(borders, may_be_off)
    factor, is_left = np.ones(len(asked)), ~may_be_off
    low, high = np.minimum(limits[area, 0], radii[mine]), np.maximum(limits[area, 1], radii[mine])
    found = radii
    for _ in range(_ROUNDS):
        laid, free = ink.laid(found)
        off = np.divide(laid, asked, out=np.ones_like(asked), where=may_be_off) - 1.0
        wrong = (np.abs(off) > np.where(factor == 1.0, _FINE, _MET)) & ~is_left
        if not wrong.any():
            break
        size = found[mine]
        can = np.where(off[area] > 0.0, size > low, size < high) & (borders.area_of[mine] == area)
        gain = np.bincount(area[can], (free[mine] * size)[can], len(asked))
        is_left |= wrong & ~(gain > 0.0)
        wrong &= gain > 0.0
        step = -off[wrong] * asked[wrong] / gain[wrong]
        factor[wrong] *= np.exp(np.clip(step, -_STEP, _STEP))
        is_left |= wrong & (np.abs(np.log(factor)) > np.log(_MOST))
        factor[is_left] = 1.0
        found = radii.copy()
        changed = factor[area] != 1.0
        found[mine[changed]] = np.clip(radii[mine] * factor[area], low, high)[changed]
    return found


def ink_asked(outlines: Sequence[Outline], darkness: Weights) -> Floats:
    """Return how much ink each of some areas asks for, (k,): the integral of the darkness."""
    parts = Compartments.of(outlines)
    inside = shapely.get_coordinates(shapely.point_on_surface(parts.polygons))
    alone = Tessellation.of(inside, outlines, parts.shape_of, darkness)
    return np.asarray(np.bincount(parts.shape_of, alone.mass, len(outlines)))


class Borders:
    """Borders of areas, and which discs they cross.

    Parameters
    ----------
    outlines : sequence of polygons
    position : (n, 2) float64
    reach : (n,) float64
        The largest radius of each disc.

    Attributes
    ----------
    edges : (m, 4) float64
    place, anchor : (n, 2) float64
        Centres, and a place close by that lies on no border.
    reach : (n,) float64
    area_of : (n,) int32
        In which area each disc's anchor lies; -1 in none.
    dot, area : (r,) int
        Rows: whose disc the border of which area may cross.
    edge, first_edge : int
        The edges, row by row, and where those of each row begin.
    """

    def __init__(self, outlines: Sequence[Outline], position: Floats, reach: Floats) -> None:
        parts = Compartments.of(outlines)
        self.n_areas, self.edges, self.reach = len(outlines), parts.edges.copy(), reach
        odd = np.arange(1, len(position) + 1)[:, None] * _ODD % 1.0 - 0.5
        self.place = position + odd * reach[:, None] * _ASTRAY
        self.anchor = self.place + reach[:, None] * _ASIDE
        self.area_of = OutlineGrid(outlines).find(self.anchor)
        dot, touched = _touching(self.place, reach, self.edges)
        area = parts.shape_of[parts.compartment_of_edge[touched]]
        key, row = np.unique(dot * self.n_areas + area, return_inverse=True)
        self.dot, self.area = key // self.n_areas, key % self.n_areas
        self.edge = touched[np.argsort(row, kind="stable")]
        self.first_edge = _summed(np.bincount(row, minlength=len(key)))

    def crossed(self, radii: Floats, is_cut: NDArray[np.bool_]) -> Floats:
        """Return how much of discs reaches over each area's border at most, (k,).

        What discs of others have within; with `is_cut`, also what its own have beyond.
        """
        if not len(self.dot):
            return np.zeros(self.n_areas)
        row = np.repeat(np.arange(len(self.dot)), np.diff(self.first_edge))
        at, edge = self.place[self.dot[row]], self.edges[self.edge]
        along, to = edge[:, 2:] - edge[:, :2], at - edge[:, :2]
        length2 = np.maximum((along * along).sum(axis=1), 1e-300)
        share = np.clip((along * to).sum(axis=1) / length2, 0.0, 1.0)
        away = np.hypot(*(to - share[:, None] * along).T)
        r = radii[self.dot]
        h = np.minimum.reduceat(away, self.first_edge[:-1])
        c = np.clip(h / np.maximum(r, 1e-300), 0.0, 1.0)
        beyond = r * r * (np.arccos(c) - c * np.sqrt(1.0 - c * c))
        counts = (self.area_of[self.dot] != self.area) | is_cut[self.area]
        return np.asarray(np.bincount(self.area, beyond * counts, self.n_areas))


class InkOfDiscs:
    """What discs lay down in each of some areas, by their sizes.

    Parameters
    ----------
    borders : Borders
    some : (k,) bool
        The areas asked about.
    """

    def __init__(self, borders: Borders, some: NDArray[np.bool_]) -> None:
        self._borders, n_areas = borders, borders.n_areas
        within = np.flatnonzero(borders.area_of >= 0)
        within = within[some[borders.area_of[within]]]
        crossed = np.flatnonzero(some[borders.area])
        key, row = np.unique(
            np.concatenate([borders.dot[crossed] * n_areas + borders.area[crossed],
                            within * n_areas + borders.area_of[within]]),
            return_inverse=True,
        )  # fmt: skip
        self._dot, self._area = key // n_areas, key % n_areas
        self._is_inside = borders.area_of[self._dot] == self._area
        n_edges = np.zeros(len(key), np.int64)
        n_edges[row[: len(crossed)]] = np.diff(borders.first_edge)[crossed]
        self._first_edge = _summed(n_edges)
        self._edge = borders.edge[np.repeat(some[borders.area], np.diff(borders.first_edge))]
        asked, self._list = np.unique(self._dot, return_inverse=True)
        self._first_other, self._other = _overlapping(asked, borders.place, borders.reach)
        n_others = np.diff(self._first_other)[self._list]
        self._first_room = _summed(2 * (n_others + n_edges))

    def laid(self, radii: Floats) -> tuple[Floats, Floats]:
        """Return each area's ink, and how much of each disc's rim is free in the disc's own."""
        k = len(self._dot)
        ink, rim, room = np.empty(k), np.empty(k), np.empty(self._first_room[-1])
        parallel_for(
            ink_in_areas, k, self._dot, self._is_inside, self._first_edge, self._edge,
            self._borders.edges, self._list, self._first_other, self._other, self._borders.place,
            self._borders.anchor, radii, self._first_room, room, ink, rim,
        )  # fmt: skip
        own, free = self._is_inside, np.zeros(len(radii))
        free[self._dot[own]] = rim[own]
        return np.asarray(np.bincount(self._area, ink, self._borders.n_areas)), free


def _touching(place: Floats, reach: Floats, edges: Floats) -> tuple[Rows, Rows]:
    """Return pairs of dots and edges that lie within their reach."""
    n = len(place)
    first = np.zeros(n + 1, np.int64)
    grid = in_grid(edges, float(reach.max(initial=0.0)))
    parallel_for(list_touching, n, place, reach, edges, *grid, first, np.empty(0, np.int64), True)
    first = np.cumsum(first)
    touched = np.empty(first[-1], np.int64)
    parallel_for(list_touching, n, place, reach, edges, *grid, first, touched, False)
    return np.repeat(np.arange(n), np.diff(first)), touched


def _overlapping(some: Rows, place: Floats, reach: Floats) -> tuple[Rows, Rows]:
    """Return where the list of each of some dots begins, and the others that it may overlap."""
    n = len(place)
    wide = reach * (1.0 + _WIDER) + _WIDER * float(np.abs(place).max(initial=0.0))
    discs = np.column_stack((place, wide)).astype(np.float32)
    order, by_cell = np.empty(n, np.int64), np.empty((n, 3), np.float32)
    first, nobody = np.zeros(len(some) + 1, np.int64), np.empty(0, np.int64)
    if not n:
        return first, nobody
    sorted_as = sort_discs(discs, order, by_cell), order
    parallel_for(list_overlapping, len(some), some, place, reach, *sorted_as, first, nobody, True)
    first = np.cumsum(first)
    other = np.empty(first[-1], np.int64)
    parallel_for(list_overlapping, len(some), some, place, reach, *sorted_as, first, other, False)
    return first, other


def _summed(counts: NDArray[np.integer]) -> Rows:
    return np.concatenate(([0], np.cumsum(counts, dtype=np.int64)))
