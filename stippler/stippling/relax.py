"""Lloyd's relaxation: every free dot moves to the centroid of its clipped cell."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from stippler.errors import GeometryError, ParameterError
from stippler.kernels.field import sum_rows
from stippler.kernels.grid import (
    find_grid_cells,
    measure_clearance,
    sort_by_grid_cell,
    spread_edges,
)
from stippler.kernels.pool import run_ranges
from stippler.kernels.relaxation import DONE, relax_dots
from stippler.stippling.compartments import RECTANGLE, Compartments, Shape

DOTS_PER_GRID_CELL = 2.0
CORNER_CAP = 64
GRAIN = 4096

Cancel = Callable[[], bool] | threading.Event | None
Density = Callable[[NDArray[np.float64], NDArray[np.float64]], ArrayLike]


@dataclass(frozen=True, slots=True, eq=False)
class DensityField:
    """How much of the dots' weight each pixel has; outside it is 0.

    Attributes
    ----------
    values : (h, w) array of float, >= 0
    pixel_mm : float or (float, float)
        Side of a pixel, or its width and height.
    origin_mm : (float, float)
        Position of the corner of pixel (0, 0).
    """

    values: NDArray[np.floating]
    pixel_mm: float | tuple[float, float]
    origin_mm: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        values = np.asarray(self.values)
        if values.ndim != 2 or values.size == 0:
            raise ParameterError("a density is a 2-d field with at least one pixel", "density")
        if not (float(values.min()) >= 0.0 and math.isfinite(float(values.max()))):
            raise ParameterError("has to be finite and not below 0", "density")
        sides = np.broadcast_to(np.asarray(self.pixel_mm, np.float64), (2,))
        if not (np.isfinite(sides) & (sides > 0)).all():
            raise ParameterError(f"{self.pixel_mm} mm is no pixel size", "density")
        if not np.isfinite(np.asarray(self.origin_mm, np.float64)).all():
            raise ParameterError(f"{self.origin_mm} is no position", "density")
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "pixel_mm", (float(sides[0]), float(sides[1])))


@dataclass(frozen=True, slots=True)
class StepReport:
    """How far the free dots went in one step."""

    mean_mm: float
    largest_mm: float
    n_moved: int


@dataclass(frozen=True, slots=True)
class RunReport:
    """Why a run ended, and its steps.

    Attributes
    ----------
    reason : {"iterations", "tolerance", "cancelled"}
    """

    reason: str
    steps: tuple[StepReport, ...]

    @property
    def n_steps(self) -> int:
        """How many steps were completed."""
        return len(self.steps)


class Relaxation:
    """Dots in compartments, ready to be relaxed step by step.

    Parameters
    ----------
    points : (n, 2) array_like, mm
        Finite; not modified.
    polygon : shapely Polygon or MultiPolygon, (m, 2) array, or a list of them
        Compartments; dots see only the dots of their own. The parts of a MultiPolygon are
        compartments of their own.
    fixed : (n,) array_like of bool, optional
        Dots that shape the cells of others and never move.
    compartment_of_dot : (n,) array_like of int, optional
        Index into the list of compartments; found by position if left out.
    density : DensityField, optional
        Weight of the page; a dot moves to the centre of mass of its cell. A dot whose cell has
        no mass keeps its place.
    over_relaxation : float
        The share of the way to the centroid that a dot goes, above 0 and below 2.

    Raises
    ------
    GeometryError
        If a compartment is not valid or has no dots, or a dot lies outside.

    Notes
    -----
    O(n) a step; the same bits for any number of threads. A dot never leaves its compartment: if
    its cell's centroid lies behind a wall it goes half the way to that wall. Dots that coincide
    are parted by a thousandth of the mean spacing. Deussen et al. 2000, section 4.3; Lloyd 1982.
    """

    def __init__(
        self,
        points: ArrayLike,
        polygon: Shape | Sequence[Shape] | ArrayLike,
        fixed: ArrayLike | None = None,
        compartment_of_dot: ArrayLike | None = None,
        density: DensityField | None = None,
        over_relaxation: float = 1.0,
    ) -> None:
        xy = _checked_points(points)
        n = len(xy)
        self._fixed = _checked(fixed, n, np.bool_, "fixed", False)
        if not 0.0 < over_relaxation < 2.0:
            raise ParameterError(
                f"{over_relaxation:g} is out of range", "over-relaxation", "give 0 < w < 2"
            )
        self._over = float(over_relaxation)
        self._compartments = Compartments.of(polygon)
        shape_of_dot = None
        if compartment_of_dot is not None:
            shape_of_dot = _checked(compartment_of_dot, n, np.int32, "compartment_of_dot", 0)
        self._compartment_of_dot = self._compartments.find(xy, shape_of_dot)
        self._refuse_empty()
        self._part_coinciding(xy)
        self._set_density(density)
        self._set_grid()
        self._order = np.arange(n, dtype=np.int32)
        self._xy = xy
        self._is_sorted = False

    @property
    def points(self) -> NDArray[np.float64]:
        """Positions in mm, in the order given: a fresh read-only array."""
        out = np.empty_like(self._xy)
        out[self._order] = self._xy
        out.flags.writeable = False
        return out

    def __len__(self) -> int:
        return len(self._xy)

    def step(self, cancel: Cancel = None) -> StepReport:
        """Move every free dot once.

        Returns
        -------
        StepReport
            Zeros if `cancel` came before the end; then nothing has moved.
        """
        report = self._step(_as_question(cancel))
        return report or StepReport(0.0, 0.0, 0)

    def run(
        self,
        iterations: int,
        tolerance_mm: float = 0.0,
        cancel: Cancel = None,
        progress: Callable[[int, StepReport], None] | None = None,
    ) -> RunReport:
        """Take steps until enough, until dots move less than a tolerance, or until cancelled.

        Parameters
        ----------
        iterations : int
        tolerance_mm : float
            Stop after a step whose largest move is not above this; 0 never stops early.
        cancel : callable or threading.Event, optional
            Asked many times a step; the step under way is dropped.
        progress : callable, optional
            Called after each step with the number of steps done and the step's report.
        """
        asked = _as_question(cancel)
        steps: list[StepReport] = []
        for i in range(iterations):
            report = self._step(asked)
            if report is None:
                return RunReport("cancelled", tuple(steps))
            steps.append(report)
            if progress is not None:
                progress(i + 1, report)
            if tolerance_mm > 0.0 and report.largest_mm <= tolerance_mm:
                return RunReport("tolerance", tuple(steps))
        return RunReport("iterations", tuple(steps))

    def cell_areas(self) -> NDArray[np.float64]:
        """Return the area of each dot's clipped cell, mm², in the order given."""
        return self._measure(weighted=False)[:, 0]

    def cell_masses(self) -> NDArray[np.float64]:
        """Return the density's integral over each dot's clipped cell, in the order given."""
        return self._measure(weighted=True)[:, 0]

    def centroids(self) -> NDArray[np.float64]:
        """Return the (weighted) centroid of each dot's clipped cell, mm, in the order given."""
        return self.points + self._measure(weighted=True)[:, 1:3]

    def energy(self) -> float:
        """Return the sum over cells of the second moment of area about the dot, mm⁴."""
        return float(self._measure(weighted=False)[:, 3].sum())

    def _measure(self, weighted: bool) -> NDArray[np.float64]:
        self._sort()
        _, cells = self._compute(np.arange(len(self), dtype=np.int32), weighted)
        out = np.empty_like(cells)
        out[self._order] = cells
        return out

    def _step(self, cancel: Callable[[], bool] | None) -> StepReport | None:
        self._sort()
        which = np.flatnonzero(~self._fixed).astype(np.int32)
        result = self._compute(which, True, cancel)
        if result is None:
            return None
        new_xy, _ = result
        moved = np.hypot(*(new_xy[which] - self._xy[which]).T)
        self._xy[which] = new_xy[which]
        self._is_sorted = False
        if not len(which):
            return StepReport(0.0, 0.0, 0)
        return StepReport(
            float(moved.mean()), float(moved.max()), int(np.count_nonzero(moved > 0.0))
        )

    def _compute(self, which, weighted, cancel=None):
        n = len(self)
        new_xy, cells = np.empty((n, 2)), np.empty((n, 4))
        status = np.zeros(n, np.uint8)
        mass, moment = self._mass, self._moment
        if not weighted:
            mass = moment = np.empty((0, 0))
        cap = CORNER_CAP
        while len(which):
            done = run_ranges(
                relax_dots,
                len(which),
                which,
                self._xy,
                self._compartment_of_dot,
                self._cell_start,
                self._grid_real,
                self._grid_int,
                self._compartments.edges,
                self._compartments.next_edge,
                self._edge_start,
                self._edge_of_slot,
                self._clear,
                mass,
                moment,
                self._frame,
                cap,
                self._most_edges,
                self._over,
                new_xy,
                cells,
                status,
                grain=GRAIN,
                cancel=cancel,
            )
            if not done:
                return None
            which = which[status[which] != DONE]
            cap *= 16
        return new_xy, cells

    def _sort(self) -> None:
        """Bring the dots into the order of the grid."""
        if self._is_sorted:
            return
        n = len(self)
        cell_of_dot, order = np.empty(n, np.int32), np.empty(n, np.int32)
        run_ranges(
            find_grid_cells,
            n,
            self._xy,
            self._compartment_of_dot,
            self._grid_real,
            self._grid_int,
            cell_of_dot,
            grain=GRAIN,
        )
        sort_by_grid_cell(cell_of_dot, self._cell_start, order)
        self._xy = self._xy[order]
        self._fixed = self._fixed[order]
        self._compartment_of_dot = self._compartment_of_dot[order]
        self._order = self._order[order]
        self._is_sorted = True

    def _refuse_empty(self) -> None:
        shapes = self._compartments.shape_of
        counts = np.bincount(shapes[self._compartment_of_dot], minlength=int(shapes[-1]) + 1)
        empty = np.flatnonzero(counts == 0)
        if len(empty):
            raise GeometryError(
                "holds no dots", f"compartment {empty[0]}", "leave it out or give it dots"
            )

    def _part_coinciding(self, xy: NDArray[np.float64]) -> None:
        """Move dots off dots that were given before them at the same place, by very little."""
        keys = np.column_stack([self._compartment_of_dot, xy])
        _, first, group = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        if len(first) == len(xy):
            return
        group = group.reshape(-1)
        for g in np.flatnonzero(np.bincount(group) > 1):
            rows = np.flatnonzero(group == g)
            c = self._compartment_of_dot[rows[0]]
            area = self._compartments.area[c]
            spacing = math.sqrt(area / np.count_nonzero(self._compartment_of_dot == c))
            free = rows[~self._fixed[rows]]
            for k, i in enumerate(free if len(free) < len(rows) else free[1:], start=1):
                xy[i] = self._place_beside(xy[i], int(c), k, 1e-3 * spacing)

    def _place_beside(
        self, at: NDArray[np.float64], c: int, k: int, distance: float
    ) -> NDArray[np.float64]:
        polygon = self._compartments.polygons[c]
        shapely.prepare(polygon)
        for attempt in range(64):
            angle = 2.399963229728653 * (k + attempt)
            radius = distance * math.sqrt(k) / (1 + attempt // 8) ** 2
            there = at + radius * np.array([math.cos(angle), math.sin(angle)])
            if shapely.contains_xy(polygon, there[0], there[1]):
                return there
        return at

    def _set_density(self, density: DensityField | None) -> None:
        self._frame = np.array([0.0, 0.0, 1.0, 1.0])
        if density is None:
            self._mass = self._moment = np.empty((0, 0))
            return
        h, w = density.values.shape
        self._mass, self._moment = np.empty((h, w + 1)), np.empty((h, w + 1))
        values = np.ascontiguousarray(density.values, np.float32)
        run_ranges(sum_rows, h, values, self._mass, self._moment, grain=64)
        self._frame = np.array([*density.origin_mm, *np.broadcast_to(density.pixel_mm, (2,))])

    def _set_grid(self) -> None:
        """Lay a grid over each compartment and spread the border's edges over it."""
        parts = self._compartments
        n_dots = np.bincount(self._compartment_of_dot, minlength=len(parts))
        width, height = (parts.box[:, 2:] - parts.box[:, :2]).T
        share = np.minimum(n_dots, 1 << 24) + 1.0
        side = np.sqrt(parts.area * DOTS_PER_GRID_CELL / share)
        side = np.maximum(side, np.sqrt(width * height / (4.0 * share + 64.0)))
        side = np.maximum(side, np.maximum(width, height) / (4.0 * share + 64.0))
        nx = np.maximum(np.ceil(width / side), 1).astype(np.int64)
        ny = np.maximum(np.ceil(height / side), 1).astype(np.int64)
        first = np.concatenate([[0], np.cumsum(nx * ny)])
        self._grid_real = np.column_stack([parts.box[:, :2], side, 1.0 / side, parts.box])
        self._grid_int = np.column_stack([nx, ny, first[:-1], parts.kind]).astype(np.int32)
        n_cells = int(first[-1])
        self._cell_start = np.zeros(n_cells + 1, np.int32)
        self._edge_start = np.zeros(n_cells + 1, np.int32)
        args = (parts.edges, parts.compartment_of_edge, self._grid_real, self._grid_int)
        self._edge_of_slot = np.empty(0, np.int32)
        spread_edges(*args, self._edge_start, self._edge_of_slot, True)
        np.cumsum(self._edge_start, out=self._edge_start)
        self._edge_of_slot = np.empty(int(self._edge_start[-1]), np.int32)
        filled = self._edge_start.copy()
        spread_edges(*args, filled, self._edge_of_slot, False)
        self._clear = np.full(n_cells, 1 << 20, np.int32)
        if (parts.kind != RECTANGLE).any():
            measure_clearance(self._grid_int, self._edge_start, self._clear)
        counts = np.bincount(parts.compartment_of_edge) if len(parts.edges) else np.zeros(1)
        self._most_edges = int(counts.max())


def relax(
    points: ArrayLike,
    polygon: Shape | Sequence[Shape] | ArrayLike,
    iterations: int = 20,
    fixed: ArrayLike | None = None,
    density: ArrayLike | Density | DensityField | None = None,
    *,
    tolerance_mm: float = 0.0,
    over_relaxation: float = 1.0,
) -> NDArray[np.float64]:
    """Move free dots to the centroids of their clipped Voronoi cells, again and again.

    Parameters
    ----------
    points : (n, 2) array_like, mm
        Finite; not modified.
    polygon : shapely Polygon or MultiPolygon, (m, 2) array, or a list of them
        Bounds the dots; holes allowed.
    iterations : int
    fixed : (n,) array_like of bool, optional
        Dots that never move.
    density : (h, w) array_like, callable or DensityField, optional
        Weight: an array over the polygon's bounding box, row 0 at its least y, or a function
        of arrays x and y.
    tolerance_mm : float
        Stop once no dot moves further in a step.
    over_relaxation : float
        See `Relaxation`.

    Returns
    -------
    (n, 2) float64, mm

    Raises
    ------
    GeometryError
        If the polygon is not valid or a dot lies outside.
    """
    if iterations < 0:
        raise ParameterError(f"{iterations} is no number of steps", "iterations", "give 0 or more")
    engine = Relaxation(
        points,
        polygon,
        fixed,
        density=_as_field(density, polygon, np.size(points) // 2),
        over_relaxation=over_relaxation,
    )
    engine.run(iterations, tolerance_mm)
    return np.array(engine.points)


def _as_field(
    density: ArrayLike | Density | DensityField | None,
    polygon: Shape | Sequence[Shape] | ArrayLike,
    n: int,
) -> DensityField | None:
    if density is None or isinstance(density, DensityField):
        return density
    boxes = Compartments.of(polygon).box
    (x0, y0), (x1, y1) = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    if callable(density):
        longest = max(x1 - x0, y1 - y0)
        pixels = min(max(8.0 * math.sqrt(n), 64.0), 4096.0)
        w = max(round(pixels * (x1 - x0) / longest), 1)
        h = max(round(pixels * (y1 - y0) / longest), 1)
        x = x0 + (np.arange(w) + 0.5) * (x1 - x0) / w
        y = y0 + (np.arange(h) + 0.5) * (y1 - y0) / h
        values = np.broadcast_to(np.asarray(density(*np.meshgrid(x, y)), np.float64), (h, w))
    else:
        values = np.asarray(density, np.float64)
    if values.ndim != 2 or values.size == 0:
        raise ParameterError("a density is a 2-d field with at least one pixel", "density")
    h, w = values.shape
    return DensityField(values, ((x1 - x0) / w, (y1 - y0) / h), (x0, y0))


def _as_question(cancel: Cancel) -> Callable[[], bool] | None:
    return cancel.is_set if isinstance(cancel, threading.Event) else cancel


def _checked_points(points: ArrayLike) -> NDArray[np.float64]:
    xy = np.array(points, dtype=np.float64)
    if xy.size == 0:
        xy = xy.reshape(0, 2)
    if xy.ndim != 2 or xy.shape[1] != 2:
        raise ParameterError(f"positions have shape (n, 2), not {xy.shape}", "dots")
    bad = np.flatnonzero(~np.isfinite(xy).all(axis=1))
    if len(bad):
        raise GeometryError("its position is not finite", f"dot {bad[0]}", "drop it")
    return np.ascontiguousarray(xy)


def _checked(values, n, dtype, name, default):
    if values is None:
        return np.full(n, default, dtype)
    array = np.array(values, dtype=dtype)
    if array.shape != (n,):
        raise ParameterError(f"has shape {array.shape}, not ({n},)", name)
    return array
