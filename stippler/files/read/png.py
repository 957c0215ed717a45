"""PNG: chunks that a reader can do without, and depths that Pillow cuts to 8 bits."""

from __future__ import annotations

import io
import zlib
from collections.abc import Iterator

import numpy as np

from stippler.files.read.pixels import Colour, Pixels, of_array

_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_NEEDED = (b"IHDR", b"PLTE", b"IDAT", b"IEND")
_MEANT = (b"tRNS", b"iCCP", b"gAMA", b"cHRM", b"sRGB", b"eXIf")
_LENGTHS = {b"gAMA": 4, b"cHRM": 32, b"sRGB": 1}
_COLOURS: dict[int, tuple[Colour, int]] = {
    0: ("grey", 1),
    2: ("rgb", 3),
    4: ("grey", 1),
    6: ("rgb", 3),
}


def without_needless_chunks(data: bytes) -> bytes:
    """Return a PNG with only what its picture needs; a damaged chunk that it can do without goes.

    A text of megabytes, or a byte gone wrong beside the picture, does not make it unreadable.
    """
    kept = [_SIGNATURE]
    for name, whole in _chunks(data):
        sound = zlib.crc32(whole[4:-4]) == int.from_bytes(whole[-4:], "big")
        sound = sound and len(whole) - 12 == _LENGTHS.get(name, len(whole) - 12)
        if name in _NEEDED or (name in _MEANT and sound) or name[:1].isupper():
            kept.append(whole)
    return b"".join(kept)


def is_beyond_pillow(data: bytes) -> bool:
    """Return whether Pillow would lose something: 16 bits of colour, or one transparent colour."""
    depth, kind = data[24], data[25]
    if kind == 3:
        return False
    return depth == 16 or (kind in (0, 2) and any(name == b"tRNS" for name, _ in _chunks(data)))


def decode(data: bytes) -> Pixels:
    """Decode a PNG of grey or RGB with all its bits; its profile and orientation are Pillow's."""
    import imagecodecs

    samples = np.asarray(imagecodecs.png_decode(without_needless_chunks(data)))
    colour, n = _COLOURS[data[25]]
    channels = 1 if samples.ndim == 2 else samples.shape[2]
    return of_array(
        samples,
        colour,
        int(np.iinfo(samples.dtype).max),
        alpha="straight" if channels > n else "",
    )


def _chunks(data: bytes) -> Iterator[tuple[bytes, bytes]]:
    """Yield each chunk's name, and its bytes from length to checksum; stop where it is cut off."""
    stream = io.BytesIO(data)
    stream.seek(len(_SIGNATURE))
    while len(head := stream.read(8)) == 8:
        length = int.from_bytes(head[:4], "big")
        body = stream.read(length + 4)
        if len(body) < length + 4 and head[4:] != b"IDAT":
            return
        yield head[4:], head + body
        if head[4:] == b"IEND":
            return
