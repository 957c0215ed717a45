"""Weathered sandstone: warped bedding, honeycomb weathering, a fissure and grain."""

from __future__ import annotations

import numpy as np
from scipy.ndimage import gaussian_filter
from sources.relief import (
    Field,
    encode,
    fractal,
    hash01,
    jit,
    light,
    noise,
    reduce,
    smoothstep,
)


@jit
def _cells(x: float, y: float, seed: int) -> tuple[float, float, float]:
    """Return the distances to the nearest and next cell centre, and a number for the cell."""
    i0, j0 = int(np.floor(x)), int(np.floor(y))
    first, second, name = 9.0, 9.0, 0.0
    for j in range(j0 - 2, j0 + 3):
        for i in range(i0 - 2, i0 + 3):
            dx = i + 0.1 + 0.8 * hash01(i, j, seed) - x
            dy = j + 0.1 + 0.8 * hash01(i, j, seed + 1) - y
            d = np.sqrt(dx * dx + dy * dy)
            if d < first:
                first, second, name = d, first, hash01(i, j, seed + 2)
            elif d < second:
                second = d
    return first, second, name


@jit
def _lamina(s: float, seed: int) -> float:
    """Hard and soft layers along the coordinate across the bedding."""
    return (
        0.55 * noise(s, 0.3, seed)
        + 0.3 * noise(2.7 * s, 5.1, seed)
        + 0.2 * noise(7.1 * s, 9.7, seed)
    )


@jit
def _build(z: Field, tint: Field) -> None:
    h, w = z.shape
    for j in range(h):
        for i in range(w):
            x, y = (i + 0.5) / h, (j + 0.5) / h
            bend = fractal(1.7 * x + 0.4 * y, 1.7 * y - 0.4 * x, 3, 4)
            fine = fractal(9 * x + 4 * y, 9 * y - 4 * x, 13, 4)
            # Two sets of beds, the lower dipping against the upper.
            split = smoothstep(-0.012, 0.012, y - 0.60 + 0.16 * x - 0.05 * bend)
            upper = y + 0.10 * x + 0.055 * bend + 0.004 * fine
            lower = y - 0.34 * x - 0.22 * x * x + 0.03 * bend + 0.004 * fine
            layer = (1 - split) * _lamina(46 * upper, 71) + split * _lamina(52 * lower, 72)
            height = 0.0050 * layer + 0.040 * bend + 0.0026 * fine
            # Honeycomb weathering where the stone is soft, stretched along the beds.
            soft = fractal(1.5 * x + 2.2, 2.0 * upper + 0.7, 23, 3) + 0.12
            eaten = smoothstep(-0.05, 0.60, soft) * (1 - split)
            first, second, name = _cells(
                11 * x + 0.45 * fine, 15.5 * upper + 0.40 * bend + 0.25 * fine, 31
            )
            bowl = smoothstep(0.06, 0.62, second - first)
            height -= 0.040 * eaten * (0.35 + 0.65 * name) * bowl
            # A fissure that steps from bed to bed, and a branch that closes.
            way = x - 0.735 + 0.20 * y - 0.034 * fractal(2.3 * y, 0.4, 61, 6) - 0.006 * fine
            way += 0.0035 * layer
            gap = 0.0030 * (0.75 + fractal(6 * y, 2.0, 63, 3))
            depth = 0.034 * smoothstep(0.0002, 0.0016, gap)
            height -= depth * np.exp(-((way / max(gap, 0.0009)) ** 2))
            height -= 0.007 * np.exp(-np.abs(way) / 0.010)
            side = x - 0.735 + 0.62 * (y - 0.28) - 0.028 * fractal(3.1 * y, 8.4, 66, 6)
            side += 0.004 * layer
            fade = smoothstep(0.20, 0.34, y) * (1 - smoothstep(0.53, 0.57, y))
            height -= 0.011 * fade * np.exp(-((side / 0.0015) ** 2))
            grain = noise(210 * x, 210 * y, 91) + 0.7 * noise(390 * x, 390 * y, 92)
            height += 0.00055 * grain
            z[j, i] = height * h
            stain = fractal(2.6 * x - 3.0, 7.0 * upper, 81, 4)
            tone = 0.52 + 0.17 * layer + 0.10 * stain + 0.025 * grain - 0.10 * eaten * bowl
            tint[j, i] = min(max(tone, 0.15), 0.95)


def draw(width: int = 1600, height: int = 1600, oversample: int = 1) -> Field:
    """Draw a wall of sandstone in raking light.

    Returns
    -------
    (height, width) float32
        Encoded luminance, 0..1.
    """
    w, h = width * oversample, height * oversample
    z, tint = np.empty((h, w), np.float32), np.empty((h, w), np.float32)
    _build(z, tint)
    elevation = np.radians(34.0)
    sky, direct = light(z, np.radians(-128.0), elevation, np.radians(4.0), 24)
    hollow = np.clip((gaussian_filter(z, 0.006 * h) - z) / (0.006 * h), -1.0, 1.0)
    linear = tint * (1 - 0.3 * hollow) * (1.22 * direct + 0.12 * sky)
    return reduce(encode(linear), oversample)
