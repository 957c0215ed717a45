"""Relaxation of a finished drawing that keeps its tone.

Density follows from the tone and from the dots' own sizes. Sizes that were solved for the tone are
solved again where the dots come to lie; sizes that a person has set stay.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.reference import Reference
from stippler.drawing.run import Holding
from stippler.stippling.compartments import Shape
from stippler.stippling.density import DensityField
from stippler.stippling.ground import brought_into
from stippler.stippling.lines import tone_along
from stippler.stippling.on_lines import OnLines
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.picture_field import PictureField
from stippler.stippling.progress import DONE, RELAXED, Progress, Step
from stippler.stippling.radii import solve_radii
from stippler.stippling.relax import AT_REST, Relaxation, StepReport
from stippler.stippling.spacing import AT_LAST, TO_INK, Wanted
from stippler.stippling.task import Standing, Task
from stippler.stippling.tessellation import Tessellation, made
from stippler.stippling.tone import DotRule, ink_for
from stippler.stippling.transport import with_long_waves_gone

_SOLVED = 0.08  # a size nearer to the solved one than this share of it was solved
_LEVELS = 65
_RESTLESS, _RINGS = 0.1, 2  # a move, in spacings, that wakes the neighbours within so many rings
_WHOLE = 1e-6  # of the page
_INSET_MM = 1e-6  # how far within the border a dot lies that was brought back
_BY_CELLS = ("lloyd", "even")  # methods whose steps others may redirect
_BESIDE = 1.0  # spacings; dots nearer to the page's edge hold still, the bleed's being gone

Floats = NDArray[np.float64]


@dataclass(slots=True, eq=False)
class StandingDraft:
    """A drawing's own dots while they are spaced anew; lengths are mm.

    Attributes
    ----------
    points : (n, 2) float64
    radius_mm : (n,) float32
    """

    task: Task
    standing: Standing
    points: Floats
    radius_mm: NDArray[np.float32]
    sheet: _Sheet | None = None
    on_lines: OnLines | None = None

    @classmethod
    def of(cls, task: Task) -> StandingDraft:
        """Begin a task that moves what is there."""
        standing = task.standing
        assert standing is not None, "there is nothing to be moved"
        draft = cls(task, standing, standing.position_mm, standing.radius_mm)
        if task.lines is not None and task.style.relaxation in _BY_CELLS and len(draft.points):
            draft.on_lines = OnLines(task.lines, draft.points, draft.parts, draft.tone)
            if draft.on_lines.is_idle:
                draft.on_lines = None
        return draft

    @property
    def tone(self) -> Callable[[Floats], Floats] | None:
        """How dense dots are to lie along lines."""
        return tone_along(self.task.reference) if self.task.style.weighted else None

    @property
    def n_steps(self) -> int:
        """How many steps are to be taken."""
        return self.task.style.iterations if self.task.steps is None else self.task.steps

    @property
    def keeps_tone(self) -> bool:
        """Whether there is a picture whose tone the dots keep while they are spaced evenly."""
        style = self.task.style
        return self.task.reference is not None and style.relaxation == "even" and style.weighted

    @property
    def parts(self) -> list[Shape]:
        """What the dots do not leave."""
        return list(self.task.parts_mm)

    @property
    def fixed(self) -> NDArray[np.bool_]:
        """Those that stay where they are."""
        fixed = self.standing.fixed
        if fixed is None:
            fixed = np.zeros(len(self.points), np.bool_)
        return fixed if self.on_lines is None else fixed & ~self.on_lines.on

    @property
    def on_line(self) -> NDArray[np.bool_]:
        """Those that move along lines."""
        return np.zeros(len(self.points), np.bool_) if self.on_lines is None else self.on_lines.on

    def without_long_waves(self, still: NDArray[np.bool_], sheet: _Sheet | None = None) -> Floats:
        """Return where the dots lie without long waves in them, each within its part."""
        of_dot = self.standing.part_of_dot
        if of_dot is None:
            of_dot = np.zeros(len(self.points), np.intp)
        density = None if sheet is None else sheet.density_at
        return with_long_waves_gone(self.points, self.parts, of_dot, still, density)

    def come_home(self) -> Floats:
        """Return where the dots are, those that have left their own areas brought back."""
        homes = self.standing.homes
        points = self.points.copy() if homes else self.points
        for rows, home in homes:
            at = points[rows]
            out = np.flatnonzero(~shapely.intersects_xy(home, at[:, 0], at[:, 1]))
            if len(out):
                points[rows[out]] = brought_into(home, at[out], _INSET_MM)
        return points

    def progress(self, step: Step, watched: bool) -> Progress:
        """Return a snapshot after a step."""
        points = _frozen(self.come_home()) if watched else np.empty((0, 2))
        sizes = self.radius_mm if watched else np.empty(0, np.float32)
        holding = self._holding() if watched else None
        return Progress(step.stage, step.done, step.total, points, _frozen(sizes),
                        step.movement_mm, None, holding)  # fmt: skip

    def finished(self) -> Progress:
        """Return the last snapshot."""
        points, sizes = _frozen(self.come_home()), _frozen(self.radius_mm)
        return Progress(DONE, 1, 1, points, sizes, holding=self._holding())

    def _holding(self) -> Holding | None:
        if self.on_lines is None or self.task.lines is None:
            return None
        self.on_lines.take_back_refused(self.points)
        return self.task.lines.holding(self.on_lines.line, self.on_lines.along)


def space(draft: StandingDraft, watched: bool) -> Iterator[Step]:
    """Space the free dots, each within its part; those at rest are left alone."""
    total = draft.n_steps
    yield Step(RELAXED, 0, total)
    if not len(draft.points):
        return
    steps = _keeping_tone(draft, total) if draft.keeps_tone else _by_method(draft, total)
    for k, report in enumerate(steps, start=1):
        yield Step(RELAXED, min(k, total), total, float(report.mean_mm))


def size_again(draft: StandingDraft, watched: bool) -> Iterator[Step]:
    """Solve sizes for the places where the dots are now; those a person has set stay."""
    draft.points = draft.come_home()
    if draft.sheet is not None:
        solved = draft.sheet.solved_at(draft.points)
        draft.radius_mm = draft.radius_mm if solved is None else solved
    yield from ()


def sizes_over_solved(task: Task) -> NDArray[np.float64]:
    """Return how much larger standing dots are than their tone asks for, (n,).

    1 for those whose sizes were solved; others were set by a person.
    """
    draft, reference = StandingDraft.of(task), task.reference
    assert reference is not None, "without one there is no tone to compare with"
    sheet = _Sheet(draft, reference)
    share = draft.radius_mm / np.maximum(sheet.solved_mm, 1e-9)
    return np.where(sheet.is_solved, 1.0, share)


def _by_method(draft: StandingDraft, total: int) -> Iterator[StepReport]:
    style, reference, standing = draft.task.style, draft.task.reference, draft.standing
    field = None
    if style.weighted and reference is not None:
        # dots settle at the root of their weight
        field = PictureField.of(reference, ((np.square,),))
    evenly = reference is None and style.relaxation == "even"
    method = "lloyd" if style.relaxation == "even" and not evenly else style.relaxation
    if evenly:
        draft.points = draft.without_long_waves(draft.fixed | draft.on_line)
    engine = Relaxation(
        draft.points, draft.parts, draft.fixed, standing.part_of_dot, field, method=method
    )
    for _ in range(total):
        report = engine.step(redirect=draft.on_lines)
        draft.points = engine.points
        yield report
        if evenly and report.largest_mm <= AT_REST * engine.spacing_mm:
            return


def _keeping_tone(draft: StandingDraft, total: int) -> Iterator[StepReport]:
    reference, standing = draft.task.reference, draft.standing
    assert reference is not None, "without one there is no tone to keep"
    before = draft.points
    sheet = _Sheet(draft, reference)
    on_line = draft.on_line
    beside = sheet.beside(before)
    still = (draft.fixed | beside) & ~on_line
    start = draft.without_long_waves(still | on_line, sheet)
    field = DensityField(sheet.raster.darkness, sheet.raster.pixel_mm)

    def engine_for(still: NDArray[np.bool_]) -> Relaxation:
        return Relaxation(
            start, draft.parts, still, standing.part_of_dot, field,
            method="even", wanted=sheet.wanted, radius_mm=sheet.sizes, is_met=beside,
        )  # fmt: skip

    engine = engine_for(still)
    engine.set_rules(AT_LAST)
    lines = None if draft.on_lines is None else draft.on_lines.copy()
    report = engine.step(redirect=lines)
    awake = _around_restless(start, engine.points, ~still)
    awake |= (start != before).any(axis=1)
    if lines is not None:
        awake |= _wakened_by(lines, start, engine.points, on_line, engine.spacing_mm)
    if not awake.any():
        yield report
        return
    awake |= on_line
    engine = engine_for(~awake)
    draft.sheet = sheet
    last = int(bool(sheet.is_solved.any()) and total > 1)
    for _ in range(total - last):
        report = engine.step(redirect=draft.on_lines)
        draft.points = engine.points
        yield report
        if report.largest_mm <= AT_REST * engine.spacing_mm:
            break
    if last:
        engine.set_rules(TO_INK)
        report = engine.step(redirect=draft.on_lines)
        draft.points = engine.points
        yield report


def _wakened_by(
    lines: OnLines, before: Floats, after: Floats, on_line: NDArray[np.bool_], spacing_mm: float
) -> NDArray[np.bool_]:
    """Tell which dots move along lines, or are drawn to one."""
    moved = np.hypot(*(after - before).T) > AT_REST * spacing_mm
    return np.asarray((moved & on_line) | (lines.on & ~on_line) | lines.drawn)


def _frozen(values: NDArray[Any]) -> NDArray[Any]:
    if values.flags.writeable:
        values = values.copy()
        values.flags.writeable = False
    return values


def _around_restless(
    before_mm: NDArray[np.float64], after_mm: NDArray[np.float64], free: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Tell which free dots are not at rest, or lie around such: the others need not move."""
    from scipy.spatial import KDTree  # which takes a while to import

    tree = KDTree(before_mm)
    near = np.asarray(tree.query(before_mm, k=min(7, len(before_mm)))[0])
    spacing = near[:, 1:].mean(axis=1) if near.ndim == 2 else np.ones(1)
    restless = np.hypot(*(after_mm - before_mm).T) > _RESTLESS * spacing
    awake: NDArray[np.bool_] = np.array(restless)
    for _ in range(_RINGS):
        wakes = np.asarray(tree.query(before_mm[awake], k=min(9, len(before_mm)))[1])
        awake[wakes.ravel()] = True
    awake &= free
    return awake


class _Sheet:
    """A finished drawing on the raster of its reference: which sizes were solved, and the rule."""

    def __init__(self, draft: StandingDraft, reference: Reference) -> None:
        position_mm, radius_mm = draft.points, draft.radius_mm
        self.radius_mm = radius_mm
        self.raster = PageRaster.of(reference, len(position_mm), None, bleeds=False)
        pixel = self.raster.pixel_mm
        w, h = self.raster.size_mm
        parts, of_dot = draft.task.parts_mm, draft.standing.part_of_dot
        covered = sum(part.area for part in parts)
        self._covered_mm2 = min(covered, w * h)
        self._within = None  # the cells are the page's, where all of it takes part
        if covered < (1.0 - _WHOLE) * w * h:
            self._within = [shapely.transform(p, lambda xy: xy / pixel) for p in parts], of_dot
        sizes = radius_mm.astype(np.float64)
        self.rule = DotRule(float(sizes.min()) / pixel, float(sizes.max()) / pixel)
        self.is_solved = np.zeros(len(sizes), np.bool_)
        self.solved_mm = solved = self._solved(position_mm)
        self.is_solved = np.abs(sizes - solved) < _SOLVED * solved
        levels, typical = self._size_by_darkness(position_mm, sizes)
        per_dot = np.pi * typical**2
        self.wanted = Wanted(ink_for(levels) / per_dot, typical)
        if self.is_solved.all():
            self.sizes = None
        else:
            darkness = reference.at(position_mm)
            self.sizes = np.where(self.is_solved, np.interp(darkness, levels, typical), sizes)

    def beside(self, position_mm: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Tell which dots lie so near to the edge of the page that its bleed held them."""
        size = np.array(self.raster.size_mm)
        spacing = np.sqrt(self._covered_mm2 / len(position_mm))
        near = np.minimum(position_mm, size - position_mm).min(axis=1) < _BESIDE * spacing
        return np.asarray(near, np.bool_)

    def density_at(self, position_mm: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return how dense dots are to be at some places, in any unit; none beyond the page."""
        px = position_mm / self.raster.pixel_mm
        beyond = (px < 0.0) | (px >= np.array(self.raster.darkness.shape[::-1]))
        inside = np.asarray(~beyond.any(axis=1))
        level = self.raster.darkness_under(np.where(inside[:, None], px, 0.0)) * self.wanted.scale
        per_area = np.interp(level, np.arange(len(self.wanted.per_area)), self.wanted.per_area)
        return np.where(inside, per_area, 0.0)

    def solved_at(self, position_mm: NDArray[np.float64]) -> NDArray[np.float32] | None:
        """Return sizes for the tone at these places; those not solved before stay."""
        if not self.is_solved.any():
            return None
        solved = self._solved(position_mm).astype(np.float32)
        return np.where(self.is_solved, solved, self.radius_mm)

    def _solved(self, position_mm: NDArray[np.float64]) -> NDArray[np.float64]:
        pixel = self.raster.pixel_mm
        inside = np.clip(position_mm, 0.0, self.raster.size_mm) / pixel
        if self._within is None:
            cells = made(self.raster.cells(inside))
        else:
            parts, of_dot = self._within
            field = DensityField(self.raster.darkness, 1.0)
            cells = Tessellation.of(inside, parts, of_dot, field)
        return solve_radii(cells, self.rule) * pixel

    def _size_by_darkness(
        self, position_mm: NDArray[np.float64], sizes: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the sizes that dots usually have at levels of darkness."""
        from scipy.ndimage import median_filter  # a quarter of a second to import

        levels = np.linspace(0.0, 1.0, _LEVELS)
        inside = np.clip(position_mm, 0.0, self.raster.size_mm) / self.raster.pixel_mm
        under = self.raster.darkness_under(inside)
        some = self.is_solved if self.is_solved.any() else np.ones(len(sizes), np.bool_)
        bins = np.rint(under[some] * (_LEVELS - 1)).astype(np.intp)
        known = np.unique(bins)
        order = np.argsort(bins, kind="stable")
        groups = np.split(sizes[some][order], np.searchsorted(bins[order], known)[1:])
        middles = np.array([np.median(group) for group in groups])
        typical = np.interp(levels, levels[known], middles)
        return levels, median_filter(typical, 5, mode="nearest")
