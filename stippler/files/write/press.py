"""Ink that spreads in print: dots solved for it, so that the printed picture is the one drawn.

Every edge grows by the gain. A dot that is smaller by it all around prints as large as it was
drawn, and overlaps come out as they were. What would be too small for the press is drawn by fewer
dots of the least size, with the same printed ink: along a short way through them, as error
diffusion does.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.files.write.sheet import Layer, Line, Shape, Sheet, shape_of
from stippler.stippling.tour import tour

LEAST_LINE_MM = 0.01
_LEAST_OF_GAIN = 0.5  # radius that a dot is to have, where nothing is known of the least


def solved(sheet: Sheet, gain_mm: float, least_dot_mm: float = 0.0) -> Sheet:
    """Return a sheet that prints as the one given looks.

    Parameters
    ----------
    gain_mm : float
        By how much every edge of ink grows; white dots on ink shrink by it.
    least_dot_mm : float
        Diameter below which the press loses dots of ink.
    """
    return replace(sheet, layers=tuple(_layer(one, gain_mm, least_dot_mm) for one in sheet.layers))


def _layer(layer: Layer, gain: float, least: float) -> Layer:
    if layer.inverse:  # white dots grow, the ground of ink recedes from what is white around it
        return replace(
            layer,
            dots=_grown(layer.dots, gain),
            ground=_shapes(layer.ground, -gain),
            shapes=_shapes(layer.shapes, gain),
            lines=_lines(layer.lines, gain),
        )
    return replace(
        layer, dots=solved_dots(layer.dots, gain, least), shapes=_shapes(layer.shapes, -gain),
        lines=_lines(layer.lines, -gain),
    )  # fmt: skip


def solved_dots(dots: Dots, gain_mm: float, least_dot_mm: float = 0.0) -> Dots:
    """Return dots of ink that print as those given look; see `solved`."""
    least = max(least_dot_mm / 2, _LEAST_OF_GAIN * gain_mm)
    return _grown(thinned(dots, least + gain_mm) if least > 0 else dots, -gain_mm)


def grown_radius(dots: Dots, by_mm: float) -> NDArray[np.float64]:
    """Return the radii of dots whose edges have grown all around; 0 where nothing is left.

    Half axes a and b that both grow by g hold (a + g)(b + g): the radius of that disc. A negative
    growth is the inverse: the radius that grows into the one given.
    """
    radius = dots.radius_mm.astype(np.float64)
    root = np.sqrt(dots.elongation.astype(np.float64))
    half = abs(by_mm) * (root + 1 / root) / 2
    if by_mm >= 0:
        return np.asarray(np.sqrt(radius**2 + 2 * half * radius + by_mm**2))
    inner = np.maximum(half**2 - by_mm**2 + radius**2, 0.0)
    return np.asarray(np.maximum(np.sqrt(inner) - half, 0.0))


def _grown(dots: Dots, by_mm: float) -> Dots:
    radius = grown_radius(dots, by_mm)
    stays = np.flatnonzero(radius > 0)  # one that the spreading alone is larger than cannot be held
    return replace(dots, radius_mm=radius.astype(np.float32)).take(stays)


def thinned(dots: Dots, least_mm: float) -> Dots:
    """Return dots of which none is smaller than a radius, and the same ink in all places."""
    small = np.flatnonzero(dots.radius_mm < least_mm * (1 - 1e-6))
    if not len(small):
        return dots
    small = small[tour(dots.position_mm[small])]
    shares = (dots.radius_mm[small] / least_mm).astype(np.float64) ** 2
    stays = np.diff(np.floor(np.cumsum(shares) + 0.5), prepend=0.0) > 0
    made = dots.copy()
    made.radius_mm[small[stays]] = least_mm
    kept = np.ones(len(dots), np.bool_)
    kept[small[~stays]] = False
    return made.take(kept)


def _lines(lines: tuple[Line, ...], by_mm: float) -> tuple[Line, ...]:
    return tuple(
        replace(line, width_mm=max(line.width_mm + 2 * by_mm, LEAST_LINE_MM)) for line in lines
    )


def _shapes(shapes: tuple[Shape, ...], by_mm: float) -> tuple[Shape, ...]:
    made = []
    for shape in shapes:
        grown = _polygon(shape).buffer(by_mm, quad_segs=8)
        if not grown.is_empty:
            made.append(shape_of(grown))
    return tuple(made)


def _polygon(shape: Shape) -> Any:
    """Return a shape as one polygon: rings by the even-odd rule."""
    from shapely.geometry import Polygon

    whole = Polygon()
    for ring in shape.rings_mm:
        whole = whole.symmetric_difference(Polygon(ring).buffer(0))
    return whole
