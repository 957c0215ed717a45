"""Rows of numbers as text, written by kernels: rounded integers, no locale."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.machine.pool import parallel_for

MAX_NUMBER = 16  # characters of the longest number


@inline
def put(out, at, text):
    """Write a text; return the place after it."""
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
    if value < 4294967296:
        return _put_digits(out, at, np.uint32(value), np.uint32(10), decimals)
    return _put_digits(out, at, np.uint64(value), np.uint64(10), decimals)


@inline
def _put_digits(out, at, value, ten, decimals):
    """Write a positive number; the narrower its type, the faster."""
    above = value // ten
    while decimals > 0 and above * ten == value:
        value = above
        above = value // ten
        decimals -= 1
    n, rest = np.int64(1), above
    while rest > 0:
        rest = rest // ten
        n += 1
    n = max(n, decimals)
    end = at + n + (1 if decimals > 0 else 0)
    p = end - 1
    for i in range(n):
        if decimals > 0 and i == decimals:
            out[p] = 46
            p -= 1
        above = value // ten
        out[p] = np.uint32(48) + np.uint32(value - above * ten)
        value = above
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
def _write_rows(start, stop, values, decimals, pieces, piece_end, kinds, room, out, used):
    n = values.shape[1]
    scale = 10.0**decimals
    at = start * room
    for i in range(start, stop):
        first = np.int64(kinds[i]) * (n + 1)
        for k in range(n + 1):
            for j in range(piece_end[first + k], piece_end[first + k + 1]):
                out[at] = pieces[j]
                at += 1
            if k < n:
                scaled = np.int64(math.floor(values[i, k] * scale[k] + 0.5))
                at = put_number(out, at, scaled, decimals[k])
    used[start] = at - start * room


def written(kernel: Callable[..., Any], n: int, room: int, *args: Any, grain: int = 2048) -> bytes:
    """Return the text of n rows that a range kernel writes.

    Parameters
    ----------
    kernel : callable
        ``kernel(start, stop, *args, room, out, used)`` writes its rows one after another from
        ``out[start * room]`` on, and how many bytes they take to ``used[start]``.
    room : int
        Bytes that no row is longer than.
    """
    out, used = np.empty(n * room, np.uint8), np.zeros(n, np.int64)
    parallel_for(kernel, n, *args, room, out, used, grain=grain)
    return b"".join(out[i * room : i * room + used[i]].data for i in np.flatnonzero(used).tolist())


def number_rows(
    columns: Sequence[NDArray[np.floating]], decimals: Sequence[int], pieces: Sequence[bytes]
) -> bytes:
    """Return a text for each row of numbers: piece, number, piece, number, ..., piece.

    Parameters
    ----------
    columns : sequence of (n,) arrays
        Below 1e9 in size.
    decimals : sequence of int
        Of each column; zeros at the end are left out, and one before the point.
    pieces : sequence of bytes
        One more than columns.
    """
    kinds = np.zeros(len(columns[0]), np.uint8)
    return number_rows_of_kinds(columns, decimals, [pieces], kinds)


def number_rows_of_kinds(
    columns: Sequence[NDArray[np.floating]],
    decimals: Sequence[int],
    pieces: Sequence[Sequence[bytes]],
    kinds: NDArray[np.uint8],
) -> bytes:
    """Return a text for each row, between the pieces of its kind; see `number_rows`."""
    values = np.column_stack([np.asarray(column, np.float64) for column in columns])
    every = [piece for some in pieces for piece in some]
    longest = max(sum(map(len, some)) for some in pieces)
    ends = np.cumsum([0, *map(len, every)])
    text = np.frombuffer(b"".join(every), np.uint8)
    places = np.array(decimals, np.int64)
    room = longest + len(columns) * MAX_NUMBER
    return written(_write_rows, len(values), room, values, places, text, ends, kinds)
