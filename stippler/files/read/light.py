"""From a picture's samples to light: by its ICC profile, its gamma, or sRGB.

The light of a pixel is its luminance relative to white, 0 to 1; darkness is 1 − light. A profile
whose channels add up (matrix and curves, as nearly all have) becomes one table a channel; others
are asked pixel by pixel.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.files.read.pixels import CHANNELS, Pixels
from stippler.names import shown

# shares of linear light, ITU-R BT.709
WEIGHTS = np.array([0.2126, 0.7152, 0.0722])
_WEIGHTS_D50 = np.array([0.22249, 0.71690, 0.06061])  # the same as profiles have them

DEEPEST = 65535  # finer samples are rounded to this many steps
_SPACES = {b"GRAY": "gray", b"RGB ": "rgb", b"CMYK": "cmyk"}
_RELATIVE, _BLACK_POINT = 1, 0x2000  # lcms: relative colorimetric; black ink is black
_LONGEST_NAME = 60
BY_PROFILE = "read by its colour profile"
_SAME = 2e-3  # of light: differences below this are rounding in a profile


@dataclass(frozen=True, slots=True, eq=False)
class Light:
    """How samples become darkness of light.

    Attributes
    ----------
    tables : tuple of (white + 1,) float32
        Darkness that each channel's value adds, by value; empty where `profile` is asked.
    profile : bytes
        Of colours that do not simply add up.
    """

    tables: tuple[NDArray[np.float32], ...]
    profile: bytes = b""
    white_light: float = 1.0
    note: str = ""

    def darkness(self, samples: NDArray[Any], white: int) -> NDArray[np.float32]:
        """Return the darkness of (h, w, channels) samples, unsigned integers up to `white`."""
        if self.profile:
            unit = samples if white == np.iinfo(samples.dtype).max else _rescaled(samples, white)
            light = _transformed(unit, self.profile) / np.float32(self.white_light)
            return _snapped(1 - light)
        dark: NDArray[np.float32] = self.tables[0][samples[..., 0]]
        for k, table in enumerate(self.tables[1:], 1):
            dark = dark + table[samples[..., k]]
        return dark

    def perceptual(self) -> Light:
        """Return the same for grey, as darkness of sRGB's numbers instead of light."""
        light = 1 - self.tables[0].astype(np.float64)
        return replace(self, tables=(_snapped(1 - light_to_srgb(light)),))


def steps_of(pixels: Pixels) -> int:
    """Return the highest index of tables: floats, and what is reckoned with first, the finest."""
    if pixels.colour == "cmyk" and pixels.white == 255 and pixels.alpha != "premultiplied":
        return 255 * 255  # what is left of paper between a colour's ink and black
    whole = pixels.colour != "cmyk" and pixels.alpha != "premultiplied" and pixels.white > 1
    return pixels.white if whole else DEEPEST


def light_of(pixels: Pixels) -> Light:
    """Find out how the samples of a picture become light."""
    steps = steps_of(pixels)
    unit = np.arange(steps + 1) / steps
    if pixels.colour == "lightness":
        return Light((_snapped(1 - _light_of_lightness(unit)),))
    light = unit**pixels.gamma if pixels.gamma else srgb_to_light(unit)
    if not pixels.profile:
        return Light(_weighted(light, pixels.colour))
    found, note = _by_profile(pixels, unit)
    if found is None:
        return Light(_weighted(light, pixels.colour), note=note)
    if _is_as_without(found, _weighted(light, pixels.colour)):
        return found
    return replace(found, note=f"{BY_PROFILE} {_name(pixels.profile)}".rstrip())


def light_to_srgb(light: NDArray[np.float64]) -> NDArray[np.float64]:
    """Encode as sRGB does."""
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def srgb_to_light(encoded: NDArray[Any]) -> NDArray[Any]:
    """Decode sRGB (IEC 61966-2-1)."""
    high = ((encoded + encoded.dtype.type(0.055)) / encoded.dtype.type(1.055)) ** (
        encoded.dtype.type(2.4)
    )
    light: NDArray[Any] = np.where(encoded <= 0.04045, encoded / encoded.dtype.type(12.92), high)
    return light


def _weighted(light: NDArray[np.float64], colour: str) -> tuple[NDArray[np.float32], ...]:
    """Return tables of channels that all have one curve."""
    weights = [1.0] if colour == "grey" else WEIGHTS
    return tuple(_snapped(w * (1 - light)) for w in weights)


def _light_of_lightness(unit: NDArray[np.float64]) -> NDArray[np.float64]:
    """Luminance of CIE L*, 1 being L* = 100."""
    f = (100 * unit + 16) / 116
    return np.where(f > 6 / 29, f**3, 3 * (6 / 29) ** 2 * (f - 4 / 29))


def _snapped(dark: NDArray[Any]) -> NDArray[np.float32]:
    """Make what rounding alone has left of white exactly 0, and of black exactly 1."""
    dark = np.clip(dark, 0, 1).astype(np.float32)
    dark[dark < 4e-5] = 0
    dark[dark > 1 - 4e-5] = 1
    return dark


# --- profiles ---------------------------------------------------------------------------------


def _by_profile(pixels: Pixels, unit: NDArray[np.float64]) -> tuple[Light | None, str]:
    """Return the light by the picture's profile, or why there is none."""
    profile, colour = pixels.profile, pixels.colour
    space = _SPACES.get(profile[16:20], "")
    wanted = "gray" if colour == "grey" else colour
    if not (space == wanted or (space == "rgb" and wanted == "gray")):
        return None, "its colour profile is of another kind than its pixels; taken as sRGB"
    try:
        if wanted == "gray":
            found = _of_neutral(profile, space, unit)
        elif wanted == "rgb":
            found = _of_rgb(profile, unit)
        else:
            paper = float(_transformed(np.zeros((1, 1, 4), np.uint8), profile)[0, 0])
            found = Light((), profile, paper)
    except (ValueError, RuntimeError) as error:  # lcms' own error is a RuntimeError
        return None, f"its colour profile cannot be used ({error}); taken as sRGB"
    return found, ""


def _is_as_without(found: Light, plain: tuple[NDArray[np.float32], ...]) -> bool:
    """Whether a profile changes nothing that can be seen: most are sRGB's own."""
    return len(found.tables) == len(plain) and all(
        np.abs(a - b).max() < _SAME for a, b in zip(found.tables, plain, strict=True)
    )


def _name(profile: bytes) -> str:
    """Return what a profile calls itself; nothing where it does not."""
    from PIL import ImageCms

    try:
        name = ImageCms.getProfileDescription(ImageCms.ImageCmsProfile(io.BytesIO(profile)))
    except (ImageCms.PyCMSError, OSError, ValueError, TypeError):
        return ""
    return " ".join(shown(name).split())[:_LONGEST_NAME]


def _of_neutral(profile: bytes, space: str, unit: NDArray[np.float64]) -> Light:
    ramp = np.repeat(unit.astype(np.float32)[None, :, None], 1 if space == "gray" else 3, axis=2)
    light = _transformed(ramp, profile)[0].astype(np.float64)
    return Light((_snapped(1 - _as_srgb(light / _white(light[-1]), unit)),))


def _of_rgb(profile: bytes, unit: NDArray[np.float64]) -> Light:
    """Return tables by channel where the light of the three adds up; else the profile."""
    probes = np.random.default_rng(0).random((1, 64, 3)).astype(np.float32)
    ends = np.array([[[0, 0, 0], [1, 1, 1]]], np.float32)
    black, white = _transformed(ends, profile)[0].astype(np.float64)
    white = _white(white)
    ramps = np.zeros((3, len(unit), 3), np.float32)
    for k in range(3):
        ramps[k, :, k] = unit
    curves = (_transformed(ramps, profile).astype(np.float64) - black) / white
    sums = sum(np.interp(probes[0, :, k], unit, curves[k]) for k in range(3)) + black / white
    far = np.abs(sums - _transformed(probes, profile)[0] / white).max()
    if far > max(_SAME, 2 / len(unit)):
        return Light((), profile, white)
    weights = curves[:, -1]
    if np.abs(weights - _WEIGHTS_D50).max() < 2 * _SAME and all(
        _is_srgb(curve / weight, unit) for curve, weight in zip(curves, weights, strict=True)
    ):
        return Light(_weighted(srgb_to_light(unit), "rgb"))
    return Light(tuple(_snapped(c[-1] - c) for c in curves))


def _white(light: float) -> float:
    """Return the light of the whitest value, which is the paper's; refuse a profile without."""
    if not 0.5 < light < 2:
        raise ValueError("white is not white in it")
    return float(light)


def _as_srgb(light: NDArray[np.float64], unit: NDArray[np.float64]) -> NDArray[np.float64]:
    return srgb_to_light(unit) if _is_srgb(light, unit) else light


def _is_srgb(light: NDArray[np.float64], unit: NDArray[np.float64]) -> bool:
    return bool(np.abs(light - srgb_to_light(unit)).max() < _SAME)


def _transformed(samples: NDArray[Any], profile: bytes) -> NDArray[np.float32]:
    """Return the light of (h, w, channels) samples by a profile, as lcms has it."""
    import imagecodecs

    space = _SPACES[profile[16:20]]
    flat = samples[..., 0] if CHANNELS["grey"] == samples.shape[-1] else samples
    light = imagecodecs.cms_transform(
        np.ascontiguousarray(flat),
        profile,
        imagecodecs.cms_profile("gray", gamma=1.0),
        colorspace=space,
        outcolorspace="gray",
        outdtype=np.float32,
        intent=_RELATIVE,
        flags=_BLACK_POINT if space == "cmyk" else 0,
    )
    return np.asarray(light, np.float32).reshape(samples.shape[:2])


def _rescaled(samples: NDArray[Any], white: int) -> NDArray[np.uint16]:
    return np.rint(samples * np.float32(DEEPEST / white)).astype(np.uint16)
