"""From samples to levels of darkness over white paper.

Darkness is 1 − luminance, over white where the picture is transparent. Luminance is *linear*
(what reaches the eye, so ink that covers that share of the paper reflects as much light as the
picture's pixel), *perceptual* (sRGB-encoded, the numbers in most files), or perceptual and then
as an illustrator would draw it (*illustration*, see `stippler.drawing.tone_curve`).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.levels import N_LEVELS, Levels, gathered, table_of
from stippler.drawing.picture_values import TONES
from stippler.drawing.tone_curve import curve_for, illustration, tones_in
from stippler.errors import ParameterError, PictureError
from stippler.files.read.light import (
    DEEPEST,
    WEIGHTS,
    Light,
    light_of,
    light_to_srgb,
    srgb_to_light,
)
from stippler.files.read.pixels import CHANNELS, Pixels
from stippler.kernels.machine.pool import parallel_for

MAX_FIELD_PIXELS = 16_000_000
"""Larger pictures are averaged down to this: 0.04 mm a pixel on A4, below any pen's dot."""

_BAND_PIXELS = 4_000_000
_OVERSHOOT = 0.01  # of white: what resampling leaves beside 0 and 1 in floats


def check_tone(tone: str) -> None:
    """Raise `ParameterError` unless it is one of `TONES`."""
    if tone not in TONES:
        raise ParameterError(
            f"{tone!r} is no tone", "tone", f"choose {', '.join(TONES[:-1])} or {TONES[-1]}"
        )


def levels_of_pixels(pixels: Pixels, tone: str) -> tuple[Levels, tuple[str, ...]]:
    """Turn pixels into darkness, upright, averaged to `MAX_FIELD_PIXELS`; and what to tell."""
    if (few := _grey_values(pixels, tone)) is not None:
        return few
    drawn = tone == "illustration"
    if drawn:
        tone = "perceptual"
    width, height = pixels.size
    k = min(max(math.ceil(math.sqrt(width * height / MAX_FIELD_PIXELS)), 1), width, height)
    shape = height // k, width // k
    light = light_of(pixels)
    told = pixels.notes + ((light.note,) if light.note else ())
    if tone == "perceptual" and len(light.tables) == 1:
        light = light.perceptual()
    bands = _bands(pixels, light, tone, k)
    of_pixel, values = _drawn(bands, shape) if drawn else gathered(bands, shape)
    return Levels(_oriented(of_pixel, pixels.orientation), values), told


def _bands(pixels: Pixels, light: Light, tone: str, k: int) -> Iterator[NDArray[np.float32]]:
    """Give the darkness of pixels, or the means of blocks of k x k, some rows at a time."""
    width, height = pixels.size
    rows, columns = height // k, width // k
    at_once = max(_BAND_PIXELS // (width * k), 1)
    for top in range(0, rows, at_once):
        bottom = min(top + at_once, rows)
        band = pixels.rows(top * k, bottom * k)[:, : columns * k]
        dark = _band(band.reshape(*band.shape[:2], -1), pixels, light, tone)
        yield dark if k == 1 else dark.reshape(bottom - top, k, -1, k).mean(axis=(1, 3))


def _drawn(
    bands: Iterable[NDArray[np.float32]], shape: tuple[int, int]
) -> tuple[NDArray[np.uint16], NDArray[np.float32]]:
    """Return levels and their values as an illustrator draws them.

    The curve has as many steps as there are levels, so that its table waits for all the tones.
    """
    of_pixel, n_done, tones = np.empty(shape, np.uint16), 0, []
    for band in bands:
        tones.append(tones_in(band.ravel()))
        of_pixel[n_done : n_done + len(band)] = np.rint(band * np.float32(N_LEVELS - 1))
        n_done += len(band)
    return of_pixel, curve_for(np.sum(tones, axis=0)).apply(table_of())


def _grey_values(pixels: Pixels, tone: str) -> tuple[Levels, tuple[str, ...]] | None:
    """Do the same for grey of whole numbers, where that is all of it; else None.

    Its samples are its levels: only what they come to is worked out.
    """
    width, height = pixels.size
    is_grey = pixels.colour == "grey" and 1 < pixels.white < N_LEVELS and not pixels.alpha
    if not is_grey or width * height > MAX_FIELD_PIXELS:
        return None
    samples = pixels.rows(0, height).reshape(height, width)
    light = light_of(pixels)
    if samples.dtype.kind != "u" or len(light.tables) != 1:
        return None
    if pixels.white < np.iinfo(samples.dtype).max and int(samples.max()) > pixels.white:
        return None
    note = (light.note,) if light.note else ()
    if tone != "linear":
        light = light.perceptual()
    each = np.arange(pixels.white + 1, dtype=samples.dtype)
    table = _band(each[None, :, None], pixels, light, tone)
    if tone == "illustration":
        table = illustration(table[0], _counts(samples, pixels.white)).apply(table)
    levels = np.array(_oriented(samples, pixels.orientation), np.uint16)
    return Levels(levels, table[0]), pixels.notes + note


def _counts(samples: NDArray[np.unsignedinteger], white: int) -> NDArray[np.int64]:
    """Return how many pixels there are of each value."""
    found: list[NDArray[np.int64]] = []

    def part(start: int, stop: int) -> None:
        found.append(np.bincount(samples[start:stop].ravel(), minlength=white + 1))

    parallel_for(part, len(samples), grain=32, chunks=16)
    total: NDArray[np.int64] = np.sum(found, axis=0)
    return total


def _band(samples: NDArray[Any], pixels: Pixels, light: Light, tone: str) -> NDArray[np.float32]:
    n, white = CHANNELS[pixels.colour], pixels.white
    colours, alpha = samples[..., :n], None
    if pixels.alpha:
        alpha = (samples[..., n] / np.float32(white)).astype(np.float32)
    if white == 1:
        colours = _checked_floats(colours, alpha if pixels.alpha == "premultiplied" else None)
        if not (pixels.profile or pixels.gamma or pixels.colour in ("lightness", "cmyk")):
            return _over_white(_float_darkness(colours, pixels.inverted, tone), alpha)
        colours, white = np.rint(colours * np.float32(DEEPEST)).astype(np.uint16), DEEPEST
    elif pixels.alpha == "premultiplied":
        colours, white = _straight(colours, samples[..., n]), DEEPEST
    if pixels.inverted:
        colours = colours.dtype.type(white) - colours
    if pixels.colour == "cmyk" and not light.profile:
        colours = _without_ink(colours, white)
    dark = light.darkness(colours, white)
    if tone == "perceptual" and len(light.tables) != 1:
        dark = _to_perceptual(dark)
    return _over_white(dark, alpha)


def _over_white(
    dark: NDArray[np.float32], alpha: NDArray[np.float32] | None
) -> NDArray[np.float32]:
    if alpha is not None:
        dark = dark * np.clip(alpha, 0, 1)
    return np.clip(dark, 0, 1)


def _straight(colours: NDArray[Any], alpha: NDArray[Any]) -> NDArray[np.uint16]:
    """Divide colours by the alpha that they were multiplied by."""
    share = colours / np.maximum(alpha, 1).astype(np.float32)[..., None]
    straight: NDArray[np.uint16] = np.rint(np.clip(share, 0, 1) * DEEPEST).astype(np.uint16)
    return straight


def _without_ink(ink: NDArray[Any], white: int) -> NDArray[np.uint16]:
    """Return the RGB of CMYK inks that are as they would be by name, for tables of `steps_of`."""
    if white == 255:
        paper_8 = 255 - ink.astype(np.uint16)
        return paper_8[..., :3] * paper_8[..., 3:]
    paper = (white - ink.astype(np.float32)) / np.float32(white)
    rgb: NDArray[np.uint16] = np.rint(paper[..., :3] * paper[..., 3:] * DEEPEST).astype(np.uint16)
    return rgb


# --- floats -----------------------------------------------------------------------------------


def _checked_floats(
    colours: NDArray[Any], alpha: NDArray[np.float32] | None
) -> NDArray[np.float32]:
    """Return floats between 0 and 1, or say why they are no picture."""
    if alpha is not None:
        colours = colours / np.where(alpha > 0, alpha, 1)[..., None]
    low, high = float(colours.min()), float(colours.max())
    if not (math.isfinite(low) and math.isfinite(high)):
        raise PictureError(
            "has float pixels that are no numbers (NaN or infinite)", "", "save it with 16 bits"
        )
    if low < -_OVERSHOOT or high > 1 + _OVERSHOOT:
        raise PictureError(
            f"has float pixels from {low:g} to {high:g}, outside 0 (black) to 1 (white)",
            "",
            "scale them, or save it with 16 bits",
        )
    unit: NDArray[np.float32] = np.clip(colours, 0, 1).astype(np.float32)
    return unit


def _float_darkness(colours: NDArray[np.float32], inverted: bool, tone: str) -> NDArray[np.float32]:
    """Return the darkness of sRGB floats, without any rounding to steps."""
    if inverted:
        colours = 1 - colours
    if colours.shape[-1] == 1 and tone == "perceptual":
        return np.float32(1) - colours[..., 0]
    dark: NDArray[np.float32] = 1 - srgb_to_light(colours)
    if colours.shape[-1] == 1:
        return dark[..., 0]
    red, green, blue = (np.float32(w) for w in WEIGHTS)
    mixed = red * dark[..., 0] + green * dark[..., 1] + blue * dark[..., 2]
    return _to_perceptual(mixed) if tone == "perceptual" else mixed


# --- tables -----------------------------------------------------------------------------------


def _to_perceptual(linear_dark: NDArray[np.float32]) -> NDArray[np.float32]:
    """Darkness of linear light to darkness of encoded light, by a table of 2¹⁶ steps."""
    index = np.rint(np.clip(linear_dark, 0, 1) * np.float32(65535)).astype(np.uint16)
    encoded: NDArray[np.float32] = _PERCEPTUAL[index]
    return encoded


def _encoded_table() -> NDArray[np.float32]:
    table = (1 - light_to_srgb(1 - np.arange(65536) / 65535)).astype(np.float32)
    table[0], table[-1] = 0, 1
    return table


_PERCEPTUAL = _encoded_table()


def _oriented(field: NDArray[Any], orientation: int) -> NDArray[Any]:
    """Apply EXIF orientation 1 to 8."""
    if orientation in (5, 6, 7, 8):
        field = field.T
    if orientation in (2, 3, 7, 6):
        field = field[:, ::-1]
    if orientation in (3, 4, 7, 8):
        field = field[::-1]
    return np.ascontiguousarray(field)
