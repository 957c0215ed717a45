"""A picture's darkness, kept once: for each pixel a level of 16 bits, and what the levels are."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.kernels.machine.pool import parallel_for

N_LEVELS = 65_536

Curve = Callable[[NDArray[np.float32]], NDArray[np.floating]]
"""What becomes of darkness 0..1, value by value."""

_Number = TypeVar("_Number", np.float32, np.uint16)

_DARKEST = np.float32(N_LEVELS - 1)
_BAND_PX = 1 << 18  # a piece at a time, so that what lies between fits the cache
_ALL = slice(None)


@dataclass(frozen=True, slots=True, eq=False)
class Levels:
    """Darkness of pixels as levels, and a table of their values.

    Greys of 8 bits have 256 values, and no picture more than 65,536: these are kept to the bit.

    Attributes
    ----------
    of_pixel : (h, w) uint16, read-only
        Which of the values a pixel has.
    values : (n,) float32, read-only
        Darkness, 0 (white, weight exactly 0) to 1 (black), of the levels that pixels have.
    """

    of_pixel: NDArray[np.uint16]
    values: NDArray[np.float32]
    _nearest: list[NDArray[np.uint16]] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.of_pixel.ndim != 2 or self.of_pixel.size == 0:
            raise ParameterError("a reference is a 2-d field with at least one pixel", "reference")
        _check_range(self.values)
        self.of_pixel.flags.writeable = self.values.flags.writeable = False

    @classmethod
    def of(cls, darkness: NDArray[np.floating]) -> Levels:
        """Keep a field of darkness, 0..1, to the bit if it has no more than 65,536 values.

        If it has more, each is rounded to the nearest of 65,536 even steps; only white itself is
        then level 0.
        """
        field = np.ascontiguousarray(darkness, np.float32)
        if field.ndim != 2 or field.size == 0:
            raise ParameterError("a reference is a 2-d field with at least one pixel", "reference")
        _check_range(field)
        return cls(*gathered([field], field.shape))

    @classmethod
    def rounded(cls, darkness: NDArray[np.float32]) -> Levels:
        """Round a field of darkness, 0..1, to the nearest of 65,536 even steps."""
        return cls(_nearest_levels(darkness), table_of())

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns."""
        h, w = self.of_pixel.shape
        return h, w

    @property
    def size(self) -> int:
        """How many pixels there are."""
        return self.of_pixel.size

    @property
    def nbytes(self) -> int:
        """Bytes of memory."""
        return self.of_pixel.nbytes + self.values.nbytes

    def darkness(self, rows: slice = _ALL, columns: slice = _ALL) -> NDArray[np.float32]:
        """Return the darkness of some pixels, worked out anew; read-only."""
        found = _looked_up(self.values, self.of_pixel[rows, columns])
        found.flags.writeable = False
        return found

    def bands(self) -> Iterator[NDArray[np.float32]]:
        """Give the darkness of all pixels, some rows at a time."""
        rows = max(_BAND_PX // self.shape[1], 1)
        for first in range(0, self.shape[0], rows):
            yield self.values[self.of_pixel[first : first + rows]]

    def seen_through(self, *curves: Curve) -> Levels:
        """Return the same pixels with what curves make of their values."""
        return Levels(self.of_pixel, self.table(*curves)[: len(self.values)])

    def table(self, *curves: Curve) -> NDArray[np.float32]:
        """Return what curves make of each level, (65536,); entries that no pixel has are 0.

        Values are rounded to even steps first, as fine as levels are.
        """
        if not self._nearest:
            self._nearest.append(_nearest_levels(self.values))
        found = np.zeros(N_LEVELS, np.float32)
        found[: len(self.values)] = table_of(*curves)[self._nearest[0]]
        return found


def gathered(
    bands: Iterable[NDArray[np.float32]], shape: tuple[int, int]
) -> tuple[NDArray[np.uint16], NDArray[np.float32]]:
    """Return the levels of a field's pixels and their values; see `Levels.of`.

    Parameters
    ----------
    bands : iterable of (rows, w) float32
        The field's rows, some at a time: that it is never held whole.
    shape : (h, w)
    """
    from stippler.kernels.tone.darkness_levels import (
        number_values,  # numba: late, for the first frame's sake
    )

    of_pixel, n_done, is_rounded = np.empty(shape, np.uint16), 0, False
    count, found = np.zeros(1, np.int64), np.empty(N_LEVELS, np.uint32)
    slots = np.full(4 * N_LEVELS, -1, np.int32)
    for band in bands:
        rows = of_pixel[n_done : n_done + len(band)]
        if not is_rounded:
            bits = np.ascontiguousarray(band).reshape(-1).view(np.uint32)
            bits.flags.writeable = False  # kernels compile for one kind
            number_values(bits, slots, found, count, rows.reshape(-1))
            is_rounded = bool(count[0] > N_LEVELS)
            if is_rounded:
                nearest = _nearest_levels(found.view(np.float32))
                of_pixel[:n_done] = _looked_up(nearest, of_pixel[:n_done])
        if is_rounded:
            rows[...] = _nearest_levels(band)
        n_done += len(band)
    if is_rounded:
        return of_pixel, table_of()
    return of_pixel, np.array(found[: int(count[0])].view(np.float32))


def table_of(*curves: Curve) -> NDArray[np.float32]:
    """Return what curves, one after the other, make of 65,536 even steps of darkness.

    Adjustment, tone, a style's curve and the rule for density are such curves: what they come to is
    looked up then, instead of being worked out for each pixel.
    """
    values: NDArray[np.floating] = np.arange(N_LEVELS, dtype=np.float32) / _DARKEST
    for curve in curves:
        values = curve(values.astype(np.float32))
    return np.ascontiguousarray(values, np.float32)


def _nearest_levels(darkness: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Return the nearest of 65,536 even steps of darkness; only white itself is the first."""
    levels = np.empty(darkness.shape, np.uint16)
    flat, out = darkness.reshape(-1), levels.reshape(-1)

    def part(start: int, stop: int) -> None:
        band = flat[start:stop] * _DARKEST
        band += np.float32(0.5)
        found = out[start:stop]
        found[...] = band
        first = found == 0
        if first.any():
            found[first & (flat[start:stop] > 0.0)] = 1

    parallel_for(part, len(flat), grain=_BAND_PX, chunks=max(len(flat) // _BAND_PX, 1))
    return levels


def _looked_up(table: NDArray[_Number], of_pixel: NDArray[np.uint16]) -> NDArray[_Number]:
    """Return the table's entries for pixels."""
    if of_pixel.size <= _BAND_PX:
        return np.take(table, of_pixel)  # in half the time that indexing takes
    out = np.empty(of_pixel.shape, table.dtype)
    rows = max(_BAND_PX // 4 // max(of_pixel.shape[1], 1), 1)

    def part(start: int, stop: int) -> None:
        np.take(table, of_pixel[start:stop], out=out[start:stop], mode="clip")

    parallel_for(part, len(out), grain=rows, chunks=max(len(out) // rows, 1))
    return out


def _check_range(darkness: NDArray[np.float32]) -> None:
    low, high = float(darkness.min()), float(darkness.max())
    if not (low >= 0.0 and high <= 1.0):  # also catches NaN
        raise ParameterError("darkness has to lie in 0..1 and be finite", "reference")
