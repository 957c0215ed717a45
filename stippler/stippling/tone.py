"""Tone: how many dots of which size lay down the ink that a darkness asks for.

Density and radius follow from darkness by one rule, so that the union of the discs covers just
the darkness; neither is scaled by it alone.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.kernels.tone.darkness_levels import count_levels

_COVERAGE = np.array([0.0, 0.8, 0.85, 0.9, 0.95, 0.98, 0.99, 1.0])
_INK = np.array([0.0, 0.8, 0.855, 0.925, 1.02, 1.11, 1.16, 1.3])
INK_TABLE = np.stack([_COVERAGE, _INK])
"""What `ink_for` interpolates, for kernels."""
"""Summed area of the discs on a unit of page, overlaps counted twice, that covers so much of it;
for relaxed dots of locally equal size."""

LEAST_PRINTED_MM = 0.1
"""Diameter below which many presses and pens print no dot; publishers ask for such lines."""

_PRINTS, _FEW = 0.97, 0.01  # of that diameter; of all dots
_BINS = 1024
_VARIES = 1.3


def ink_for(darkness: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the summed disc area that covers a share `darkness` of the page."""
    ink: NDArray[np.float64] = np.interp(darkness, _COVERAGE, _INK)
    return ink


@dataclass(frozen=True, slots=True)
class DotRule:
    """The joint rule for radius and density.

    Attributes
    ----------
    radius_min, radius_max : float
        The allowed range, in any one unit of length.
    scale : float
        Multiplies the radius that the rule would choose, before it is clamped to the range.
    thin : float
        Multiplies the density; below 1 where even the largest dots are too few.
    even : bool
        One radius for every darkness, the geometric middle of the range.
    """

    radius_min: float
    radius_max: float
    scale: float = 1.0
    thin: float = 1.0
    even: bool = False

    BLEED_REACH: ClassVar[float] = 0.75
    """A dot beyond the page's edge is kept if it is nearer than this share of its radius."""

    @property
    def varies(self) -> bool:
        """Whether sizes can carry tone."""
        return self.radius_max > _VARIES * self.radius_min

    def radius(self, darkness: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return the radius for a darkness: small up to the middle tones, large in the dark.

        The number of dots then hardly changes from the middle tones on, where it is the size
        that carries the tone, and light parts are drawn as finely as can be. The ends of the
        range are kept free, so that solving the tone can still go either way.
        """
        low, high = self.radius_min, self.radius_max
        if self.even:
            middle = self.scale * math.sqrt(low * high)
            return np.full(np.shape(darkness), min(max(middle, low), high))
        share = 0.06 + 0.88 * np.asarray(darkness, np.float64) ** 3
        radius: NDArray[np.float64] = np.clip(self.scale * (low + share * (high - low)), low, high)
        return radius

    def density(self, darkness: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return dots per unit of area; exactly 0 for white."""
        per_dot = np.pi * self.radius(darkness) ** 2
        density: NDArray[np.float64] = self.thin * ink_for(np.asarray(darkness)) / per_dot
        return density

    def per_border(self, darkness: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return dots per unit of length that a bleed adds along the page's edge."""
        return self.BLEED_REACH * self.radius(darkness) * self.density(darkness)


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
    border: NDArray[np.float32],
    ratio: float = 2.0,
    *,
    faintest: float | None = None,
) -> DotRule:
    """Choose radii and density for a picture; lengths in pixels.

    Parameters
    ----------
    n_dots : int or None
        None: the number follows from `size_range`.
    size_range : (min, max) or None
        None: a range of 1:`ratio` that meets the tone with `n_dots`.
    border : (m,) float32
        Darkness of the pixels along the page's edge, if there is a bleed.
    faintest : float, optional
        Given for dots of one radius, of which those on lighter pixels than this are not counted.
    """
    levels, rim = _histogram(darkness), _histogram(border)
    even = faintest is not None
    if faintest is not None:
        levels = levels[0] * (levels[1] >= faintest), levels[1]
    if size_range is not None:
        rule = DotRule(*size_range, even=even)
        return rule if n_dots is None else _scaled(rule, levels, rim, n_dots)
    if n_dots is None:
        raise ParameterError("neither a number nor a size is given", "dots")
    unit = DotRule(1.0, ratio, even=even)
    area = float(levels[0] @ unit.density(levels[1]))
    length = float(rim[0] @ unit.per_border(rim[1]))
    if not area > 0:
        return unit
    low = (length + math.sqrt(length**2 + 4.0 * n_dots * area)) / (2.0 * n_dots)
    return DotRule(low, low * ratio, even=even)


_Levels = tuple[NDArray[np.float64], NDArray[np.float64]]


def _histogram(darkness: NDArray[np.float32]) -> _Levels:
    """Return pixels per level and the levels; white apart, at exactly 0."""
    flat = darkness.ravel().view()
    flat.flags.writeable = False  # kernels compile for one kind
    counts, sums = np.zeros(_BINS + 1), np.zeros(_BINS + 1)
    count_levels(flat, counts, sums)
    return counts, np.divide(sums, counts, out=np.zeros_like(sums), where=counts > 0)


def _scaled(rule: DotRule, levels: _Levels, rim: _Levels, n_dots: int) -> DotRule:
    """Scale the radii within their range until the rule gives `n_dots`; then thin, never crowd."""

    def number(scale: float) -> float:
        scaled = replace(rule, scale=scale)
        inner = float(levels[0] @ scaled.density(levels[1]))
        return inner + float(rim[0] @ scaled.per_border(rim[1]))

    low, high = rule.radius_min / rule.radius_max / 2, 2 * rule.radius_max / rule.radius_min
    for _ in range(50):
        middle = math.sqrt(low * high)
        if number(middle) > n_dots:
            low = middle
        else:
            high = middle
    there = number(high)
    thin = min(1.0, n_dots / there) if there > 0 else 1.0
    return replace(rule, scale=high, thin=thin)


def shortfall(
    darkness: NDArray[np.float32], rule: DotRule, pixel_mm: float, n: int, wanted: int | None
) -> Shortfall:
    """Say where the largest dots, as dense as the rule sets them, are not dark enough."""
    notes: tuple[str, ...] = ()
    if not darkness.any():
        notes = ("the reference is white: no dots",)
    elif n == 0:
        notes = ("no dot of this size fits the ink: ask for more, or for smaller ones",)
    elif wanted is not None and n < 0.99 * wanted:
        notes = (f"only {n:,} of {wanted:,} dots fit at the smallest size",)
    levels, lack = _lack(rule)
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


def _lack(rule: DotRule) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return levels of darkness, and how much of each the largest dots cannot draw."""
    levels = np.linspace(0.0, 1.0, 257)
    drawn = np.interp(rule.density(levels) * np.pi * rule.radius_max**2, _INK, _COVERAGE)
    return levels, np.where(levels - drawn > 0.004, levels - drawn, 0.0)


def darkest_drawn(rule: DotRule) -> float:
    """Return the darkness above which a rule's dots fall short; 1 if they never do."""
    levels, lack = _lack(rule)
    short = np.flatnonzero(lack)
    return float(levels[max(short[0] - 1, 0)]) if len(short) else 1.0


def too_small_to_print(radius_mm: NDArray[np.floating]) -> tuple[str, ...]:
    """Say how many dots are smaller than presses and pens print; nothing if hardly any are."""
    small = float(np.mean(2.0 * radius_mm < _PRINTS * LEAST_PRINTED_MM)) if len(radius_mm) else 0.0
    if small < _FEW:
        return ()
    return (
        f"{100 * small:.0f} % of the dots are less than {LEAST_PRINTED_MM:g} mm across, which many "
        "presses and pens do not print; ask for fewer dots or a larger page",
    )
