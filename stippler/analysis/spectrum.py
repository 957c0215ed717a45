"""The Fourier spectrum of a set of dots: whether it is blue noise, and without direction."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, slots=True, eq=False)
class Spectrum:
    """Power of a point set, averaged over rings of equal frequency.

    Attributes
    ----------
    frequency : (k,) float64
        In units of one over the mean spacing.
    power : (k,) float64
        1 for independent random dots.
    anisotropy_db : (k,) float64
        Variance over the squared mean within each ring; about 0 without preferred direction.
    picture : (2 m + 1, 2 m + 1) float64
        The power itself, zero frequency in the middle.
    """

    frequency: NDArray[np.float64]
    power: NDArray[np.float64]
    anisotropy_db: NDArray[np.float64]
    picture: NDArray[np.float64]

    @property
    def low(self) -> float:
        """Mean power below half the frequency of the mean spacing: 0 for perfect evenness."""
        return float(self.power[self.frequency < 0.5].mean())

    @property
    def peak(self) -> float:
        """Largest power of a ring: how strongly one spacing prevails."""
        return float(self.power.max())

    @property
    def direction_db(self) -> float:
        """Mean anisotropy around the prevailing frequency, in dB."""
        around = (self.frequency > 0.5) & (self.frequency < 1.5)
        return float(self.anisotropy_db[around].mean())


def measure_spectrum(
    points: NDArray[np.float64], box: tuple[float, float, float, float], reach: float = 2.5
) -> Spectrum:
    """Compute the power spectrum of dots that fill a box.

    Parameters
    ----------
    points : (n, 2) float64
        At least one.
    box : (x0, y0, x1, y1)
        In the unit of the points.
    reach : float
        Highest frequency, in units of one over the mean spacing.

    Notes
    -----
    O(n reach² n). Ulichney 1987 for rings and anisotropy.
    """
    n = len(points)
    x0, y0, x1, y1 = box
    at = (points - (x0, y0)) / max(x1 - x0, y1 - y0)
    m = max(1, int(reach * math.sqrt(n)))
    f = np.arange(-m, m + 1)
    turns = -2j * np.pi
    columns = np.exp(turns * np.outer(at[:, 0], f))
    rows = np.exp(turns * np.outer(f, at[:, 1]))
    picture = np.abs(rows @ columns) ** 2 / n
    ring = np.floor(np.hypot(f[:, None], f[None, :])).astype(np.intp).ravel()
    count = np.bincount(ring)
    mean = np.bincount(ring, picture.ravel()) / count
    variance = np.bincount(ring, picture.ravel() ** 2) / count - mean**2
    keep = slice(1, m + 1)
    floor = np.maximum(variance[keep], 1e-12)
    return Spectrum(
        np.arange(len(mean))[keep] / math.sqrt(n),
        mean[keep],
        10.0 * np.log10(floor / np.maximum(mean[keep], 1e-12) ** 2),
        picture,
    )
