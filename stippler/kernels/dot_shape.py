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
from stippler.kernels.jit import inline, kernel
from stippler.kernels.pool import run_ranges

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
def _trace(start, stop, center, radius, elongation, angle, rough, seed, waves, out):
    """Trace outlines; `waves` (m, 3 + 4 N_HARMONICS) is made by `wave_table`."""
    c = np.empty(2 * N_HARMONICS)
    for i in range(start, stop):
        fill_coefficients(seed[i], rough[i], c)
        wide = radius[i] * math.sqrt(elongation[i])
        ux, uy = wide * math.cos(angle[i]), wide * math.sin(angle[i])
        vx, vy = -uy / elongation[i], ux / elongation[i]
        for j in range(waves.shape[0]):
            n = 1.0
            slope = 0.0
            for m in range(2 * N_HARMONICS):
                n += c[m] * waves[j, 3 + m]
                slope += c[m] * waves[j, 3 + 2 * N_HARMONICS + m]
            r = math.sqrt(n)
            bend = waves[j, 2]
            s = bend * slope / (2.0 * r)
            x = r * waves[j, 0] + s * waves[j, 0] - bend * r * waves[j, 1]
            y = r * waves[j, 1] + s * waves[j, 1] + bend * r * waves[j, 0]
            out[i, j, 0] = center[i, 0] + x * ux + y * vx
            out[i, j, 1] = center[i, 1] + x * uy + y * vy


@cache
def wave_table(n_segments: int, handles: bool) -> NDArray[np.float64]:
    """Return what `_trace` multiplies coefficients with: rows of points, or of Bezier controls.

    A row holds cos phi, sin phi, how far along the tangent the point lies (0 for a point of the
    outline), then the harmonics and their derivatives. With handles there are three rows a
    segment: a point, the control after it and the control before the next point.
    """
    step = 2.0 * math.pi / n_segments
    bend = 4.0 / 3.0 * math.tan(step / 4.0)
    corner = np.arange(n_segments) * step
    if handles:
        phi = np.stack([corner, corner, corner + step], axis=1).ravel()
        bends = np.tile([0.0, bend, -bend], n_segments)
    else:
        phi, bends = corner, np.zeros(n_segments)
    k = np.arange(2, 2 + N_HARMONICS)
    c, s = np.cos(np.outer(phi, k)), np.sin(np.outer(phi, k))
    waves = np.stack([c, s], axis=2).reshape(len(phi), -1)
    slopes = np.stack([-k * s, k * c], axis=2).reshape(len(phi), -1)
    table = np.column_stack([np.cos(phi), np.sin(phi), bends, waves, slopes])
    table.flags.writeable = False
    return table


def _traced(dots: ShapedDots, table: NDArray[np.float64]) -> NDArray[np.float64]:
    check_shapes(dots.elongation, dots.angle_rad, dots.roughness)
    out = np.empty((len(dots.position_mm), len(table), 2))
    run_ranges(
        _trace, len(out), dots.position_mm, dots.radius_mm, dots.elongation, dots.angle_rad,
        dots.roughness, dots.seed, table, out, grain=_GRAIN,
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
    return _traced(dots, wave_table(n_points, False))


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
    return _traced(dots, wave_table(n_segments, True))


def check_shapes(elongation: ArrayLike, angle_rad: ArrayLike, roughness: ArrayLike) -> None:
    """Raise `ParameterError` if a shape parameter lies outside its range or is not finite."""
    for name, values, low, high in (
        ("elongation", elongation, 1.0, MAX_ELONGATION),
        ("roughness", roughness, 0.0, 1.0),
        ("angle", angle_rad, -math.inf, math.inf),
    ):
        array = np.asarray(values, np.float64)
        fine = np.isfinite(array) & (array >= low) & (array <= high)
        if not fine.all():
            wrong = array.ravel()[int(np.argmin(fine.ravel()))]
            within = (
                f"keep it within {low:g} to {high:g}" if math.isfinite(low) else "keep it finite"
            )
            raise ParameterError(f"{wrong:g} is out of range", name, within)
