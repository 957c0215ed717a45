"""PNG, written strip by strip, so that a picture need not be held whole."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from stippler.errors import ParameterError
from stippler.files.write.format import Values
from stippler.files.write.raster import grey_strips, size_px
from stippler.files.write.sheet import Sheet
from stippler.units import MM_PER_INCH

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_COLOR_TYPE = {1: 0, 2: 4, 3: 2, 4: 6}
# Dots are runs of black and white: without a row filter, run lengths and Huffman codes alone are
# both the fastest and the smallest of zlib's ways.
_NO_FILTER = 0
_DEFLATE = (6, zlib.DEFLATED, zlib.MAX_WBITS, zlib.DEF_MEM_LEVEL, zlib.Z_RLE)


def png_chunks(
    strips: Iterable[NDArray[np.uint8]], size_px: tuple[int, int], dpi: float
) -> Iterator[bytes]:
    """Yield a picture as PNG, piece by piece.

    Parameters
    ----------
    strips : iterable of (rows, width) or (rows, width, 1 to 4) uint8
        From top to bottom; grey, grey and alpha, RGB or RGBA.
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
    deflate = zlib.compressobj(*_DEFLATE)
    n_rows = channels = 0
    for strip in strips:
        rows = np.ascontiguousarray(strip).reshape(len(strip), -1)
        if not channels:
            channels = rows.shape[1] // width
            yield _SIGNATURE + _header(width, height, channels) + _density(dpi)
        if len(rows) == 0 or rows.shape[1] != channels * width or strip.dtype != np.uint8:
            raise ParameterError("a strip is not as wide as the picture", "PNG")
        packed = deflate.compress(_filtered(rows))
        n_rows += len(rows)
        if packed:
            yield _chunk(b"IDAT", packed)
    if n_rows != height:
        raise ParameterError(f"{n_rows} rows make no picture {height} high", "PNG")
    yield _chunk(b"IDAT", deflate.flush()) + _chunk(b"IEND", b"")


def _filtered(rows: NDArray[np.uint8]) -> bytes:
    out = np.empty((len(rows), rows.shape[1] + 1), np.uint8)
    out[:, 0] = _NO_FILTER
    out[:, 1:] = rows
    return out.tobytes()


def _header(width: int, height: int, channels: int) -> bytes:
    if channels not in _COLOR_TYPE:
        raise ParameterError(f"{channels} channels make no picture", "PNG", "give 1 to 4")
    fields = struct.pack(">IIBBBBB", width, height, 8, _COLOR_TYPE[channels], 0, 0, 0)
    return _chunk(b"IHDR", fields)


def _density(dpi: float) -> bytes:
    per_m = round(dpi * 1000 / MM_PER_INCH)
    return _chunk(b"pHYs", struct.pack(">IIB", per_m, per_m, 1))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def chunks(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield a sheet as PNG, strip by strip; ink on a clear ground where that is asked for."""
    dpi = float(values["dpi"])
    size = size_px(sheet, dpi)
    strips = grey_strips(sheet, dpi)
    if values["transparent"]:
        strips = (_on_clear_ground(strip) for strip in strips)
    return png_chunks(strips, (size.width, size.height), dpi)


def _on_clear_ground(greys: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return black of the opacity that looks like these greys on white."""
    return np.stack([np.zeros_like(greys), 255 - greys], axis=-1)
