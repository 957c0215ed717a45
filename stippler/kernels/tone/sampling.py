"""Values of a field of levels between its pixels."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import ZERO, kernel


@kernel
def _sample(start, stop, of_pixel, values, px_per_mm, points, out):
    h, w = of_pixel.shape
    for k in range(start, stop):
        x = min(max(points[k, 0] * px_per_mm - 0.5, 0.0), w - 1.0)
        y = min(max(points[k, 1] * px_per_mm - 0.5, 0.0), h - 1.0)
        i, j = int(x), int(y)
        u, v = x - i, y - j
        i1, j1 = min(i + 1, w - 1), min(j + 1, h - 1)
        # the far pixel first: so sums are contracted as they were on fields of floats
        upper = values[of_pixel[j, i1]] * u + values[of_pixel[j, i]] * (1.0 - u)
        lower = values[of_pixel[j1, i1]] * u + values[of_pixel[j1, i]] * (1.0 - u)
        out[k] = upper * (1.0 - v) + lower * v


def sampled(
    of_pixel: NDArray[np.uint16],
    values: NDArray[np.float32],
    px_per_mm: float,
    points_mm: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return values at points, interpolated between the centres of pixels.

    Parameters
    ----------
    of_pixel : (h, w) uint16, read-only
        Which of the values each pixel has.
    values : (n,) float32, read-only
    px_per_mm : float
    points_mm : (m, 2) float64
        Those beside the field take the value of its border.
    """
    points = np.ascontiguousarray(points_mm, np.float64)
    out = np.empty(len(points))
    _sample(ZERO, len(out), of_pixel, values, px_per_mm, points, out)
    return out
