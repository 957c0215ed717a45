"""The outline of a dot: one formula, in kernels here and in `shaders/lib/dot_shape.glsl`.

A dot is a rough circle of area pi, squeezed along its angle into a shape of the same area, scaled
by its radius. In polar coordinates of the unsqueezed shape

    radius(phi)^2 = 1 + sum over k = 2..9 of x_k cos(k phi) + y_k sin(k phi)

so the area, half the integral of radius^2, is pi whatever the coefficients. They come from the
dot's seed by integer hashing, and their lengths add up to ``roughness * MAX_ROUGH < 1``: radius^2
stays above 0, and an outline that every ray from the centre meets once cannot cross itself.
"""

from __future__ import annotations

import math
from functools import cache
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.errors import ParameterError
from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.machine.pool import parallel_for

N_HARMONICS = 8
MAX_ROUGH = 0.9
MAX_ELONGATION = 4.0
WEIGHTS = (1.0, 0.9, 0.8, 0.6, 0.5, 0.4, 0.35, 0.3)

_WEIGHTS = np.array(WEIGHTS, np.float64)
_GRAIN = 512


class ShapedDots(Protocol):
    """The arrays that hold the dots' shapes; the drawing's dots have them."""

    position_mm: NDArray[np.float64]
    radius_mm: NDArray[np.float32]
    elongation: NDArray[np.float32]
    angle_rad: NDArray[np.float32]
    roughness: NDArray[np.float32]
    seed: NDArray[np.uint32]


@inline
def hash32(x):
    """Mix 32 bits."""
    x = np.uint32(x)
    x = np.uint32(x ^ (x >> np.uint32(16)))
    x = np.uint32(x * np.uint32(0x7FEB352D))
    x = np.uint32(x ^ (x >> np.uint32(15)))
    x = np.uint32(x * np.uint32(0x846CA68B))
    return np.uint32(x ^ (x >> np.uint32(16)))


@kernel
def _hash_units(seed, salt, out):
    for i in range(len(seed)):
        out[i] = (hash32(seed[i] ^ np.uint32(salt)) >> np.uint32(8)) / 16777216.0


def hash_unit(seed: NDArray[np.uint32], salt: int) -> NDArray[np.float64]:
    """Return a number in [0, 1) for each seed; other salts give other numbers."""
    out = np.empty(len(seed))
    _hash_units(seed, salt, out)
    return out


@inline
def fill_coefficients(seed, roughness, c):
    """Fill c with x_2, y_2, x_3, ... y_9 for a dot's seed and roughness."""
    total = 1e-6
    for i in range(N_HARMONICS):
        h = hash32(np.uint32(seed) + np.uint32(i + 1) * np.uint32(0x9E3779B9))
        c[2 * i] = ((h & np.uint32(0xFFFF)) / 32767.5 - 1.0) * _WEIGHTS[i]
        c[2 * i + 1] = ((h >> np.uint32(16)) / 32767.5 - 1.0) * _WEIGHTS[i]
        total += math.sqrt(c[2 * i] ** 2 + c[2 * i + 1] ** 2)
    for i in range(2 * N_HARMONICS):
        c[i] *= roughness * MAX_ROUGH / total


@kernel
def _trace(start, stop, center, radius, elongation, angle, rough, seed, waves, slopes, bend, out):
    """Trace outlines; with a bend also the Bezier controls after and before each point.

    `waves` (2 N_HARMONICS, m) holds cos and sin of k phi, `slopes` their derivatives.
    """
    c = np.empty(2 * N_HARMONICS)
    m = waves.shape[1]
    each = out.shape[1] // m
    n, slope = np.empty(m), np.empty(m)
    for i in range(start, stop):
        fill_coefficients(seed[i], rough[i], c)
        n[:] = 1.0
        slope[:] = 0.0
        if rough[i] > 0.0:
            for k in range(2 * N_HARMONICS):
                for j in range(m):
                    n[j] += c[k] * waves[k, j]
                    slope[j] += c[k] * slopes[k, j]
        wide = radius[i] * math.sqrt(elongation[i])
        ux, uy = wide * math.cos(angle[i]), wide * math.sin(angle[i])
        vx, vy = -uy / elongation[i], ux / elongation[i]
        for j in range(m):
            r = math.sqrt(n[j])
            cos, sin = slopes[2 * N_HARMONICS, j], slopes[2 * N_HARMONICS + 1, j]
            px, py = r * cos, r * sin
            x = center[i, 0] + px * ux + py * vx
            y = center[i, 1] + px * uy + py * vy
            out[i, each * j, 0], out[i, each * j, 1] = x, y
            if each == 3:
                s = slope[j] / (2.0 * r)
                tx, ty = bend * (s * cos - py), bend * (s * sin + px)
                dx, dy = tx * ux + ty * vx, tx * uy + ty * vy
                before = 3 * j - 1 if j > 0 else 3 * m - 1
                out[i, 3 * j + 1, 0], out[i, 3 * j + 1, 1] = x + dx, y + dy
                out[i, before, 0], out[i, before, 1] = x - dx, y - dy


@cache
def wave_tables(n_points: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return what `_trace` multiplies coefficients with; cos and sin of phi end the second."""
    phi = np.arange(n_points) * (2.0 * math.pi / n_points)
    k = np.arange(2.0, 2.0 + N_HARMONICS)[:, None]
    c, s = np.cos(k * phi), np.sin(k * phi)
    waves = np.stack([c, s], axis=1).reshape(-1, n_points)
    slopes = np.stack([-k * s, k * c], axis=1).reshape(-1, n_points)
    slopes = np.vstack([slopes, np.cos(phi), np.sin(phi)])
    for table in (waves, slopes):
        table.flags.writeable = False
    return waves, slopes


def _traced(dots: ShapedDots, n_points: int, *, handles: bool) -> NDArray[np.float64]:
    check_shapes(dots.elongation, dots.angle_rad, dots.roughness)
    out = np.empty((len(dots.position_mm), n_points * (3 if handles else 1), 2))
    bend = 4.0 / 3.0 * math.tan(math.pi / (2.0 * n_points))
    parallel_for(
        _trace, len(out), dots.position_mm, dots.radius_mm, dots.elongation, dots.angle_rad,
        dots.roughness, dots.seed, *wave_tables(n_points), bend, out, grain=_GRAIN,
    )  # fmt: skip
    return out


def outlines(dots: ShapedDots, n_points: int = 64) -> NDArray[np.float64]:
    """Return points on the outlines of dots.

    Parameters
    ----------
    dots : Dots
        Or anything with the same arrays.
    n_points : int
        Points on each outline, at even steps of phi.

    Returns
    -------
    (n, n_points, 2) float64, mm
        In order, from x towards y; the last is not the first again.

    Raises
    ------
    ParameterError
        If a shape lies outside its range.
    """
    if n_points < 3:
        raise ParameterError(f"{n_points} points make no outline", "n_points", "give at least 3")
    return _traced(dots, n_points, handles=False)


def bezier_outlines(dots: ShapedDots, n_segments: int) -> NDArray[np.float64]:
    """Return the outlines of dots as closed chains of cubic Bezier segments.

    Parameters
    ----------
    n_segments : int
        For each outline; see `segments_needed`.

    Returns
    -------
    (n, 3 * n_segments, 2) float64, mm
        For each segment its start, the control after it and the control before its end.

    Raises
    ------
    ParameterError
        If a shape lies outside its range.
    """
    if n_segments < 3:
        raise ParameterError(f"{n_segments} segments close no outline", "n_segments")
    return _traced(dots, n_segments, handles=True)


def check_shapes(elongation: ArrayLike, angle_rad: ArrayLike, roughness: ArrayLike) -> None:
    """Raise `ParameterError` if a shape parameter lies outside its range or is not finite."""
    for name, values, low, high in (
        ("elongation", elongation, 1.0, MAX_ELONGATION),
        ("roughness", roughness, 0.0, 1.0),
        ("angle", angle_rad, -math.inf, math.inf),
    ):
        array = np.atleast_1d(values)
        least, most = array.min(initial=1.0), array.max(initial=1.0)  # NaN if any is
        if math.isfinite(least) and math.isfinite(most) and low <= least and most <= high:
            continue
        fine = np.isfinite(array) & (array >= low) & (array <= high)
        wrong = array.ravel()[int(np.argmin(fine.ravel()))]
        within = f"keep it within {low:g} to {high:g}" if math.isfinite(low) else "keep it finite"
        raise ParameterError(f"{wrong:g} is out of range", name, within)
