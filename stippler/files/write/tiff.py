"""TIFF: 1 bit by CCITT group 4, or 8 bits by LZW, as journals ask for; with the dpi tag.

Strips are made one at a time and packed by libtiff, through Pillow.
"""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.errors import OutputError
from stippler.files.write.format import Values
from stippler.files.write.raster import Size, bit_strips, grey_strips, size_px
from stippler.files.write.sheet import Sheet

_GROUP_4, _LZW = 4, 5
_PILLOW = {_GROUP_4: "group4", _LZW: "tiff_lzw"}
_STRIP_OFFSETS, _ROWS_PER_STRIP, _STRIP_BYTES = 273, 278, 279
_MOST_BYTES = 2**32 - 1
_SHORT, _LONG, _RATIONAL = 3, 4, 5


def chunks(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield a sheet as TIFF: all strips are packed before the first byte is known.

    Until then empty pieces are yielded.
    """
    dpi, bits = float(values["dpi"]), int(values["bits"])
    size = size_px(sheet, dpi)
    compression = _GROUP_4 if bits == 1 else _LZW
    strips: list[bytes] = []
    rows = 0
    for pixels in bit_strips(sheet, dpi) if bits == 1 else grey_strips(sheet, dpi):
        rows = rows or len(pixels)
        strips.append(_packed(pixels, size.width, compression))
        yield b""  # nothing is known yet; whoever writes may end it here
    yield from _file(strips, size, rows, bits, compression, dpi)


def _packed(pixels: NDArray[np.uint8], width: int, compression: int) -> bytes:
    """Return one strip as libtiff packs it."""
    from PIL import Image

    mode = "1" if compression == _GROUP_4 else "L"
    data = pixels if mode == "L" else np.bitwise_not(pixels)
    image = Image.frombytes(mode, (width, len(pixels)), np.ascontiguousarray(data).tobytes())
    stream = io.BytesIO()
    tags: Any = {_ROWS_PER_STRIP: len(pixels)}
    image.save(stream, "TIFF", compression=_PILLOW[compression], tiffinfo=tags)
    with Image.open(stream) as packed:
        ifd: Any = packed.tag_v2  # type: ignore[attr-defined]
        (start,), (length,) = ifd[_STRIP_OFFSETS], ifd[_STRIP_BYTES]
    return stream.getvalue()[start : start + length]


def _file(
    strips: list[bytes], size: Size, rows: int, bits: int, compression: int, dpi: float
) -> Iterator[bytes]:
    """Yield header, tags and strips, the tags first, so that nothing has to be sought."""
    n = len(strips)
    resolution = struct.pack("<II", round(dpi * 1000), 1000)
    # white is 0 in faxes, 1 elsewhere
    white = 1
    fields: list[tuple[int, int, int, bytes]] = [
        (254, _LONG, 1, struct.pack("<I", 0)),
        (256, _LONG, 1, struct.pack("<I", size.width)),
        (257, _LONG, 1, struct.pack("<I", size.height)),
        (258, _SHORT, 1, struct.pack("<H", bits)),
        (259, _SHORT, 1, struct.pack("<H", compression)),
        (262, _SHORT, 1, struct.pack("<H", white)),
        (_STRIP_OFFSETS, _LONG, n, b"\0" * 4 * n),
        (277, _SHORT, 1, struct.pack("<H", 1)),
        (_ROWS_PER_STRIP, _LONG, 1, struct.pack("<I", rows)),
        (_STRIP_BYTES, _LONG, n, struct.pack(f"<{n}I", *map(len, strips))),
        (282, _RATIONAL, 1, resolution),
        (283, _RATIONAL, 1, resolution),
        (296, _SHORT, 1, struct.pack("<H", 2)),
    ]
    head = 8 + 2 + 12 * len(fields) + 4
    first = head + sum(len(data) for *_, data in fields if len(data) > 4)
    starts = first + np.cumsum([0, *map(len, strips)])
    if starts[-1] > _MOST_BYTES:
        raise OutputError("is larger than a TIFF can be", "the picture", "lower the dpi")
    offsets = struct.pack(f"<{n}I", *starts[:-1].tolist())
    fields[6] = (_STRIP_OFFSETS, _LONG, n, offsets)
    yield b"II*\0" + struct.pack("<IH", 8, len(fields)) + _entries(fields, head)
    yield from strips


def _entries(fields: list[tuple[int, int, int, bytes]], head: int) -> bytes:
    entries, beyond = b"", b""
    for tag, kind, count, data in fields:
        value = data.ljust(4, b"\0")
        if len(data) > 4:
            value = struct.pack("<I", head + len(beyond))
            beyond += data
        entries += struct.pack("<HHI", tag, kind, count) + value
    return entries + struct.pack("<I", 0) + beyond
