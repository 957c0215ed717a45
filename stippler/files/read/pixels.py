"""What a picture's file holds: samples, and what their numbers mean."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

Colour = Literal["grey", "rgb", "cmyk", "lightness"]
CHANNELS: dict[str, int] = {"grey": 1, "rgb": 3, "cmyk": 4, "lightness": 1}


@dataclass(frozen=True, slots=True, eq=False)
class Pixels:
    """Samples of a picture, as its file has them.

    Attributes
    ----------
    size : (width, height)
    rows : callable
        Gives the samples from one row to another: (rows, w) or (rows, w, channels), unsigned
        integers from 0 to `white`, or floats; colours first, then alpha.
    colour : {"grey", "rgb", "cmyk", "lightness"}
        Lightness is CIE L*; CMYK is ink, from 0 for none to `white`.
    white : int
        The highest value of a sample, which is white; 1 for floats.
    inverted : bool
        Grey whose 0 is white.
    alpha : {"", "straight", "premultiplied"}
        What the channel after the colours is.
    profile : bytes
        ICC profile; empty for sRGB.
    gamma : float
        Where there is no profile: the power that turns samples into light; 0 for sRGB.
    orientation : int
        1 to 8, as EXIF counts them.
    notes : tuple of str
        What was taken for granted in reading it, for the person to know.
    """

    size: tuple[int, int]
    rows: Callable[[int, int], NDArray[Any]]
    colour: Colour
    white: int = 255
    inverted: bool = False
    alpha: Literal["", "straight", "premultiplied"] = ""
    profile: bytes = b""
    gamma: float = 0.0
    orientation: int = 1
    notes: tuple[str, ...] = ()


def of_array(samples: NDArray[Any], colour: Colour, white: int, **meaning: Any) -> Pixels:
    """Return the pixels of samples that lie in memory, (h, w) or (h, w, channels)."""
    size = (samples.shape[1], samples.shape[0])
    return Pixels(size, lambda top, bottom: samples[top:bottom], colour, white, **meaning)


def with_alpha(samples: NDArray[Any], transparent: tuple[int, ...], white: int) -> NDArray[Any]:
    """Add an alpha channel that is 0 where all colours have the one value that is transparent."""
    colours = samples.reshape(*samples.shape[:2], -1)
    seen = (colours != np.array(transparent, colours.dtype)).any(axis=2)
    alpha = np.where(seen, white, 0).astype(colours.dtype)
    return np.concatenate([colours, alpha[..., None]], axis=2)
