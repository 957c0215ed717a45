"""A part of a sheet as it will be seen: the pixels of its file, or its outlines at the screen's."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stippler.files.write.raster import bit_strips, grey_strips, size_px
from stippler.files.write.sheet import Layer, Sheet, moved
from stippler.units import MM_PER_INCH

_MOST_PIXELS = 6_000_000  # of a file that are looked at one by one


@dataclass(frozen=True, slots=True)
class Window:
    """What is looked at: a rectangle of the sheet in mm, and so many pixels of the screen."""

    left: float
    top: float
    width_mm: float
    height_mm: float
    columns: int
    rows: int


def proof(
    sheet: Sheet, window: Window, dpi: float | None = None, bits: int = 8
) -> NDArray[np.uint8]:
    """Return (rows, columns) greys of a part of a sheet, 255 is paper.

    Parameters
    ----------
    dpi : float, optional
        Of the file, if it has pixels: they are shown as they are, or averaged where they are
        smaller than the screen's. Of more than six million outlines are shown instead.
    bits : {1, 8}
        Of such a pixel.
    """
    if dpi is None:
        return _outlined(sheet, window)
    size = size_px(sheet, dpi)
    per_mm = max(size.width / sheet.width_mm, size.height / sheet.height_mm)
    x0, x1 = _pixels(window.left, window.width_mm, per_mm, size.width)
    y0, y1 = _pixels(window.top, window.height_mm, per_mm, size.height)
    if (x1 - x0) * (y1 - y0) > _MOST_PIXELS:
        return _outlined(sheet, window)
    exact = replace(
        window, left=x0 / per_mm, top=y0 / per_mm, width_mm=(x1 - x0) / per_mm,
        height_mm=(y1 - y0) / per_mm,
    )  # fmt: skip
    part = part_of(sheet, exact)
    if bits == 1:
        packed = np.concatenate(list(bit_strips(part, per_mm * MM_PER_INCH)))
        pixels = (1 - np.unpackbits(packed, axis=1)[:, : x1 - x0]) * np.uint8(255)
    else:
        pixels = np.concatenate(list(grey_strips(part, per_mm * MM_PER_INCH)))
    return _resampled(pixels, window, (x0 / per_mm, y0 / per_mm), per_mm)


def part_of(sheet: Sheet, window: Window) -> Sheet:
    """Return what of a sheet is seen in a window, as a sheet of its own."""
    low = np.array([window.left, window.top])
    high = low + np.array([window.width_mm, window.height_mm])
    layers = tuple(_near(layer, low, high) for layer in sheet.layers)
    return moved(
        replace(sheet, layers=layers), 1.0, (-window.left, -window.top),
        (window.width_mm, window.height_mm),
    )  # fmt: skip


def _near(layer: Layer, low: NDArray[np.float64], high: NDArray[np.float64]) -> Layer:
    dots = layer.dots
    # rough outlines reach at most 1.4 times as far as smooth ones
    reach = (1.5 * dots.radius_mm * np.sqrt(dots.elongation))[:, None]
    near = (dots.position_mm + reach > low) & (dots.position_mm - reach < high)
    rows = np.flatnonzero(near.all(axis=1))
    return layer if len(rows) == len(dots) else replace(layer, dots=dots.take(rows))


def _pixels(first_mm: float, length_mm: float, per_mm: float, n: int) -> tuple[int, int]:
    first = min(max(math.floor(first_mm * per_mm), 0), n - 1)
    return first, min(max(math.ceil((first_mm + length_mm) * per_mm), first + 1), n)


def _outlined(sheet: Sheet, window: Window) -> NDArray[np.uint8]:
    dpi = MM_PER_INCH * window.columns / window.width_mm
    exact = replace(window, height_mm=window.rows * window.width_mm / window.columns)
    return np.concatenate(list(grey_strips(part_of(sheet, exact), dpi)))[: window.rows]


def _resampled(
    pixels: NDArray[np.uint8], window: Window, from_mm: tuple[float, float], per_mm: float
) -> NDArray[np.uint8]:
    """Return pixels as large as the screen shows them: averaged by area, never blurred."""
    edges_x = (
        window.left + np.linspace(0, window.width_mm, window.columns + 1) - from_mm[0]
    ) * per_mm
    edges_y = (window.top + np.linspace(0, window.height_mm, window.rows + 1) - from_mm[1]) * per_mm
    across = _averaged(pixels.astype(np.float32).T, edges_x)
    return np.asarray(np.rint(_averaged(across.T, edges_y)), np.uint8)


def _averaged(rows: NDArray[np.float32], edges: NDArray[np.float64]) -> NDArray[np.float32]:
    """Average rows between edges, in units of rows."""
    n = len(rows)
    edges = np.clip(edges, 0.0, n)
    step = float(edges[-1] - edges[0]) / max(len(edges) - 1, 1)
    if step < 1.0:  # a row is larger than a pixel: the row in which the pixel's middle lies
        middle = np.clip((edges[:-1] + edges[1:]) / 2, 0, n - 1e-9).astype(np.intp)
        return rows[middle]
    sums = np.zeros((n + 1, rows.shape[1]))
    np.cumsum(rows, axis=0, out=sums[1:], dtype=np.float64)
    whole = np.minimum(edges.astype(np.intp), n - 1)
    at = sums[whole] + (edges - whole)[:, None] * rows[whole]
    span = np.maximum(np.diff(edges), 1e-9)[:, None]
    return np.asarray(np.diff(at, axis=0) / span, np.float32)
