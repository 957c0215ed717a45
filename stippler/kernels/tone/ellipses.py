"""Which places of a raster long dots cover."""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import NDArray

from stippler.kernels.machine.jit import bare_kernel

Array = NDArray[Any]


@bare_kernel
def mark_covered(
    place: Array, columns: int, rows: int, side: Array, points: Array, radii: Array,
    elongation: Array, cos: Array, sin: Array, out: Array,
) -> None:  # fmt: skip
    """Mark the places that ellipses cover.

    Parameters
    ----------
    place : (rows * columns, 2) float64
        One in each square of a grid, row by row.
    side : (2,) float64
        Of a square.
    points, radii : (n, 2) and (n,) float64
        Middles, and the radii of discs of the same area.
    elongation, cos, sin : (n,)
        Long over short axis, and the direction of the long one.
    out : (rows * columns,) uint8
        1 where an ellipse covers the place; others are left as they are.
    """
    for i in range(len(radii)):
        x, y, c, s = points[i, 0], points[i, 1], cos[i], sin[i]
        stretch = math.sqrt(elongation[i])
        wide, thin = radii[i] * stretch, radii[i] / stretch
        half_x = math.sqrt((wide * c) ** 2 + (thin * s) ** 2)
        half_y = math.sqrt((wide * s) ** 2 + (thin * c) ** 2)
        first = max(int((x - half_x) / side[0]), 0)
        last = min(int((x + half_x) / side[0]), columns - 1)
        low = max(int((y - half_y) / side[1]), 0)
        high = min(int((y + half_y) / side[1]), rows - 1)
        for row in range(low, high + 1):
            for k in range(row * columns + first, row * columns + last + 1):
                dx, dy = place[k, 0] - x, place[k, 1] - y
                along, across = (dx * c + dy * s) / wide, (dy * c - dx * s) / thin
                if along * along + across * across < 1.0:
                    out[k] = 1
