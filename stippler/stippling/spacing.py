"""What the rules of even spacing go by: how dense and how large dots are to be, and how strictly.

See `stippler.kernels.cells.spacing` for the rules, `docs/quality.md` for what they were chosen by.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from stippler.stippling.tone import DotRule

_LEVELS = 1025


@dataclass(frozen=True, slots=True)
class Rules:
    """How strictly dots are spaced; lengths are shares of h, the hexagonal neighbour distance.

    Attributes
    ----------
    near : float
        Dots nearer than this are pushed apart.
    base, slope, cap : float
        So are large dots nearer than `base` and `slope` of their diameter, up to `cap`.
    hole : float
        Empty circles larger by this than the hexagonal grid's draw the dots around them.
    narrow : float
        How much less for each spacing by which dots are wider than `WIDE`.
    level, pull : float
        How much of what they want dots do in a step.
    gain, low : float
        A dot goes to its ink's centroid instead, by this much for each spacing that the ink's
        centroid is off the cell's, less `low`.
    least : float
        Share of every move that goes to the ink's centroid.
    """

    near: float = 0.86
    base: float = 0.06
    slope: float = 1.0
    cap: float = 0.94
    hole: float = 1.15
    narrow: float = 0.6
    level: float = 0.5
    pull: float = 0.5
    gain: float = 8.0
    low: float = 0.1
    least: float = 0.0

    def array(self) -> NDArray[np.float64]:
        """Return what kernels read; not to be written."""
        return _array_of(self)


@cache
def _array_of(rules: Rules) -> NDArray[np.float64]:
    return np.array(astuple(rules))


RULES = Rules()

AT_LAST = Rules(near=0.84, cap=0.84, hole=1.22, narrow=0.0)
"""The rules that dots come to rest by."""

_TIGHT_STEPS, _LOOSENING_STEPS = 40, 60

TO_INK = Rules(gain=150.0, low=0.1, least=0.25)
"""The last steps: dots go to the midst of their ink, wholly wherever it is uneven at all."""

LLOYD = Rules(least=1.0)
"""Lloyd's step, weighted by the field."""


def rules_after(n_steps: int) -> Rules:
    """Return the rules of the step after `n_steps`: strict at first, then ever looser.

    What strict rules want cannot be had everywhere. What has been reached meets looser ones with
    room to spare, so that dots come to rest.
    """
    return _loosened(min(max((n_steps - _TIGHT_STEPS) / _LOOSENING_STEPS, 0.0), 1.0))


@cache  # a run of many steps asks for all of them before its first
def _loosened(t: float) -> Rules:
    """Return rules between the strict ones, 0, and the last, 1."""
    if t == 0.0:
        return RULES
    return Rules(*(a + t * (b - a) for a, b in zip(astuple(RULES), astuple(AT_LAST), strict=True)))


@dataclass(frozen=True, slots=True, eq=False)
class Wanted:
    """How dense and how large dots are to be by levels of a field, evenly from 0 to `top`.

    Attributes
    ----------
    per_area : (k,) float64
        In any unit: it is made to fit the number of dots there are. One level is one density.
    radius_mm : (k,) float64
    top : float
    """

    per_area: NDArray[np.float64]
    radius_mm: NDArray[np.float64]
    top: float = 1.0

    @classmethod
    def uniform(cls) -> Wanted:
        """Want one density everywhere, of dots without size."""
        return cls(np.ones(1), np.zeros(1))

    @classmethod
    def in_proportion(cls, values: NDArray[np.floating]) -> Wanted:
        """Want dots in proportion to a field that has these values."""
        top = max(float(values.max()), 1e-30)
        return cls(np.array([0.0, top]), np.zeros(2), top)

    @classmethod
    def by_rule(cls, rule: DotRule, pixel_mm: float) -> Wanted:
        """Want what a rule gives for each darkness."""
        levels = np.linspace(0.0, 1.0, _LEVELS)
        return cls(rule.density(levels), pixel_mm * rule.radius(levels))

    @property
    def scale(self) -> float:
        """What turns a mean of the field into a level."""
        return (len(self.per_area) - 1) / self.top

    def table(self) -> NDArray[np.float64]:
        """Return what kernels read."""
        return np.ascontiguousarray(np.column_stack([self.per_area, self.radius_mm]))
