"""Lloyd's relaxation: every free dot moves to the centroid of its clipped cell."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.drawing.style import RELAXATIONS
from stippler.drawing.validation import floats, whole
from stippler.errors import GeometryError, ParameterError
from stippler.stippling.cells import Cells, Redirect
from stippler.stippling.coinciding import part_coinciding
from stippler.stippling.compartments import Compartments, Shape
from stippler.stippling.density import Density, DensityField
from stippler.stippling.field_sums import Weights
from stippler.stippling.picture_field import PictureField
from stippler.stippling.spacing import Rules, Wanted, rules_after
from stippler.stippling.tessellation import Making, Tessellation, made

__all__ = ["DensityField", "PictureField", "Relaxation", "RunReport", "StepReport", "relax"]

AT_REST = 0.005
"""Largest move of a step, in mean spacings, at which dots spaced by the rules have come to rest."""

Cancel = Callable[[], bool] | threading.Event | None


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
    reason : {"iterations", "tolerance", "rest", "cancelled"}
        At rest are dots spaced evenly once hardly any moves.
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
    density : DensityField or PictureField, optional
        Weight of the page, or of each shape by itself; a dot moves to the centre of mass of its
        cell. A dot whose cell has no mass keeps its place.
    over_relaxation : float
        The share of the way to the centroid that a dot goes, above 0 and below 2.
    method : {"lloyd", "even", "delaunay-mean", "springs"}
        "even" spaces dots by rules that leave no rows and come to rest, in proportion to the
        density; the last two are the paper's comparisons.
    wanted : Wanted or one for each shape, optional
        How dense and how large "even" has dots to be by levels of the density.
    radius_mm : (n,) array_like, optional
        The dots' own sizes, by which "even" spaces them then.
    is_met : (n,) array_like of bool, optional
        Dots whose cells say too little of what they want, as beside an edge that others lay beyond:
        "even" takes it as met.

    Raises
    ------
    GeometryError
        If a compartment is not valid, or a dot lies outside.

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
        density: Weights | None = None,
        over_relaxation: float = 1.0,
        *,
        method: str = "lloyd",
        wanted: Wanted | Sequence[Wanted] | None = None,
        radius_mm: ArrayLike | None = None,
        is_met: ArrayLike | None = None,
    ) -> None:
        if method not in RELAXATIONS:
            raise ParameterError(
                f"{method!r} is not known", "method", f"give one of {', '.join(RELAXATIONS)}"
            )
        self._method = method
        xy = _checked_points(points)
        n = len(xy)
        self._fixed = _checked(fixed, n, np.bool_, "fixed", False)
        over = floats(over_relaxation, "over-relaxation")
        if over.ndim or not 0.0 < over < 2.0:
            raise ParameterError(
                f"{over_relaxation} is out of range", "over-relaxation", "give 0 < w < 2"
            )
        self._parts = Compartments.of(polygon)
        shape_of_dot = None
        if compartment_of_dot is not None:
            shape_of_dot = _checked(compartment_of_dot, n, np.int32, "compartment_of_dot", 0)
        found = self._parts.find(xy, shape_of_dot)
        part_coinciding(xy, found, self._parts, self._fixed)
        self._density = density
        self._cells = Cells(xy, self._fixed, found, self._parts, density, float(over))
        self._rules: Rules | None = None
        self._n_done = 0
        if method == "even":
            if wanted is None:
                wanted = _in_proportion(density, int(self._parts.shape_of[-1]) + 1)
            own = None if radius_mm is None else _checked(radius_mm, n, np.float64, "radius", 0)
            self._cells.space_by(wanted, own, _checked(is_met, n, np.bool_, "is_met", False))

    @property
    def points(self) -> NDArray[np.float64]:
        """Positions in mm, in the order given: a fresh read-only array."""
        out = self._cells.xy
        out.flags.writeable = False
        return out

    def __len__(self) -> int:
        return self._cells.n

    def set_rules(self, rules: Rules) -> None:
        """Change how strictly the next steps of "even" space dots; they loosen no more by then."""
        self._rules = rules

    @property
    def spacing_mm(self) -> float:
        """The dots' mean spacing: the root of the area that each has."""
        return self._cells.spacing

    @property
    def n_failed(self) -> int:
        """How many cells the last step could not carry over from the one before."""
        return self._cells.n_failed

    def step(self, cancel: Cancel = None, redirect: Redirect | None = None) -> StepReport:
        """Move every free dot once.

        Parameters
        ----------
        cancel : callable or threading.Event, optional
        redirect : callable, optional
            Called with where dots are and where the step would take them, (n, 2) mm each, in the
            order given, once all centroids are known; returns where they shall go instead. Fixed
            dots stay; so does one that would be sent out of its compartment, but for those that it
            says `may_cross` to another. Not by "delaunay-mean" and "springs".

        Returns
        -------
        StepReport
            Zeros if `cancel` came before the end; then nothing has moved.
        """
        report = self._step(_as_question(cancel), redirect)
        return report or StepReport(0.0, 0.0, 0)

    def run(
        self,
        iterations: int,
        tolerance_mm: float = 0.0,
        cancel: Cancel = None,
        progress: Callable[[int, StepReport], None] | None = None,
        redirect: Redirect | None = None,
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
        redirect : callable, optional
            As for `step`.
        """
        asked = _as_question(cancel)
        steps: list[StepReport] = []
        for i in range(iterations):
            report = self._step(asked, redirect)
            if report is None:
                return RunReport("cancelled", tuple(steps))
            steps.append(report)
            if progress is not None:
                progress(i + 1, report)
            if tolerance_mm > 0.0 and report.largest_mm <= tolerance_mm:
                return RunReport("tolerance", tuple(steps))
            if self._method == "even" and report.largest_mm <= AT_REST * self._cells.spacing:
                return RunReport("rest", tuple(steps))
        return RunReport("iterations", tuple(steps))

    def cell_areas(self) -> NDArray[np.float64]:
        """Return the area of each dot's clipped cell, mm², in the order given."""
        return self._cells.measure(weighted=False)[:, 0]

    def cell_masses(self) -> NDArray[np.float64]:
        """Return the density's integral over each dot's clipped cell, in the order given."""
        return self._cells.measure(weighted=True)[:, 0]

    def centroids(self) -> NDArray[np.float64]:
        """Return the (weighted) centroid of each dot's clipped cell, mm, in the order given."""
        return self.points + self._cells.measure(weighted=True)[:, 1:3]

    def tessellation(self, weighted: bool = True) -> Tessellation:
        """Return all cells, clipped, in the order given; masses by the density if `weighted`."""
        return made(self.outlining(weighted))

    def outlining(self, weighted: bool = True, which: NDArray[np.integer] | None = None) -> Making:
        """Compute all cells, or those of the dots `which`, (k,) int, a part after the other."""
        return Tessellation.of_cells(self._cells, weighted, which)

    def energy(self) -> float:
        """Return the sum over cells of the second moment of area about the dot, mm⁴."""
        return float(self._cells.measure(weighted=False)[:, 4].sum())

    def _step(
        self, cancel: Callable[[], bool] | None, redirect: Redirect | None = None
    ) -> StepReport | None:
        if self._method not in ("lloyd", "even"):
            return self._step_by_neighbours()
        if self._method == "even":
            self._cells.set_rules(self._rules or rules_after(self._n_done))
        gone = self._cells.step(cancel, redirect)
        if gone is None:
            return None
        self._n_done += 1
        n_free = len(self) - int(np.count_nonzero(self._fixed))
        if not n_free:
            return StepReport(0.0, 0.0, 0)
        return StepReport(
            float(gone.sum()) / n_free, float(gone.max()), int(np.count_nonzero(gone))
        )

    def _step_by_neighbours(self) -> StepReport:
        from stippler.stippling.delaunay import step_by_neighbours

        before, cells = self._cells.xy, self._cells
        owner = np.empty(len(self), np.int32)
        owner[cells.order] = cells.compartment_of_dot
        after = step_by_neighbours(before, self._fixed, owner, self._parts, self._method)
        self._cells = Cells(after, self._fixed, owner, self._parts, self._density, cells.over)
        gone = np.hypot(*(after - before).T)
        n_free = max(len(self) - int(np.count_nonzero(self._fixed)), 1)
        return StepReport(
            float(gone.sum()) / n_free,
            float(gone.max(initial=0.0)),
            int(np.count_nonzero(gone)),
        )


def relax(
    points: ArrayLike,
    polygon: Shape | Sequence[Shape] | ArrayLike,
    iterations: int = 20,
    fixed: ArrayLike | None = None,
    density: ArrayLike | Density | Weights | None = None,
    *,
    method: str = "lloyd",
    compartment_of_dot: ArrayLike | None = None,
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
    density : (h, w) array_like, callable, DensityField or PictureField, optional
        Weight: an array over the polygon's bounding box, row 0 at its least y, or a function
        of arrays x and y.
    method : {"lloyd", "even", "delaunay-mean", "springs"}
        "even" leaves no rows and comes to rest; dots are as dense as the density says. The last
        two are for comparison: they know no border and no density.
    compartment_of_dot, tolerance_mm, over_relaxation
        See `Relaxation`.

    Returns
    -------
    (n, 2) float64, mm

    Raises
    ------
    GeometryError
        If the polygon is not valid or a dot lies outside.
    """
    if whole(iterations, "iterations") < 0:
        raise ParameterError(f"{iterations} is no number of steps", "iterations", "give 0 or more")
    tolerance = floats(tolerance_mm, "tolerance")
    if tolerance.ndim or not tolerance >= 0.0:
        raise ParameterError(f"{tolerance_mm} is no length", "tolerance", "give 0 or more")
    if density is not None and not isinstance(density, DensityField | PictureField):
        boxes = Compartments.of(polygon).box
        box = np.concatenate([boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)])
        density = DensityField.over_box(density, box, np.size(points) // 2)
    engine = Relaxation(
        points, polygon, fixed, compartment_of_dot, density, over_relaxation, method=method
    )
    engine.run(int(iterations), float(tolerance))
    return np.array(engine.points)


def _in_proportion(density: Weights | None, n_shapes: int) -> Wanted | list[Wanted]:
    if density is None:
        return Wanted.uniform()
    if isinstance(density, DensityField):
        return Wanted.in_proportion(density.values)
    each = [Wanted.in_proportion(table) for table in density.tables]
    if density.table_of_shape is None:
        return each[0]
    return [each[k] for k in density.table_of_shape[:n_shapes]]


def _as_question(cancel: Cancel) -> Callable[[], bool] | None:
    return cancel.is_set if isinstance(cancel, threading.Event) else cancel


def _checked_points(points: ArrayLike) -> NDArray[np.float64]:
    xy = floats(points, "dots")
    if xy.size == 0:
        xy = xy.reshape(0, 2)
    if xy.ndim != 2 or xy.shape[1] != 2:
        raise ParameterError(f"positions have shape (n, 2), not {xy.shape}", "dots")
    bad = np.flatnonzero(~np.isfinite(xy).all(axis=1))
    if len(bad):
        raise GeometryError("its position is not finite", f"dot {bad[0]}", "drop it")
    return xy


def _checked(
    values: ArrayLike | None, n: int, dtype: type[np.generic], name: str, default: float
) -> NDArray[Any]:
    if values is None:
        return np.full(n, default, dtype)
    numbers = floats(values, name)
    if numbers.shape != (n,):
        raise ParameterError(f"has shape {numbers.shape}, not ({n},)", name)
    with np.errstate(invalid="ignore"):
        array = numbers.astype(dtype)
    bad = np.flatnonzero(array != numbers)
    if len(bad):
        kind = "true or false" if dtype is np.bool_ else "a whole number"
        raise ParameterError(f"{numbers[bad[0]]:g}, for dot {bad[0]}, is not {kind}", name)
    return array
