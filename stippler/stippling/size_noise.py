"""Noise that changes slowly over the page: sizes of dots in stone and wood."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_OCTAVES = 3
_WEIGHT = 0.5  # of an octave, of the one before
_SALTS = (0x9E3779B1, 0x85EBCA6B, 0xC2B2AE35)


def noise_at(
    position_mm: Floats, width_mm: float, seed: int, *, stretch: float = 1.0, angle_rad: float = 0.0
) -> Floats:
    """Return values of about -1..1, alike at places much nearer to each other than `width_mm`.

    Parameters
    ----------
    position_mm : (n, 2) float64
    width_mm : float
        How wide places of like value are.
    seed : int
    stretch : float
        How much longer they are along `angle_rad`.
    """
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    x, y = position_mm.T
    along, across = (c * x + s * y) / (width_mm * stretch), (c * y - s * x) / width_mm
    total, weight, sum_of_squares = np.zeros(len(position_mm)), 1.0, 0.0
    for k in range(_OCTAVES):
        total += weight * _values(along * 2**k, across * 2**k, seed * _OCTAVES + k)
        sum_of_squares += weight**2
        weight *= _WEIGHT
    return np.clip(1.6 * total / math.sqrt(sum_of_squares), -1.0, 1.0)


def _values(x: Floats, y: Floats, seed: int) -> Floats:
    """Return values between those of a lattice, drawn by chance."""
    left, top = np.floor(x), np.floor(y)
    u, v = _eased(x - left), _eased(y - top)
    column, row = left.astype(np.int64), top.astype(np.int64)
    corner = [_hashed(column + i, row + j, seed) for j in (0, 1) for i in (0, 1)]
    upper = corner[0] + u * (corner[1] - corner[0])
    lower = corner[2] + u * (corner[3] - corner[2])
    return np.asarray(upper + v * (lower - upper))


def _eased(t: Floats) -> Floats:
    return t * t * (3.0 - 2.0 * t)


def _hashed(column: NDArray[np.int64], row: NDArray[np.int64], seed: int) -> Floats:
    """Return a number in -1..1 for each point of the lattice."""
    mixed = np.uint32(seed * _SALTS[2] % 2**32)
    x = column.astype(np.uint32) * np.uint32(_SALTS[0]) ^ row.astype(np.uint32) * np.uint32(
        _SALTS[1]
    )
    x = x ^ mixed
    for shift, factor in ((16, 0x7FEB352D), (15, 0x846CA68B)):
        x = (x ^ (x >> np.uint32(shift))) * np.uint32(factor)
    x ^= x >> np.uint32(16)
    return np.asarray(x, np.float64) / 2.0**31 - 1.0
