"""JPEG of 12 bits a sample, or without loss, which Pillow does not read."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np
from PIL import Image

from stippler.errors import PictureError
from stippler.files.read.pixels import Colour, Pixels, of_array

_FRAMES = {*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC}
_LOSSLESS = {0xC3, 0xC7, 0xCB, 0xCF}
_COLOURS: dict[int, Colour] = {1: "grey", 3: "rgb"}
_EXIF, _PROFILE = b"Exif\0\0", b"ICC_PROFILE\0"


@dataclass(frozen=True, slots=True)
class Frame:
    """What a JPEG's header says of its picture."""

    size: tuple[int, int]
    bits: int
    channels: int
    lossless: bool

    @property
    def is_beyond_pillow(self) -> bool:
        """Whether Pillow does not read it."""
        return self.bits != 8 or self.lossless


def frame_of(stream: BinaryIO) -> Frame | None:
    """Return what an open JPEG's header says, or None where there is no such header."""
    for marker, body in _segments(stream):
        if marker in _FRAMES and len(body) >= 6:
            height, width = int.from_bytes(body[1:3], "big"), int.from_bytes(body[3:5], "big")
            return Frame((width, height), body[0], body[5], marker in _LOSSLESS)
    return None


def decode(stream: BinaryIO, frame: Frame) -> Pixels:
    """Decode a JPEG of more than 8 bits or without loss."""
    import imagecodecs

    if frame.channels not in _COLOURS:
        raise PictureError(
            f"has {frame.channels} channels of {frame.bits} bits", "", "save it as TIFF"
        )
    if not 2 <= frame.bits <= 16:
        raise PictureError(f"claims {frame.bits} bits a sample", "", "save it again")
    exif, profile = b"", b""
    for marker, body in _segments(stream):
        if marker == 0xE1 and body.startswith(_EXIF):
            exif = body
        elif marker == 0xE2 and body.startswith(_PROFILE):
            profile += body[len(_PROFILE) + 2 :]
    stream.seek(0)
    data = stream.read()
    samples = np.asarray(
        imagecodecs.ljpeg_decode(data) if frame.lossless else imagecodecs.jpeg_decode(data)
    )
    if samples.shape[1::-1] != frame.size:
        raise PictureError("is damaged: it is not of the size that it tells", "", "save it again")
    return of_array(
        samples,
        _COLOURS[frame.channels],
        (1 << frame.bits) - 1,
        profile=profile,
        orientation=_orientation(exif),
    )


def _segments(stream: BinaryIO) -> Iterator[tuple[int, bytes]]:
    """Yield marker and body of each segment up to the picture's data."""
    stream.seek(2)
    while (byte := stream.read(1)) == b"\xff":
        while byte == b"\xff":
            byte = stream.read(1)
        marker = byte[0] if byte else 0xD9
        length = int.from_bytes(stream.read(2), "big")
        if marker in (0xD9, 0xDA) or length < 2:
            return
        yield marker, stream.read(length - 2)


def _orientation(exif: bytes) -> int:
    try:
        tags = Image.Exif()
        tags.load(exif)
        value = tags.get(0x0112, 1)
    except Exception:  # noqa: BLE001 - Pillow raises whatever a broken block leads it to
        return 1
    return value if isinstance(value, int) and 1 <= value <= 8 else 1
