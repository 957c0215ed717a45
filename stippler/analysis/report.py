"""All measures of a drawing at once, by name."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.analysis.spacing import measure_spacing
from stippler.analysis.spectrum import measure_spectrum
from stippler.analysis.tone_error import measure_size_noise, measure_tone

_MOST_DOTS, _FEWEST_DOTS = 4_000, 8  # whose spectrum is measured
_FINE_PX = 6.0  # a dot spacing of so many pixels is fine enough for the tone

Report = dict[str, float]
"""Values by name; NaN where there are too few dots."""


def measure_dots(position_mm: NDArray[np.float64], radius_mm: NDArray[np.floating]) -> Report:
    """Measure what dots tell by themselves: their number, sizes, spacing and spectrum.

    Parameters
    ----------
    position_mm : (n, 2) float64
    radius_mm : (n,) float
    """
    n = len(position_mm)
    spacing = measure_spacing(position_mm)
    report: Report = {
        "dots": n,
        "radius_min_mm": float(radius_mm.min()) if n else math.nan,
        "radius_mean_mm": float(radius_mm.mean()) if n else math.nan,
        "radius_max_mm": float(radius_mm.max()) if n else math.nan,
        "size_noise": measure_size_noise(position_mm, np.asarray(radius_mm, np.float64)),
        "spacing_mm": spacing.mean,
        "spacing_cv": spacing.nearest_cv,
        "relative_cv": spacing.relative_cv,
        "relative_min": spacing.relative_min,
        "edge_variance": spacing.edge_variance,
    }
    return report | _spectrum(position_mm)


def measure_against(
    position_mm: NDArray[np.float64],
    radius_mm: NDArray[np.floating],
    darkness: NDArray[np.float32],
    width_mm: float,
) -> Report:
    """Measure how well the ink of dots, as discs, meets a picture that fills the page's width."""
    names = ("tone_rmse", "detail_rmse", "tone_bias", "tone_gain", "overlap")
    n = len(position_mm)
    if n == 0:
        return dict.fromkeys(names, math.nan)
    ink = max(float(darkness.mean()), 1e-3) * darkness.size
    k = min(max(1, int(math.sqrt(ink / n) / _FINE_PX)), *darkness.shape)
    h, w = (side // k for side in darkness.shape)
    seen = darkness[: h * k, : w * k].reshape(h, k, w, k).mean(axis=(1, 3), dtype=np.float64)
    px = darkness.shape[1] / (k * width_mm)
    found = measure_tone(position_mm * px, radius_mm.astype(np.float64) * px, seen)
    values = (found.tone_rmse, found.detail_rmse, found.bias, found.gain, found.overlap)
    return dict(zip(names, values, strict=True))


def _spectrum(position_mm: NDArray[np.float64]) -> Report:
    """Measure the spectrum of the dots in a square in their middle."""
    centre, half = _middle(position_mm)
    inside = position_mm[(np.abs(position_mm - centre) <= half).all(axis=1)]
    values = [math.nan] * 3
    if half > 0 and len(inside) >= _FEWEST_DOTS:
        (x0, y0), (x1, y1) = (centre - half).tolist(), (centre + half).tolist()
        spectrum = measure_spectrum(inside, (x0, y0, x1, y1))
        values = [spectrum.low, spectrum.peak, spectrum.direction_db]
    names = ("spectrum_low", "spectrum_peak", "direction_db")
    return {"spectrum_dots": len(inside)} | dict(zip(names, values, strict=True))


def _middle(position_mm: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """Return the centre and half the side of the square whose dots are enough."""
    if len(position_mm) == 0:
        return np.zeros(2), 0.0
    low, high = position_mm.min(axis=0), position_mm.max(axis=0)
    centre, half = (low + high) / 2, float((high - low).min()) / 2
    away = np.abs(position_mm - centre).max(axis=1)
    if len(away) > _MOST_DOTS:
        half = min(half, float(np.partition(away, _MOST_DOTS - 1)[_MOST_DOTS - 1]))
    return centre, half
