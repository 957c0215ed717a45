"""Bringing a worker's result to the dots that it may still move."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import kernel

F8 = NDArray[np.float64]
I4 = NDArray[np.int32]
I8 = NDArray[np.int64]


@kernel
def merge_positions(
    rows: I8,
    result: F8,
    edited: I4,
    base: int,
    constraint: NDArray[np.int8],
    position: F8,
    after: F8,
) -> tuple[int, float]:
    """Move the free dots that are there and have not been edited since `base`.

    Parameters
    ----------
    rows : (n,)
        Of the dots of the result, below 0 where one is gone.

    Returns
    -------
    tuple of int and float
        How many there are, and how far the one went that moved most. Their places stand in
        `position` (by row) and `after` (by the order of `rows`).
    """
    n = 0
    furthest2 = 0.0
    for k in range(len(rows)):
        row = rows[k]
        if row < 0 or edited[row] > base or constraint[row] != 0:
            continue
        dx, dy = result[k, 0] - position[row, 0], result[k, 1] - position[row, 1]
        furthest2 = max(furthest2, dx * dx + dy * dy)
        position[row, 0] = after[k, 0] = result[k, 0]
        position[row, 1] = after[k, 1] = result[k, 1]
        n += 1
    return n, math.sqrt(furthest2)
