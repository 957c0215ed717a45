"""A sheet as PDF and PostScript painting operators, which differ in a few words only."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.files.write.sheet import Layer, Line, Shape, kinds
from stippler.files.write.sizes import by_size
from stippler.files.write.svg import SEGMENTS
from stippler.kernels.shapes.number_text import number_rows
from stippler.kernels.shapes.page_text import filled_outlines

PLACES = 2  # decimals of positions in mm: 0.01 mm is half a pixel at 1200 dpi, at most
FINE = 3  # of outlines
_BLOCK = 8192
_PATH_BLOCK = 2048


@dataclass(frozen=True, slots=True)
class Words:
    """How a page language says it.

    Attributes
    ----------
    grey : bytes
        Sets the colour that fills and lines have, after its number.
    even_odd : bytes
        Fills the path by the even-odd rule.
    round_dots : callable
        (positions, diameters' radii) as operators.
    """

    grey: bytes
    even_odd: bytes
    line_to: bytes
    close: bytes
    stroke: bytes
    round_dots: Callable[[Dots, int], Iterator[bytes]]


def painted(layer: Layer, words: Words, decimals: int) -> Iterator[bytes]:
    """Yield the operators that paint a layer; lines are to have round ends already."""
    color, other = (b"1", b"0") if layer.inverse else (b"0", b"1")
    if layer.ground:
        yield other + words.grey
        yield from (_filled(shape, words) for shape in layer.ground)
    yield color + words.grey
    yield from (_filled(shape, words) for shape in layer.shapes)
    yield from (_stroked(line, words) for line in layer.lines)
    yield from _dots(layer.dots, words, decimals)


def pdf_dots(dots: Dots, decimals: int) -> Iterator[bytes]:
    """Yield round dots as lines of no length with round ends, by size."""
    for width_mm, rows in by_size(dots.radius_mm):
        yield f"{width_mm:.5f} w\n".encode()
        for start in range(0, len(rows), _BLOCK):
            x, y = dots.position_mm[rows[start : start + _BLOCK]].T
            yield number_rows((x, y), (decimals, decimals), (b"", b" ", b" m h\n"))
        yield b"S\n"


def ps_dots(dots: Dots, decimals: int) -> Iterator[bytes]:
    """Yield round dots as the procedure ``d`` of the prologue."""
    for start in range(0, len(dots), _BLOCK):
        some = slice(start, start + _BLOCK)
        x, y = dots.position_mm[some].T
        columns = (x, y, dots.radius_mm[some])
        yield number_rows(columns, (decimals, decimals, decimals + 2), (b"", b" ", b" ", b" d\n"))


PDF_WORDS = Words(b" g\n", b"f*\n", b" l\n", b"h\n", b"S\n", pdf_dots)
PS_WORDS = Words(b" setgray\n", b"eofill\n", b" l\n", b"h\n", b"stroke\n", ps_dots)


def _path(points: NDArray[np.float64], words: Words) -> bytes:
    x, y = points.T
    first = number_rows((x[:1], y[:1]), (FINE, FINE), (b"", b" ", b" m\n"))
    return first + number_rows((x[1:], y[1:]), (FINE, FINE), (b"", b" ", words.line_to))


def _filled(shape: Shape, words: Words) -> bytes:
    rings = b"".join(_path(ring, words) + words.close for ring in shape.rings_mm)
    return rings + words.even_odd


def _stroked(line: Line, words: Words) -> bytes:
    points = line.points_mm
    if len(points) == 1:
        points = np.vstack([points, points])
    width = f"{line.width_mm:.4f} w\n".encode()
    return width + _path(points, words) + (words.close if line.closed else b"") + words.stroke


def _dots(dots: Dots, words: Words, decimals: int) -> Iterator[bytes]:
    is_round, smooth, rough = kinds(dots)
    if len(is_round):
        yield from words.round_dots(dots.take(is_round), decimals)
    finer = decimals + FINE - PLACES
    for start in range(0, len(smooth), _PATH_BLOCK):
        some = smooth[start : start + _PATH_BLOCK]
        yield filled_outlines(dots.take(some), SEGMENTS[0][1], finer)
    roughness = dots.roughness[rough]
    for (above, _), (limit, n_segments) in pairwise(SEGMENTS):
        rows = rough[(roughness > above) & (roughness <= limit)]
        for start in range(0, len(rows), _PATH_BLOCK):
            yield filled_outlines(dots.take(rows[start : start + _PATH_BLOCK]), n_segments, finer)
