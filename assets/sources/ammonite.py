"""An ammonite on white ground, lit from the upper left: a specimen plate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter
from sources.relief import Field, encode, fractal, jit, light, noise, reduce, smoothstep

TAU = 2 * np.pi
EXPANSION = 2.05
"""Growth of the radius in one whorl (Raup's W)."""
INNER = 0.44
"""Radius of the umbilical seam over that of the venter."""
THICKNESS = 0.80
"""Thickness of a whorl over its height."""
RIBS = 30
"""Primary ribs on one whorl; each forks into two."""
END = 0.30
"""Angle of the mouth, from the right, upwards."""
FORK = 0.12
"""Where on the flank (-1 seam, 1 venter) the ribs fork."""

AZIMUTH, ELEVATION = np.radians(-138.0), np.radians(42.0)
"""Where the key light stands: upper left."""


@jit
def _sweep(u: float) -> float:
    """Return how far, in whorls, ribs lean forward at `u`: a flat S."""
    s = 0.5 * (u + 1)
    return 0.006 * s + 0.018 * s * s * s - 0.006 * np.sin(np.pi * s)


@jit
def _ridge(phase: float, fork: float) -> float:
    """Height of the ribs at a phase; `fork` moves from 0 (one rib) to 1 (two)."""
    p = phase - TAU * np.floor(phase / TAU + 0.5)
    s = 0.5 * np.pi * fork
    width = 0.84 - 0.26 * fork
    left, right = p - s, p + s
    if left < -np.pi:
        left += TAU
    if right > np.pi:
        right -= TAU
    a = np.exp(-((left / width) ** 2))
    b = np.exp(-((right / width) ** 2))
    return max(a, b) + 0.35 * min(a, b) * (1 - max(a, b))


@jit
def _whorl(r: float, theta: float) -> tuple[float, float]:
    """Return height and rib relief at one turn of the spiral.

    The height is -1 where this whorl does not reach.
    """
    venter = EXPANSION ** ((theta - END) / TAU)
    jitter = 0.22 * noise(theta * 3.1, 0.5, 11)
    phase = RIBS * (theta - END) + jitter
    grown = smoothstep(0.05, 0.22, venter)
    seam = INNER * venter
    u = (2 * r - venter - seam) / (venter - seam)
    if u >= 1.05 or u <= -1.0:
        return -1.0, 0.0
    fork = smoothstep(FORK - 0.10, FORK + 0.34, u)
    lean = phase - RIBS * TAU * _sweep(u)
    rib = _ridge(lean, fork)
    # Ribs cross the venter and scallop the outline.
    u -= 0.045 * grown * (rib - 0.4) * smoothstep(0.45, 1.0, u)
    behind = END + TAU * (_sweep(u) - _sweep(0.0)) - 0.19 * max((u - 0.1) / 0.9, 0.0) ** 2.5 - theta
    if behind <= 0.0 or u >= 1.0:
        return -1.0, 0.0
    size = 0.5 * (venter - seam)
    # Section: steep umbilical wall, flat flank, round venter; widest at u = -0.35.
    if u > -0.35:
        body = np.sqrt(1 - ((u + 0.35) / 1.35) ** 2.25)
    else:
        body = np.sqrt(1 - ((-0.35 - u) / 0.65) ** 2.6)
    index = np.floor(lean / TAU + 0.5)
    strength = 0.9 + 0.22 * noise(index * 0.77, 3.3, 5)
    relief = grown * smoothstep(-0.98, -0.55, u) * (strength * rib - 0.45) * (1 - 0.25 * fork)
    p = lean - TAU * index
    knob = np.exp(-((p / 0.75) ** 2) - ((u - FORK + 0.06) / 0.13) ** 2)
    relief += 0.55 * grown * knob
    lines = noise(lean * 1.9 + 0.4 * noise(u * 5, lean * 0.3, 8), u * 2.0, 9)
    relief += 0.075 * grown * lines
    # The last constriction and the lip of the mouth.
    relief -= 0.9 * np.exp(-(((behind - 0.115) / 0.035) ** 2)) * smoothstep(-0.9, -0.3, u)
    relief += 0.6 * np.exp(-(((behind - 0.035) / 0.03) ** 2)) * smoothstep(-0.9, -0.3, u)
    lip = min(behind / 0.022, 1.0)
    height = THICKNESS * size * (body + 0.125 * relief * body**0.5)
    return height * np.sqrt(1 - (1 - lip) ** 2), relief


@jit
def _shell(x: float, y: float) -> tuple[float, float]:
    """Return height above the median plane (-1 beside the shell) and rib relief."""
    r = np.sqrt(x * x + y * y)
    phi = np.arctan2(y, x)
    best, relief = -1.0, 0.0
    for turn in range(-8, 2):
        theta = phi + TAU * turn
        reach = EXPANSION ** ((theta - END) / TAU)
        if r > 1.02 * reach or r < 0.97 * INNER * reach:
            continue
        height, rib = _whorl(r, theta)
        if height > best:
            best, relief = height, rib
    return best, relief


@jit
def _build(z: Field, tint: Field, scale: float, cx: float, cy: float, ground: float) -> None:
    h, w = z.shape
    for j in range(h):
        for i in range(w):
            x, y = (i + 0.5 - cx) / scale, (cy - j - 0.5) / scale
            height, relief = _shell(x, y)
            if height < 0.0:
                z[j, i] = -ground * scale
                tint[j, i] = -1.0
                continue
            weather = fractal(11 * x + 5 * y, 11 * y - 5 * x, 21, 6)
            warp = 0.5 * fractal(16 * x - 9 * y, 16 * y + 9 * x, 51, 3)
            pits = fractal(61 * x + 33 * y + warp, 61 * y - 33 * x - warp, 33, 2)
            pits = max(pits - 1.06, 0.0)
            height += 0.0013 * weather - 0.012 * pits
            z[j, i] = height * scale
            patina = fractal(2.1 * x + 0.8 * y + 4.0 + 0.3 * warp, 2.1 * y - 0.8 * x, 41, 6)
            tone = 0.62 + 0.10 * relief + 0.12 * patina + 0.03 * weather - 0.5 * pits
            tint[j, i] = min(max(tone, 0.2), 0.98)


def draw(width: int = 1800, height: int = 1500, oversample: int = 2) -> Field:
    """Draw the plate; the ground is exactly 1 outside the cast shadow.

    Returns
    -------
    (height, width) float32
        Encoded luminance, 0..1.
    """
    w, h = width * oversample, height * oversample
    scale = 0.505 * h
    cx, cy = 0.5 * w - 0.215 * scale, 0.5 * h - 0.165 * scale
    z, tint = np.empty((h, w), np.float32), np.empty((h, w), np.float32)
    ground = 0.5 * THICKNESS * (1 - INNER) * 0.97
    _build(z, tint, scale, cx, cy, ground)
    sky, direct = light(z, AZIMUTH, ELEVATION, np.radians(7.5))
    shell = tint >= 0
    floor = (0.77 * direct / np.sin(ELEVATION) + 0.23 * sky).astype(np.float32)
    floor = np.where(shell, floor, _blur(floor, ~shell, 0.006 * scale))
    on_shell = _shade_shell(z, tint, sky, direct, floor, shell, scale)
    picture = np.where(shell, on_shell, _shade_ground(floor))
    return reduce(picture.astype(np.float32), oversample)


def _blur(field: Field, inside: NDArray[np.bool_], sigma: float) -> Field:
    """Blur without crossing the border of a mask."""
    weight = gaussian_filter(inside.astype(np.float32), sigma)
    return gaussian_filter(np.where(inside, field, 0), sigma) / np.maximum(weight, 1e-6)


def _shade_ground(floor: Field) -> Field:
    """Shadow on white paper, fading to exactly 1."""
    shade = np.clip(1.0 - floor - 0.085, 0.0, 1.0) / 0.915
    return encode(1.0 - 0.94 * shade * shade * (1.5 - 0.5 * shade))


def _shade_shell(
    z: Field, tint: Field, sky: Field, direct: Field, floor: Field, shell: Field, scale: float
) -> Field:
    gy, gx = np.gradient(z)
    nz = 1 / np.sqrt(1 + gx * gx + gy * gy)
    lit_floor = gaussian_filter(np.where(shell, 0.3, floor), 0.04 * scale)
    bounce = 0.5 * (1 - nz) * lit_floor
    # Dust settles in hollows, ridges are worn pale.
    hollow = np.clip((gaussian_filter(z, 0.008 * scale) - z) / (0.006 * scale), -1.0, 1.0)
    tint = np.clip(tint * (1 - 0.35 * np.where(shell, hollow, 0.0)), 0.1, 0.97)
    linear = tint * (1.34 * direct + 0.07 * sky + 0.18 * bounce)
    linear += 0.16 * _gloss(gx, gy, nz) * direct
    return _curve(encode(_shoulder(linear)))


def _shoulder(linear: Field) -> Field:
    """Bend lights above 0.6 towards 1 without clipping."""
    over = np.maximum(linear - 0.6, 0.0)
    return np.minimum(linear, 0.6) + 0.4 * (1 - np.exp(-over / 0.4))


def _curve(value: Field) -> Field:
    """Deepen the shadows a little, keep the lights."""
    return (value + 0.18 * value * (value - 1) * (1.6 - value) * 2.0).astype(np.float32)


def _gloss(gx: Field, gy: Field, nz: Field) -> Field:
    """Blinn's highlight for a viewer above."""
    lx, ly = np.cos(AZIMUTH) * np.cos(ELEVATION), np.sin(AZIMUTH) * np.cos(ELEVATION)
    lz = np.sin(ELEVATION) + 1.0
    size = np.sqrt(lx * lx + ly * ly + lz * lz)
    facing = nz * (lz - gx * lx - gy * ly) / size
    return np.maximum(facing, 0.0) ** 24
