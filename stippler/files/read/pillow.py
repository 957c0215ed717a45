"""What Pillow reads: its modes, and what their numbers mean."""

from __future__ import annotations

import struct
import threading
import warnings
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngImageFile

from stippler.files.read.pixels import Colour, Pixels, of_array, with_alpha

FORMATS = ("PNG", "JPEG", "WEBP", "BMP", "GIF", "JPEG2000", "AVIF", "TIFF")
_limit_lock = threading.Lock()
_ORIENTATION = 0x0112
_PLAIN: dict[str, tuple[Colour, bool]] = {
    "L": ("grey", False),
    "LA": ("grey", True),
    "RGB": ("rgb", False),
    "RGBA": ("rgb", True),
    "CMYK": ("cmyk", False),
    "LAB": ("lightness", False),
}
_CONVERTED = {"1": "L", "La": "LA", "RGBa": "RGBA", "P": "RGBA", "PA": "RGBA"}
_SRGB_GAMMA = 1 / 2.2
_NEAR = 0.005


def open_png(stream: BinaryIO) -> Image.Image:
    """Open a PNG as `open_image` does, which first imports what reads other kinds."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return PngImageFile(stream)
        except (SyntaxError, IndexError, TypeError, KeyError, struct.error):
            stream.seek(0)
    return open_image(stream)


def open_image(stream: BinaryIO) -> Image.Image:
    """Open a picture without decoding it; our own limit is checked on its size by the caller."""
    with _limit_lock, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of tags that are broken and of no use to us
        limit, Image.MAX_IMAGE_PIXELS = Image.MAX_IMAGE_PIXELS, None
        try:
            return Image.open(stream, formats=FORMATS)
        finally:
            Image.MAX_IMAGE_PIXELS = limit


def open_heic(stream: BinaryIO) -> Image.Image:
    """Open a HEIC without decoding it."""
    import pillow_heif

    return pillow_heif.open_heif(stream).to_pillow()


def decode(image: Image.Image) -> Pixels:
    """Decode a Pillow image and say what its samples mean."""
    image.load()
    meant = {
        "profile": profile_of(image),
        "gamma": gamma_of(image),
        "orientation": orientation_of(image),
    }
    if image.mode == "F":
        return of_array(np.asarray(image), "grey", 1, **meant)
    if image.mode == "I" or image.mode.startswith("I;16"):
        deep = np.clip(np.asarray(image), 0, 65535).astype(np.uint16)
        return _with_transparency(deep, image, 65535, meant)
    if image.mode == "1" or image.mode not in _PLAIN:
        image = image.convert(_CONVERTED.get(image.mode, "RGB"))
    if image.mode in ("L", "RGB") and "transparency" in image.info:
        return _with_transparency(np.asarray(image), image, 255, meant)
    colour, has_alpha = _PLAIN[image.mode]

    def rows(top: int, bottom: int) -> NDArray[Any]:
        return np.asarray(image.crop((0, top, image.width, bottom)))

    return Pixels(
        image.size,
        rows,
        colour,
        alpha="straight" if has_alpha else "",
        **meant,  # type: ignore[arg-type]
    )


def profile_of(image: Image.Image) -> bytes:
    """Return an image's ICC profile; empty if it has none."""
    profile = image.info.get("icc_profile")
    return profile if isinstance(profile, bytes) else b""


def gamma_of(image: Image.Image) -> float:
    """Return the power that turns a PNG's samples into light; 0 where they are sRGB."""
    gamma = image.info.get("gamma")
    if "srgb" in image.info or not isinstance(gamma, float) or not 0.05 < gamma < 20:
        return 0.0
    return 0.0 if abs(gamma - _SRGB_GAMMA) < _NEAR else 1 / gamma


def orientation_of(image: Image.Image) -> int:
    """Return EXIF's orientation, 1 where there is none or its block is broken."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            value = image.getexif().get(_ORIENTATION, 1)
    except Exception:  # noqa: BLE001 - Pillow raises whatever a broken block leads it to
        return 1
    return value if isinstance(value, int) and 1 <= value <= 8 else 1


def _with_transparency(
    samples: NDArray[Any], image: Image.Image, white: int, meant: dict[str, Any]
) -> Pixels:
    """Return grey or RGB samples, with an alpha where one of their values is transparent."""
    colour: Colour = "grey" if samples.ndim == 2 else "rgb"
    transparent = image.info.get("transparency")
    value = transparent if isinstance(transparent, tuple) else (transparent,)
    if len(value) != (1 if colour == "grey" else 3) or not all(isinstance(v, int) for v in value):
        return of_array(samples, colour, white, **meant)
    return of_array(with_alpha(samples, value, white), colour, white, alpha="straight", **meant)
