"""Areas whose dots run off their border or see others: laid out on a wider ground, and trimmed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.halftone.scan_order import outside_polygon
from stippler.stippling.beyond import NOTHING, Beyond
from stippler.stippling.borders import Borders, along_line
from stippler.stippling.ground import AreaGround, Evened, Floats, Ground, without_dots_at
from stippler.stippling.halftone_area import edges_of
from stippler.stippling.near_lines import NearLines
from stippler.stippling.page_raster import (
    BLEED_SPACINGS,
    FEWEST_WITH_BLEED,
    LEAST_WIDTH,
    PageRaster,
)
from stippler.stippling.radii import solve_radii
from stippler.stippling.task import STIPPLE, Task
from stippler.stippling.tessellation import made
from stippler.stippling.tone import DotRule, rule_for

_STRIP = 2.0  # mean spacings that dots are laid out beyond a line; wider made no rim more even
_BAND, _CELLS = 3.0, 4.0  # mean spacings; dots beside the line, and those that bound their cells


def area_ground(task: Task) -> AreaGround:
    """Return what an area's dots are laid out on.

    It is wider than the area where its border bleeds, or is seen through. Few dots, and those of
    narrow areas, do without a bleed, as on a page.
    """
    reference, outline_mm = task.reference, task.parts_mm[0]
    assert reference is not None, "only relaxation does without a reference"
    own = AreaGround(reference, task.style, outline_mm)
    style = own.style
    may_see = style.weighted and style.is_relaxed and style.sizes == "tone"
    if not may_see or task.kind != STIPPLE:
        return own
    size_mm = (reference.width_mm, reference.height_mm)
    borders = Borders.of(outline_mm, style.border, size_mm, task.pieces_mm)
    if not (borders.bleeding or task.seen_mm):
        return own
    n_dots = style.n_dots or float(own.raster.rule.density(own.raster.darkness).sum())
    spacing = math.sqrt(outline_mm.area / max(n_dots, 1.0))
    beyond = _beyond(task, BLEED_SPACINGS * spacing, n_dots / outline_mm.area)
    x0, y0, x1, y1 = outline_mm.bounds
    if n_dots < FEWEST_WITH_BLEED or min(x1 - x0, y1 - y0) < LEAST_WIDTH * spacing:
        borders = Borders(outline_mm)
    borders = replace(borders, cut=beyond.cut)
    if not (borders.bleeding or task.seen_mm):
        return own
    run_over = NOTHING
    if borders.open and task.neighbours_mm is not None:
        width, fewest = BLEED_SPACINGS * spacing, n_dots / outline_mm.area
        run_over = Beyond.of(task.bleeds_onto_mm, outline_mm, task.neighbours_mm, width, fewest)
        bare = set(run_over.cut)
        lines = [line for one in task.bleeds_onto_mm for line in one.line.geoms]
        borders = borders.cut_at([line for line in lines if line not in bare])
    wide = WideGround(task, own, borders, _STRIP * spacing, beyond, run_over)
    return wide if wide.evens_rim or task.seen_mm or run_over.strips else own


def _beyond(task: Task, width_mm: float, per_mm2: float) -> Beyond:
    around = task.neighbours_mm
    if not task.seen_mm or around is None:
        return NOTHING
    return Beyond.of(task.seen_mm, task.parts_mm[0], around, width_mm, per_mm2)


class WideGround(AreaGround):
    """An area, a strip beyond the lines that bleed, and what is seen of its neighbours.

    Parameters
    ----------
    own : AreaGround
        The area itself; it takes over the rule for dots of which some are trimmed.
    borders : Borders
    width_mm : float
        Of the strip.
    beyond : Beyond
        What is seen through other pieces of border.
    run_over : Beyond
        Where the strip lies over dots of others: these are not seen, but sizes are solved among
        them, so that ink is not laid twice.
    """

    bleeds = True

    def __init__(
        self,
        task: Task,
        own: AreaGround,
        borders: Borders,
        width_mm: float,
        beyond: Beyond,
        run_over: Beyond,
    ) -> None:
        reference, style = task.reference, own.style
        assert reference is not None, "an area is drawn from a picture"
        whole = beyond.joined_to(borders.grown(width_mm))
        if style.n_dots is not None:
            n_dots = max(round(style.n_dots * whole.area / borders.outline.area), 1)
            style = replace(style, n_dots=n_dots)
        super().__init__(reference, style, whole, width_mm)
        self.style, self._own, self._borders, self._seen = own.style, own, borders, beyond
        rule, side = own.raster.rule, own.raster.pixel_mm
        edge = [
            self.darkness_at(along_line(line, max(round(line.length / side), 1)))
            for line in borders.bleeding
        ]
        self.evens_rim = any(dark.any() for dark in edge)
        if self.evens_rim:
            sizes = style.size_range_mm
            in_px = None if sizes is None else (sizes[0] / side, sizes[1] / side)
            darkness = own.raster.darkness
            rule = rule_for(darkness, own.style.n_dots, in_px, np.concatenate(edge))
            own.raster = replace(own.raster, rule=rule)
        self.raster = replace(self.raster, rule=_scaled(rule, side / self.raster.pixel_mm))
        if self.evens_rim:
            own.rim = Rim(borders, self.raster, self.origin_mm)
        if beyond.strips:
            assert task.neighbours_mm is not None, "their dots are seen"
            at = task.neighbours_mm[beyond.rows] - np.array(self.origin_mm)
            self.beyond = self.inside(at) / self.raster.pixel_mm
        if beyond.strips or run_over.strips:
            assert task.neighbours_mm is not None, "sizes are solved among them"
            rows = np.union1d(beyond.rows, run_over.rows)
            around = run_over.seen_with(beyond.seen_with(own.on_page_mm))
            own.see(around, task.neighbours_mm[rows])

    def open_to_dots(self, density: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return dots per square pixel without any where the neighbours' are."""
        if not len(self.beyond):
            return density
        closed = np.ones_like(density)
        for strip in self._seen.strips:
            edges = edges_of(strip) - np.tile(self.origin_mm, 2)
            mine = np.ones_like(density)
            outside_polygon(edges / self.raster.pixel_mm, mine)
            closed[mine > 0.0] = 0.0
        density *= closed
        wanted = float(density.sum(dtype=np.float64))
        density = without_dots_at(density, self.beyond)
        left = float(density.sum(dtype=np.float64))
        return density * np.float32(wanted / left) if left > 0.0 else density

    @property
    def after_trim(self) -> Ground:
        """Return the area itself."""
        return self._own

    def darkness_at(self, at_mm: Floats) -> NDArray[np.float32]:
        """Return how dark places of the page are."""
        return _darkness_at(self.raster, self.origin_mm, at_mm)

    def trimmed(self, points: Floats, n_wanted: int | None) -> Floats:
        """Return the dots of the area, and those of the strip that reach into it."""
        own, side = self._own, self.raster.pixel_mm
        at = points * side + np.array(self.origin_mm)
        strayed = self._seen.hold(at)
        at[strayed] = own.inside(at[strayed] - np.array(own.origin_mm)) + np.array(own.origin_mm)
        if not (self._borders.bleeding or self._borders.cut):
            return own.trimmed((at - np.array(own.origin_mm)) / own.raster.pixel_mm, n_wanted)
        radius = self.raster.radii(points) * side
        kept, at = self._borders.trimmed(at, radius, n_wanted)
        return own.inside(at[kept] - np.array(own.origin_mm)) / own.raster.pixel_mm


class Rim:
    """Where an area's dots may bleed, and how dark it is there, seen without its border.

    Sizes beside the lines are solved once, before any dot is moved across them.
    """

    def __init__(
        self, borders: Borders, raster: PageRaster, origin_mm: tuple[float, float]
    ) -> None:
        self.borders, self.raster, self.origin_mm = borders, raster, origin_mm
        self._band: NDArray[np.intp] | None = None
        self._edges: dict[int, Floats] = {}

    def _begin(self, ground: AreaGround, points: Floats) -> NDArray[np.intp]:
        """Find the dots beside the lines and their sizes; return which these are."""
        raster, side = ground.raster, ground.raster.pixel_mm
        self._spacing = math.sqrt(self.borders.outline.area / max(len(points), 1))
        self._lines = NearLines(self.borders.bleeding, _CELLS * self._spacing)
        near = self._lines.nearest(points * side + np.array(ground.origin_mm))
        band = np.flatnonzero(np.isfinite(near.away))
        others = ground.sized_among
        cells = ground.cells(np.concatenate((others, points)), len(others) + band)
        self._radius_mm = solve_radii(made(cells), raster.rule) * side
        return band

    def evened(self, ground: AreaGround, points: Floats, give: float) -> Evened:
        """Move dots across the lines; return them, in pixels, and which are beside a line."""
        if self._band is None:
            self._band = self._begin(ground, points)
        band, side, corner = self._band, ground.raster.pixel_mm, np.array(ground.origin_mm)
        before = points[band] * side + corner
        after = self.borders.rim_evened(
            before, self._radius_mm, self._darkness, give, self._lines, self._edges
        )
        moved = np.flatnonzero((after != before).any(axis=1))
        points = points.copy()
        points[band[moved]] = ground.inside(after[moved] - corner) / side
        beside, around = np.zeros((2, len(points)), np.bool_)
        around[band] = True
        beside[band] = self._lines.nearest(after).away < _BAND * self._spacing
        return Evened(points, beside, around)

    def _darkness(self, at_mm: Floats) -> Floats:
        return _darkness_at(self.raster, self.origin_mm, at_mm).astype(np.float64)


def _darkness_at(
    raster: PageRaster, origin_mm: tuple[float, float], at_mm: Floats
) -> NDArray[np.float32]:
    return raster.darkness_under((at_mm - np.array(origin_mm)) / raster.pixel_mm)


def _scaled(rule: DotRule, by: float) -> DotRule:
    return replace(rule, radius_min=by * rule.radius_min, radius_max=by * rule.radius_max)
