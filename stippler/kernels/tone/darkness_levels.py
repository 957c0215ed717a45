"""Fields of darkness by levels: how many pixels there are of each, and what a table makes of them.

A level holds all darkness up to it: white, and only white, is level 0.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import kernel

Array = NDArray[Any]


@kernel
def count_levels(darkness: Array, counts: Array, sums: Array) -> None:
    """Add up pixels and their darkness, in the field's order, by as many levels as there is room.

    Parameters
    ----------
    darkness : (m,) float32
    counts, sums : (k + 1,) float64
        Of level 0 to k, which is black; added to.
    """
    top = len(counts) - 1
    scale = np.float32(top)
    for i in range(len(darkness)):
        level = min(max(math.ceil(darkness[i] * scale), 0), top)
        counts[level] += 1.0
        sums[level] += np.float64(darkness[i])


@kernel
def number_values(bits: Array, slots: Array, found: Array, count: Array, out: Array) -> None:
    """Give numbers to the different values of a field, in the order in which they occur first.

    Parameters
    ----------
    bits : (m,) uint32
        The values, as bits.
    slots : (2**18,) int32
        All -1; where values are looked for.
    found : (k,) uint32
        Is given the values; those that are there already stay.
    count : (1,) int64
        Their number, before and after; k + 1 where there are more, and the rest is left.
    out : (m,) uint16
        Is given the number of each value.
    """
    last = np.uint32(len(slots) - 1)
    n = count[0]
    for i in range(len(bits)):
        value = bits[i]
        at = np.uint32(np.uint32(value * np.uint32(2654435769)) >> np.uint32(14))
        while slots[at] >= 0 and found[slots[at]] != value:
            at = np.uint32((at + np.uint32(1)) & last)
        if slots[at] < 0:
            if n == len(found):
                count[0] = n + 1
                return
            slots[at] = n
            found[n] = value
            n += 1
        out[i] = slots[at]
    count[0] = n


@kernel
def look_up_levels(
    start: int, stop: int, darkness: Array, scale: float, table: Array, out: Array
) -> None:
    """Write rows start..stop of what a table makes of darkness, whose level is it times a scale.

    Parameters
    ----------
    darkness, out : (h, w) float32
    scale : float
        A float32 that brings the darkest pixel to the table's last entry.
    table : (k + 1,) float32
    """
    top = len(table) - 1
    per = np.float32(scale)
    for y in range(start, stop):
        for x in range(darkness.shape[1]):
            level = min(max(math.ceil(darkness[y, x] * per), 0), top)
            out[y, x] = table[level]
