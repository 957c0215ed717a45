"""A rectangle of a page's picture, at the resolution that its dots need."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.levels import Curve, Levels
from stippler.drawing.reference import Picture, Reference
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.tone.blocks import average_blocks

PIXELS_PER_DOT = 60
"""Blocks of a reference that is finer are averaged."""

_MIN_PIXELS = 600_000  # of a page
_DOTS_PER_PIXEL = 0.25  # pixels of a reference that is coarser are divided

Box = tuple[float, float, float, float]
BoxPx = tuple[int, int, int, int]


@dataclass(frozen=True, slots=True, eq=False)
class Tones:
    """Darkness worked out for one job, which no picture keeps: of an area, white beside it.

    Attributes
    ----------
    darkness : (h, w) float32, read-only
        0 (white, weight exactly 0) to 1 (black).
    width_mm : float
    """

    darkness: NDArray[np.float32]
    width_mm: float

    def __post_init__(self) -> None:
        self.darkness.flags.writeable = False

    @property
    def pixel_mm(self) -> float:
        """Side of a pixel on the page."""
        columns: int = self.darkness.shape[1]
        return self.width_mm / columns

    @property
    def height_mm(self) -> float:
        """Height of the field on the page."""
        rows: int = self.darkness.shape[0]
        return self.pixel_mm * rows


@dataclass(frozen=True, slots=True, eq=False)
class Window:
    """What a part of the page is dark, in pixels as fine as its dots ask for.

    Its cost follows the part's own pixels, each read once, and not those of the page.

    Attributes
    ----------
    darkness : (h, w) float32, read-only
    pixel_mm : float
    origin_mm : (float, float)
        Where on the page the corner of pixel (0, 0) lies.
    scale : float
        Side of a pixel in those of the picture.
    """

    darkness: NDArray[np.float32]
    pixel_mm: float
    origin_mm: tuple[float, float]
    scale: float

    @classmethod
    def of_page(cls, reference: Reference | Tones, n_dots: int) -> Window:
        """Read all of a reference for so many dots.

        A page of few dots is read more finely than these alone ask for.
        """
        h, w = _shape_of(reference)
        if n_dots > _DOTS_PER_PIXEL * h * w:
            return _divided(reference, n_dots)
        return _read(reference, (0, 0, w, h), n_dots, _MIN_PIXELS, ())

    @classmethod
    def of(
        cls, reference: Reference, box_mm: Box, n_dots: int, *curves: Curve, bleed_mm: float = 0.0
    ) -> Window:
        """Read the box of an area for its dots.

        Parameters
        ----------
        reference : Reference
        box_mm : (x0, y0, x1, y1)
            All pixels of the page that it touches are taken, one at least.
        n_dots : int
            How many the box is to have, about.
        curves : callables
            What the adjusted darkness goes through, as a style's tone curve.
        bleed_mm : float
            How far beyond the page the picture goes on, mirrored, where the box does.
        """
        h, w = reference.source.levels.shape
        side = reference.pixel_mm
        x0, x1 = _touched(box_mm[0] / side, box_mm[2] / side, w)
        y0, y1 = _touched(box_mm[1] / side, box_mm[3] / side, h)
        inner = _read(reference, (x0, y0, x1, y1), n_dots, 0, curves)
        return inner if bleed_mm <= 0.0 else _bled(inner, reference, box_mm, bleed_mm)


def _bled(inner: Window, reference: Reference, box_mm: Box, bleed_mm: float) -> Window:
    """Repeat a window beyond the page, mirrored, as far as a box reaches."""
    size = (reference.width_mm, reference.height_mm)
    pads = []
    for axis in (0, 1):
        n = inner.darkness.shape[1 - axis]
        before, after = -box_mm[axis], box_mm[axis + 2] - size[axis]
        pads.append([
            min(math.ceil(min(max(beyond, 0.0), bleed_mm) / inner.pixel_mm), n)
            for beyond in (before, after)
        ])  # fmt: skip
    darkness = np.pad(inner.darkness, pads[::-1], mode="symmetric")
    darkness.flags.writeable = False
    x, y = (inner.origin_mm[k] - pads[k][0] * inner.pixel_mm for k in (0, 1))
    return Window(darkness, inner.pixel_mm, (x, y), inner.scale)


def _divided(reference: Reference | Tones, n_dots: int) -> Window:
    """Divide pixels larger than dots."""
    plain = reference.darkness
    k = math.ceil(math.sqrt(n_dots / (_DOTS_PER_PIXEL * plain.size)))
    darkness = np.repeat(np.repeat(plain, k, 0), k, 1)
    darkness.flags.writeable = False
    return Window(darkness, reference.pixel_mm / k, (0.0, 0.0), 1.0 / k)


def _read(
    reference: Reference | Tones, box: BoxPx, n_dots: int, least: int, curves: tuple[Curve, ...]
) -> Window:
    """Average blocks of pixels finer than dots can show."""
    x0, y0, x1, y1 = box
    n_pixels = (x1 - x0) * (y1 - y0)
    k = max(int(math.sqrt(n_pixels / max(least, PIXELS_PER_DOT * n_dots, 1))), 1)
    darkness = _averaged(reference, box, k, curves)
    if darkness.flags.writeable:
        darkness.flags.writeable = False  # as a reference's own: kernels compile for one kind
    side = reference.pixel_mm
    return Window(darkness, side * k, (side * x0, side * y0), float(k))


def _averaged(
    reference: Reference | Tones, box: BoxPx, k: int, curves: tuple[Curve, ...]
) -> NDArray[np.float32]:
    if k < 2:
        return _looked_up(reference, box, curves)
    if isinstance(reference, Tones):
        picture = Picture(Levels.rounded(reference.darkness))
        reference = Reference.of(picture, reference.width_mm)
    x0, y0, x1, y1 = box
    out = np.empty((-(-(y1 - y0) // k), -(-(x1 - x0) // k)), np.float32)
    table, levels = reference.table(*curves), reference.source.levels.of_pixel
    parallel_for(average_blocks, len(out), levels, table, y0, x0, y1, x1, k, out, grain=8)
    return out


def _looked_up(
    reference: Reference | Tones, box: BoxPx, curves: tuple[Curve, ...]
) -> NDArray[np.float32]:
    """Return pixels as they are; those of the whole page without curves to the bit."""
    x0, y0, x1, y1 = box
    if isinstance(reference, Tones) or (not curves and box == (0, 0, *_shape_of(reference)[::-1])):
        return reference.darkness
    seen = reference.source.levels.seen_through(reference.adjustment.apply, *curves)
    return seen.darkness(slice(y0, y1), slice(x0, x1))


def _shape_of(reference: Reference | Tones) -> tuple[int, ...]:
    if isinstance(reference, Tones):
        return reference.darkness.shape
    return reference.source.levels.shape


def _touched(low: float, high: float, n: int) -> tuple[int, int]:
    first = min(max(math.floor(low), 0), n - 1)
    return first, min(max(math.ceil(high), first + 1), n)
