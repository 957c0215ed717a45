"""Reading pictures as fields of darkness: of any kind, by content and not by name."""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from stippler.drawing.picture_values import TONES
from stippler.drawing.reference import Picture, Reference
from stippler.errors import ParameterError, PictureError
from stippler.files.read import jpeg, pillow, png, tiff
from stippler.files.read.darkness import check_tone, levels_of_pixels
from stippler.files.read.kinds import FORMATS_TEXT, HEAD_BYTES, kind_of, told_of
from stippler.files.read.pixels import Colour, Pixels, of_array

__all__ = [
    "MAX_PIXELS",
    "TONES",
    "check_picture",
    "check_tone",
    "darkness_of_array",
    "darkness_of_image",
    "picture_of_bytes",
    "read_darkness",
    "read_picture",
    "size_of_picture",
]

MAX_PIXELS = 128_000_000
MOST_KEPT = 256 * 2**20
"""Bytes of a picture's file that a drawing keeps, at most."""
_TURNED = (5, 6, 7, 8)
# what decoders raise on damaged files
_DAMAGED = (OSError, ValueError, SyntaxError, EOFError, LookupError, TypeError, RuntimeError)


def check_picture(path: str | Path) -> None:
    """Raise `PictureError` if a file cannot be opened as a picture; reads only its header."""
    size_of_picture(path)


def size_of_picture(path: str | Path) -> tuple[int, int]:
    """Return a picture's upright (width, height) by its header; errors as `read_darkness`."""
    path = Path(path)
    with _told(path), path.open("rb") as stream:
        kind = _kind(stream)
        if kind == "tiff" and (page := _tiff_page(stream)) is not None:
            return _upright(tiff.size_of(page), tiff.orientation_of(page))
        if kind == "jpeg" and (frame := _deep_jpeg(stream)) is not None:
            return _upright(frame.size, 1)
        try:
            return _declared_size(stream, kind)
        except (OSError, ValueError, SyntaxError):
            if kind != "png":
                raise
            stream.seek(0)
            return _declared_size(io.BytesIO(png.without_needless_chunks(stream.read())), kind)


def read_darkness(
    path: str | Path, tone: str = "linear", notes: list[str] | None = None
) -> NDArray[np.float32]:
    """Read a picture file as darkness.

    Parameters
    ----------
    path : path
        PNG, JPEG, TIFF, WebP, BMP, GIF (first frame), JPEG 2000, HEIC or AVIF, by content and not
        by name; see ``docs/pictures.md`` for what its numbers are taken to mean.
    tone : {"illustration", "linear", "perceptual"}
        Whether darkness is as an illustrator would draw it, of light, or of sRGB's numbers.
    notes : list of str, optional
        What the person should know of how it was read is added to it.

    Returns
    -------
    (h, w) float32
        0 (white or transparent, exactly) to 1 (black), upright. Large pictures are averaged over
        k × k pixels, in the tone asked for.

    Raises
    ------
    PictureError
        If there is no such file, or it is no picture, cut off, or above `MAX_PIXELS`.
    """
    check_tone(tone)
    path = Path(path)
    with _told(path), path.open("rb") as stream:
        levels, told = levels_of_pixels(_decoded(stream), tone)
    if notes is not None:
        notes.extend(told)
    return levels.darkness()


def read_picture(
    path: str | Path, *, tone: str, width_mm: float, notes: list[str] | None = None
) -> Reference:
    """Read a picture file as the reference of a page `width_mm` wide; as `read_darkness`.

    The reference keeps the file as it came, unless that has more than `MOST_KEPT` bytes.
    """
    check_tone(tone)
    path = Path(path)
    with _told(path), path.open("rb") as stream:
        data = stream.read(MOST_KEPT + 1)
        kept = len(data) <= MOST_KEPT
        source: BinaryIO = io.BytesIO(data) if kept else stream
        source.seek(0)
        levels, told = levels_of_pixels(_decoded(source), tone)
    if notes is not None:
        notes.extend(told)
    picture = Picture(levels, tone, path.name, data if kept else None)
    return Reference.of(picture, width_mm)


def small_grey(path: Path, side_px: int) -> NDArray[np.uint8] | None:
    """Return a picture as grey values for a list of files, small; None where it cannot be read.

    As its numbers are, without profiles; pictures that only our own decoders read have none.
    """
    try:
        with _told(path), path.open("rb") as stream, _image(stream, _kind(stream)) as image:
            image.draft("L", (side_px, side_px))
            image.thumbnail((side_px, side_px))
            paper = Image.new("RGBA", image.size, "white")
            paper.alpha_composite(image.convert("RGBA"))
            return np.array(paper.convert("L"))
    except (PictureError, MemoryError):
        return None


def picture_of_bytes(data: bytes, name: str, tone: str) -> Picture:
    """Read a picture from a file's bytes; as `read_darkness`."""
    check_tone(tone)
    with _told(Path(name or "picture")):
        levels, _ = levels_of_pixels(_decoded(io.BytesIO(data)), tone)
    return Picture(levels, tone, name, data)


def darkness_of_image(image: Image.Image, tone: str = "linear") -> NDArray[np.float32]:
    """Turn a Pillow image into darkness; as `read_darkness`."""
    check_tone(tone)
    _checked_size(image.size)
    return levels_of_pixels(pillow.decode(image), tone)[0].darkness()


def darkness_of_array(values: Any, tone: str = "linear") -> NDArray[np.float32]:
    """Turn pixel values into darkness.

    Parameters
    ----------
    values : (h, w), (h, w, 1..4) array_like
        Grey, grey and alpha, RGB or RGBA; integers over their type's range, bools, or floats from
        0 (black) to 1 (white).
    """
    check_tone(tone)
    try:
        pixels = np.asarray(values)
    except ValueError:
        raise ParameterError("rows differ in length", "image") from None
    if pixels.ndim not in (2, 3) or pixels.size == 0 or (pixels.ndim == 3 and pixels.shape[2] > 4):
        raise ParameterError(f"an array of shape {pixels.shape} is no picture", "image")
    if pixels.shape[0] * pixels.shape[1] > MAX_PIXELS:
        raise ParameterError(f"more than {MAX_PIXELS // 1_000_000} megapixels", "image")
    samples, white = _unsigned(pixels)
    channels = 1 if samples.ndim == 2 else samples.shape[2]
    colour: Colour = "grey" if channels < 3 else "rgb"
    alpha = "straight" if channels in (2, 4) else ""
    levels, _ = levels_of_pixels(of_array(samples, colour, white, alpha=alpha), tone)
    return levels.darkness()


def _unsigned(pixels: NDArray[Any]) -> tuple[NDArray[Any], int]:
    """Return an array's values as 8 or 16 bits or as floats, and the value of white."""
    kind = pixels.dtype.kind
    if kind not in "uibf":
        raise ParameterError(f"pixels of type {pixels.dtype} are no picture", "image")
    if kind == "f":
        if not (pixels.min() >= 0.0 and pixels.max() <= 1.0):  # also catches NaN
            raise ParameterError("float pixels have to be finite, 0 (black) to 1 (white)", "image")
        return pixels.astype(np.float32), 1
    if kind == "b":
        return pixels.astype(np.uint8) * np.uint8(255), 255
    if int(pixels.min()) < 0:
        raise ParameterError("negative pixel values", "image")
    white = int(np.iinfo(pixels.dtype).max)
    if white > 65535:
        return (pixels / float(white)).astype(np.float32), 1
    return pixels.astype(np.uint8 if white < 256 else np.uint16, copy=False), white


# --- by kind ----------------------------------------------------------------------------------


def _decoded(stream: BinaryIO) -> Pixels:
    """Decode what an open file holds; its size is checked first."""
    kind = _kind(stream)
    if kind == "tiff" and (page := _tiff_page(stream)) is not None:
        _checked_size(tiff.size_of(page))
        try:
            return tiff.decode(page)
        except tiff.NotUnpackedError:
            stream.seek(0)  # Pillow knows some compressions more
    if kind == "jpeg" and (frame := _deep_jpeg(stream)) is not None:
        _checked_size(frame.size)
        return jpeg.decode(stream, frame)
    if kind == "png":
        return _png(stream.read())
    with _image(stream, kind) as image:
        return pillow.decode(image)


def _deep_jpeg(stream: BinaryIO) -> jpeg.Frame | None:
    """Return the header of a JPEG that Pillow does not read."""
    frame = jpeg.frame_of(stream)
    stream.seek(0)
    return frame if frame is not None and frame.is_beyond_pillow else None


def _declared_size(stream: BinaryIO, kind: str) -> tuple[int, int]:
    with _image(stream, kind) as image:
        late = kind == "png" and "exif" not in image.info  # to look for it, all would be decoded
        return _upright(image.size, 1 if late else pillow.orientation_of(image))


def _png(data: bytes) -> Pixels:
    """Decode a PNG; one that Pillow stumbles over is tried again with only what it needs."""
    try:
        return _decoded_png(data)
    except (OSError, ValueError, SyntaxError):
        found = _decoded_png(png.without_needless_chunks(data))
        note = "parts of the file beside the picture are damaged; they are left out"
        return replace(found, notes=(*found.notes, note))


def _decoded_png(data: bytes) -> Pixels:
    with _image(io.BytesIO(data), "png") as image:
        if not png.is_beyond_pillow(data):
            return pillow.decode(image)
        return replace(
            png.decode(data),
            profile=pillow.profile_of(image),
            gamma=pillow.gamma_of(image),
            orientation=pillow.orientation_of(image),
        )


@contextmanager
def _image(stream: BinaryIO, kind: str) -> Iterator[Image.Image]:
    """Open what Pillow or its companion for HEIC reads; the size is checked before decoding."""
    openers = {"heic": pillow.open_heic, "png": pillow.open_png}
    with openers.get(kind, pillow.open_image)(stream) as image:
        _checked_size(image.size)
        yield image


def _tiff_page(stream: BinaryIO) -> Any:
    """Return a TIFF's picture, or None if only Pillow may know it."""
    try:
        return tiff.open_page(stream)
    except tiff.NotUnpackedError:
        stream.seek(0)
        return None


def _kind(stream: BinaryIO) -> str:
    """Return the kind of an open file, or say what it is if it is no picture."""
    head = stream.read(HEAD_BYTES)
    stream.seek(0)
    if not head:
        raise PictureError("is empty", "", f"give a {FORMATS_TEXT}")
    if told := told_of(head):
        raise PictureError(told[0], "", told[1])
    return kind_of(head)


def _checked_size(size: tuple[int, int]) -> tuple[int, int]:
    width, height = size
    if width <= 0 or height <= 0:
        raise PictureError("has no pixels")
    if width * height > MAX_PIXELS:
        raise PictureError(
            f"has {width} × {height} pixels, over our {MAX_PIXELS // 1_000_000} megapixels",
            "",
            "reduce it first",
        )
    return size


def _upright(size: tuple[int, int], orientation: int) -> tuple[int, int]:
    """Check a size, and turn it as the picture is turned."""
    width, height = _checked_size(size)
    return (height, width) if orientation in _TURNED else (width, height)


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Turn what the file system and the decoders raise into one line that names the file."""
    try:
        yield
    except PictureError as error:
        raise PictureError(error.what, path, error.do) from None
    except FileNotFoundError:
        raise PictureError("no such file", path, "check the name") from None
    except IsADirectoryError:
        raise PictureError("is a folder", path, "name a picture in it") from None
    except PermissionError:
        raise PictureError("may not be read", path, "check its permissions") from None
    except UnidentifiedImageError:
        raise PictureError("is no picture we read", path, f"give a {FORMATS_TEXT}") from None
    except MemoryError:
        raise PictureError("needs more memory than there is", path, "reduce it first") from None
    except ParameterError:  # pragma: no cover: a caller's fault, were there one, is no damage
        raise
    except _DAMAGED as bad:
        raise PictureError(
            f"is damaged or cut off ({bad})", path, "save it again from its program"
        ) from None
