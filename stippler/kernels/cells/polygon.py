"""How deep points lie in a polygon."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import kernel

F8 = NDArray[np.float64]


@kernel
def find_depths(points: F8, corners: F8, out: F8) -> None:
    """Write distances of points to a polygon's border, below 0 outside (even-odd rule)."""
    m = len(corners)
    for i in range(len(points)):
        x, y = points[i, 0], points[i, 1]
        least2, inside = math.inf, False
        for k in range(m):
            ax, ay = corners[k - 1, 0], corners[k - 1, 1]
            bx, by = corners[k, 0], corners[k, 1]
            if (ay > y) != (by > y) and x < ax + (y - ay) * (bx - ax) / (by - ay):
                inside = not inside
            u, v = bx - ax, by - ay
            length2 = u * u + v * v
            t = ((x - ax) * u + (y - ay) * v) / length2 if length2 > 0.0 else 0.0
            t = min(max(t, 0.0), 1.0)
            du, dv = x - ax - t * u, y - ay - t * v
            least2 = min(least2, du * du + dv * dv)
        out[i] = math.sqrt(least2) if inside else -math.sqrt(least2)
