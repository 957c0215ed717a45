"""Scores of whole drawings by the outside measure: ``python -m benchmarks.quality``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks.figures import Figure
from benchmarks.scorer import measure
from stippler.analysis.tone_error import measure_tone
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.resources import assets
from stippler.stippling.stipple import Progress, stages
from stippler.stippling.tone import DotRule

SPHERE = Path(__file__).parents[1] / "tests/data/sphere_ramp.png"
SAMPLES = ("ammonite.png", "honey-bee.jpg", "sandstone.jpg", "step-wedge.png")
SAMPLE_PX = 1000

_Promise = dict[str, tuple[float, float]]
_TEN: _Promise = {
    "tone_rmse": (0.007, 0.004),
    "detail_rmse": (0.009, 0.006),
    "gain off 1": (0.015, 0.005),
    "bias off 0": (0.002, 0.001),
    "ssim": (0.995, 0.998),
    "rel_nn_cv": (0.127, 0.11),
    "min_rel": (0.47, 0.55),
    "size_noise": (0.05, 0.03),
}
_FIFTY = _TEN | {"tone_rmse": (0.009, 0.005), "detail_rmse": (0.012, 0.008), "ssim": (0.99, 0.995)}
_HIGHER = ("ssim", "min_rel")


def figures(quick: bool = False) -> list[Figure]:
    """Score drawings of the sphere and ramp, and of the samples, 1:2 and single size."""
    results: list[Figure] = []
    sphere = read_darkness(SPHERE)
    for n, promise in ((10_000, _TEN), (50_000, _FIFTY)):
        if n == 50_000 and quick:
            continue
        results += _figures(f"sphere, {n:,} dots", sphere, Style(n_dots=n), promise)
        radius = single_radius(sphere, n)
        single = Style(size_range_mm=(radius, radius))
        results += _figures(f"sphere, one size, about {n:,}", sphere, single, {})
    for name in SAMPLES[:1] if quick else SAMPLES:
        for n, promise in ((10_000, _TEN), (50_000, _FIFTY)):
            if n == 50_000 and quick:
                continue
            picture = read_darkness(assets() / "samples" / name, SAMPLE_PX)
            results += _figures(f"{Path(name).stem}, {n:,} dots", picture, Style(n_dots=n), promise)
    return results


def read_darkness(path: Path, longest_px: int = 0) -> NDArray[np.float64]:
    """Return a picture's perceptual darkness, scaled down to a longest side if one is given."""
    image = Image.open(path).convert("L")
    if longest_px:
        image.thumbnail((longest_px, longest_px), Image.Resampling.BOX)
    return 1.0 - np.asarray(image, np.float64) / 255.0


def draw(darkness: NDArray[np.float64], style: Style) -> Progress:
    """Carry out a style with a millimetre for each pixel, as the measure wants it."""
    reference = Reference(darkness.astype(np.float32), float(darkness.shape[1]))
    *_, last = stages(reference, style, snapshots=False)
    return last


def score(darkness: NDArray[np.float64], result: Progress) -> dict[str, Any]:
    """Score a drawing, by the outside measure and against an exact union of the discs."""
    points, radii = np.array(result.position_mm), result.radius_mm.astype(np.float64)
    found = measure(points, radii, darkness)
    found["gain off 1"] = abs(found["tone_gain"] - 1.0)
    found["bias off 0"] = abs(found["tone_bias"])
    found["exact"] = measure_tone(points, radii, darkness).tone_rmse
    return found


def single_radius(darkness: NDArray[np.float64], n: int) -> float:
    """Return the one radius with which about n dots meet the tone."""
    wanted = float(DotRule(1.0, 1.0).density(darkness).sum())
    return float(np.sqrt(wanted / n))


def _figures(
    name: str, darkness: NDArray[np.float64], style: Style, promise: _Promise
) -> list[Figure]:
    found = score(darkness, draw(darkness, style))
    results = []
    for key in _TEN:
        reach, stretch = promise.get(key, (None, None))
        note = ""
        if key == "tone_rmse":
            note = f"{found['exact']:.4f} exactly; {found['scale']} samples a pixel here"
        results.append(
            Figure(f"{name}: {key}", found[key], "", reach, stretch, key in _HIGHER, note)
        )
    return results


if __name__ == "__main__":
    from benchmarks.all import main

    raise SystemExit(main(only="quality"))
