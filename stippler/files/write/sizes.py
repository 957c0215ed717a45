"""Round dots by size, for formats that set a width once and then draw many."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

STEP = 0.002
"""Radii within such a share of each other count as the same: a thousandth off at most."""


def by_size(radius_mm: NDArray[np.float32]) -> Iterator[tuple[float, NDArray[np.intp]]]:
    """Yield diameters that keep the ink, and the rows of their dots, smallest first."""
    if not len(radius_mm):
        return
    radius = radius_mm.astype(np.float64)
    step = np.floor(np.log(radius / radius.min()) / STEP).astype(np.int64)
    order = np.argsort(step, kind="stable")
    for rows in np.split(order, np.flatnonzero(np.diff(step[order])) + 1):
        yield 2.0 * float(np.sqrt(np.mean(radius[rows] ** 2))), rows
