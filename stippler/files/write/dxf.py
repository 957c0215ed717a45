"""DXF of release 12, in mm, y up: circles or points and outlines, by layer."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.files.write.format import Values
from stippler.files.write.formats import POINTS
from stippler.files.write.names import plain, unique
from stippler.files.write.plot_order import sorted_dots
from stippler.files.write.sheet import Layer, Sheet, kinds
from stippler.kernels.shapes.dot_shape import outlines
from stippler.kernels.shapes.number_text import number_rows, number_rows_of_kinds

_DECIMALS = 4
_OUTLINE = 32
# a polygon inside a circle has less area: its corners are moved out to make up for it
_OUT = math.sqrt((2 * math.pi / _OUTLINE) / math.sin(2 * math.pi / _OUTLINE))
_BLOCK = 4096
_COLORS = 7


def chunks(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield a sheet as DXF. Layers that are paper on ink end in ``-white``."""
    layers = [layer for layer in sheet.layers if not layer.is_empty]
    if values.get("sort"):
        layers = [sorted_dots(layer) for layer in layers]
    names = unique(plain(one.name) + ("-white" if one.inverse else "") for one in layers)
    grounds = [f"{name[:24]}-ground" for name in names]
    yield _head(sheet, [*names, *(g for g, one in zip(grounds, layers, strict=True) if one.ground)])
    for name, ground, layer in zip(names, grounds, layers, strict=True):
        for shape in layer.ground:
            yield from _rings(shape.rings_mm, ground, sheet.height_mm)
        for shape in layer.shapes:
            yield from _rings(shape.rings_mm, name, sheet.height_mm)
        for line in layer.lines:
            yield _polyline(line.points_mm, name, sheet.height_mm, closed=line.closed)
        yield from _dots(layer, name, sheet.height_mm, values["dots_as"])
    yield b"0\nENDSEC\n0\nEOF\n"


def _head(sheet: Sheet, names: list[str]) -> bytes:
    size = f"{sheet.width_mm:.6f}\n20\n{sheet.height_mm:.6f}\n30\n0.0\n"
    head = (
        "0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n4\n"
        "9\n$MEASUREMENT\n70\n1\n9\n$EXTMIN\n10\n0.0\n20\n0.0\n30\n0.0\n"
        f"9\n$EXTMAX\n10\n{size}0\nENDSEC\n"
        f"0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLAYER\n70\n{len(names)}\n"
    )
    for k, name in enumerate(names):
        color = 7 if k == 0 else k % _COLORS + 1
        head += f"0\nLAYER\n2\n{name}\n70\n0\n62\n{color}\n6\nCONTINUOUS\n"
    return (head + "0\nENDTAB\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n").encode()


def _dots(layer: Layer, name: str, height: float, dots_as: str) -> Iterator[bytes]:
    dots = layer.dots
    is_round, smooth, rough = kinds(dots)
    if dots_as == POINTS:
        is_round, smooth, rough = np.arange(len(dots)), smooth[:0], rough[:0]
    for rows in _blocks(is_round):
        x, y = dots.position_mm[rows, 0], height - dots.position_mm[rows, 1]
        if dots_as == POINTS:
            pieces = (f"0\nPOINT\n8\n{name}\n10\n".encode(), b"\n20\n", b"\n30\n0.0\n")
            yield number_rows((x, y), (_DECIMALS, _DECIMALS), pieces)
        else:
            head = f"0\nCIRCLE\n8\n{name}\n10\n".encode()
            columns = (x, y, dots.radius_mm[rows])
            decimals = (_DECIMALS, _DECIMALS, _DECIMALS + 1)
            yield number_rows(columns, decimals, (head, b"\n20\n", b"\n30\n0.0\n40\n", b"\n"))
    for rows in (*_blocks(smooth), *_blocks(rough)):
        yield _outlines(dots.take(rows), name, height)


def _outlines(dots: Dots, name: str, height: float) -> bytes:
    dots = replace(dots, radius_mm=(dots.radius_mm * _OUT).astype(np.float32))
    rings = outlines(dots, _OUTLINE).reshape(-1, 2)
    place = np.arange(len(rings)) % _OUTLINE
    which = np.where(place == 0, 0, np.where(place == _OUTLINE - 1, 2, 1)).astype(np.uint8)
    return _vertices(rings, name, height, which, closed=True)


def _rings(rings: tuple[NDArray[np.float64], ...], name: str, height: float) -> Iterator[bytes]:
    for ring in rings:
        yield _polyline(ring, name, height, closed=True)


def _polyline(points: NDArray[np.float64], name: str, height: float, *, closed: bool) -> bytes:
    if len(points) == 1:
        points = np.vstack([points, points])
    which = np.ones(len(points), np.uint8)
    which[0], which[-1] = 0, 2
    return _vertices(points, name, height, which, closed=closed)


def _vertices(
    points: NDArray[np.float64],
    name: str,
    height: float,
    which: NDArray[np.uint8],
    *,
    closed: bool,
) -> bytes:
    """Return polylines; `which` tells first (0), middle (1) and last points (2)."""
    vertex = f"0\nVERTEX\n8\n{name}\n10\n"
    begin = f"0\nPOLYLINE\n8\n{name}\n66\n1\n70\n{int(closed)}\n10\n0.0\n20\n0.0\n30\n0.0\n"
    end = f"\n30\n0.0\n0\nSEQEND\n8\n{name}\n"
    pieces = (
        ((begin + vertex).encode(), b"\n20\n", b"\n30\n0.0\n"),
        (vertex.encode(), b"\n20\n", b"\n30\n0.0\n"),
        (vertex.encode(), b"\n20\n", end.encode()),
    )
    columns = (points[:, 0], height - points[:, 1])
    return number_rows_of_kinds(columns, (_DECIMALS, _DECIMALS), pieces, which)


def _blocks(rows: NDArray[np.intp]) -> Iterator[NDArray[np.intp]]:
    for start in range(0, len(rows), _BLOCK):
        yield rows[start : start + _BLOCK]
