"""SVG: the page in mm, round dots as circles, deformed ones as smooth closed paths."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import IO
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.errors import ParameterError
from stippler.kernels.shapes import svg_text

DECIMALS = 3
MAX_DECIMALS = 6
_FINE = 0.02  # of the smallest radius: a last decimal of so much puts nothing more than half off

_ROUGH = 1e-3  # less is drawn smooth
SEGMENTS = ((_ROUGH, 4), (0.08, 12), (0.2, 16), (0.4, 20), (0.55, 24), (1.0, 32))
_BLOCK = 8192
_PATH_BLOCK = 2048  # their text is made in room that stays in the cache


def write(drawing: Drawing, stream: IO[bytes], *, decimals: int | None = None) -> None:
    """Write a drawing as SVG to a binary stream; see `svg_chunks`."""
    stream.writelines(svg_chunks(drawing, decimals=decimals))


def svg_chunks(drawing: Drawing, *, decimals: int | None = None) -> Iterator[bytes]:
    """Yield a drawing as SVG, piece by piece.

    Parameters
    ----------
    decimals : int, optional
        Of positions in mm; radii get two more. None: 3, a thousandth of a millimetre, or as many
        as keep within a hundredth of the smallest radius.

    Yields
    ------
    bytes
        UTF-8; the same drawing gives the same bytes on any machine with any number of threads.

    Raises
    ------
    ParameterError
        If `decimals` or a dot's shape lies outside its range.

    Notes
    -----
    Dots of an area are one group; in it the round ones come first, then smooth ellipses, then rough
    outlines. A path keeps within 1 % of the radius of the formula in `kernels/shapes/dot_shape.py`.
    """
    if decimals is None:
        decimals = _decimals_for(drawing.dots)
    if not 0 <= decimals <= MAX_DECIMALS:
        raise ParameterError(
            f"{decimals} is no number of decimals", "decimals", f"give 0 to {MAX_DECIMALS}"
        )
    yield _head(drawing)
    for index, area in sorted(drawing.areas.items()):
        rows = np.flatnonzero(drawing.dots.area == index)
        if len(rows):
            yield f'<g id="area-{index}" data-name={quoteattr(area.name)}>\n'.encode()
            yield from _elements(drawing.dots, rows, decimals)
            yield b"</g>\n"
    yield b"</svg>\n"


def _decimals_for(dots: Dots) -> int:
    if not len(dots):
        return DECIMALS
    step = _FINE * float(dots.radius_mm.min())
    return min(max(math.ceil(-math.log10(step) - 1e-6), DECIMALS), MAX_DECIMALS)


def _head(drawing: Drawing) -> bytes:
    width, height = (_number(side) for side in (drawing.page.width_mm, drawing.page.height_mm))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}mm" height="{height}mm" '
        f'viewBox="0 0 {width} {height}">\n<rect width="{width}" height="{height}" fill="#fff"/>\n'
    ).encode()


def _number(value: float) -> str:
    return f"{value:.6f}".rstrip("0").rstrip(".")


def _elements(dots: Dots, rows: NDArray[np.intp], decimals: int) -> Iterator[bytes]:
    roughness = dots.roughness[rows]
    smooth = roughness <= _ROUGH
    is_round = smooth & (dots.elongation[rows] == 1)
    for some in _blocks(rows[is_round], _BLOCK):
        yield svg_text.circles(dots.position_mm[some], dots.radius_mm[some], decimals)
    for some in _blocks(rows[smooth & ~is_round], _PATH_BLOCK):
        yield svg_text.paths(dots.take(some), SEGMENTS[0][1], decimals)
    for (above, _), (limit, n_segments) in pairwise(SEGMENTS):
        for some in _blocks(rows[(roughness > above) & (roughness <= limit)], _PATH_BLOCK):
            yield svg_text.paths(dots.take(some), n_segments, decimals)


def _blocks(rows: NDArray[np.intp], size: int) -> Iterator[NDArray[np.intp]]:
    for start in range(0, len(rows), size):
        yield rows[start : start + size]
