"""Rows of bits, eight to a byte, the first in the highest bit; and greys counted from them."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.machine.pool import parallel_for

SAMPLES = 8  # sub-rows and sub-columns of a pixel that is to become grey

_55, _33, _0F = (np.uint64(int(digits * 8, 16)) for digits in ("55", "33", "0f"))
_LEVEL = np.round(255 - 255 * np.arange(SAMPLES**2 + 1) / SAMPLES**2).astype(np.uint8)


@inline
def fill_span(row, left, right, n_bits, ink):
    """Set (or clear) the bits whose middles lie in ``left <= x < right``."""
    first = np.int64(math.ceil(max(left, 0.0) - 0.5))
    end = np.int64(math.ceil(min(right, float(n_bits)) - 0.5))
    if first >= end:
        return
    a, b = first >> 3, (end - 1) >> 3
    head = 0xFF >> (first & 7)
    tail = (0xFF << (7 - ((end - 1) & 7))) & 0xFF
    if a == b:
        head &= tail
    row[a] = row[a] | head if ink else row[a] & ~head
    for k in range(a + 1, b):
        row[k] = 255 if ink else 0
    if b > a:
        row[b] = row[b] | tail if ink else row[b] & ~tail


@kernel
def _count(start, stop, words, level, out):
    """Count the ink of pixels, each of 8 rows of 8 bits; `words` holds 8 pixels in each."""
    n = words.shape[1]
    for y in range(start, stop):
        for k in range(n):
            total = np.uint64(0)
            for s in range(SAMPLES):
                v = words[SAMPLES * y + s, k]
                if v:
                    v -= (v >> np.uint64(1)) & _55
                    v = (v & _33) + ((v >> np.uint64(2)) & _33)
                    total += (v + (v >> np.uint64(4))) & _0F
            for j in range(8):
                x = 8 * k + j
                if x < out.shape[1]:
                    out[y, x] = level[int((total >> np.uint64(8 * j)) & np.uint64(0xFF))]


def empty_rows(n_rows: int, n_bits: int) -> NDArray[np.uint8]:
    """Return rows of cleared bits, each padded to whole words."""
    return np.zeros((n_rows, -(-n_bits // 64) * 8), np.uint8)


def greys(bits: NDArray[np.uint8], width: int) -> NDArray[np.uint8]:
    """Return (rows / 8, width) greys, 255 where no bit is set."""
    out = np.empty((len(bits) // SAMPLES, width), np.uint8)
    parallel_for(_count, len(out), bits.view("<u8"), _LEVEL, out, grain=16)
    return out
