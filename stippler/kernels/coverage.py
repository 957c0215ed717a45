"""Ink on a grid: the union of discs, and what is left of it when seen from afar."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.jit import kernel

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
    """Draw discs into rows ``start..stop`` of a coverage field; the darker one wins.

    `order` sorts the dots by y and `row_of` (h + 1,) says where each row's dots begin in it.
    """
    h, w = field.shape
    reach = 0.0
    for r in radii:
        reach = max(reach, r)
    reach += 1.0
    first = row_of[max(int(np.floor(start - reach)), 0)]
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
        solid = max(r - 0.5, 0.0) ** 2
        for row in range(y0, y1):
            ey = row + 0.5 - y
            for col in range(x0, x1):
                ex = col + 0.5 - x
                d2 = ex * ex + ey * ey
                if d2 <= solid:
                    field[row, col] = 1.0
                else:
                    c = r + 0.5 - np.sqrt(d2)
                    if c > field[row, col]:
                        field[row, col] = min(c, 1.0)


@kernel
def blur_rows(start: int, stop: int, source: Array, weights: Array, target: Array) -> None:
    """Convolve rows with a symmetric kernel, the border repeated; `weights` from the centre out."""
    w = source.shape[1]
    m = len(weights)
    for y in range(start, stop):
        for x in range(w):
            s = weights[0] * source[y, x]
            for k in range(1, m):
                s += weights[k] * (source[y, max(x - k, 0)] + source[y, min(x + k, w - 1)])
            target[y, x] = s


@kernel
def blur_columns(start: int, stop: int, source: Array, weights: Array, target: Array) -> None:
    """Convolve columns with a symmetric kernel, the border repeated."""
    h, w = source.shape
    m = len(weights)
    for y in range(start, stop):
        for x in range(w):
            target[y, x] = weights[0] * source[y, x]
        for k in range(1, m):
            a = max(y - k, 0)
            b = min(y + k, h - 1)
            for x in range(w):
                target[y, x] += weights[k] * (source[a, x] + source[b, x])
