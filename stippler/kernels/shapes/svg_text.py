"""Dots as SVG elements, written as text by kernels."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.shapes.dot_shape import ShapedDots, bezier_outlines
from stippler.kernels.shapes.number_text import (
    MAX_NUMBER,
    joined,
    number_rows,
    put,
    put_number,
)

_CIRCLE = (b'<circle cx="', b'" cy="', b'" r="', b'"/>')
_D = np.frombuffer(b'<path d="M', np.uint8)
_H0 = np.frombuffer(b"h0", np.uint8)
_Z = np.frombuffer(b'z"/>\n', np.uint8)


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
        at = put(row, 0, _D)
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
        length[i] = put(row, at, _Z)


def circles(
    position_mm: NDArray[np.float64],
    radius_mm: NDArray[np.floating],
    decimals: int,
    radius_decimals: int,
) -> bytes:
    """Return a ``<circle>`` for each dot."""
    columns = (position_mm[:, 0], position_mm[:, 1], radius_mm)
    return number_rows(columns, (decimals, decimals, radius_decimals), _CIRCLE)


def paths(dots: ShapedDots, n_segments: int, decimals: int) -> bytes:
    """Return a closed ``<path>`` a line for each dot."""
    chain = bezier_outlines(dots, n_segments)
    room = len(_D) + len(_Z) + (2 + 6 + 4 * n_segments) * (MAX_NUMBER + 1)
    rows = np.empty((len(chain), room), np.uint8)
    length = np.empty(len(rows), np.int64)
    parallel_for(_write_paths, len(rows), chain, decimals, rows, length, grain=256)
    return joined(rows, length)


@kernel
def _write_moves(start, stop, steps, decimals, out, length):
    scale = 10.0**decimals
    for i in range(start, stop):
        row = out[i]
        row[0] = 109
        at = put_number(row, 1, np.int64(math.floor(steps[i, 0] * scale + 0.5)), decimals)
        at = _put_step(row, at, np.int64(math.floor(steps[i, 1] * scale + 0.5)), decimals)
        length[i] = put(row, at, _H0)


def relative_moves(steps: NDArray[np.float64], decimals: int) -> bytes:
    """Return a step and a line of no length for each dot of a path."""
    rows = np.empty((len(steps), 2 * MAX_NUMBER + 5), np.uint8)
    length = np.empty(len(rows), np.int64)
    parallel_for(_write_moves, len(rows), steps, decimals, rows, length)
    return joined(rows, length)
