"""How a picture's darkness is changed before dots are made of it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError

MAX_BRIGHTNESS = 0.9
MAX_CONTRAST = 1.0
MIN_SPAN = 0.05
GAMMA_RANGE = (0.2, 5.0)
_BAND_PX = 1 << 18  # a piece at a time, so that what lies between fits the cache


@dataclass(frozen=True, slots=True)
class Adjustment:
    """Brightness, contrast, gamma and inversion of a picture, applied in the order of `curve`.

    White stays white, exactly, unless it is inverted: no dots come out of bare paper.

    Attributes
    ----------
    brightness : float
        -0.9..0.9. Above 0 so much darkness is taken away, and the lightest tones become paper;
        below 0 all but white is deepened, and the darkest tones become black.
    contrast : float
        -1..1. Above 0 an S-shaped curve about the middle grey; below 0 a flatter one.
    gamma : float
        0.2..5. Above 1 the middle tones get lighter, below 1 darker; white and black stay.
    invert : bool
        Black for white, before all else.
    white, black : float
        0..1, at least `MIN_SPAN` apart. Tones lighter than `white` become paper, those darker than
        `black` black, and what lies between is spread out; before the brightness.
    """

    brightness: float = 0.0
    contrast: float = 0.0
    gamma: float = 1.0
    invert: bool = False
    white: float = 0.0
    black: float = 1.0

    def __post_init__(self) -> None:
        for name, value, low, high in (
            ("brightness", self.brightness, -MAX_BRIGHTNESS, MAX_BRIGHTNESS),
            ("contrast", self.contrast, -MAX_CONTRAST, MAX_CONTRAST),
            ("gamma", self.gamma, *GAMMA_RANGE),
            ("white point", self.white, 0.0, 1.0 - MIN_SPAN),
            ("black point", self.black, self.white + MIN_SPAN * (1.0 - 1e-9), 1.0),
        ):
            if not (math.isfinite(value) and low <= value <= high):
                raise ParameterError(
                    f"{value:g} is out of range", name, f"give {low:g} to {high:g}"
                )

    @property
    def curve(self) -> tuple[float, float, float, float, float]:
        """Inversion, what is taken away, factor, steepness and exponent, as shader and kernel use.

        With darkness d, inverted where the first is 1: d = (d - taken) * factor, held to 0..1;
        then d^k / (d^k + (1 - d)^k) with the steepness k; then d to the power of the exponent.
        """
        span = self.black - self.white
        taken = self.white + span * max(self.brightness, 0.0)
        factor = 1.0 / (span * (1.0 + min(self.brightness, 0.0)))
        return float(self.invert), taken, factor, 4.0**self.contrast, self.gamma

    def apply(self, darkness: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return the darkness as adjusted, 0..1, of the same shape."""
        out = np.array(darkness, np.float32)
        flat = out.reshape(-1)
        for first in range(0, len(flat), _BAND_PX):
            self._apply_to(flat[first : first + _BAND_PX])
        return out

    def _apply_to(self, d: NDArray[np.float32]) -> None:
        inverted, taken, factor, steepness, exponent = (np.float32(v) for v in self.curve)
        if inverted:
            np.subtract(np.float32(1.0), d, out=d)
        d -= taken
        d *= factor
        np.clip(d, 0.0, 1.0, out=d)
        if steepness != 1.0:
            dark, light = d**steepness, (1.0 - d) ** steepness
            np.divide(dark, dark + light, out=d)
        if exponent != 1.0:
            np.power(d, exponent, out=d)


NEUTRAL = Adjustment()
