"""Quality of a stipple drawing, measured from outside: nothing here uses the program's own code.

The figures that the program promises were set with this measure, and so are those of other
programs in `docs/quality.md`; its arithmetic must not change.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from scipy.spatial import KDTree

Floats = NDArray[np.float64]


def ink(points: Floats, radii: Floats, width: int, height: int, scale: int) -> NDArray[np.float32]:
    """Return the coverage by discs, 0..1, on a grid `scale` times finer than the picture."""
    w, h = width * scale, height * scale
    cover = np.zeros((h, w), np.float32)
    for (x, y), r in zip(points * scale, radii * scale, strict=True):
        x0, x1 = max(int(x - r - 1), 0), min(int(x + r + 2), w)
        y0, y1 = max(int(y - r - 1), 0), min(int(y + r + 2), h)
        if x0 >= x1 or y0 >= y1:
            continue
        gy, gx = np.mgrid[y0:y1, x0:x1]
        d = np.hypot(gx + 0.5 - x, gy + 0.5 - y)
        part = cover[y0:y1, x0:x1]
        np.maximum(part, np.clip(r + 0.5 - d, 0, 1), out=part)
    return cover


def ssim(a: Floats, b: Floats, sigma: float) -> float:
    """Return the structural similarity of two pictures."""
    c1, c2 = 0.01**2, 0.03**2

    def g(t: Floats) -> Floats:
        return np.asarray(gaussian_filter(t, sigma), np.float64)

    ma, mb = g(a), g(b)
    va, vb, vab = g(a * a) - ma * ma, g(b * b) - mb * mb, g(a * b) - ma * mb
    top = (2 * ma * mb + c1) * (2 * vab + c2)
    return float(np.mean(top / ((ma**2 + mb**2 + c1) * (va + vb + c2))))


def measure(points: Floats, radii: Floats, dark: Floats) -> dict[str, Any]:
    """Score dots, in pixels of the picture, against the darkness they were made from.

    tone_rmse: RMS difference of local ink and darkness, blurred by two mean dot spacings;
    tone_bias: its mean, positive is too dark; tone_gain: slope of drawn over asked darkness;
    detail_rmse: as tone_rmse with one spacing; ssim: of the two blurred pictures; overlap: share
    of ink lost to dots that overlap; nn_cv: variation of the nearest-neighbour distance;
    rel_nn_cv and min_rel: variation and first percentile of that distance over the one to the
    seventh; size_noise: RMS of log(radius / mean of the six nearest).
    """
    h, w = dark.shape
    n = len(points)
    spacing = np.sqrt(max(dark.mean(), 1e-3) * h * w / n)
    zoom = min(float(np.clip(4.0 / np.median(radii), 1, 16000 / max(w, h))), np.sqrt(9e7 / (w * h)))
    scale = max(1, round(zoom))
    cover = ink(points, radii, w, h, scale)
    area = np.pi * (radii**2).sum() * scale * scale
    coarse = cover.reshape(h, scale, w, scale).mean(axis=(1, 3))
    sigma = 2 * spacing
    a = np.asarray(gaussian_filter(coarse, sigma, mode="nearest"))
    b = np.asarray(gaussian_filter(dark, sigma, mode="nearest"))
    tree = KDTree(points)
    d = np.asarray(tree.query(points, k=min(8, n))[0])
    nn, local = d[:, 1], d[:, -1]
    fine = gaussian_filter(coarse, spacing, mode="nearest") - gaussian_filter(
        dark, spacing, mode="nearest"
    )
    near = np.asarray(tree.query(points, k=min(7, n))[1])[:, 1:]
    noise = np.log(radii / radii[near].mean(axis=1))
    rel = nn / np.maximum(local, 1e-9)
    return {
        "dots": n,
        "tone_rmse": float(np.sqrt(np.mean((a - b) ** 2))),
        "tone_bias": float(np.mean(a - b)),
        "tone_gain": float(np.polyfit(b.ravel(), a.ravel(), 1)[0]) if b.std() > 1e-6 else np.nan,
        "detail_rmse": float(np.sqrt(np.mean(fine**2))),
        "size_noise": float(np.sqrt(np.mean(noise**2))),
        "ssim": ssim(a, b, 2 * sigma),
        "overlap": float(1 - cover.sum() / area),
        "nn_cv": float(nn.std() / nn.mean()),
        "rel_nn_cv": float(rel.std() / rel.mean()),
        "min_rel": float(np.percentile(rel, 1)),
        "scale": scale,
    }
