"""Means of blocks of a picture that is kept as levels."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import kernel


@kernel
def average_blocks(
    start: int, stop: int, levels: NDArray[np.uint16], table: NDArray[np.float32], top: int,
    left: int, bottom: int, right: int, k: int, out: Any,
) -> None:  # fmt: skip
    """Write rows start..stop of what blocks of k × k pixels come to, looked up in a table.

    The blocks cover the pixels from `top` and `left` on; those at `bottom` and `right` may be
    narrower.
    """
    for row in range(start, stop):
        y0 = top + row * k
        y1 = min(y0 + k, bottom)
        for column in range(out.shape[1]):
            x0 = left + column * k
            x1 = min(x0 + k, right)
            total = 0.0
            for y in range(y0, y1):
                for x in range(x0, x1):
                    total += np.float64(table[levels[y, x]])
            out[row, column] = total / ((y1 - y0) * (x1 - x0))
