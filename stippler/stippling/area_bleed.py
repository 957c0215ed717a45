"""Areas whose dots run off their border: laid out on a wider ground, and trimmed to their own."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.partition import Outline
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.border_policies import Pieces
from stippler.stippling.borders import Borders, along_line
from stippler.stippling.ground import AreaGround, Floats, Ground
from stippler.stippling.page_raster import (
    BLEED_SPACINGS,
    FEWEST_WITH_BLEED,
    LEAST_WIDTH,
    PageRaster,
)
from stippler.stippling.radii import solve_radii
from stippler.stippling.tone import DotRule, rule_for

_BAND, _CELLS = 3.0, 6.0  # mean spacings; dots beside the line, and those that bound their cells


def area_ground(
    reference: Reference,
    style: Style,
    outline_mm: Outline,
    pieces_mm: Pieces = (),
    *,
    bleeds: bool = True,
) -> AreaGround:
    """Return what an area's dots are laid out on; wider than itself where its border bleeds.

    Few dots, and those of narrow areas, lie within it from the start, as on a page.
    """
    own = AreaGround(reference, style, outline_mm)
    style = own.style
    if not (bleeds and style.weighted and style.is_relaxed and style.sizes == "tone"):
        return own
    size_mm = (reference.width_mm, reference.height_mm)
    borders = Borders.of(outline_mm, style.border, size_mm, pieces_mm)
    if not borders.bleeding:
        return own
    raster = own.raster
    n_dots = style.n_dots or float(raster.rule.density(raster.darkness).sum())
    spacing = math.sqrt(outline_mm.area / max(n_dots, 1.0))
    x0, y0, x1, y1 = outline_mm.bounds
    if n_dots < FEWEST_WITH_BLEED or min(x1 - x0, y1 - y0) < LEAST_WIDTH * spacing:
        return own
    wide = WideGround(reference, own, borders, BLEED_SPACINGS * spacing)
    return wide if wide.bleeds else own


class WideGround(AreaGround):
    """An area and a strip beyond the lines that bleed.

    Parameters
    ----------
    own : AreaGround
        The area itself; it takes over the rule for dots of which some are trimmed.
    """

    def __init__(
        self, reference: Reference, own: AreaGround, borders: Borders, width_mm: float
    ) -> None:
        whole, style = borders.grown(width_mm), own.style
        if style.n_dots is not None:
            n_dots = max(round(style.n_dots * whole.area / borders.outline.area), 1)
            style = replace(style, n_dots=n_dots)
        super().__init__(reference, style, whole, width_mm)
        self.style, self._own, self._borders = own.style, own, borders
        edge = np.concatenate([
            self.darkness_at(along_line(line, max(round(line.length / own.raster.pixel_mm), 1)))
            for line in borders.bleeding
        ])  # fmt: skip
        self.bleeds = bool(edge.any())
        if not self.bleeds:
            return
        side, sizes = own.raster.pixel_mm, style.size_range_mm
        in_px = None if sizes is None else (sizes[0] / side, sizes[1] / side)
        rule = rule_for(own.raster.darkness, own.style.n_dots, in_px, edge)
        own.raster = replace(own.raster, rule=rule)
        self.raster = replace(self.raster, rule=_scaled(rule, side / self.raster.pixel_mm))
        own.rim = Rim(borders, self.raster, self.origin_mm)

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
        radius = self.raster.radii(points) * side
        kept, at = self._borders.trimmed(at, radius, n_wanted)
        return own.inside(at[kept] - np.array(own.origin_mm)) / own.raster.pixel_mm


@dataclass(frozen=True, slots=True, eq=False)
class Rim:
    """Where an area's dots may bleed, and how dark it is there, seen without its border."""

    borders: Borders
    raster: PageRaster
    origin_mm: tuple[float, float]

    def evened(
        self, ground: AreaGround, points: Floats, give: float
    ) -> tuple[Floats, NDArray[np.bool_]]:
        """Move dots across the lines; return them, in pixels, and which are beside a line."""
        raster, corner = ground.raster, np.array(ground.origin_mm)
        side = raster.pixel_mm
        spacing = math.sqrt(self.borders.outline.area / max(len(points), 1))
        at = points * side + corner
        band = np.flatnonzero(self.borders.near(at, _CELLS * spacing))
        if len(band):
            n_in_box = round(raster.darkness.size * side**2 / spacing**2)
            *_, (_, radii) = solve_radii(points[band], raster.darkness, raster.rule, n_in_box)
            at[band] = self.borders.rim_evened(at[band], radii * side, self._darkness, give)
        evened = ground.inside(at - corner) / side
        return evened, self.borders.near(at, _BAND * spacing)

    def _darkness(self, at_mm: Floats) -> Floats:
        return _darkness_at(self.raster, self.origin_mm, at_mm).astype(np.float64)


def _darkness_at(
    raster: PageRaster, origin_mm: tuple[float, float], at_mm: Floats
) -> NDArray[np.float32]:
    return raster.darkness_under((at_mm - np.array(origin_mm)) / raster.pixel_mm)


def _scaled(rule: DotRule, by: float) -> DotRule:
    return replace(rule, radius_min=by * rule.radius_min, radius_max=by * rule.radius_max)
