"""What momentum does to the even rules, a trial: ``python -m benchmarks.momentum``.

Each step goes its own way and a share of the way before it (Polyak 1964), and begins anew where the
two point against each other (O'Donoghue and Candès 2015). 6,000 dots of one grey, a hexagonal grid
moved by 0.35 spacings by chance, mean of two seeds.
"""

from __future__ import annotations

import sys

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import box

from stippler.analysis.grain import measure_grain
from stippler.stippling.relax import Relaxation

_N, _SIDE, _DISORDER = 6000, 100.0, 0.35
_LOOKS = (5, 10, 20, 30, 60)
_TRIALS = ((0.0, 0), (0.15, 0), (0.3, 0), (0.5, 0), (0.3, 10))  # share, and from which step on

Floats = NDArray[np.float64]


class Momentum:
    """Adds to each step a share of the one before."""

    def __init__(self, share: float, first: int) -> None:
        self._share, self._wait = share, first
        self._before: Floats | None = None

    def __call__(self, before: Floats, wanted: Floats) -> Floats:
        """Return where dots shall go."""
        step, self._wait = wanted - before, self._wait - 1
        if self._wait >= 0:
            return wanted
        if self._before is not None and float((step * self._before).sum()) >= 0.0:
            step = step + self._share * self._before
        self._before = step
        return np.clip(before + step, 0.0, _SIDE)


def _start(seed: int) -> Floats:
    spacing = _SIDE * np.sqrt(2.0 / np.sqrt(3.0) / _N)
    height = spacing * np.sqrt(3.0) / 2.0
    rows = [
        [(x, y) for x in np.arange((k % 2) * spacing / 2.0, _SIDE, spacing)]
        for k, y in enumerate(np.arange(height / 2.0, _SIDE, height))
    ]
    points = np.concatenate(rows)
    moved = points + np.random.default_rng(seed).normal(0.0, _DISORDER * spacing, points.shape)
    return np.asarray(np.clip(moved, 1e-3, _SIDE - 1e-3))


def _course(share: float, first: int, seed: int) -> list[tuple[float, ...]]:
    engine = Relaxation(_start(seed), box(0, 0, _SIDE, _SIDE), method="even")
    momentum = Momentum(share, first) if share else None
    found: list[tuple[float, ...]] = []
    for k in range(1, max(_LOOKS) + 1):
        report = engine.step(redirect=momentum)
        if k in _LOOKS:
            grain = measure_grain(engine.points)
            move = report.largest_mm / engine.spacing_mm
            found.append((grain.least_distance, grain.distance_cv, grain.rows_at_4, move))
    return found


def main() -> None:
    """Print a row for each share and number of steps."""
    sys.stdout.write("share  from  steps  least distance  its variation   rows  largest move\n")
    for share, first in _TRIALS:
        mean = np.mean([_course(share, first, seed) for seed in (1, 2)], axis=0)
        for k, values in zip(_LOOKS, mean.tolist(), strict=True):
            least, cv, rows, move = values
            sys.stdout.write(
                f"{share:5.2f}{first:6}{k:7}{least:16.3f}{cv:15.4f}{rows:7.4f}{move:14.4f}\n"
            )


if __name__ == "__main__":
    main()
