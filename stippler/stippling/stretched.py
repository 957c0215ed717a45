"""Tone of dots that are not round: what they ink is measured, and what they are asked for follows.

A long dot overlaps others sooner than a round one of its area, so sizes solved for discs fall short
where it is dark.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.drawing.pens import pen_named
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.drawing.style_shape import shaped
from stippler.kernels.tone.ellipses import mark_covered

Floats = NDArray[np.float64]

_PER_DOT, _FEWEST_SAMPLES, _MOST_SAMPLES = 6, 160_000, 250_000
_LEVELS = 12  # of darkness, whose ink is compared
_FEWEST = 500  # samples of a level
_MOST = 4.0  # times the ink of the picture that dots are asked for, at most


def is_stretched(style: Style) -> bool:
    """Tell whether a style's dots are long."""
    return style.elongation > 1.0 or pen_named(style.pen).elongation[1] > 1.0


class InkOfShapes:
    """Looks at a raster in places by chance, and asks dots for more or less by their tone."""

    def __init__(self, darkness: NDArray[np.float32], points: Floats, seed: int) -> None:
        h, w = darkness.shape
        self._at, self._columns, self._rows = _one_in_each_square(w, h, len(points), seed)
        self._side = np.array([w / self._columns, h / self._rows])
        tone = darkness[self._at[:, 1].astype(np.intp), self._at[:, 0].astype(np.intp)]
        self._inked = np.flatnonzero(tone > 0.0)
        self._points, tone = points, tone[self._inked].astype(np.float64)
        x, y = np.minimum(points.astype(np.intp), (w - 1, h - 1)).T
        self._tone_of_dot = darkness[y, x].astype(np.float64)
        ends = np.quantile(tone, np.linspace(0.0, 1.0, _LEVELS + 1)[1:-1]) if len(tone) else ()
        self._level = np.searchsorted(ends, tone)
        n = np.bincount(self._level, minlength=_LEVELS)
        self._used = n >= _FEWEST
        sums = np.bincount(self._level, tone, _LEVELS)
        self._asked = sums[self._used]
        self._middle = self._asked / n[self._used]
        self._factor = np.ones(len(self._asked))

    def gain(self, radii: Floats, dots: Dots) -> Floats:
        """Return what the ink that dots are asked for is to be multiplied with, by dot.

        Parameters
        ----------
        radii : (n,) float64, pixels
            As they were solved with the last gain.
        dots : Dots
            Their shapes.
        """
        if not len(self._asked):
            return np.ones(len(radii))
        covered = self._covered(radii, dots)
        laid = np.bincount(self._level, covered, _LEVELS)[self._used]
        self._factor = np.clip(self._factor * self._asked / np.maximum(laid, 1.0), 0.25, _MOST)
        return np.asarray(np.interp(self._tone_of_dot, self._middle, self._factor))

    def _covered(self, radii: Floats, dots: Dots) -> NDArray[np.uint8]:
        """Return for each place with ink whether a dot covers it."""
        found = np.zeros(len(self._at), np.uint8)
        angle = dots.angle_rad.astype(np.float64)
        mark_covered(
            self._at, self._columns, self._rows, self._side, self._points, radii,
            dots.elongation.astype(np.float64), np.cos(angle), np.sin(angle), found,
        )  # fmt: skip
        return found[self._inked]


def shapes_of(position_mm: Floats, radius_mm: Floats, style: Style, reference: Reference) -> Dots:
    """Return dots in the shapes of a style; which has which is up to their ids."""
    return shaped(Dots.round(position_mm, radius_mm.astype(np.float32)), style, reference)


def _one_in_each_square(w: int, h: int, n_dots: int, seed: int) -> tuple[Floats, int, int]:
    """Return places on a raster, by chance one in each of as many squares as dots ask for.

    And how many columns and rows of squares there are.
    """
    n = min(max(_PER_DOT * n_dots, _FEWEST_SAMPLES), _MOST_SAMPLES)
    side = np.sqrt(w * h / n)
    columns, rows = max(round(w / side), 1), max(round(h / side), 1)
    corner = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), -1).reshape(-1, 2)
    by_chance = np.random.default_rng([seed, n_dots]).random(corner.shape)
    return np.asarray((corner + by_chance) * (w / columns, h / rows)), columns, rows
