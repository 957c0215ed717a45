"""Ink along the edge of the page."""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel

Array = NDArray[Any]

_HALVINGS = 24


@inline
def _asked_up_to(asked: Array, at: float) -> float:
    last = len(asked) - 1
    k = min(max(int(at), 0), last - 1)
    return float(asked[k] + min(max(at - k, 0.0), 1.0) * (asked[k + 1] - asked[k]))


@inline
def _half_chord(radius: float, distance: float) -> float:
    under = radius * radius - distance * distance
    return math.sqrt(under) if under > 0.0 else 0.0


@kernel
def even_rim(
    along: Array, inwards: Array, radii: Array, asked: Array, line: float, give: float
) -> None:
    """Move dots across the edge so that the ink along it meets what is asked, from end to end.

    Dot by dot: what the chords of all dots so far cover of a line just inside the edge, less what
    the picture asks up to half the way to the next dot, is made up for by the dot's own chord, as
    far as it may move.

    Parameters
    ----------
    along, inwards : (n,) float64, pixels
        Places of the dots near one edge, from its one end, sorted, and into the page; `inwards`
        is changed.
    radii : (n,) float64, pixels
    asked : (m + 1,) float64
        Running sum of the darkness of the edge's pixels.
    line : float, pixels
        How far inside the edge the ink is compared.
    give : float
        How far a dot may move, in its radius.
    """
    length = len(asked) - 1.0
    laid = 0.0
    covered = 0.0  # up to here
    for i in range(len(along)):
        s = along[i]
        r = radii[i]
        end = 0.5 * (s + along[i + 1]) if i + 1 < len(along) else length
        wanted = _asked_up_to(asked, end) - laid
        nearest = max(inwards[i] - give * r, min(line, inwards[i]))
        farthest = inwards[i] + give * r
        most = _half_chord(r, nearest - line)
        least = _half_chord(r, farthest - line)
        if most == 0.0:
            continue
        low, high = least, most
        for _ in range(_HALVINGS):
            h = 0.5 * (low + high)
            if max(min(s + h, length) - max(s - h, covered), 0.0) < wanted:
                low = h
            else:
                high = h
        h = 0.5 * (low + high)
        if h < 1e-3 * r:
            h = 0.0
        if h == 0.0 and _half_chord(r, inwards[i] - line) > 0.0:
            inwards[i] = min(line + r, farthest)  # it may just not reach the line
        elif h > 0.0:
            inwards[i] = line + math.sqrt(max(r * r - h * h, 0.0))
        laid += max(min(s + h, length) - max(s - h, covered), 0.0)
        covered = max(covered, min(s + h, length))
