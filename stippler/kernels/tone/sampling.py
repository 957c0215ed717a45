"""Values of a field between its pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import ZERO, kernel


@kernel
def _sample(start, stop, field, px_per_mm, points, out):
    h, w = field.shape
    for k in range(start, stop):
        x = min(max(points[k, 0] * px_per_mm - 0.5, 0.0), w - 1.0)
        y = min(max(points[k, 1] * px_per_mm - 0.5, 0.0), h - 1.0)
        i, j = int(x), int(y)
        u, v = x - i, y - j
        i1, j1 = min(i + 1, w - 1), min(j + 1, h - 1)
        upper = field[j, i] * (1.0 - u) + field[j, i1] * u
        lower = field[j1, i] * (1.0 - u) + field[j1, i1] * u
        out[k] = upper * (1.0 - v) + lower * v


def sampled(
    field: NDArray[np.float32], px_per_mm: float, points_mm: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return a field's values at points, interpolated between the centres of its pixels."""
    points = np.ascontiguousarray(points_mm, np.float64)
    out = np.empty(len(points))
    _sample(ZERO, len(out), field, px_per_mm, points, out)
    return out
