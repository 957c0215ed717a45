"""Relaxation of a finished drawing that keeps its tone.

Density follows from the tone and from the dots' own sizes. Sizes that were solved for the tone are
solved again where the dots come to lie; sizes that a person has set stay.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import median_filter
from scipy.spatial import KDTree

from stippler.drawing.reference import Reference
from stippler.stippling.compartments import Shape
from stippler.stippling.density import DensityField
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.radii import solve_radii
from stippler.stippling.relax import AT_REST, Relaxation
from stippler.stippling.spacing import AT_LAST, TO_INK, Wanted
from stippler.stippling.tone import DotRule, ink_for
from stippler.stippling.transport import with_long_waves_gone

_SOLVED = 0.08  # a size nearer to the solved one than this share of it was solved
_LEVELS = 65
_RESTLESS, _RINGS = 0.1, 2  # a move, in spacings, that wakes the neighbours within so many rings
_BESIDE = 1.0  # spacings; dots nearer to the page's edge hold still, the bleed's being gone

Arrays = tuple[NDArray[np.float64], NDArray[np.float32] | None]


def relaxed_all(
    position_mm: NDArray[np.float64],
    radius_mm: NDArray[np.float32],
    outlines: Sequence[Shape | NDArray[np.float64]],
    fixed: NDArray[np.bool_],
    outline_of_dot: NDArray[np.integer],
    reference: Reference | None,
    steps: int,
) -> Iterator[Arrays]:
    """Space the free dots of a drawing evenly, each within its outline.

    Yields
    ------
    position_mm : (n, 2) float64
        After each step.
    radius_mm : (n,) float32 or None
        Sizes for these places; given once, at the end, where any were solved.
    """
    if reference is None or not len(position_mm):
        position_mm = with_long_waves_gone(position_mm, outlines, outline_of_dot, fixed)
        engine = Relaxation(position_mm, outlines, fixed, outline_of_dot, method="even")
        for _ in range(steps):
            report = engine.step()
            yield engine.points, None
            if report.largest_mm <= AT_REST * engine.spacing_mm:
                return
        return
    sheet = _Sheet(position_mm, radius_mm, reference)
    still = fixed | sheet.beside(position_mm)
    before_mm = position_mm
    position_mm = with_long_waves_gone(
        position_mm, outlines, outline_of_dot, still, sheet.density_at
    )
    field = DensityField(sheet.raster.darkness, sheet.raster.pixel_mm)

    def engine_for(still: NDArray[np.bool_]) -> Relaxation:
        return Relaxation(
            position_mm, outlines, still, outline_of_dot, field,
            method="even", wanted=sheet.wanted, radius_mm=sheet.sizes,
        )  # fmt: skip

    engine = engine_for(still)
    engine.set_rules(AT_LAST)
    engine.step()
    awake = _around_restless(position_mm, engine.points, ~still)
    awake |= (position_mm != before_mm).any(axis=1)
    if not awake.any():
        yield position_mm, None
        return
    engine = engine_for(~awake)
    last = int(bool(sheet.is_solved.any()) and steps > 1)
    for _ in range(steps - last):
        report = engine.step()
        yield engine.points, None
        if report.largest_mm <= AT_REST * engine.spacing_mm:
            break
    if last:
        engine.set_rules(TO_INK)
        engine.step()
        yield engine.points, None
    yield engine.points, sheet.solved_at(engine.points)


def _around_restless(
    before_mm: NDArray[np.float64], after_mm: NDArray[np.float64], free: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Tell which free dots are not at rest, or lie around such: the others need not move."""
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

    def __init__(
        self, position_mm: NDArray[np.float64], radius_mm: NDArray[np.float32], reference: Reference
    ) -> None:
        self.radius_mm = radius_mm
        self.raster = PageRaster.of(reference, len(position_mm), None, bleeds=False)
        pixel = self.raster.pixel_mm
        sizes = radius_mm.astype(np.float64)
        self.rule = DotRule(float(sizes.min()) / pixel, float(sizes.max()) / pixel)
        self.is_solved = np.zeros(len(sizes), np.bool_)
        solved = self._solved(position_mm)
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
        spacing = np.sqrt(size.prod() / len(position_mm))
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
        *_, (_, radii) = solve_radii(inside, self.raster.darkness, self.rule)
        return radii * pixel

    def _size_by_darkness(
        self, position_mm: NDArray[np.float64], sizes: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the sizes that dots usually have at levels of darkness."""
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
