"""The picture that tone is taken from, as a field of darkness over the page."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.adjustment import NEUTRAL, Adjustment
from stippler.errors import ParameterError


@dataclass(frozen=True, slots=True, eq=False)
class Reference:
    """Darkness over the page: pixel (0, 0) at the top left corner, square pixels.

    Attributes
    ----------
    darkness : (h, w) float32, read-only
        0 (white, weight exactly 0) to 1 (black).
    width_mm : float
        Width of the field on the page.
    adjustment : Adjustment
        How the darkness was made from that of `picture`.
    """

    darkness: NDArray[np.float32]
    width_mm: float
    adjustment: Adjustment = NEUTRAL
    _picture: Reference | None = None

    def __post_init__(self) -> None:
        field = self.darkness
        if field.ndim != 2 or field.size == 0:
            raise ParameterError("a reference is a 2-d field with at least one pixel", "reference")
        if not (np.isfinite(self.width_mm) and self.width_mm > 0):
            raise ParameterError(f"{self.width_mm} mm is no width", "page", "give a width above 0")
        low, high = float(field.min()), float(field.max())
        if not (low >= 0.0 and high <= 1.0):  # also catches NaN
            raise ParameterError("darkness has to lie in 0..1 and be finite", "reference")
        fresh = np.ascontiguousarray(field, np.float32)
        fresh.flags.writeable = False
        object.__setattr__(self, "darkness", fresh)

    @property
    def picture(self) -> Reference:
        """The reference as it is without any adjustment."""
        return self._picture or self

    def adjusted(self, adjustment: Adjustment) -> Reference:
        """Return the picture with another adjustment; what was adjusted before does not add up."""
        if adjustment == self.adjustment:
            return self
        picture = self.picture
        if adjustment == picture.adjustment:
            return picture
        return Reference(adjustment.apply(picture.darkness), self.width_mm, adjustment, picture)

    @property
    def pixel_mm(self) -> float:
        """Side of a pixel on the page."""
        columns: int = self.darkness.shape[1]
        return self.width_mm / columns

    @property
    def height_mm(self) -> float:
        """Height of the field on the page."""
        rows: int = self.darkness.shape[0]
        return self.pixel_mm * rows

    def at(self, position_mm: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the darkness at points of the page, between pixels by interpolation.

        Parameters
        ----------
        position_mm : (n, 2) float64
            Points beside the field take that of its border.
        """
        from stippler.kernels.tone.sampling import (
            sampled,  # numba: late, for the first frame's sake
        )

        return sampled(self.darkness, 1.0 / self.pixel_mm, position_mm)
