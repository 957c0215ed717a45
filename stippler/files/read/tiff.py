"""TIFF: every kind of sample, or the true reason why not.

`tifffile` gives the samples as they lie in the file; what their numbers mean is read here from the
tags. What it cannot unpack (rare compressions of 8 bits) goes to Pillow.
"""

from __future__ import annotations

import logging
import re
from typing import TYPE_CHECKING, Any, BinaryIO, Literal

import numpy as np
from numpy.typing import NDArray

from stippler.errors import PictureError
from stippler.files.read.kinds import RAW
from stippler.files.read.pixels import CHANNELS, Colour, Pixels, of_array

if TYPE_CHECKING:
    from tifffile import TiffFile, TiffPage

_AGAIN = "save it again as grey or RGB, with 8 or 16 bits"
_WHITE_IS_ZERO, _BLACK_IS_ZERO, _RGB, _PALETTE, _MASK, _CMYK, _YCBCR = range(7)
_CIELAB, _ICCLAB, _ITULAB, _CFA, _LINEAR_RAW = 8, 9, 10, 32803, 34892
_COLOURS: dict[int, Colour] = {
    _WHITE_IS_ZERO: "grey",
    _BLACK_IS_ZERO: "grey",
    _PALETTE: "grey",
    _RGB: "rgb",
    _CMYK: "cmyk",
    _YCBCR: "rgb",
    _CIELAB: "lightness",
    _ICCLAB: "lightness",
}
_UINT, _INT, _FLOAT = 1, 2, 3
_REDUCED, _IS_MASK = 1, 4
_SUBIFDS, _PROFILE, _DNG_VERSION, _MAX_SAMPLE, _S_MAX_SAMPLE = 330, 34675, 50706, 281, 341
_DEPTHS = (8, 10, 12)

logging.getLogger("tifffile").addHandler(logging.NullHandler())  # else it writes to stderr


class NotUnpackedError(Exception):
    """Samples that tifffile cannot unpack; another reader may."""


def open_page(stream: BinaryIO) -> TiffPage:
    """Open a TIFF and choose its picture: the first page of full size, which is no thumbnail."""
    import tifffile

    try:
        return _full_page(tifffile.TiffFile(stream))
    except PictureError:
        raise
    except Exception as error:  # tifffile raises whatever a broken tag leads it to
        raise NotUnpackedError(str(error)) from error


def size_of(page: TiffPage) -> tuple[int, int]:
    """Return the (width, height) that a page declares, before it is turned."""
    return int(page.imagewidth), int(page.imagelength)


def decode(page: TiffPage) -> Pixels:
    """Decode a page's samples and say what they mean.

    Raises
    ------
    PictureError
        If they mean nothing that can be drawn; says why.
    NotUnpackedError
        If they cannot be unpacked here.
    """
    photometric = int(page.photometric)
    colour = _colour(page, photometric)
    samples = _samples(page)
    n = CHANNELS[colour] if colour != "lightness" else 3
    if photometric == _PALETTE:
        samples, colour, n = _by_palette(samples, page), "rgb", 3
    if samples.shape[2] < n:
        raise PictureError(f"has {samples.shape[2]} channels where it needs {n}", "", _AGAIN)
    alpha = _alpha(page, samples.shape[2] - n)
    kept = [*range(CHANNELS[colour]), *([n] if alpha else ())]
    samples = samples[..., kept] if kept != list(range(samples.shape[2])) else samples
    samples, white, note = _scaled(samples, page, photometric)
    return of_array(
        samples,
        colour,
        white,
        inverted=photometric == _WHITE_IS_ZERO,
        alpha=alpha,
        profile=_tag_bytes(page, _PROFILE),
        orientation=orientation_of(page),
        notes=(note,) if note else (),
    )


# --- pages ------------------------------------------------------------------------------------


def _full_page(tiff: TiffFile) -> TiffPage:
    """Return the first page that is no thumbnail and no mask, looked for in subpages, too."""
    first: TiffPage = tiff.pages.first
    if _DNG_VERSION in first.tags:
        raise PictureError(RAW[0], "", RAW[1])
    page: TiffPage
    for page in _pages(tiff):
        if not page.subfiletype & (_REDUCED | _IS_MASK):
            return page
    return first


def _pages(tiff: TiffFile) -> Any:
    for k in range(min(len(tiff.pages), 64)):
        page: Any = tiff.pages[k]
        yield page
        if _SUBIFDS in page.tags and page.pages is not None:
            yield from page.pages


def orientation_of(page: TiffPage) -> int:
    """Return how a page is to be turned, 1 where that is not said."""
    tag = page.tags.get(274)
    value = tag.value if tag is not None else 1
    return int(value) if isinstance(value, int) and 1 <= value <= 8 else 1


def _tag_bytes(page: TiffPage, code: int) -> bytes:
    tag = page.tags.get(code)
    value = tag.value if tag is not None else b""
    return value if isinstance(value, bytes) else b""


# --- what is in a page ------------------------------------------------------------------------


def _colour(page: TiffPage, photometric: int) -> Colour:
    """Return what the samples are of, or refuse what cannot be drawn."""
    if photometric in (_CFA, _LINEAR_RAW):
        raise PictureError(RAW[0], "", RAW[1])
    if photometric not in _COLOURS:
        kinds = {_MASK: "is a mask, not a picture", _ITULAB: "holds fax colours (ITU L*a*b*)"}
        raise PictureError(
            kinds.get(photometric, f"holds colours of an unusual kind ({photometric})"), "", _AGAIN
        )
    if photometric == _CMYK and page.tags.valueof(332, 1) != 1:
        raise PictureError("holds inks other than CMYK", "", "save it again as RGB")
    if int(page.imagedepth) > 1:
        raise PictureError("holds a volume, not a picture", "", "save one of its slices")
    if int(page.sampleformat) not in (_UINT, _INT, _FLOAT, 4):
        raise PictureError("holds complex numbers", "", _AGAIN)
    return _COLOURS[photometric]


def _samples(page: TiffPage) -> NDArray[Any]:
    """Return a page's samples as (h, w, channels)."""
    try:
        samples = np.asarray(page.asarray(maxworkers=1))
    except Exception as error:  # whatever a codec raises
        raise NotUnpackedError(str(error)) from error
    if int(page.bitspersample) == 24 and samples.dtype == np.uint32:
        samples = _three_bytes(samples, page.parent.byteorder)
    height, width = int(page.imagelength), int(page.imagewidth)
    if samples.shape == (height, width):
        return samples[..., None]
    if samples.ndim == 3 and samples.shape[:2] == (height, width):
        return samples
    if samples.ndim == 3 and samples.shape[1:] == (height, width):
        return np.moveaxis(samples, 0, -1)
    raise NotUnpackedError(f"samples of shape {samples.shape}")


def _three_bytes(samples: NDArray[np.uint32], byteorder: str) -> NDArray[np.uint32]:
    """Order the bytes of samples of 24 bits, which tifffile leaves out of order."""
    if byteorder == ">":
        return samples.byteswap()
    ordered = ((samples & 0xFF) << 16) | (samples & 0xFF00) | (samples >> 16 & 0xFF)
    return ordered.astype(np.uint32)


def _by_palette(samples: NDArray[Any], page: TiffPage) -> NDArray[np.uint16]:
    """Look colours up; a map of 8-bit numbers, which some programs write, is stretched."""
    colormap = page.colormap
    if colormap is None:
        raise PictureError("has lost its palette", "", _AGAIN)
    table = np.asarray(colormap, np.uint16)
    if table.max() < 256:
        table = (table * 257).astype(np.uint16)
    colours = table.T[np.minimum(samples[..., 0], table.shape[1] - 1)]
    extra = samples[..., 1:2].astype(np.uint16)
    white = (1 << int(page.bitspersample)) - 1
    return np.concatenate([colours, (extra * (65535 // white)).astype(np.uint16)], axis=2)


def _alpha(page: TiffPage, n_extra: int) -> Literal["", "straight", "premultiplied"]:
    """Return what the first channel after the colours is."""
    if n_extra < 1:
        return ""
    extra = page.extrasamples
    kind = int(extra[0]) if extra else 0
    if kind == 0:  # not said: a single one is transparency, as all other readers have it
        return "straight" if n_extra == 1 else ""
    return "premultiplied" if kind == 1 else "straight" if kind == 2 else ""


# --- scale ------------------------------------------------------------------------------------


def _scaled(
    samples: NDArray[Any], page: TiffPage, photometric: int
) -> tuple[NDArray[Any], int, str]:
    """Return samples as unsigned integers or floats, what white is, and what to tell."""
    if photometric == _PALETTE:
        return samples, 65535, ""
    kind, bits = samples.dtype.kind, int(page.bitspersample)
    if kind == "b":
        return samples.astype(np.uint8) * np.uint8(255), 255, ""
    if kind == "c":
        raise PictureError("holds complex numbers", "", _AGAIN)
    if kind == "f":
        return _floats(samples, page), 1, ""
    if photometric in (_CIELAB, _ICCLAB):
        return _lightness(samples, photometric)
    white = (1 << bits) - 1
    if kind == "i":
        if int(samples.min()) < 0:
            raise PictureError(
                "has values below 0, and only its program knows what they mean", "", _AGAIN
            )
        white >>= 1
    note = ""
    if bits == 16 and photometric in (_WHITE_IS_ZERO, _BLACK_IS_ZERO):
        white, note = _used_depth(samples[..., 0], page, white)
    if white <= 65535:
        return samples.astype(np.uint16 if white > 255 else np.uint8, copy=False), white, note
    return (samples / float(white)).astype(np.float32), 1, note


def _floats(samples: NDArray[Any], page: TiffPage) -> NDArray[np.float32]:
    """Return floats; those that go beyond 1 are taken over the range that the file declares."""
    top = page.tags.valueof(_S_MAX_SAMPLE)
    top = max(top) if isinstance(top, tuple) and top else top
    if isinstance(top, int | float) and 1 < top < np.inf and samples.max() > 1:
        samples = samples / float(top)
    return samples.astype(np.float32, copy=False)


def _lightness(samples: NDArray[Any], photometric: int) -> tuple[NDArray[Any], int, str]:
    if samples.dtype == np.uint8:
        return samples, 255, ""
    if samples.dtype == np.uint16:
        top = 65280 if photometric == _ICCLAB else 65535
        return np.minimum(samples, top), top, ""
    raise PictureError("holds L*a*b* of an unusual depth", "", _AGAIN)


def _used_depth(samples: NDArray[Any], page: TiffPage, white: int) -> tuple[int, str]:
    """Return what is white in 16 bits that a camera of fewer bits has filled."""
    declared = _declared_white(page)
    highest = int(samples.max())
    if declared is not None and highest <= declared < white:
        return declared, ""
    for depth in _DEPTHS:
        if 0 < highest < 1 << depth:
            return (1 << depth) - 1, f"uses {depth} of its 16 bits; drawn as a {depth}-bit picture"
    return white, ""


def _declared_white(page: TiffPage) -> int | None:
    """Return the highest value that tags tell of: MaxSampleValue, or OME's significant bits."""
    for code in (_S_MAX_SAMPLE, _MAX_SAMPLE):
        top = page.tags.valueof(code)
        top = max(top) if isinstance(top, tuple) and top else top
        if isinstance(top, int) and top > 0 and top & (top + 1) == 0:  # else it is a statistic
            return top
    found = re.search(r'SignificantBits="(\d+)"', str(page.description or ""))
    return (1 << int(found[1])) - 1 if found and 1 <= int(found[1]) <= 16 else None
