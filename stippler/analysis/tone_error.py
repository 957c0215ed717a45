"""How well the ink of a drawing, seen from afar, meets the darkness it was made from."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tone.rasterize_discs import cover

_MOST_CELLS = 60_000_000


@dataclass(frozen=True, slots=True)
class ToneError:
    """Differences of blurred ink and blurred darkness, both 0..1.

    Attributes
    ----------
    tone_rmse : float
        Root of the mean square, blurred by a Gaussian of two mean dot spacings.
    detail_rmse : float
        The same with one mean dot spacing.
    bias : float
        Mean difference; above 0 the drawing is too dark.
    gain : float
        Slope of drawn over asked darkness; NaN for a picture of one tone.
    overlap : float
        Share of ink lost to dots that overlap.
    """

    tone_rmse: float
    detail_rmse: float
    bias: float
    gain: float
    overlap: float


def draw_ink(
    points: NDArray[np.float64], radii: NDArray[np.float64], shape: tuple[int, int], zoom: int = 1
) -> NDArray[np.float32]:
    """Return the share of each pixel that the union of the discs covers.

    Parameters
    ----------
    points : (n, 2) float64, pixels
    radii : (n,) float64, pixels
    shape : (h, w)
    zoom : int
        Samples a side of a pixel.
    """
    h, w = shape
    at = np.ascontiguousarray(points, np.float64) * zoom
    order = np.argsort(at[:, 1], kind="stable").astype(np.int64)
    row_of = np.searchsorted(at[order, 1], np.arange(h * zoom + 1)).astype(np.int64)
    row_of[0], row_of[-1] = 0, len(order)
    field = np.empty((h * zoom, w * zoom), np.float32)
    parallel_for(
        cover, h * zoom, at, np.asarray(radii, np.float64) * zoom, order, row_of, field, grain=64
    )
    ink: NDArray[np.float32] = field.reshape(h, zoom, w, zoom).mean(axis=(1, 3))
    return ink


def measure_tone(
    points: NDArray[np.float64], radii: NDArray[np.float64], darkness: NDArray[np.floating]
) -> ToneError:
    """Compare the ink of dots with the darkness asked for; lengths in pixels.

    Parameters
    ----------
    points : (n, 2) float64
        At least one.
    radii : (n,) float64
    darkness : (h, w), 0..1
    """
    from scipy.ndimage import gaussian_filter

    asked = np.asarray(darkness, np.float64)
    h, w = asked.shape
    spacing = math.sqrt(max(float(asked.mean()), 1e-3) * h * w / len(points))
    zoom = math.ceil(8.0 / float(np.median(radii)))
    zoom = max(1, min(zoom, int(math.sqrt(_MOST_CELLS / (h * w)))))
    ink = draw_ink(points, radii, (h, w), zoom).astype(np.float64)
    drawn, seen = (gaussian_filter(f, 2.0 * spacing, mode="nearest") for f in (ink, asked))
    fine = gaussian_filter(ink - asked, spacing, mode="nearest")
    varies = float(seen.std()) > 1e-6
    return ToneError(
        float(np.sqrt(np.mean((drawn - seen) ** 2))),
        float(np.sqrt(np.mean(fine**2))),
        float(np.mean(ink - asked)),
        float(np.polyfit(seen.ravel(), drawn.ravel(), 1)[0]) if varies else math.nan,
        float(1.0 - ink.sum() / (math.pi * np.square(radii).sum())),
    )


def measure_size_noise(points: NDArray[np.float64], radii: NDArray[np.float64]) -> float:
    """Return the RMS logarithm of each radius over the mean of its six neighbours'."""
    from scipy.spatial import KDTree

    n = len(points)
    if n < 8:
        return math.nan
    near = np.asarray(KDTree(points).query(points, k=7)[1])[:, 1:]
    return float(np.sqrt(np.mean(np.log(radii / radii[near].mean(axis=1)) ** 2)))
