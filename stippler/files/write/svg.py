"""SVG: the page in mm, a layer for each area, dots as circles, strokes or pen taps."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.errors import ParameterError
from stippler.files.write.format import Values
from stippler.files.write.formats import CIRCLES, COMPOUND, MAX_DECIMALS
from stippler.files.write.names import one_line
from stippler.files.write.sheet import (
    ROUGH,
    Layer,
    Line,
    Shape,
    Sheet,
    kinds,
    sheet_of,
    smallest_mm,
)
from stippler.files.write.sizes import sorted_by_size
from stippler.files.write.xml_text import quoted
from stippler.kernels.shapes import svg_text
from stippler.kernels.shapes.number_text import number_rows

Radii = NDArray[np.float32]

MIN_DECIMALS = 3
_FINE = 0.02  # of the smallest radius: a last decimal of so much puts nothing more than 1 % off
TAP_MM = 0.01  # pen taps are lines of this length, which no plotter program drops

SEGMENTS = ((ROUGH, 4), (0.08, 12), (0.2, 16), (0.4, 20), (0.55, 24), (1.0, 32))
_BLOCK = 8192
_STROKES_BLOCK = 65_536  # enough for all cores
_PATH_BLOCK = 2048  # their text is made in room that stays in the cache
_LINE_DECIMALS = 1  # of lines and shapes, more than positions get
_RADIUS_DECIMALS = 1
_MANY = 2_000  # round dots whose circles are in units of the last decimal: no points, fewer bytes
_WHOLE_RADIUS = 100  # such units: radii of so many are whole, with the ink kept on average
_GOLDEN = 0.6180339887498949
MOST_ELEMENTS = 900_000
"""Readers refuse files of a million elements (resvg, librsvg)."""
_BETWEEN = b'"/>\n<path d="'  # two dots; nothing between them is one path of both

# a picture of one white pixel: viewers show paper, while plotters and lasers look for paths
_WHITE = (
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAsTj2FAAAAABJRU5ErkJggg=="
)


def svg_chunks(
    drawing: Drawing, *, decimals: int | None = None, round_dots: str = CIRCLES
) -> Iterator[bytes]:
    """Yield a drawing as SVG, piece by piece; see `chunks`."""
    return chunks(
        sheet_of(drawing), {"decimals": decimals, "round_dots": round_dots, "paper": True}
    )


def chunks(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield a sheet as SVG, piece by piece.

    Parameters
    ----------
    values : mapping
        Of the format's options. `decimals` of positions and of dots' outlines in mm; radii, lines
        and shapes get one more. None: 3, or as many as keep within 1 % of the smallest radius.

    Yields
    ------
    bytes
        UTF-8; the same sheet gives the same bytes on any machine with any number of threads.

    Raises
    ------
    ParameterError
        If `decimals` or a dot's shape lies outside its range.

    Notes
    -----
    Of more than `MOST_ELEMENTS` dots many share a path, and round ones are compound strokes.
    In a layer the round dots come first, then smooth ellipses, then rough outlines. A path keeps
    within 1 % of the radius of the formula in `kernels/shapes/dot_shape.py`.
    """
    from stippler.files.write.plot_order import sorted_dots

    decimals = values.get("decimals")
    if decimals is None:
        decimals = _decimals_for(smallest_mm(sheet))
    if not 0 <= decimals <= MAX_DECIMALS:
        raise ParameterError(
            f"{decimals} is no number of decimals", "decimals", f"give 0 to {MAX_DECIMALS}"
        )
    how = values.get("round_dots", CIRCLES)
    is_huge = sum(len(layer.dots) for layer in sheet.layers) > MOST_ELEMENTS
    if is_huge and how == CIRCLES:
        how = COMPOUND
    yield _head(sheet, paper=bool(values.get("paper", True)))
    for number, layer in enumerate(sheet.layers, 1):
        if not layer.is_empty:
            if values.get("sort"):
                layer = sorted_dots(layer)
            parts = _layer(number, layer, decimals, how)
            yield from (part.replace(_BETWEEN, b"") for part in parts) if is_huge else parts
    yield b"</svg>\n"


def zipped_chunks(sheet: Sheet, values: Values) -> Iterator[bytes]:
    """Yield a sheet as compressed SVG."""
    return gzipped(chunks(sheet, values))


def gzipped(parts: Iterator[bytes]) -> Iterator[bytes]:
    """Yield the same, compressed, without a date or a name."""
    import zlib

    deflate = zlib.compressobj(7, zlib.DEFLATED, 31, zlib.DEF_MEM_LEVEL, zlib.Z_FILTERED)
    for part in parts:
        if packed := deflate.compress(part):
            yield packed
    yield deflate.flush()


def _decimals_for(smallest: float) -> int:
    if not math.isfinite(smallest):
        return MIN_DECIMALS
    return min(max(math.ceil(-math.log10(_FINE * smallest) - 1e-6), MIN_DECIMALS), MAX_DECIMALS)


def number(value: float) -> str:
    """Return a number in millionths, in few characters."""
    return f"{value:.6f}".rstrip("0").rstrip(".")


def _head(sheet: Sheet, *, paper: bool) -> bytes:
    width, height = number(sheet.width_mm), number(sheet.height_mm)
    head = (
        '<svg xmlns="http://www.w3.org/2000/svg" '
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
        'xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd" '
        f'width="{width}mm" height="{height}mm" viewBox="0 0 {width} {height}">\n'
        '<sodipodi:namedview pagecolor="#ffffff" inkscape:document-units="mm"/>\n'
    )
    if paper:
        head += (
            '<g id="paper" inkscape:groupmode="layer" inkscape:label="% paper" '
            'sodipodi:insensitive="true">'
            f'<image width="{width}" height="{height}" preserveAspectRatio="none" '
            f'href="data:image/png;base64,{_WHITE}"/></g>\n'
        )
    return head.encode()


def _layer(index: int, layer: Layer, decimals: int, round_dots: str) -> Iterator[bytes]:
    name = one_line(layer.name)
    label, data = quoted(f"{index} {name}"), quoted(layer.name_for_xml)
    color = "#fff" if layer.inverse else "#000"
    yield (
        f'<g id="layer-{index}" inkscape:groupmode="layer" inkscape:label={label} '
        f'data-name={data} fill="{color}">\n'
    ).encode()
    for shape in layer.ground:
        yield _shape(shape, decimals, ' fill="#000"' if layer.inverse else ' fill="#fff"')
    for shape in layer.shapes:
        yield _shape(shape, decimals)
    if layer.lines:
        yield (
            f'<g fill="none" stroke="{color}" stroke-linecap="round" stroke-linejoin="round">\n'
        ).encode()
        for line in layer.lines:
            yield _line(line, decimals)
        yield b"</g>\n"
    yield from _dots(layer.dots, decimals, round_dots, color)
    yield b"</g>\n"


def _path(points: NDArray[np.float64], decimals: int) -> str:
    text = number_rows((points[:, 0], points[:, 1]), (decimals, decimals), (b"", b" ", b"L"))
    return "M" + text[:-1].decode()


def _shape(shape: Shape, decimals: int, color: str = "") -> bytes:
    rings = "".join(_path(ring, decimals + _LINE_DECIMALS) + "z" for ring in shape.rings_mm)
    return f'<path{color} fill-rule="evenodd" d="{rings}"/>\n'.encode()


def _line(line: Line, decimals: int) -> bytes:
    points = line.points_mm
    if len(points) == 1:
        points = np.vstack([points, points])
    d = _path(points, decimals + _LINE_DECIMALS) + ("z" if line.closed else "")
    return f'<path stroke-width="{number(line.width_mm)}" d="{d}"/>\n'.encode()


def _dots(dots: Dots, decimals: int, round_dots: str, color: str) -> Iterator[bytes]:
    is_round, smooth, rough = kinds(dots)
    if round_dots == CIRCLES:
        yield from _circles(dots, is_round, decimals)
    elif len(is_round):
        yield (f'<g fill="none" stroke="{color}" stroke-linecap="round">\n').encode()
        draw = _strokes if round_dots == COMPOUND else _taps
        yield from draw(dots.position_mm[is_round], dots.radius_mm[is_round], decimals)
        yield b"</g>\n"
    for some in _blocks(smooth, _PATH_BLOCK):
        yield svg_text.paths(dots.take(some), SEGMENTS[0][1], decimals)
    roughness = dots.roughness[rough]
    for (above, _), (limit, n_segments) in pairwise(SEGMENTS):
        for some in _blocks(rough[(roughness > above) & (roughness <= limit)], _PATH_BLOCK):
            yield svg_text.paths(dots.take(some), n_segments, decimals)


def _circles(dots: Dots, rows: NDArray[np.intp], decimals: int) -> Iterator[bytes]:
    """Circles in mm; many of them in units of the last decimal, under one scale."""
    per_mm, of_radius = 1.0, decimals + _RADIUS_DECIMALS
    radius = dots.radius_mm[rows].astype(np.float64)
    if len(rows) >= _MANY and decimals:
        per_mm, decimals, of_radius = 10.0**decimals, 0, _RADIUS_DECIMALS
        radius *= per_mm
        if radius.min() >= _WHOLE_RADIUS:
            radius, of_radius = _whole(radius), 0
        yield f'<g transform="scale({number(1 / per_mm)})">\n'.encode()
    for start in range(0, len(rows), _BLOCK):
        some = slice(start, start + _BLOCK)
        place = dots.position_mm[rows[some]] * per_mm
        yield svg_text.circles(place, radius[some], decimals, of_radius)
        yield b"\n"
    if per_mm != 1.0:
        yield b"</g>\n"


def _whole(radius: NDArray[np.float64]) -> NDArray[np.float64]:
    """Round up or down in turns, so that radii are the same on average: dots of one size, too."""
    turns = np.arange(len(radius)) * _GOLDEN
    turns -= np.floor(turns)
    exact = np.round(radius, 2)  # what single precision adds to a whole number is not rounded up
    return np.asarray(np.floor(exact + np.minimum(turns, 0.999)))


def _strokes(position_mm: NDArray[np.float64], radius_mm: Radii, decimals: int) -> Iterator[bytes]:
    """Round dots of a size as one path: lines of no length with round ends."""
    diameter, first, rows = sorted_by_size(radius_mm)
    texts = [b'"/>\n<path stroke-width="%b" d="' % number(one).encode() for one in diameter]
    texts[0] = texts[0].removeprefix(b'"/>\n')
    place = np.rint(position_mm[rows] * 10.0**decimals).astype(np.int64)
    steps = np.diff(place, axis=0, prepend=0)
    steps[first] = place[first]
    opens = np.full(len(rows), -1, np.int32)
    opens[first] = np.arange(len(first))
    for start in range(0, len(rows), _STROKES_BLOCK):
        some = slice(start, start + _STROKES_BLOCK)
        yield svg_text.strokes(steps[some], opens[some], texts, decimals)
    yield b'"/>\n'


def _taps(position_mm: NDArray[np.float64], radius_mm: Radii, decimals: int) -> Iterator[bytes]:
    """Round dots as very short lines, one path each, which plotter programs keep and sort."""
    half = TAP_MM / 2
    # as wide as leaves the ink what it is, the short line included
    wide = 2 * (np.hypot(TAP_MM, math.pi * radius_mm.astype(np.float64)) - TAP_MM) / math.pi
    pieces = (b'<path stroke-width="', b'" d="M', b" ", f'h{number(TAP_MM)}"/>\n'.encode())
    finer = decimals + 1
    for start in range(0, len(wide), _BLOCK):
        some = slice(start, start + _BLOCK)
        x, y = position_mm[some].T
        yield number_rows((wide[some], x - half, y), (finer, finer, decimals), pieces)


def _blocks(rows: NDArray[np.intp], size: int) -> Iterator[NDArray[np.intp]]:
    for start in range(0, len(rows), size):
        yield rows[start : start + size]
