"""Outlines in a grid, so that points are located at a cost that does not follow their number."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.kernels.dots.locate import TINY, fill_corners, list_cells, locate
from stippler.kernels.machine.pool import parallel_for

_MOST_CELLS = 65_536
_FEW = 4096  # points that are not worth a second core


class OutlineGrid:
    """Says which of several outlines a point lies in; the uppermost counts.

    Parameters
    ----------
    outlines : polygons
        From the uppermost to the lowest.
    """

    def __init__(self, outlines: Sequence[Polygon | MultiPolygon]) -> None:
        parts = [_edges_of(outline) for outline in outlines]
        ends = np.concatenate([[0], np.cumsum([len(part) for part in parts])])
        self._edges = np.ascontiguousarray(np.concatenate(parts))
        corners = self._edges.reshape(-1, 2)
        (x0, y0), (x1, y1) = corners.min(axis=0).tolist(), corners.max(axis=0).tolist()
        n_cells = min(max(2 * len(self._edges), 64), _MOST_CELLS)
        side = max(math.sqrt((x1 - x0) * (y1 - y0) / n_cells), max(x1 - x0, y1 - y0) / 4096)
        self._columns, self._rows = int((x1 - x0) / side) + 1, int((y1 - y0) / side) + 1
        self._frame = np.array([x0, y0, side])
        items = [self._items(int(a), int(b)) for a, b in pairwise(ends)]
        rank = np.repeat(np.arange(len(items)), [len(item[0]) for item in items])
        cell, holds, edge = (np.concatenate(column) for column in zip(*items, strict=True))
        order = np.argsort(cell, kind="stable")
        self._start = np.searchsorted(cell[order], np.arange(self._columns * self._rows + 1))
        self._rank, self._holds, self._edge = (
            np.ascontiguousarray(column[order], np.int32) for column in (rank, holds, edge)
        )

    def find(self, points: NDArray[np.float64]) -> NDArray[np.int32]:
        """Return the place in the list of the outline that each point lies in, or -1."""
        points = np.array(points, np.float64, order="C")
        out = np.empty(len(points), np.int32)

        def part(start: int, stop: int) -> None:
            locate(
                points[start:stop], self._frame, self._columns, self._rows, self._start,
                self._rank, self._holds, self._edge, self._edges, out[start:stop],
            )  # fmt: skip

        if len(points) < _FEW:
            part(0, len(points))
        else:
            parallel_for(part, len(points))
        return out

    def _items(self, first: int, last: int) -> tuple[NDArray[np.int64], ...]:
        """Return the cells of one outline, whether it holds their corners, and its edges there."""
        grid = (self._frame, self._columns, self._rows)
        inside = np.zeros((self._rows, self._columns), np.int32)
        fill_corners(self._edges, first, last, *grid, inside)
        cell, edge = np.empty(0, np.int64), np.empty(0, np.int32)
        while (n := list_cells(self._edges, first, last, *grid, cell, edge)) > len(cell):
            cell, edge = np.empty(n, np.int64), np.empty(n, np.int32)
        flat = inside.reshape(-1)
        plain = flat.copy()
        plain[cell] = 0
        whole = np.flatnonzero(plain)
        cells = np.concatenate([cell, whole])
        return cells, flat[cells], np.concatenate([edge, np.full(len(whole), -1)])


def _edges_of(outline: Polygon | MultiPolygon) -> NDArray[np.float64]:
    """Return the edges of all rings, each with its lower end first; tiny numbers become 0."""
    rings = shapely.get_parts(shapely.boundary(outline))
    corners, ring = shapely.get_coordinates(rings, return_index=True)
    edges = np.concatenate([corners[:-1], corners[1:]], axis=1)[ring[1:] == ring[:-1]]
    edges[np.abs(edges) < TINY] = 0.0
    down = edges[:, 1] > edges[:, 3]
    edges[down] = edges[down][:, [2, 3, 0, 1]]
    return np.asarray(edges)
