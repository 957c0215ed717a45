"""The curve by which an illustrator would draw a picture's greys: from its own histogram.

True tone is right at arm's length and too dark near by: dots merge over what is darker than a
middle grey, and form is lost. So the lightest tones become bare paper, the deepest stay just open,
and what lies between goes by lightness, a little lighter or darker where the whole would be too
dark or too pale.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.kernels.machine.pool import parallel_for

DEEPEST = 0.82
"""Share of the paper that ink covers at most: relaxed dots just do not merge."""

_CLIPPED = 0.005  # of the pixels, at each end of the histogram
_LEAST_SPAN = 0.3  # between white and black: pale pictures are not blown up to any contrast
_PAPER, _PAPER_SHARE, _PAPER_WIDTH = 0.3, 0.2, 0.02  # no darker, rarer, more uneven is paper
_PALE, _DARK, _GAMMAS = 0.28, 0.40, (0.6, 2.0)  # mean ink that is left as it is, else aimed at
_PALEST, _DARKEST, _MOST_GAMMAS = 0.22, 0.48, (0.4, 4.0)  # and what powers beyond those serve
_LEVELS = 1024
_AT_ONCE = 65_536  # pixels


@dataclass(frozen=True, slots=True)
class ToneCurve:
    """Ink by darkness: none up to `white`, `deepest` from `black` on, between by a power.

    Attributes
    ----------
    white, black : float
        Darkness, 0..1.
    gamma : float
        Above 1 the middle tones get lighter.
    deepest : float
    """

    white: float = 0.0
    black: float = 1.0
    gamma: float = 1.0
    deepest: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.white < self.black <= 1.0:
            raise ParameterError(
                f"{self.white:g} to {self.black:g} is no range", "white and black", "give 0 to 1"
            )
        if not (self.gamma > 0.0 and 0.0 < self.deepest <= 1.0):
            raise ParameterError(f"{self.gamma:g}, {self.deepest:g}", "gamma and deepest tone")

    def at(self, darkness: NDArray[np.floating]) -> NDArray[np.float64]:
        """Return the ink for darkness."""
        t = (np.asarray(darkness, np.float64) - self.white) / (self.black - self.white)
        ink: NDArray[np.float64] = self.deepest * np.clip(t, 0.0, 1.0) ** self.gamma
        return ink

    def apply(self, darkness: NDArray[np.float32]) -> NDArray[np.float32]:
        """Return a field of ink, by a table; white stays 0 exactly."""
        table = self.at(np.arange(65536) / 65535.0).astype(np.float32)
        out = np.empty(darkness.shape, np.float32)

        def part(start: int, stop: int) -> None:
            level = np.rint(darkness[start:stop] * np.float32(65535)).astype(np.uint16)
            out[start:stop] = table[level]

        # what lies between fits the cache
        parallel_for(part, len(darkness), grain=32, chunks=max(len(darkness) // 64, 1))
        return out


def illustration(
    darkness: NDArray[np.float32], counts: NDArray[np.int64] | None = None
) -> ToneCurve:
    """Choose the curve for a picture by its perceptual darkness.

    `counts`: how many pixels there are of each value, where these alone are given.
    """
    pixels = tones_in(darkness.ravel()) if counts is None else _shared_out(darkness, counts)
    return curve_for(pixels)


def curve_for(pixels: NDArray[np.int64]) -> ToneCurve:
    """Choose the curve by how many pixels there are of each tone, as `tones_in` counts them."""
    share = pixels / max(int(pixels.sum()), 1)
    levels = (np.arange(_LEVELS) + 0.5) / _LEVELS
    white = _white_of(share, levels)
    inked = np.where(levels > white, share, 0.0)
    if not inked.sum() > 0.0:
        return ToneCurve(0.0, 1.0, 1.0, DEEPEST)
    dark_end = levels[np.searchsorted(np.cumsum(inked) / inked.sum(), 1.0 - _CLIPPED)]
    black = min(max(float(dark_end) + 0.5 / _LEVELS, white + _LEAST_SPAN), 1.0)
    white = min(white, black - _LEAST_SPAN)
    return ToneCurve(white, black, _gamma_for(share, levels, white, black), DEEPEST)


def tones_in(darkness: NDArray[np.float32]) -> NDArray[np.int64]:
    """Return how many of (n,) pixels there are of each of 1,024 tones."""
    found = np.zeros(_LEVELS, np.int64)
    for first in range(0, len(darkness), _AT_ONCE):  # what lies between fits the cache
        bins = (darkness[first : first + _AT_ONCE] * np.float32(_LEVELS)).astype(np.intp)
        found += np.bincount(np.minimum(bins, _LEVELS - 1, out=bins), minlength=_LEVELS)
    return found


def _shared_out(darkness: NDArray[np.float32], counts: NDArray[np.int64]) -> NDArray[np.int64]:
    """Return how many pixels there are of each level, from how many there are of each value."""
    found = np.zeros(_LEVELS, np.int64)
    bins = (darkness * np.float32(_LEVELS)).astype(np.intp)
    np.add.at(found, np.minimum(bins, _LEVELS - 1), counts)
    return found


def _white_of(share: NDArray[np.float64], levels: NDArray[np.float64]) -> float:
    """Return the darkness up to which a picture is paper: its background's, if it has one."""
    if share[0] >= _PAPER_SHARE:
        return 0.0  # white as it is
    half = int(_PAPER_WIDTH * _LEVELS)
    within = np.convolve(share, np.ones(2 * half + 1), "same")
    best = int(np.argmax(np.where(levels < _PAPER, within, 0.0)))
    lighter = float(share[: max(best - 2 * half, 0)].sum())
    if within[best] >= _PAPER_SHARE and lighter < 0.05:
        return float(levels[min(best + half, _LEVELS - 1)])
    first = int(np.searchsorted(np.cumsum(share), _CLIPPED))
    return float(max(levels[first] - 0.5 / _LEVELS, 0.0))


def _gamma_for(
    share: NDArray[np.float64], levels: NDArray[np.float64], white: float, black: float
) -> float:
    """Return the power that brings the mean ink into bounds, or as near as powers go."""

    def mean(gamma: float) -> float:
        return float(share @ ToneCurve(white, black, gamma, DEEPEST).at(levels))

    def solved(aim: float, low: float, high: float) -> float:
        for _ in range(30):
            middle = 0.5 * (low + high)
            if mean(middle) > aim:
                low = middle
            else:
                high = middle
        return round(0.5 * (low + high), 3)

    gamma = solved(min(max(mean(1.0), _PALE), _DARK), *_GAMMAS)
    if _PALEST <= mean(gamma) <= _DARKEST:
        return gamma
    return solved(min(max(mean(gamma), _PALEST), _DARKEST), *_MOST_GAMMAS)
