"""Weights of the page that draw dots together."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.drawing.validation import floats
from stippler.errors import ParameterError

_DENSEST = 1e30  # sums of the kernels' float32 go no further

Density = Callable[[NDArray[np.float64], NDArray[np.float64]], ArrayLike]


@dataclass(frozen=True, slots=True, eq=False)
class DensityField:
    """How much of the dots' weight each pixel has; outside it is 0.

    Attributes
    ----------
    values : (h, w) array of float, >= 0
    pixel_mm : float or (float, float)
        Side of a pixel, or its width and height.
    origin_mm : (float, float)
        Position of the corner of pixel (0, 0).
    """

    values: NDArray[np.floating]
    pixel_mm: float | tuple[float, float]
    origin_mm: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        values = np.asarray(self.values)
        if values.ndim != 2 or values.size == 0:
            raise ParameterError("a density is a 2-d field with at least one pixel", "density")
        if not (float(values.min()) >= 0.0 and float(values.max()) <= _DENSEST):
            raise ParameterError(f"has to be between 0 and {_DENSEST:g}", "density")
        sides = self.sides_mm
        if not all(math.isfinite(side) and side > 0 for side in sides):
            raise ParameterError(f"{self.pixel_mm} mm is no pixel size", "density")
        if not all(math.isfinite(value) for value in self.origin_mm):
            raise ParameterError(f"{self.origin_mm} is no position", "density")
        object.__setattr__(self, "values", values)
        object.__setattr__(self, "pixel_mm", sides)

    @property
    def sides_mm(self) -> tuple[float, float]:
        """Width and height of a pixel."""
        if isinstance(self.pixel_mm, tuple):
            width, height = self.pixel_mm
            return float(width), float(height)
        return float(self.pixel_mm), float(self.pixel_mm)

    @classmethod
    def over_box(
        cls, density: ArrayLike | Density, box: NDArray[np.float64], n_dots: int
    ) -> DensityField:
        """Lay an array or a function of arrays x and y over a box (xmin, ymin, xmax, ymax).

        A function is sampled at about eight pixels to the mean spacing of `n_dots` dots.
        """
        x0, y0, x1, y1 = box
        if callable(density):
            longest = max(x1 - x0, y1 - y0)
            pixels = min(max(8.0 * math.sqrt(n_dots), 64.0), 4096.0)
            w = max(round(pixels * (x1 - x0) / longest), 1)
            h = max(round(pixels * (y1 - y0) / longest), 1)
            x = x0 + (np.arange(w) + 0.5) * (x1 - x0) / w
            y = y0 + (np.arange(h) + 0.5) * (y1 - y0) / h
            sampled = floats(density(*np.meshgrid(x, y)), "density")
            if sampled.shape not in ((), (h, w)):
                raise ParameterError(
                    f"the function returns shape {sampled.shape} for x and y of shape {(h, w)}",
                    "density",
                )
            values = np.broadcast_to(sampled, (h, w))
        else:
            values = floats(density, "density")
        if values.ndim != 2 or values.size == 0:
            raise ParameterError("a density is a 2-d field with at least one pixel", "density")
        h, w = values.shape
        return cls(values, (float(x1 - x0) / w, float(y1 - y0) / h), (float(x0), float(y0)))
