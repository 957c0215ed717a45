"""The dots of an area while they are made: what each stage of the pipeline advances."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.style import Style
from stippler.stippling.ground import Ground, PageGround
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.progress import DONE, Progress, Step
from stippler.stippling.task import STIPPLE, Task
from stippler.stippling.tone import Shortfall

if TYPE_CHECKING:
    from stippler.drawing.run import Holding

Floats = NDArray[np.float64]
_NOTHING = np.empty((0, 2)), np.empty(0)


@dataclass(slots=True, eq=False)
class Draft:
    """Arrays, the raster that they lie on, and the rule for its dots; lengths are pixels.

    Attributes
    ----------
    task : Task
    ground : Ground
    points : (n, 2) float64
    radii : (n,) float64 or None
        None while they are what the rule gives for the darkness under each dot.
    fixed : (n,) bool or None
        Dots that stay where they are.
    stand : (k, 2) float64
        Dots that are there already, and are not made anew.
    shortfall : Shortfall or None
        What the ink falls short of, once it is known.
    holding : Holding or None
        Which lines hold dots, once some have lined up.
    is_sized : bool
        Whether sizes were solved, within a range.
    """

    task: Task
    ground: Ground
    points: Floats
    radii: Floats | None = None
    fixed: NDArray[np.bool_] | None = None
    stand: Floats = field(default_factory=lambda: np.empty((0, 2)))
    shortfall: Shortfall | None = None
    holding: Holding | None = None
    is_sized: bool = False

    @classmethod
    def of(cls, task: Task) -> Draft:
        """Begin a task that makes dots or goes on with some."""
        reference, style = task.reference, task.style
        assert reference is not None, "only relaxation does without a reference"
        ground: Ground
        if task.parts_mm:
            from stippler.stippling.area_bleed import area_ground

            ground = area_ground(task)
        else:
            ground = PageGround(reference, style, with_bleed=task.kind == STIPPLE)
        draft = cls(task, ground, np.empty((0, 2)))
        standing, raster = task.standing, ground.raster
        if standing is None:
            return draft
        at = ground.inside(standing.position_mm - np.array(ground.origin_mm))
        if task.kind == STIPPLE:
            draft.stand = at / raster.pixel_mm
            return draft
        draft.points = at / raster.pixel_mm
        draft.radii = np.asarray(standing.radius_mm, np.float64) / raster.pixel_mm
        draft.fixed = standing.fixed
        return draft

    @property
    def raster(self) -> PageRaster:
        """What the dots lie on."""
        return self.ground.raster

    @property
    def style(self) -> Style:
        """How they are drawn, with a number if one is to be met."""
        return self.ground.style

    @property
    def goes_on(self) -> bool:
        """Whether just these dots are wanted, none more and none less."""
        return self.task.kind != STIPPLE

    @property
    def n_wanted(self) -> int | None:
        """How many dots are to be made; None where that follows from their sizes."""
        n_dots = self.style.n_dots
        return None if n_dots is None else max(n_dots - len(self.stand), 0)

    def shown(self) -> tuple[Floats, Floats]:
        """Return places and radii of the dots that were made, in pixels, as they are now."""
        if self.radii is None:
            points = self.ground.trimmed(self.points, self.n_wanted)
            return points, self.ground.after_trim.raster.radii(points)
        return self.points, self.radii

    def progress(self, step: Step, watched: bool) -> Progress:
        """Return a snapshot after a step."""
        points, radii = self.shown() if watched else _NOTHING
        return Progress(step.stage, step.done, step.total, *self._on_page(points, radii),
                        step.movement_mm)  # fmt: skip

    def finished(self) -> Progress:
        """Return the last snapshot."""
        lack = self.shortfall
        if lack is not None and lack.box_mm is not None:
            (x0, y0, x1, y1), (x, y) = lack.box_mm, self.ground.origin_mm
            lack = replace(lack, box_mm=(x0 + x, y0 + y, x1 + x, y1 + y))
        made = self._on_page(*self.shown())
        rule, pixel = self.raster.rule, self.raster.pixel_mm
        limits = (rule.radius_min * pixel, rule.radius_max * pixel) if self.is_sized else None
        return Progress(DONE, 1, 1, *made, shortfall=lack, holding=self.holding, limits_mm=limits)

    def _on_page(
        self, points: Floats, radii: Floats
    ) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
        ground = self.ground.after_trim
        position, radius = ground.raster.on_page(points, radii)
        return ground.on_page(position), radius
