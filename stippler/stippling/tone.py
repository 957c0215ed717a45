"""Tone: how many dots of which size lay down the ink that a darkness asks for.

Density and radius follow from darkness by one rule, so that the union of the discs covers just
the darkness; neither is scaled by it alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.kernels.coverage import blur_columns, blur_rows, cover
from stippler.kernels.pool import run_ranges

_COVERAGE = np.array([0.0, 0.8, 0.85, 0.9, 0.95, 0.98, 0.99, 1.0])
_INK = np.array([0.0, 0.8, 0.855, 0.925, 1.02, 1.11, 1.16, 1.3])
"""Summed area of the discs on a unit of page, overlaps counted twice, that covers so much of it;
for relaxed dots of locally equal size."""

_BINS = 1024


def ink_for(darkness: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the summed disc area that covers a share `darkness` of the page."""
    ink: NDArray[np.float64] = np.interp(darkness, _COVERAGE, _INK)
    return ink


@dataclass(frozen=True, slots=True)
class Rule:
    """The joint rule for radius and density.

    Attributes
    ----------
    radius_min, radius_max : float
        The allowed range, in any one unit of length.
    scale : float
        Multiplies the radius that the rule would choose, before it is clamped to the range.
    thin : float
        Multiplies the density; below 1 where even the largest dots are too few.
    """

    radius_min: float
    radius_max: float
    scale: float = 1.0
    thin: float = 1.0

    def radius(self, darkness: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return the radius for a darkness: small in the light, large in the dark.

        The ends of the range are kept free, so that solving the tone can still go either way.
        """
        low, high = self.radius_min, self.radius_max
        share = 0.12 + 0.68 * np.asarray(darkness, np.float64)
        radius: NDArray[np.float64] = np.clip(self.scale * (low + share * (high - low)), low, high)
        return radius

    def density(self, darkness: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return dots per unit of area; exactly 0 for white."""
        per_dot = np.pi * self.radius(darkness) ** 2
        density: NDArray[np.float64] = self.thin * ink_for(np.asarray(darkness)) / per_dot
        return density


@dataclass(frozen=True, slots=True)
class Shortfall:
    """Where even overlapping dots of the largest size are not dark enough.

    Attributes
    ----------
    share : float
        Share of the page concerned, 0..1.
    missing : float
        Mean darkness missing there, 0..1.
    box_mm : (x0, y0, x1, y1) or None
        What encloses it on the page.
    notes : tuple of str
        What else the person should know.
    """

    share: float = 0.0
    missing: float = 0.0
    box_mm: tuple[float, float, float, float] | None = None
    notes: tuple[str, ...] = ()


def rule_for(
    darkness: NDArray[np.float32],
    n_dots: int | None,
    size_range: tuple[float, float] | None,
    ratio: float = 2.0,
) -> Rule:
    """Choose radii and density for a picture; lengths in pixels.

    Parameters
    ----------
    n_dots : int or None
        None: the number follows from `size_range`.
    size_range : (min, max) or None
        None: a range of 1:`ratio` that meets the tone with `n_dots`.
    """
    histogram, values = _histogram(darkness)
    if size_range is None:
        if n_dots is None:
            raise ParameterError("neither a number nor a size is given", "dots")
        unit = Rule(1.0, ratio)
        wanted = float(histogram @ unit.density(values))
        low = math.sqrt(wanted / n_dots) if wanted > 0 else 1.0
        return Rule(low, low * ratio)
    low, high = size_range
    rule = Rule(low, high)
    if n_dots is None:
        return rule
    return _scaled(rule, histogram, values, n_dots)


def _histogram(darkness: NDArray[np.float32]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return pixels per level and the levels; white apart, at exactly 0."""
    level = np.ceil(darkness.ravel() * np.float32(_BINS)).astype(np.intp)
    counts = np.bincount(level, minlength=_BINS + 1).astype(np.float64)
    sums = np.bincount(level, darkness.ravel(), minlength=_BINS + 1)
    values = np.divide(sums, counts, out=np.zeros_like(sums), where=counts > 0)
    return counts, values


def _scaled(
    rule: Rule, counts: NDArray[np.float64], values: NDArray[np.float64], n_dots: int
) -> Rule:
    """Scale the radii within their range until the rule gives `n_dots`; then thin, never crowd."""

    def number(scale: float) -> float:
        return float(counts @ Rule(rule.radius_min, rule.radius_max, scale).density(values))

    low, high = rule.radius_min / rule.radius_max / 2, 2 * rule.radius_max / rule.radius_min
    for _ in range(50):
        middle = math.sqrt(low * high)
        if number(middle) > n_dots:
            low = middle
        else:
            high = middle
    there = number(high)
    thin = min(1.0, n_dots / there) if there > 0 else 1.0
    return Rule(rule.radius_min, rule.radius_max, high, thin)


def solve_radii(
    points: NDArray[np.float64],
    radii: NDArray[np.float64],
    darkness: NDArray[np.float32],
    size_range: tuple[float, float],
    rounds: int = 8,
) -> NDArray[np.float64]:
    """Change radii within their range until the blurred union of ink meets the blurred darkness.

    Parameters
    ----------
    points : (n, 2) float64, pixels of `darkness`
    radii : (n,) float64, pixels
        First guess; not modified.
    """
    low, high = size_range
    r = np.clip(radii, low, high)
    if not len(r):
        return r
    h, w = darkness.shape
    zoom = min(max(1, math.ceil(3.0 / float(np.median(r)))), max(1, int(16000 / max(h, w))))
    spacing = math.sqrt(float(darkness.sum(dtype=np.float64)) / len(r))
    weights = _gaussian(max(0.9 * spacing, 0.5))
    asked = _blur(darkness, weights)
    scaled = points * zoom
    order = np.argsort(scaled[:, 1], kind="stable").astype(np.int64)
    row_of = np.searchsorted(scaled[order, 1], np.arange(h * zoom + 1)).astype(np.int64)
    field = np.empty((h * zoom, w * zoom), np.float32)
    column = np.clip(points[:, 0].astype(np.intp), 0, w - 1)
    row = np.clip(points[:, 1].astype(np.intp), 0, h - 1)
    for _ in range(rounds):
        run_ranges(cover, h * zoom, scaled, r * zoom, order, row_of, field, grain=64)
        drawn = field.reshape(h, zoom, w, zoom).mean(axis=(1, 3))
        seen = _blur(drawn, weights)[row, column]
        gain = asked[row, column] / np.maximum(seen, 1e-3)
        r = np.clip(r * np.clip(gain, 0.5, 2.0) ** 0.5, low, high)
    return r


def _gaussian(sigma: float) -> NDArray[np.float32]:
    k = np.arange(math.ceil(3 * sigma) + 1)
    half = np.exp(-0.5 * (k / sigma) ** 2)
    weights: NDArray[np.float32] = (half / (half[0] + 2 * half[1:].sum())).astype(np.float32)
    return weights


def _blur(field: NDArray[np.float32], weights: NDArray[np.float32]) -> NDArray[np.float32]:
    h = field.shape[0]
    middle = np.empty_like(field)
    result = np.empty_like(field)
    run_ranges(blur_rows, h, field, weights, middle, grain=64)
    run_ranges(blur_columns, h, middle, weights, result, grain=64)
    return result


def shortfall(
    darkness: NDArray[np.float32], rule: Rule, pixel_mm: float, n: int, wanted: int | None
) -> Shortfall:
    """Say where the largest dots, as dense as the rule sets them, are not dark enough."""
    notes: tuple[str, ...] = ()
    if n == 0:
        notes = ("the reference is white: no dots",)
    elif wanted is not None and n < 0.99 * wanted:
        notes = (f"only {n:,} of {wanted:,} dots fit at the smallest size",)
    levels = np.linspace(0.0, 1.0, 257)
    drawn = np.interp(rule.density(levels) * np.pi * rule.radius_max**2, _INK, _COVERAGE)
    lack = np.where(levels - drawn > 0.004, levels - drawn, 0.0)
    if not lack.any():
        return Shortfall(notes=notes)
    missing = np.interp(darkness, levels, lack)
    where = missing > 0
    if not where.any():
        return Shortfall(notes=notes)
    x = np.flatnonzero(where.any(axis=0))
    y = np.flatnonzero(where.any(axis=1))
    box = (x[0] * pixel_mm, y[0] * pixel_mm, (x[-1] + 1) * pixel_mm, (y[-1] + 1) * pixel_mm)
    return Shortfall(float(where.mean()), float(missing[where].mean()), box, notes)
