"""PNG, written strip by strip, so that a picture need not be held whole."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.units import MM_PER_INCH

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOR_TYPE = {1: 0, 3: 2, 4: 6}
_UP = 2  # each row as its difference to the one above: dots repeat downwards
_LEVEL = 3


def png_chunks(
    strips: Iterable[NDArray[np.uint8]], size_px: tuple[int, int], dpi: float
) -> Iterator[bytes]:
    """Yield a picture as PNG, piece by piece.

    Parameters
    ----------
    strips : iterable of (rows, width) or (rows, width, 1, 3 or 4) uint8
        From top to bottom; grey, RGB or RGBA.
    size_px : (width, height)
    dpi : float
        Written into the file, so that it prints at the right size.

    Yields
    ------
    bytes
        The same strips give the same bytes, however they are cut.

    Raises
    ------
    ParameterError
        If the strips do not add up to the size.
    """
    width, height = size_px
    deflate = zlib.compressobj(_LEVEL)
    above: NDArray[np.uint8] | None = None
    n_rows = channels = 0
    for strip in strips:
        rows = np.ascontiguousarray(strip).reshape(len(strip), -1)
        if above is None:
            channels = rows.shape[1] // width
            yield _SIGNATURE + _header(width, height, channels) + _density(dpi)
            above = np.zeros(rows.shape[1], np.uint8)
        if len(rows) == 0 or rows.shape[1] != channels * width or strip.dtype != np.uint8:
            raise ParameterError("a strip is not as wide as the picture", "PNG")
        packed = deflate.compress(_filtered(rows, above))
        n_rows, above = n_rows + len(rows), rows[-1]
        if packed:
            yield _chunk(b"IDAT", packed)
    if n_rows != height:
        raise ParameterError(f"{n_rows} rows make no picture {height} high", "PNG")
    yield _chunk(b"IDAT", deflate.flush()) + _chunk(b"IEND", b"")


def _filtered(rows: NDArray[np.uint8], above: NDArray[np.uint8]) -> bytes:
    out = np.empty((len(rows), rows.shape[1] + 1), np.uint8)
    out[:, 0] = _UP
    np.subtract(rows[0], above, out=out[0, 1:])
    np.subtract(rows[1:], rows[:-1], out=out[1:, 1:])
    return out.tobytes()


def _header(width: int, height: int, channels: int) -> bytes:
    if channels not in _COLOR_TYPE:
        raise ParameterError(f"{channels} channels make no picture", "PNG", "give 1, 3 or 4")
    fields = struct.pack(">IIBBBBB", width, height, 8, _COLOR_TYPE[channels], 0, 0, 0)
    return _chunk(b"IHDR", fields)


def _density(dpi: float) -> bytes:
    per_m = round(dpi * 1000 / MM_PER_INCH)
    return _chunk(b"pHYs", struct.pack(">IIB", per_m, per_m, 1))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
