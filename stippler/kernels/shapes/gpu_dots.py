"""Dots as the GPU takes them: six words each, and which of them a view needs."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import ZERO, inline, kernel
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.shapes.dot_shape import MAX_ELONGATION

N_WORDS = 6  # x, y, radius; elongation and angle, roughness, flags and share, seed
WORD_BYTES = 4
FIXED, SELECTED, IN_WHITE, UNSEEN = 1, 2, 4, 8
SEED = 5  # its place among the words
ROUND_WORDS = (0, 0xFF000000, 0)  # elongation 1, no roughness, no flags, a share of 1

_GRAIN = 16384
_PER_ELONGATION = 65535.0 / (MAX_ELONGATION - 1.0)
_PER_TURN = 65536.0
_WHOLE = np.uint32(0xFF000000)
_ALL_BLACK = np.empty(0, np.uint8)


@inline
def _pack_place(row, x, y, radius):
    row[0] = x
    row[1] = y
    row[2] = radius


@inline
def _pack_shape(row, elongation, angle, roughness, seed, flags):
    e = np.uint32((elongation - 1.0) * _PER_ELONGATION + 0.5)
    turns = angle / (2.0 * math.pi)
    a = np.uint32(np.int64((turns - math.floor(turns)) * _PER_TURN + 0.5) & 0xFFFF)
    r = np.uint32(roughness * 65535.0 + 0.5)
    row[3] = np.uint32(e | np.uint32(a << np.uint32(16)))
    row[4] = np.uint32(r | np.uint32(np.uint32(flags) << np.uint32(16)) | _WHOLE)
    row[5] = seed


@kernel
def _pack(
    start, stop, rows, position, radius, x0, y0, elongation, angle, roughness, seed, constraint,
    selected, paint, place, shape,
):  # fmt: skip
    for k in range(start, stop):
        i = rows[k]
        flags = (FIXED if constraint[i] != 0 else 0) | (SELECTED if selected[i] else 0)
        if len(paint) > 0 and paint[k] > 0:
            flags |= IN_WHITE if paint[k] == 1 else UNSEEN
        _pack_place(place[k], position[i, 0] - x0, position[i, 1] - y0, radius[i])
        _pack_shape(shape[k], elongation[i], angle[i], roughness[i], seed[i], flags)


@kernel
def _pack_places(start, stop, rows, position, radius, x0, y0, place):
    for k in range(start, stop):
        i = rows[k]
        _pack_place(place[k], position[i, 0] - x0, position[i, 1] - y0, radius[i])


@inline
def _spread(x):
    """Put a 0 between the bits of a number below 256."""
    x = (x | (x << 4)) & 0x0F0F
    x = (x | (x << 2)) & 0x3333
    return (x | (x << 1)) & 0x5555


@kernel
def _morton(start, stop, position, per_x, per_y, out):
    for i in range(start, stop):
        x = min(max(int(position[i, 0] * per_x), 0), 255)
        y = min(max(int(position[i, 1] * per_y), 0), 255)
        out[i] = _spread(x) | (_spread(y) << 1)


@kernel
def _choose(place, left, top, right, bottom, pad, low, high, out):
    n = 0
    for i in range(place.shape[0]):
        radius = place[i, 2]
        if low < radius <= high:
            reach = radius * pad
            if (
                left - reach <= place[i, 0] <= right + reach
                and top - reach <= place[i, 1] <= bottom + reach
            ):
                out[n] = i
                n += 1
    return n


@kernel
def _part(words, place, from_mm, rough, smooth):
    n_rough, n_smooth = ZERO, ZERO
    for i in range(words.shape[0]):
        elongation = 1.0 + (words[i, 3] & 0xFFFF) / _PER_ELONGATION
        radius = place[i, 2]
        if words[i, 4] & 0xFFFF and radius * radius > from_mm * from_mm * elongation:
            rough[n_rough] = i
            n_rough += 1
        else:
            smooth[n_smooth] = i
            n_smooth += 1
    return n_rough


def part_by_roughness(
    rows: NDArray[np.uint32], from_mm: float
) -> tuple[NDArray[np.uint32], NDArray[np.uint32]]:
    """Return which packed dots are rough and have a short half axis above a limit, and the rest."""
    rough, smooth = np.empty((2, len(rows)), np.uint32)
    n_rough = _part(rows, rows.view(np.float32), from_mm, rough, smooth)
    return rough[:n_rough], smooth[: len(rows) - n_rough]


def flags_of(rows: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Return the flags of packed dots: `FIXED`, `SELECTED`, `IN_WHITE`, `UNSEEN`."""
    return (rows[:, 4] >> np.uint32(16)) & np.uint32(0xFF)


def set_shares(words: NDArray[np.uint32], shares: NDArray[np.float32]) -> None:
    """Write the shares of dots in the union of all, 0 to 1, to 8 bits."""
    share = (shares * 255.0 + 0.5).astype(np.uint32) << np.uint32(24)
    words[:, 4] = words[:, 4] & np.uint32(0xFFFFFF) | share


def shares_in(words: NDArray[np.uint32]) -> NDArray[np.float32]:
    """Return the shares of packed dots, 0 to 1."""
    return (words[:, 4] >> np.uint32(24)).astype(np.float32) / np.float32(255.0)


def words(n: int) -> NDArray[np.uint32]:
    """Return room for n dots."""
    return np.empty((n, N_WORDS), np.uint32)


def nearby_order(
    position_mm: NDArray[np.float64], size_mm: tuple[float, float]
) -> NDArray[np.int64]:
    """Return an order of dots in which neighbours on the page mostly stand close together.

    Rasterising is twice as fast on a CPU, and what a brush touches is uploaded in few pieces.
    """
    keys = np.empty(len(position_mm), np.uint16)
    per_x, per_y = (256.0 / side for side in size_mm)
    parallel_for(_morton, len(keys), position_mm, per_x, per_y, keys, grain=_GRAIN)
    return np.argsort(keys, kind="stable")  # a radix sort for 16 bits


def pack(
    dots: Any,
    origin_mm: tuple[float, float],
    selected: NDArray[np.bool_],
    rows: NDArray[np.int64],
    out: NDArray[np.uint32],
    paint: NDArray[np.uint8] = _ALL_BLACK,
) -> None:
    """Pack the given rows of dots into consecutive rows of `out`; `selected` is of all dots.

    `paint` is of the rows, `stippler.drawing.polarity`'s; empty where all dots are black.
    """
    parallel_for(
        _pack, len(out), rows, dots.position_mm, dots.radius_mm, *origin_mm, dots.elongation,
        dots.angle_rad, dots.roughness, dots.seed, dots.constraint, selected, paint,
        out.view(np.float32), out, grain=_GRAIN,
    )  # fmt: skip


def pack_places(
    position_mm: NDArray[np.float64],
    radius_mm: NDArray[np.float32],
    origin_mm: tuple[float, float],
    rows: NDArray[np.int64],
    out: NDArray[np.uint32],
) -> None:
    """Pack only positions and radii of the given rows into consecutive rows of `out`."""
    parallel_for(
        _pack_places, len(out), rows, position_mm, radius_mm, *origin_mm, out.view(np.float32),
        grain=_GRAIN,
    )  # fmt: skip


def choose(
    rows: NDArray[np.uint32],
    inside_mm: tuple[float, float, float, float],
    pad: float,
    radius_mm: tuple[float, float],
) -> NDArray[np.uint32]:
    """Return copies of the packed dots that touch a rectangle and have radii in a range.

    Parameters
    ----------
    inside_mm : (left, top, right, bottom)
        From the origin the dots were packed with.
    pad : float
        A dot reaches at most so many of its radii.
    radius_mm : (low, high)
        Larger than low, at most high.
    """
    found = np.empty(len(rows), np.int64)
    low, high = (np.float32(r) for r in radius_mm)
    n = _choose(rows.view(np.float32), *inside_mm, pad, low, high, found)
    return rows[found[:n]]
