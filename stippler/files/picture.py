"""Reading pictures as fields of darkness.

Darkness is 1 − luminance, over white where the picture is transparent. Luminance is *linear*
(what reaches the eye, so ink that covers that share of the paper reflects as much light as the
picture's pixel) or *perceptual* (sRGB-encoded, the numbers in the file).
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from stippler.drawing.reference import Reference
from stippler.errors import ParameterError, PictureError

TONES = ("linear", "perceptual")

FORMATS = ("PNG", "JPEG", "TIFF", "WEBP", "BMP", "GIF")
FORMATS_TEXT = "PNG, JPEG, TIFF, WebP, BMP or GIF"
MAX_PIXELS = 128_000_000
MAX_FIELD_PIXELS = 16_000_000
"""Larger pictures are averaged down to this: 0.04 mm a pixel on A4, below any pen's dot."""

_BAND_PIXELS = 4_000_000
# shares of linear light, ITU-R BT.709
_RED, _GREEN, _BLUE = np.float32(0.2126), np.float32(0.7152), np.float32(0.0722)
_limit_lock = threading.Lock()


def check_picture(path: str | Path) -> None:
    """Raise `PictureError` if a file cannot be opened as a picture; reads only its header."""
    path = Path(path)
    with _told(path), _open(path) as image:
        _check_size(image.size, path)


def read_darkness(path: str | Path, tone: str = "linear") -> NDArray[np.float32]:
    """Read a picture file as darkness.

    Parameters
    ----------
    path : path
        PNG, JPEG, TIFF, WebP, BMP or GIF (first frame), by content and not by name; 8 or 16 bits,
        palette, grey, RGB, CMYK, with or without alpha; EXIF orientation is followed.

    Returns
    -------
    (h, w) float32
        0 (white or transparent, exactly) to 1 (black). Pictures above `MAX_FIELD_PIXELS` are
        averaged over k × k pixels, in the tone asked for.

    Raises
    ------
    PictureError
        If there is no such file, or it is no picture, cut off, or above `MAX_PIXELS`.
    """
    path = Path(path)
    with _told(path), _open(path) as image:
        return darkness_of_image(image, tone, where=path)


def read_picture(path: str | Path, *, tone: str, width_mm: float) -> Reference:
    """Read a picture file as the reference of a page `width_mm` wide; as `read_darkness`."""
    return Reference(read_darkness(path, tone), width_mm)


def darkness_of_image(
    image: Image.Image, tone: str = "linear", *, where: object = "picture"
) -> NDArray[np.float32]:
    """Turn a Pillow image into darkness; as `read_darkness`."""
    check_tone(tone)
    width, height = image.size
    _check_size(image.size, where)
    orientation = int(image.getexif().get(0x0112, 1) or 1)
    image = _plain(image)
    k = min(max(math.ceil(math.sqrt(width * height / MAX_FIELD_PIXELS)), 1), width, height)
    out = np.empty((height // k, width // k), np.float32)
    rows = max(_BAND_PIXELS // (width * k), 1)
    for top in range(0, len(out), rows):
        bottom = min(top + rows, len(out))
        band = image.crop((0, top * k, out.shape[1] * k, bottom * k))
        dark = _band_darkness(np.asarray(band), band.mode, tone)
        if k > 1:
            dark = dark.reshape(bottom - top, k, -1, k).mean(axis=(1, 3))
        out[top:bottom] = dark
    return _oriented(out, orientation)


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
    if pixels.dtype.kind in "ui":
        scale = np.iinfo(pixels.dtype).max
        if pixels.size and int(pixels.min()) < 0:
            raise ParameterError("negative pixel values", "image")
    elif pixels.dtype.kind in "bf":
        scale = 1
    else:
        raise ParameterError(f"pixels of type {pixels.dtype} are no picture", "image")
    unit = (pixels / np.float32(scale)).astype(np.float32)
    if not (unit.min() >= 0.0 and unit.max() <= 1.0):  # also catches NaN
        raise ParameterError("float pixels have to be finite, 0 (black) to 1 (white)", "image")
    channels = [unit] if unit.ndim == 2 else [unit[..., i] for i in range(unit.shape[2])]
    return _darkness(channels, tone)


def check_tone(tone: str) -> None:
    """Raise `ParameterError` unless it is one of `TONES`."""
    if tone not in TONES:
        raise ParameterError(f"{tone!r} is no tone", "tone", f"choose {' or '.join(TONES)}")


def _check_size(size: tuple[int, int], where: object) -> None:
    width, height = size
    if width == 0 or height == 0:
        raise PictureError("has no pixels", where)
    if width * height > MAX_PIXELS:
        raise PictureError(
            f"has {width} × {height} pixels, over our {MAX_PIXELS // 1_000_000} megapixels",
            where,
            "reduce it first",
        )


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Turn what the file system and Pillow raise into one line that names the file."""
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
    except (OSError, ValueError, SyntaxError, EOFError, IndexError, TypeError, KeyError) as error:
        # Pillow's decoders raise all of these on damaged files
        raise PictureError(
            f"is damaged or cut off ({error})", path, "save it again from its program"
        ) from None


@contextmanager
def _open(path: Path) -> Iterator[Image.Image]:
    if path.is_dir():
        raise IsADirectoryError(path)
    with path.open("rb") as stream:
        if not stream.read(1):
            raise PictureError("is empty", path, f"give a {FORMATS_TEXT}")
        stream.seek(0)
        with _limit_lock:  # ours is checked on the declared size instead, before decoding
            limit, Image.MAX_IMAGE_PIXELS = Image.MAX_IMAGE_PIXELS, None
            try:
                image = Image.open(stream, formats=FORMATS)
            finally:
                Image.MAX_IMAGE_PIXELS = limit
        with image:
            yield image


def _plain(image: Image.Image) -> Image.Image:
    """Decode, and convert modes other than grey and RGB, 8 or 16 bits, with or without alpha."""
    mode = image.mode
    if mode in ("P", "PA") or (mode in ("L", "RGB", "1") and "transparency" in image.info):
        return image.convert("RGBA")
    if mode in ("1", "La", "RGBa", "RGBX", "CMYK", "YCbCr", "LAB", "HSV"):
        return image.convert({"1": "L", "La": "LA", "RGBa": "RGBA"}.get(mode, "RGB"))
    if not (mode in ("L", "LA", "RGB", "RGBA", "I", "F") or mode.startswith("I;16")):
        return image.convert("RGB")
    image.load()
    return image


def _band_darkness(pixels: NDArray[Any], mode: str, tone: str) -> NDArray[np.float32]:
    if mode == "F" or mode == "I" or mode.startswith("I;16"):
        if mode == "F":
            if not np.isfinite(pixels).all() or pixels.min() < 0 or pixels.max() > 1:
                raise PictureError(
                    "has float pixels outside 0 (black) to 1 (white)", "", "save it with 16 bits"
                )
            return _darkness([pixels.astype(np.float32)], tone)
        return _darkness([np.clip(pixels, 0, 65535).astype(np.float32) / np.float32(65535)], tone)
    channels = [pixels] if pixels.ndim == 2 else [pixels[..., i] for i in range(pixels.shape[2])]
    alpha: NDArray[np.float32] | None = _BYTE[channels.pop()] if mode in ("LA", "RGBA") else None
    if len(channels) == 1:
        grey: NDArray[np.float32] = _byte_darkness(tone)[channels[0]]
        return grey if alpha is None else grey * alpha
    linear = _byte_darkness("linear")
    return _combine([linear[c] for c in channels], alpha, tone)


def _darkness(channels: list[NDArray[np.float32]], tone: str) -> NDArray[np.float32]:
    alpha = channels.pop() if len(channels) in (2, 4) else None
    if len(channels) == 1 and tone == "perceptual":
        dark = np.float32(1) - channels[0]
        return dark if alpha is None else dark * alpha
    return _combine([1 - _to_linear(c) for c in channels], alpha, tone)


def _combine(
    linear_dark: list[NDArray[np.float32]], alpha: NDArray[np.float32] | None, tone: str
) -> NDArray[np.float32]:
    """Weigh channels of linear darkness, so that white stays exactly 0."""
    dark = linear_dark[0]
    if len(linear_dark) == 3:
        red, green, blue = linear_dark
        dark = _RED * red + _GREEN * green + _BLUE * blue
    if tone == "perceptual":
        dark = _to_perceptual(dark)
    if alpha is not None:
        dark = dark * alpha
    return np.clip(dark, 0, 1)


def _to_linear(encoded: NDArray[np.float32]) -> NDArray[np.float32]:
    """Decode sRGB (IEC 61966-2-1)."""
    high = ((encoded + np.float32(0.055)) / np.float32(1.055)) ** np.float32(2.4)
    linear: NDArray[np.float32] = np.where(encoded <= 0.04045, encoded / np.float32(12.92), high)
    return linear


def _to_perceptual(linear_dark: NDArray[np.float32]) -> NDArray[np.float32]:
    """Darkness of linear light to darkness of encoded light, by a table of 2¹⁶ steps."""
    index = np.rint(linear_dark * np.float32(65535)).astype(np.uint16)
    encoded: NDArray[np.float32] = _PERCEPTUAL[index]
    return encoded


def _encoded_table() -> NDArray[np.float32]:
    linear = 1 - np.arange(65536) / 65535
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    table = (1 - encoded).astype(np.float32)
    table[0], table[-1] = 0, 1
    return table


_BYTE = np.arange(256, dtype=np.float32) / np.float32(255)
_BYTE_LINEAR = 1 - _to_linear(_BYTE)
_PERCEPTUAL = _encoded_table()


def _byte_darkness(tone: str) -> NDArray[np.float32]:
    return _BYTE_LINEAR if tone == "linear" else 1 - _BYTE


def _oriented(field: NDArray[np.float32], orientation: int) -> NDArray[np.float32]:
    """Apply EXIF orientation 1 to 8."""
    if orientation in (5, 6, 7, 8):
        field = field.T
    if orientation in (2, 3, 7, 6):
        field = field[:, ::-1]
    if orientation in (3, 4, 7, 8):
        field = field[::-1]
    return np.ascontiguousarray(field)
