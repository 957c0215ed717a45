"""A picture's darkness as 16-bit levels, and what is to be read from it as a table of them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

N_LEVELS = 65_536

Curve = Callable[[NDArray[np.float32]], NDArray[np.floating]]
"""What becomes of darkness 0..1, value by value."""

_DARKEST = np.float32(N_LEVELS - 1)
_BAND_PX = 1 << 18  # a piece at a time, so that what lies between fits the cache


def levels_of(darkness: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Return the nearest of 65,536 levels of darkness, read-only; only white itself is level 0."""
    levels = np.empty(darkness.shape, np.uint16)
    flat, out = darkness.reshape(-1), levels.reshape(-1)
    for first in range(0, len(flat), _BAND_PX):
        band = flat[first : first + _BAND_PX] * _DARKEST
        tiny = (band > 0.0) & (band < 0.5)
        band += np.float32(0.5)
        found = band.astype(np.uint16)
        found[tiny] = 1
        out[first : first + _BAND_PX] = found
    levels.flags.writeable = False
    return levels


def table_of(*curves: Curve) -> NDArray[np.float32]:
    """Return what curves, one after the other, make of each level.

    Adjustment, tone, a style's curve and the rule for density are such curves: what they come to is
    looked up then, instead of being worked out for each pixel.
    """
    values: NDArray[np.floating] = np.arange(N_LEVELS, dtype=np.float32) / _DARKEST
    for curve in curves:
        values = curve(values.astype(np.float32))
    return np.ascontiguousarray(values, np.float32)
