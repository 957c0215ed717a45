"""The outline of a dot: one formula, in kernels here and in `shaders/lib/dot_shape.glsl`."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.jit import kernel
from stippler.kernels.pool import run_ranges


class ShapedDots(Protocol):
    """The arrays of dots that a shape is made of."""

    position_mm: NDArray[np.float64]
    radius_mm: NDArray[np.float32]
    elongation: NDArray[np.float32]
    angle_rad: NDArray[np.float32]
    roughness: NDArray[np.float32]
    seed: NDArray[np.uint32]
    fixed: NDArray[np.bool_]


@kernel
def _pack_place(start, stop, position, radius, x0, y0, out):  # type: ignore[no-untyped-def]
    for i in range(start, stop):
        out[i, 0] = position[i, 0] - x0
        out[i, 1] = position[i, 1] - y0
        out[i, 2] = radius[i]


@kernel
def _pack_shape(start, stop, elongation, angle, roughness, seed, fixed, out):  # type: ignore[no-untyped-def]
    for i in range(start, stop):
        e = np.uint32((elongation[i] - 1.0) * (65535.0 / 3.0) + 0.5)
        turns = angle[i] / (2.0 * np.pi)
        a = np.uint32((turns - np.floor(turns)) * 65536.0 + 0.5) & np.uint32(0xFFFF)
        r = np.uint32(roughness[i] * 65535.0 + 0.5)
        out[i, 0] = e | (a << np.uint32(16))
        out[i, 1] = r | (np.uint32(fixed[i]) << np.uint32(16))
        out[i, 2] = seed[i]


def pack_positions(
    position_mm: NDArray[np.float64],
    radius_mm: NDArray[np.float32],
    origin_mm: tuple[float, float],
) -> NDArray[np.float32]:
    """Return (n, 3) float32 of x, y from the origin and radius, as the GPU takes them."""
    out = np.empty((len(position_mm), 3), np.float32)
    run_ranges(_pack_place, len(out), position_mm, radius_mm, *origin_mm, out, grain=16384)
    return out


def pack_dots(
    dots: ShapedDots, origin_mm: tuple[float, float]
) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """Return (n, 3) float32 places and (n, 3) uint32 shapes, as the GPU takes them."""
    place = pack_positions(dots.position_mm, dots.radius_mm, origin_mm)
    shape = np.empty((len(place), 3), np.uint32)
    run_ranges(
        _pack_shape, len(place), dots.elongation, dots.angle_rad, dots.roughness, dots.seed,
        dots.fixed, shape, grain=16384,
    )  # fmt: skip
    return place, shape
