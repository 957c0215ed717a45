"""Outlines of dots as PDF and PostScript path operators."""

from __future__ import annotations

import math

import numpy as np

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.shapes.dot_shape import ShapedDots, bezier_outlines
from stippler.kernels.shapes.number_text import MAX_NUMBER, put_number, written

_SPACE, _C, _F, _M, _NEWLINE = 32, 99, 102, 109, 10


@inline
def _put_point(out, at, x, y, scale, decimals):
    at = put_number(out, at, np.int64(math.floor(x * scale + 0.5)), decimals)
    out[at] = _SPACE
    at = put_number(out, at + 1, np.int64(math.floor(y * scale + 0.5)), decimals)
    out[at] = _SPACE
    return at + 1


@kernel
def _write_chains(start, stop, chain, decimals, room, out, used):
    scale = 10.0**decimals
    m = chain.shape[1]
    at = start * room
    for i in range(start, stop):
        at = _put_point(out, at, chain[i, 0, 0], chain[i, 0, 1], scale, decimals)
        out[at] = _M
        out[at + 1] = _NEWLINE
        at += 2
        for j in range(1, m + 1):
            k = j if j < m else 0
            at = _put_point(out, at, chain[i, k, 0], chain[i, k, 1], scale, decimals)
            if j % 3 == 0:
                out[at] = _C
                out[at + 1] = _NEWLINE
                at += 2
        out[at] = _F
        out[at + 1] = _NEWLINE
        at += 2
    used[start] = at - start * room


def filled_outlines(dots: ShapedDots, n_segments: int, decimals: int) -> bytes:
    """Return ``x y m``, Bezier segments ``... c``, and ``f`` for each dot."""
    chain = bezier_outlines(dots, n_segments)
    room = (2 + 6 * n_segments) * (MAX_NUMBER + 1) + 2 * n_segments + 8
    return written(_write_chains, len(chain), room, chain, decimals, grain=256)
