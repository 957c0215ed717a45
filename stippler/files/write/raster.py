"""A sheet as rows of pixels, strip by strip, exact whatever overlaps; needs no OpenGL."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.errors import ParameterError
from stippler.files.write.sheet import Layer, Line, Shape, Sheet, kinds
from stippler.kernels.machine.pool import parallel_for
from stippler.kernels.raster import fill
from stippler.kernels.raster.bits import SAMPLES, empty_rows, greys
from stippler.kernels.shapes.dot_shape import check_shapes, outlines

MAX_SIDE_PX = 200_000
_STRIP_BITS = 128_000_000  # in one strip: 16 MB
_OUTLINE = 96  # points of a rough outline
_OUTLINES_AT_ONCE = 20_000
# a polygon inside a circle has less area: its corners are moved out to make up for it
_OUT = math.sqrt((2 * math.pi / _OUTLINE) / math.sin(2 * math.pi / _OUTLINE))


@dataclass(frozen=True, slots=True)
class Size:
    """Pixels of a picture."""

    width: int
    height: int


def size_px(sheet: Sheet, dpi: float) -> Size:
    """Return the picture's size, or raise `ParameterError` if there can be none."""
    per_mm = dpi / 25.4
    longest = max(sheet.width_mm, sheet.height_mm) * per_mm
    if not 0.5 <= longest <= MAX_SIDE_PX:  # also catches NaN
        raise ParameterError(
            f"{dpi:g} pixels an inch make no picture of this page",
            "dpi",
            f"keep its longer side between 1 and {MAX_SIDE_PX:,} pixels",
        )
    return Size(max(round(sheet.width_mm * per_mm), 1), max(round(sheet.height_mm * per_mm), 1))


def grey_strips(sheet: Sheet, dpi: float) -> Iterator[NDArray[np.uint8]]:
    """Yield (rows, width) greys from top to bottom: 255 is paper, 0 is ink, 65 levels."""
    size = size_px(sheet, dpi)
    for bits in _bit_strips(sheet, size, SAMPLES, fill.BLOCK_ROWS):
        yield greys(bits, size.width)


def bit_strips(
    sheet: Sheet, dpi: float, multiple: int = fill.BLOCK_ROWS
) -> Iterator[NDArray[np.uint8]]:
    """Yield (rows, ceil(width / 8)) bytes of pixels, 1 is ink: those whose middle lies in it.

    All strips but the last have the same number of rows, a multiple of `multiple`.
    """
    size = size_px(sheet, dpi)
    for bits in _bit_strips(sheet, size, 1, multiple):
        yield bits[:, : -(-size.width // 8)]


def _bit_strips(
    sheet: Sheet, size: Size, samples: int, multiple: int
) -> Iterator[NDArray[np.uint8]]:
    width, height = size.width * samples, size.height * samples
    # the sheet covers all pixels, as on the screen
    scale = max(width / sheet.width_mm, height / sheet.height_mm)
    painters = [paint for layer in sheet.layers for paint in _painters(layer, scale)]
    rows = max(_STRIP_BITS // width // multiple, 1) * multiple
    for top in range(0, height, rows):
        bits = empty_rows(min(rows, height - top), width)
        for paint in painters:
            paint(bits, width, top)
        yield bits


Painter = Callable[[NDArray[np.uint8], int, int], None]
"""Fills rows of bits, so many to a row, whose first is that row of the page."""


def _painters(layer: Layer, scale: float) -> Iterator[Painter]:
    ink = not layer.inverse
    if layer.ground:
        yield _polygons(layer.ground, scale, not ink)
    if layer.shapes:
        yield _polygons(layer.shapes, scale, ink)
    if layer.lines:
        yield _lines(layer.lines, scale, ink)
    is_round, smooth, rough = kinds(layer.dots)
    check_shapes(layer.dots.elongation, layer.dots.angle_rad, layer.dots.roughness)
    for rows in (is_round, smooth):
        if len(rows):
            yield _ellipses(layer.dots, rows, scale, ink)
    if len(rough):
        yield from _outlined(layer.dots, rough, scale, ink)


def _blocks(bits: NDArray[np.uint8]) -> int:
    return -(-len(bits) // fill.BLOCK_ROWS)


def _ellipses(dots: Dots, rows: NDArray[np.intp], scale: float, ink: bool) -> Painter:
    rows = rows[np.argsort(dots.position_mm[rows, 1], kind="stable")]
    long = dots.radius_mm[rows] * np.sqrt(dots.elongation[rows].astype(np.float64)) * scale
    short = long / dots.elongation[rows]
    cos, sin = np.cos(dots.angle_rad[rows]), np.sin(dots.angle_rad[rows])
    table = np.column_stack(
        [
            dots.position_mm[rows] * scale,
            (cos / long) ** 2 + (sin / short) ** 2,
            cos * sin * (1 / long**2 - 1 / short**2),
            (sin / long) ** 2 + (cos / short) ** 2,
            np.hypot(long * sin, short * cos),
        ]
    )
    reach = float(table[:, 5].max())

    def paint(bits: NDArray[np.uint8], width: int, top: int) -> None:
        parallel_for(
            fill.fill_ellipses, _blocks(bits), bits, width, top, table, reach, ink, grain=1
        )

    return paint


def _outlined(dots: Dots, rows: NDArray[np.intp], scale: float, ink: bool) -> Iterator[Painter]:
    """Rough dots, some at a time, traced when the rows they lie in are painted."""
    rows = rows[np.argsort(dots.position_mm[rows, 1], kind="stable")]
    for start in range(0, len(rows), _OUTLINES_AT_ONCE):
        yield _some_outlined(dots.take(rows[start : start + _OUTLINES_AT_ONCE]), scale, ink)


def _some_outlined(dots: Dots, scale: float, ink: bool) -> Painter:
    dots = replace(dots, radius_mm=(dots.radius_mm * _OUT).astype(np.float32))
    y = dots.position_mm[:, 1] * scale
    far = 2.0 * dots.radius_mm * np.sqrt(dots.elongation) * scale  # outlines reach at most 1.4
    reach = float(far.max())
    first, last = float((y - far).min()), float((y + far).max())
    traced: list[tuple[NDArray[np.float64], NDArray[np.float64]]] = []

    def paint(bits: NDArray[np.uint8], width: int, top: int) -> None:
        if first > top + len(bits) or last < top:
            traced.clear()
            return
        if not traced:
            rings = outlines(dots, _OUTLINE) * scale
            bounds = np.column_stack([y, rings[:, :, 1].min(axis=1), rings[:, :, 1].max(axis=1)])
            traced.append((rings, bounds))
        rings, bounds = traced[0]
        parallel_for(
            fill.fill_outlines, _blocks(bits), bits, width, top, rings, bounds, reach, ink, grain=1
        )

    return paint


def _lines(lines: tuple[Line, ...], scale: float, ink: bool) -> Painter:
    table = np.vstack([_segments(line) for line in lines]) * scale

    def paint(bits: NDArray[np.uint8], width: int, top: int) -> None:
        parallel_for(fill.fill_lines, _blocks(bits), bits, width, top, table, ink, grain=1)

    return paint


def _segments(line: Line) -> NDArray[np.float64]:
    points = line.points_mm
    if line.closed or len(points) == 1:
        points = np.vstack([points, points[:1]])
    half = np.full(len(points) - 1, line.width_mm / 2)
    return np.column_stack([points[:-1], points[1:], half])


def _polygons(shapes: tuple[Shape, ...], scale: float, ink: bool) -> Painter:
    edges = [
        np.vstack([np.column_stack([ring, np.roll(ring, -1, axis=0)]) for ring in shape.rings_mm])
        for shape in shapes
    ]
    starts = np.cumsum([0, *(len(some) for some in edges)])
    table = np.vstack(edges) * scale

    def paint(bits: NDArray[np.uint8], width: int, top: int) -> None:
        parallel_for(
            fill.fill_polygons, _blocks(bits), bits, width, top, table, starts, ink, grain=1
        )

    return paint
