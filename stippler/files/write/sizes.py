"""Round dots by size, for formats that set a width once and then draw many."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

STEP = 0.002
"""Radii within such a share of each other count as the same: a thousandth off at most."""


_FEW_STEPS = 1 << 16  # so many are sorted by their digits, at a tenth of the time


def by_size(radius_mm: NDArray[np.float32]) -> Iterator[tuple[float, NDArray[np.intp]]]:
    """Yield diameters that keep the ink, and the rows of their dots, smallest first."""
    diameter, first, rows = sorted_by_size(radius_mm)
    yield from zip(diameter, np.split(rows, first[1:]), strict=False)


def sorted_by_size(
    radius_mm: NDArray[np.float32],
) -> tuple[list[float], NDArray[np.intp], NDArray[np.intp]]:
    """Return diameters that keep the ink, the first place of each in the list of rows, and that."""
    if not len(radius_mm):
        return [], np.empty(0, np.intp), np.empty(0, np.intp)
    radius = radius_mm.astype(np.float64)
    step = np.floor(np.log(radius / radius.min()) / STEP)
    step = step.astype(np.uint16 if step.max() < _FEW_STEPS else np.int64)
    rows = np.argsort(step, kind="stable")
    first = np.concatenate(([0], np.flatnonzero(np.diff(step[rows])) + 1))
    each = np.split(np.square(radius[rows]), first[1:])
    return [2.0 * float(np.sqrt(np.mean(squares))) for squares in each], first, rows
