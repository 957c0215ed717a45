"""Dots as SVG elements, written as text by kernels: numbers as rounded integers, no locale."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.shapes.dot_shape import ShapedDots, bezier_outlines

MAX_NUMBER = 16  # characters of the longest number
RADIUS_DECIMALS = 2  # more than positions get: an error in a radius is one in tone

_CX = np.frombuffer(b'<circle cx="', np.uint8)
_CY = np.frombuffer(b'" cy="', np.uint8)
_R = np.frombuffer(b'" r="', np.uint8)
_D = np.frombuffer(b'<path d="M', np.uint8)
_Z = np.frombuffer(b'z"/>\n', np.uint8)
_END = np.frombuffer(b'"/>\n', np.uint8)
_CIRCLE_ROOM = len(_CX) + len(_CY) + len(_R) + len(_END) + 3 * MAX_NUMBER


@inline
def _put(out, at, text):
    for i in range(text.shape[0]):
        out[at + i] = text[i]
    return at + text.shape[0]


@inline
def put_number(out, at, value, decimals):
    """Write ``value / 10**decimals`` in the fewest characters; return the place after it."""
    if value == 0:
        out[at] = 48
        return at + 1
    if value < 0:
        out[at] = 45
        at += 1
        value = -value
    if decimals == 3 and value < 10000:
        return _put_small(out, at, np.uint32(value))
    while decimals > 0 and value % 10 == 0:
        value //= 10
        decimals -= 1
    n = decimals
    rest = value
    for _ in range(decimals):
        rest //= 10
    while rest > 0:
        rest //= 10
        n += 1
    end = at + n + (1 if decimals > 0 else 0)
    p = end - 1
    for i in range(n):
        if decimals > 0 and i == decimals:
            out[p] = 46
            p -= 1
        out[p] = 48 + value % 10
        value //= 10
        p -= 1
    if p == at:  # the point in front
        out[p] = 46
    return end


@inline
def _put_small(out, at, value):
    """Write thousandths below 10: most numbers of a path."""
    whole = value // np.uint32(1000)
    rest = value - whole * np.uint32(1000)
    if whole > 0:
        out[at] = 48 + whole
        at += 1
    if rest > 0:
        tenths = rest // np.uint32(100)
        rest -= tenths * np.uint32(100)
        out[at] = 46
        out[at + 1] = 48 + tenths
        at += 2
        if rest > 0:
            hundredths = rest // np.uint32(10)
            rest -= hundredths * np.uint32(10)
            out[at] = 48 + hundredths
            at += 1
            if rest > 0:
                out[at] = 48 + rest
                at += 1
    return at


@kernel
def _write_circles(start, stop, center, radius, decimals, out, length):
    scale = 10.0**decimals
    scale_r = 10.0 ** (decimals + RADIUS_DECIMALS)
    for i in range(start, stop):
        row = out[i]
        at = _put(row, 0, _CX)
        at = put_number(row, at, np.int64(math.floor(center[i, 0] * scale + 0.5)), decimals)
        at = _put(row, at, _CY)
        at = put_number(row, at, np.int64(math.floor(center[i, 1] * scale + 0.5)), decimals)
        at = _put(row, at, _R)
        r = np.int64(math.floor(radius[i] * scale_r + 0.5))
        at = put_number(row, at, r, decimals + RADIUS_DECIMALS)
        length[i] = _put(row, at, _END)


@inline
def _put_step(out, at, value, decimals):
    """Write a number and, in front of it, a space where its sign does not part it already."""
    if value >= 0:
        out[at] = 32
        at += 1
    return put_number(out, at, value, decimals)


@kernel
def _write_paths(start, stop, chain, decimals, out, length):
    """Write chains of Bezier segments; the first as ``c``, the others as ``s``.

    All steps are between rounded points, so rounding does not add up along the outline.
    """
    scale = 10.0**decimals
    m = chain.shape[1]
    for i in range(start, stop):
        row = out[i]
        at = _put(row, 0, _D)
        x = np.int64(math.floor(chain[i, 0, 0] * scale + 0.5))
        y = np.int64(math.floor(chain[i, 0, 1] * scale + 0.5))
        at = put_number(row, at, x, decimals)
        at = _put_step(row, at, y, decimals)
        for j in range(1, m + 1):
            if j % 3 == 1 and j > 1:
                continue  # what s reflects
            k = j if j < m else 0
            px = np.int64(math.floor(chain[i, k, 0] * scale + 0.5))
            py = np.int64(math.floor(chain[i, k, 1] * scale + 0.5))
            if j == 1 or j == 5:
                row[at] = 99 if j == 1 else 115
                at = put_number(row, at + 1, px - x, decimals)
            else:
                at = _put_step(row, at, px - x, decimals)
            at = _put_step(row, at, py - y, decimals)
            if j % 3 == 0:
                x, y = px, py
        length[i] = _put(row, at, _Z)


@kernel
def _join(start, stop, rows, length, offset, out):
    for i in range(start, stop):
        at = offset[i] - length[i]
        for j in range(length[i]):
            out[at + j] = rows[i, j]


def _joined(rows: NDArray[np.uint8], length: NDArray[np.int64]) -> bytes:
    """Return the used parts of all rows, one after another."""
    if not len(rows):
        return b""
    offset = np.cumsum(length)
    out = np.empty(int(offset[-1]), np.uint8)
    parallel_for(_join, len(rows), rows, length, offset, out, grain=2048)
    return out.tobytes()


def circles(
    position_mm: NDArray[np.float64], radius_mm: NDArray[np.float32], decimals: int
) -> bytes:
    """Return a ``<circle>`` a line for each dot."""
    rows = np.empty((len(position_mm), _CIRCLE_ROOM), np.uint8)
    length = np.empty(len(rows), np.int64)
    parallel_for(_write_circles, len(rows), position_mm, radius_mm, decimals, rows, length)
    return _joined(rows, length)


def paths(dots: ShapedDots, n_segments: int, decimals: int) -> bytes:
    """Return a closed ``<path>`` a line for each dot."""
    chain = bezier_outlines(dots, n_segments)
    room = len(_D) + len(_Z) + (2 + 6 + 4 * n_segments) * (MAX_NUMBER + 1)
    rows = np.empty((len(chain), room), np.uint8)
    length = np.empty(len(rows), np.int64)
    parallel_for(_write_paths, len(rows), chain, decimals, rows, length, grain=256)
    return _joined(rows, length)
