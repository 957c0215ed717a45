"""Ink on a grid: the union of discs."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import kernel

Array = NDArray[Any]


@kernel
def cover(
    start: int,
    stop: int,
    points: Array,
    radii: Array,
    order: Array,
    row_of: Array,
    field: Array,
) -> None:
    """Set the cells of rows ``start..stop`` whose centre lies in a disc to 1, others to 0.

    `order` sorts the dots by y and `row_of` (h + 1,) says where each row's dots begin in it.
    Centres know no half-covered cells, so that touching discs leave neither seam nor excess.
    """
    h, w = field.shape
    reach = 0.0
    for r in radii:
        reach = max(reach, r)
    reach += 1.0
    first = row_of[min(max(int(np.floor(start - reach)), 0), h)]
    last = row_of[min(int(np.ceil(stop + reach)) + 1, h)]
    field[start:stop] = 0.0
    for k in range(first, last):
        i = order[k]
        x = points[i, 0]
        y = points[i, 1]
        r = radii[i]
        y0 = max(int(np.floor(y - r - 0.5)), start)
        y1 = min(int(np.ceil(y + r + 0.5)), stop)
        x0 = max(int(np.floor(x - r - 0.5)), 0)
        x1 = min(int(np.ceil(x + r + 0.5)), w)
        for row in range(y0, y1):
            ey = row + 0.5 - y
            for col in range(x0, x1):
                ex = col + 0.5 - x
                if ex * ex + ey * ey <= r * r:
                    field[row, col] = 1.0
