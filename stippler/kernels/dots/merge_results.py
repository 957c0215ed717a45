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
    ids: I8,
    result: F8,
    row_of_id: I4,
    edited: I4,
    base: int,
    fixed: NDArray[np.bool_],
    position: F8,
    after: F8,
) -> tuple[int, float]:
    """Move the free dots that are there and have not been edited since `base`.

    Writes their places to `position` (by row) and `after` (by the order of `ids`); returns how
    many there are, and how far the one went that moved most.
    """
    n = 0
    furthest2 = 0.0
    for k in range(len(ids)):
        row = row_of_id[ids[k]]
        if row < 0 or edited[ids[k]] > base or fixed[row]:
            continue
        dx, dy = result[k, 0] - position[row, 0], result[k, 1] - position[row, 1]
        furthest2 = max(furthest2, dx * dx + dy * dy)
        position[row, 0] = after[k, 0] = result[k, 0]
        position[row, 1] = after[k, 1] = result[k, 1]
        n += 1
    return n, math.sqrt(furthest2)
