"""Fields of darkness by levels: how many pixels there are of each, and what a table makes of them.

A level holds all darkness up to it: white, and only white, is level 0.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import kernel

Array = NDArray[Any]


@kernel
def count_levels(darkness: Array, counts: Array, sums: Array) -> None:
    """Add up pixels and their darkness, in the field's order, by as many levels as there is room.

    Parameters
    ----------
    darkness : (m,) float32
    counts, sums : (k + 1,) float64
        Of level 0 to k, which is black; added to.
    """
    top = len(counts) - 1
    scale = np.float32(top)
    for i in range(len(darkness)):
        level = min(max(math.ceil(darkness[i] * scale), 0), top)
        counts[level] += 1.0
        sums[level] += np.float64(darkness[i])


@kernel
def look_up_levels(
    start: int, stop: int, darkness: Array, scale: float, table: Array, out: Array
) -> None:
    """Write rows start..stop of what a table makes of darkness, whose level is it times a scale.

    Parameters
    ----------
    darkness, out : (h, w) float32
    scale : float
        A float32 that brings the darkest pixel to the table's last entry.
    table : (k + 1,) float32
    """
    top = len(table) - 1
    per = np.float32(scale)
    for y in range(start, stop):
        for x in range(darkness.shape[1]):
            level = min(max(math.ceil(darkness[y, x] * per), 0), top)
            out[y, x] = table[level]
