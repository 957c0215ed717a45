"""Light on a relief: noise, normals, sky and soft key light over a height field.

Everything is computed from horizons, the steepest slope seen from a point in one direction, so
that shadows and occlusion come out smooth, without random samples.
"""

from __future__ import annotations

from typing import Any

import numba
import numpy as np
from numpy.typing import NDArray

Field = NDArray[np.float32]

FLAT = 0.05
"""Horizons below this slope hide nothing of the sky."""
KEY_COUNT = 21
"""Strips that the key light is cut into."""

jit: Any = numba.njit(nogil=True, error_model="numpy", fastmath={"contract"})
fast: Any = numba.njit(nogil=True, error_model="numpy", fastmath=True)


@jit
def hash01(i: int, j: int, seed: int) -> float:
    """Return a number in 0..1 for a lattice point."""
    n = (i * 374761393 + j * 668265263 + seed * 2147483647) & 0xFFFFFFFF
    n = ((n ^ (n >> 13)) * 1274126177) & 0xFFFFFFFF
    n = ((n ^ (n >> 15)) * 2246822519) & 0xFFFFFFFF
    return ((n ^ (n >> 16)) & 0xFFFFFF) / 16777216.0


@jit
def noise(x: float, y: float, seed: int) -> float:
    """Smooth value noise in -1..1 with lattice spacing 1."""
    i, j = int(np.floor(x)), int(np.floor(y))
    u, v = x - i, y - j
    u = u * u * u * (u * (u * 6 - 15) + 10)
    v = v * v * v * (v * (v * 6 - 15) + 10)
    top = hash01(i, j, seed) * (1 - u) + hash01(i + 1, j, seed) * u
    low = hash01(i, j + 1, seed) * (1 - u) + hash01(i + 1, j + 1, seed) * u
    return 2 * (top * (1 - v) + low * v) - 1


@jit
def fractal(x: float, y: float, seed: int, octaves: int) -> float:
    """Sum octaves of noise, each turned, twice as fine and half as high."""
    total, scale = 0.0, 1.0
    for k in range(octaves):
        total += scale * noise(x, y, seed + k)
        x, y = 1.6 * x - 1.2 * y + 17.3, 1.2 * x + 1.6 * y - 5.1
        scale *= 0.5
    return total


@jit
def smoothstep(low: float, high: float, x: float) -> float:
    """Rise smoothly from 0 at `low` to 1 at `high`."""
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3 - 2 * t)


@fast
def _raise_horizons(z: Any, y: int, offsets: Any, pad: int, slope: Any) -> None:
    """Raise a row's slopes to the steepest of all samples along one direction."""
    w = len(slope)
    here = z[y + pad, pad : pad + w]
    for k in range(len(offsets)):
        dx, dy = int(offsets[k, 0]), int(offsets[k, 1])
        near = np.float32(offsets[k, 2])
        there = z[y + pad + dy, pad + dx : pad + dx + w]
        for x in range(w):
            slope[x] = max(slope[x], (there[x] - here[x]) * near)


@fast
def _sky_row(z: Any, y: int, rays: Any, counts: Any, pad: int, normal: Any, out: Any) -> None:
    w = len(out)
    slope = np.empty(w, np.float32)
    out[:] = 0.0
    for k in range(len(rays)):
        a = 2 * np.pi * (k + 0.5) / len(rays)
        dx, dy = np.cos(a), np.sin(a)
        slope[:] = FLAT
        _raise_horizons(z, y, rays[k, : counts[k]], pad, slope)
        for x in range(w):
            nx, ny, nz = normal[0, x], normal[1, x], normal[2, x]
            flat = nx * dx + ny * dy
            m = max(slope[x] if slope[x] > FLAT else 0.0, -flat / nz)
            c2 = 1 / (1 + m * m)
            out[x] += flat * (0.5 * np.pi - np.arctan(m) - m * c2) + nz * c2
    out /= len(rays)


@fast
def _key_row(
    z: Any, y: int, rays: Any, counts: Any, pad: int, normal: Any, key: Any, out: Any
) -> None:
    w = len(out)
    azimuth, elevation, spread = key
    slope = np.empty(w, np.float32)
    seen = np.zeros(w, np.float32)
    weights = 0.0
    for k in range(len(rays)):
        off = (2 * (k + 0.5) / len(rays) - 1) * spread
        chord = np.sqrt(spread * spread - off * off)
        weights += chord
        slope[:] = np.tan(elevation - spread)
        _raise_horizons(z, y, rays[k, : counts[k]], pad, slope)
        for x in range(w):
            part = (elevation + chord - np.arctan(slope[x])) / (2 * chord)
            seen[x] += chord * min(max(part, 0.0), 1.0)
    soft = np.sin(spread)
    for x in range(w):
        across = normal[0, x] * np.cos(azimuth) + normal[1, x] * np.sin(azimuth)
        facing = normal[2, x] * np.sin(elevation) + across * np.cos(elevation)
        if facing < soft:  # a light with a width fades out beyond grazing incidence
            facing = (facing + soft) ** 2 / (4 * soft) if facing > -soft else 0.0
        out[x] = facing * seen[x] / weights


@fast
def _light_rows(
    z: Any, pad: int, key: Any, sky_rays: Any, sky_n: Any, rays: Any, n: Any, sky: Any, direct: Any
) -> None:
    h, w = sky.shape
    normal = np.empty((3, w), np.float32)
    for y in range(h):
        for x in range(w):
            i, j = x + pad, y + pad
            gx, gy = 0.5 * (z[j, i + 1] - z[j, i - 1]), 0.5 * (z[j + 1, i] - z[j - 1, i])
            nz = 1 / np.sqrt(1 + gx * gx + gy * gy)
            normal[0, x], normal[1, x], normal[2, x] = -gx * nz, -gy * nz, nz
        _sky_row(z, y, sky_rays, sky_n, pad, normal, sky[y])
        _key_row(z, y, rays, n, pad, normal, key, direct[y])


def _rays(azimuths: Any, reach: float, growth: float) -> tuple[Any, Any]:
    """Return whole-pixel offsets and inverse distances along each direction, and their counts."""
    t, steps = 1.0, []
    while t < reach:
        steps.append(t)
        t = max(t + 1.0, t * growth)
    along = np.array(steps)
    rays = np.zeros((len(azimuths), len(steps), 3))
    for ray, a in zip(rays, azimuths, strict=True):
        ray[:, 0], ray[:, 1] = np.round(np.cos(a) * along), np.round(np.sin(a) * along)
        ray[:, 2] = 1 / np.hypot(ray[:, 0], ray[:, 1])
    return rays, np.full(len(azimuths), len(steps))


def light(
    z: Field, azimuth: float, elevation: float, spread: float, sky_count: int = 32
) -> tuple[Field, Field]:
    """Light a relief whose heights are in pixels.

    Parameters
    ----------
    azimuth, elevation, spread : float, radians
        Where the round key light stands (azimuth from x towards y, which points down) and half
        the angle it fills.

    Returns
    -------
    sky, direct : (h, w) float32
        Irradiance from an even sky (1 on an open plane) and from the key light (1 facing it).
    """
    rise = float(np.ptp(z))
    reach = min(rise / FLAT, 0.5 * max(z.shape))
    around = 2 * np.pi * (np.arange(sky_count) + 0.5) / sky_count
    sky_rays = _rays(around, reach, 1.09)
    offs = (2 * (np.arange(KEY_COUNT) + 0.5) / KEY_COUNT - 1) * spread / np.cos(elevation)
    rays = _rays(azimuth + offs, rise / np.tan(elevation - spread) + 2, 1.025)
    pad = int(max(reach, rise / np.tan(elevation - spread))) + 4
    padded = np.pad(z, pad, mode="edge")
    sky, direct = np.empty_like(z), np.empty_like(z)
    key = (azimuth, elevation, spread)
    _light_rows(padded, pad, key, *sky_rays, *rays, sky, direct)
    return sky, direct


def encode(linear: Field) -> Field:
    """Turn linear luminance in 0..1 into sRGB-encoded values."""
    x = np.clip(linear, 0.0, 1.0)
    curve = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return curve.astype(np.float32)


def reduce(field: Field, factor: int) -> Field:
    """Average blocks of pixels."""
    h, w = field.shape
    return field.reshape(h // factor, factor, w // factor, factor).mean((1, 3))
