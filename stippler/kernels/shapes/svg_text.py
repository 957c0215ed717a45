"""Dots as SVG elements, written as text by kernels."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.shapes.dot_shape import ShapedDots, bezier_outlines
from stippler.kernels.shapes.number_text import (
    MAX_NUMBER,
    number_rows,
    put,
    put_number,
    written,
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
def _write_paths(start, stop, chain, decimals, room, out, used):
    """Write chains of Bezier segments; the first as ``c``, the others as ``s``.

    All steps are between rounded points, so rounding does not add up along the outline.
    """
    scale = 10.0**decimals
    m = chain.shape[1]
    at = start * room
    for i in range(start, stop):
        at = put(out, at, _D)
        x = np.int64(math.floor(chain[i, 0, 0] * scale + 0.5))
        y = np.int64(math.floor(chain[i, 0, 1] * scale + 0.5))
        at = put_number(out, at, x, decimals)
        at = _put_step(out, at, y, decimals)
        for j in range(1, m + 1):
            if j % 3 == 1 and j > 1:
                continue  # what s reflects
            k = j if j < m else 0
            px = np.int64(math.floor(chain[i, k, 0] * scale + 0.5))
            py = np.int64(math.floor(chain[i, k, 1] * scale + 0.5))
            if j == 1 or j == 5:
                out[at] = 99 if j == 1 else 115
                at = put_number(out, at + 1, px - x, decimals)
            else:
                at = _put_step(out, at, px - x, decimals)
            at = _put_step(out, at, py - y, decimals)
            if j % 3 == 0:
                x, y = px, py
        at = put(out, at, _Z)
    used[start] = at - start * room


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
    return written(_write_paths, len(chain), room, chain, decimals, grain=256)


@kernel
def _write_strokes(start, stop, steps, opens, text, text_end, decimals, room, out, used):
    at = start * room
    for i in range(start, stop):
        if opens[i] >= 0:
            at = put(out, at, text[text_end[opens[i]] : text_end[opens[i] + 1]])
        out[at] = 109
        at = put_number(out, at + 1, steps[i, 0], decimals)
        at = _put_step(out, at, steps[i, 1], decimals)
        at = put(out, at, _H0)
    used[start] = at - start * room


def strokes(
    steps: NDArray[np.int64], opens: NDArray[np.int32], texts: Sequence[bytes], decimals: int
) -> bytes:
    """Return a step and a line of no length for each dot of some paths.

    Parameters
    ----------
    steps : (n, 2) int64
        From the dot before, in units of the last decimal.
    opens : (n,) int32
        Which of the texts stands before a dot; -1 is none.
    texts : sequence of bytes
    """
    ends = np.cumsum([0, *map(len, texts)])
    room = 2 * MAX_NUMBER + 5 + max(map(len, texts))
    text = np.frombuffer(b"".join(texts), np.uint8)
    return written(_write_strokes, len(steps), room, steps, opens, text, ends, decimals)
