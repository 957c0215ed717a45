"""The grids that neighbours and border edges are looked up in, one for each compartment."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.cells.grid import measure_clearance, spread_edges
from stippler.kernels.cells.tables import Border
from stippler.stippling.compartments import RECTANGLE, Compartments

DOTS_PER_CELL = 3.0


@dataclass(frozen=True, slots=True, eq=False)
class DotGrid:
    """Grid cells of all compartments, numbered through; see `stippler.kernels.cells.grid`.

    Attributes
    ----------
    real, whole
        Frame and size of each compartment's grid.
    n_cells : int
    border : Border
        The border edges, by grid cell.
    """

    real: NDArray[np.float64]
    whole: NDArray[np.int32]
    n_cells: int
    border: Border

    @classmethod
    def over(cls, parts: Compartments, n_dots: NDArray[np.intp]) -> DotGrid:
        """Lay grids of about `DOTS_PER_CELL` dots a cell; `n_dots` counts by compartment."""
        real, whole, n_cells = _frames(parts, n_dots)
        return cls(real, whole, n_cells, _border_of(parts, real, whole, n_cells))


def _border_of(
    parts: Compartments, real: NDArray[np.float64], whole: NDArray[np.int32], n_cells: int
) -> Border:
    args = (parts.edges, parts.compartment_of_edge, real, whole)
    start = np.zeros(n_cells + 1, np.int32)
    edge_of_slot = np.empty(0, np.int32)
    clear = np.full(n_cells, 1 << 20, np.int32)
    most_edges = 0
    if (parts.kind != RECTANGLE).any():  # a rectangle's box is its border
        spread_edges(*args, start, edge_of_slot, True)
        np.cumsum(start, out=start)
        edge_of_slot = np.empty(int(start[-1]), np.int32)
        spread_edges(*args, start.copy(), edge_of_slot, False)
        measure_clearance(whole, start, clear)
        most_edges = int(np.bincount(parts.compartment_of_edge).max())
    return Border(parts.edges, parts.next_edge, start, edge_of_slot, clear, most_edges)


def _frames(
    parts: Compartments, n_dots: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.int32], int]:
    if len(parts) == 1 and parts.kind[0] == RECTANGLE:
        return _frame_of_rectangle(parts, int(n_dots[0]))
    width, height = (parts.box[:, 2:] - parts.box[:, :2]).T
    share = n_dots + 1.0
    most = 4.0 * share + 64.0  # grid cells allowed to a compartment, whatever its shape
    side = np.sqrt(parts.area * DOTS_PER_CELL / share)
    side = np.maximum(side, np.sqrt(width * height / most))
    side = np.maximum(side, np.maximum(width, height) / most)
    nx = np.maximum(np.ceil(width / side), 1).astype(np.int64)
    ny = np.maximum(np.ceil(height / side), 1).astype(np.int64)
    first = np.concatenate([[0], np.cumsum(nx * ny)])
    real = np.column_stack([parts.box[:, :2], side, 1.0 / side, _boxes(parts)])
    kind, first_edge = parts.kind != RECTANGLE, parts.first_edge[:-1]
    columns = nx, ny, first[:-1], kind, first_edge, parts.is_convex
    whole = np.column_stack(columns).astype(np.int32)
    return np.ascontiguousarray(real), np.ascontiguousarray(whole), int(first[-1])


def _frame_of_rectangle(
    parts: Compartments, n_dots: int
) -> tuple[NDArray[np.float64], NDArray[np.int32], int]:
    """Return what `_frames` does of the one rectangle that brushes ask for with each stamp."""
    x0, y0, x1, y1 = parts.box[0].tolist()
    width, height, share = x1 - x0, y1 - y0, n_dots + 1.0
    most = 4.0 * share + 64.0
    side = max(
        math.sqrt(float(parts.area[0]) * DOTS_PER_CELL / share),
        math.sqrt(width * height / most),
        max(width, height) / most,
    )
    nx, ny = max(math.ceil(width / side), 1), max(math.ceil(height / side), 1)
    real = np.array([[x0, y0, side, 1.0 / side, x0, y0, x1, y1]])
    return real, np.array([[nx, ny, 0, 0, 0, 1]], np.int32), nx * ny


def _boxes(parts: Compartments) -> NDArray[np.float64]:
    """Return the box that cells start from: a polygon's is a trifle larger than the polygon.

    A dot on the polygon's outermost corner would else lie on its cell's rim, where it cannot be
    told which chains of the border hide it.
    """
    box = parts.box
    size = (box[:, 2:] - box[:, :2]).max(axis=1)
    beyond = np.where(parts.kind == RECTANGLE, 0.0, 1e-9 * size + 1e-14 * np.abs(box).max(axis=1))
    larger: NDArray[np.float64] = box + beyond[:, None] * np.array([-1.0, -1.0, 1.0, 1.0])
    return larger
