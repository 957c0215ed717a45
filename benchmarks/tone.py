"""Which tone looks right: the lightness of drawn grey patches beside that of the picture's.

At arm's length the eye no longer sees dots but the light that comes back from them and the paper
between, averaged. A patch of which a share c is inked sends back 1 − c of the light, and its
lightness is L* (CIE 1976) of that.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from benchmarks.figures import Figure
from stippler.api import stipple
from stippler.headless import render_image

GREYS = np.array([40, 64, 90, 115, 140, 166, 191, 217, 242], np.uint8)
_PATCH_PX = 120
_PATCH_MM = 20.0
_SCALE_PX = 24.0  # a millimetre


def figures(quick: bool = False) -> list[Figure]:
    """Draw nine grey patches in both tones and compare lightness."""
    results = []
    for tone in ("linear", "perceptual"):
        drawn = drawn_lightness(tone, 6_000 if quick else 20_000)
        error = drawn - lightness(to_linear(GREYS / 255))
        results.append(
            Figure(
                f"{tone}: lightness of drawn greys, RMS error",
                float(np.sqrt((error**2).mean())),
                "L*",
                note=f"mean {error.mean():+.1f}",
            )
        )
    return results


def drawn_lightness(tone: str, dots: int) -> NDArray[np.float64]:
    """Return the lightness of each patch as drawn, dots and paper averaged as light."""
    picture = np.repeat(np.repeat(GREYS[None, :], _PATCH_PX, axis=1), _PATCH_PX, axis=0)
    drawing = stipple(picture, dots, _PATCH_MM * len(GREYS), tone=tone)  # type: ignore[arg-type]
    pixels = render_image(drawing, px_per_mm=_SCALE_PX)[..., 0] / 255  # 1 − coverage
    patch, margin = round(_PATCH_MM * _SCALE_PX), round(2 * _SCALE_PX)
    light = [
        pixels[margin:-margin, k * patch + margin : (k + 1) * patch - margin].mean()
        for k in range(len(GREYS))
    ]
    return lightness(np.array(light))


def to_linear(encoded: NDArray[np.float64]) -> NDArray[np.float64]:
    """Decode sRGB."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def lightness(luminance: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return CIE 1976 L*, 0..100."""
    small = luminance <= (6 / 29) ** 3
    return np.where(small, luminance * (29 / 3) ** 3, 116 * np.cbrt(luminance) - 16)
