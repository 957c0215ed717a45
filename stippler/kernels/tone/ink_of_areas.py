"""Ink of dots within areas whose borders cut their cells.

An area is the sum, with signs, of the triangles that its border makes with a dot. So what a dot
lays down in it is all of the dot's ink, if it lies there, less what is beyond each piece of border.
"""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel
from stippler.kernels.tone.radii import disc_in_cell

Array = NDArray[Any]


@kernel
def ink_in_cells(
    start: int,
    stop: int,
    first: Array,
    corner: Array,
    following: Array,
    cell_of: Array,
    radii: Array,
    ink: Array,
) -> None:
    """Write what dots lay down within their cells, which come as `fit_radii` takes them.

    Parameters
    ----------
    cell_of : (k,) int64
        The cells asked for.
    radii, ink : (k,) float64
    """
    for k in range(start, stop):
        c = cell_of[k]
        ink[k], _arc = disc_in_cell(corner, following, first[c], first[c + 1], radii[k])


@kernel
def ink_beyond(
    start: int,
    stop: int,
    first: Array,
    corner: Array,
    cell_of: Array,
    border: Array,
    radii: Array,
    ink: Array,
) -> None:
    """Write what dots lay down in their cells beyond pieces of border, as seen from the dot.

    Parameters are those of `ink_in_cells`, the cells convex, and:

    border : (k, 4) float64
        Ends of the piece, seen from the dot; below 0 is what lies beyond one that runs clockwise.
    """
    for k in range(start, stop):
        c = cell_of[k]
        ink[k] = _beyond(
            corner[first[c] : first[c + 1]],
            radii[k],
            border[k, 0],
            border[k, 1],
            border[k, 2],
            border[k, 3],
        )


@inline
def _beyond(cell: Array, r: float, ax: float, ay: float, bx: float, by: float) -> float:
    dx, dy = bx - ax, by - ay
    t0, t1 = _within_disc(ax, ay, dx, dy, r)
    m = len(cell)
    for k in range(m):
        j = k + 1 if k + 1 < m else 0
        ux, uy = cell[j, 0] - cell[k, 0], cell[j, 1] - cell[k, 1]
        at = ux * (ay - cell[k, 1]) - uy * (ax - cell[k, 0])
        t0, t1 = _not_below(at, ux * dy - uy * dx, t0, t1)
    if t0 >= t1:
        return 0.0
    px, py, qx, qy = ax + t0 * dx, ay + t0 * dy, ax + t1 * dx, ay + t1 * dy
    sign = 1.0
    if px * qy - py * qx < 0.0:
        px, py, qx, qy = qx, qy, px, py
        sign = -1.0
    total = _outside(px, py, qx, qy, r)
    for k in range(m):
        j = k + 1 if k + 1 < m else 0
        cx, cy = cell[k, 0], cell[k, 1]
        ux, uy = cell[j, 0] - cx, cell[j, 1] - cy
        t0, t1 = _within_disc(cx, cy, ux, uy, r)
        t0, t1 = _not_below(px * cy - py * cx, px * uy - py * ux, t0, t1)
        t0, t1 = _not_below(cx * qy - cy * qx, ux * qy - uy * qx, t0, t1)
        if t0 < t1:
            total -= _outside(cx + t0 * ux, cy + t0 * uy, cx + t1 * ux, cy + t1 * uy, r)
    return sign * max(total, 0.0)


@inline
def _within_disc(ax: float, ay: float, dx: float, dy: float, r: float) -> tuple[float, float]:
    """Return from where to where, as shares of it, a side lies within the disc; (1, 0): nowhere."""
    d2 = dx * dx + dy * dy
    cross = ax * dy - ay * dx
    under = r * r * d2 - cross * cross
    if d2 == 0.0 or under <= 0.0:
        return 1.0, 0.0
    middle = -(ax * dx + ay * dy) / d2
    half = math.sqrt(under) / d2
    return max(middle - half, 0.0), min(middle + half, 1.0)


@inline
def _not_below(at: float, slope: float, t0: float, t1: float) -> tuple[float, float]:
    """Return what of a range is left where ``at + t * slope`` is not below 0."""
    if slope > 0.0:
        t0 = max(t0, -at / slope)
    elif slope < 0.0:
        t1 = min(t1, -at / slope)
    elif at < 0.0:
        t1 = t0
    return t0, t1


@inline
def _outside(px: float, py: float, qx: float, qy: float, r: float) -> float:
    """Return the area between a chord and the circle around the origin, in the chord's angle."""
    chord = px * qy - py * qx
    return 0.5 * (r * r * math.atan2(chord, px * qx + py * qy) - chord)
