"""Adding dots and taking them away: how many, where, and which."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.brushes.tip import Tip


class Count:
    """Whole numbers that add up to a rate, whatever the length of the steps."""

    def __init__(self, per_s: float) -> None:
        self._per_s, self._owed = per_s, 0.0

    def take(self, dt_s: float, share: float = 1.0) -> int:
        """Return how many are due after `dt_s` more seconds."""
        self._owed += self._per_s * share * dt_s
        n = int(self._owed + 1e-9)
        self._owed -= n
        return n


def spray(n: int, tip: Tip, radius_mm: float, rng: np.random.Generator) -> NDArray[np.float64]:
    """Return offsets of n new dots, evenly over the tip."""
    return tip.spread(n, radius_mm, rng)


def choose(n: int, weight: NDArray[np.float64], rng: np.random.Generator) -> NDArray[np.intp]:
    """Choose n dots at random, by weight; fewer where there are not as many."""
    some = np.flatnonzero(weight > 0.0)
    if len(some) <= n:
        return some
    # the largest of u^(1/w), one u a dot, are a weighted sample without replacement
    with np.errstate(divide="ignore"):
        keys = np.log(rng.random(len(some))) / weight[some]
    return np.asarray(some[np.argpartition(-keys, n)[:n]])
