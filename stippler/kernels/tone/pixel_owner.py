"""Dots and the pixels they stand on."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import kernel

Array = NDArray[Any]


@kernel
def onto_ink(start: int, stop: int, points: Array, field: Array, reach: int, moved: Array) -> None:
    """Move dots that stand on white to the nearest point of a pixel that is not.

    A pixel is white if it is exactly 0. Points in pixels; changed in place; `moved` (n,) says
    1 for a dot moved, 2 for one without ink within `reach` pixels, else 0.
    """
    h, w = field.shape
    for i in range(start, stop):
        x = points[i, 0]
        y = points[i, 1]
        cx = min(max(int(x), 0), w - 1)
        cy = min(max(int(y), 0), h - 1)
        moved[i] = 0
        if field[cy, cx] > 0.0:
            continue
        best = np.inf
        bx = x
        by = y
        moved[i] = 2
        ring = 1
        while ring <= reach and (ring - 1.0) ** 2 < best:
            for row in range(max(cy - ring, 0), min(cy + ring, h - 1) + 1):
                edge = row == cy - ring or row == cy + ring
                step = 1 if edge else 2 * ring
                for col in range(cx - ring, cx + ring + 1, step):
                    if col < 0 or col >= w or not field[row, col] > 0.0:
                        continue
                    nx = min(max(x, col + 0.02), col + 0.98)
                    ny = min(max(y, row + 0.02), row + 0.98)
                    d = (nx - x) ** 2 + (ny - y) ** 2
                    if d < best:
                        best = d
                        bx = nx
                        by = ny
                        moved[i] = 1
            ring += 1
        points[i, 0] = bx
        points[i, 1] = by


@kernel
def sample(start: int, stop: int, points: Array, field: Array, values: Array) -> None:
    """Read the pixel under each dot; points in pixels."""
    h, w = field.shape
    for i in range(start, stop):
        x = min(max(int(points[i, 0]), 0), w - 1)
        y = min(max(int(points[i, 1]), 0), h - 1)
        values[i] = field[y, x]
