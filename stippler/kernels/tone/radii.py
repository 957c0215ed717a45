"""Radii of dots within their cells: how large a dot has to be to lay down what its cell asks for.

A point of the page that any disc covers is covered by the disc of the nearest dot, as long as
neighbours have about the same size. So the union of all discs is the sum, over the cells, of
disc ∩ cell; overlaps are counted once and each dot can be solved by itself, exactly. What the range
of radii does not allow is handed on to neighbours.

Cells are given by their sides, as in `stippler.stippling.tessellation`: those of dot i are
``first[i]..first[i + 1]``, side k runs from ``corner[k]`` to ``corner[following[k]]``, seen from
the dot, and beyond it is the dot ``beyond[k]``, or none below 0.
"""

from __future__ import annotations

import math
from typing import Any

from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel

Array = NDArray[Any]


@inline
def disc_in_cell(
    corner: Array, following: Array, begin: int, end: int, r: float
) -> tuple[float, float]:
    """Return the area of a disc around the origin inside a cell, and its arc in it."""
    area = math.pi * r * r
    arc = 2.0 * math.pi * r
    for k in range(begin, end):
        j = following[k]
        ax = corner[k, 0]
        ay = corner[k, 1]
        dx = corner[j, 0] - ax
        dy = corner[j, 1] - ay
        d2 = dx * dx + dy * dy
        if d2 == 0.0:
            continue
        cross = ax * dy - ay * dx  # twice the area of the triangle to the dot
        under = r * r * d2 - cross * cross
        if under <= 0.0:
            continue
        middle = -(ax * dx + ay * dy) / d2
        half = math.sqrt(under) / d2
        t0 = max(middle - half, 0.0)
        t1 = min(middle + half, 1.0)
        if t0 >= t1:
            continue
        px = ax + t0 * dx
        py = ay + t0 * dy
        qx = ax + t1 * dx
        qy = ay + t1 * dy
        chord = px * qy - py * qx
        angle = math.atan2(chord, px * qx + py * qy)
        area -= 0.5 * (r * r * angle - chord)
        arc -= r * angle
    return area, arc


@kernel
def fit_radii(
    start: int,
    stop: int,
    first: Array,
    corner: Array,
    following: Array,
    asked: Array,
    before: Array,
    low: float,
    high: float,
    radii: Array,
    left: Array,
) -> None:
    """Solve the radius of each dot for the ink its cell asks for, within ``low..high``.

    Dots that ask for the same as `before` are left as they are. `left` gets the ink that the
    range did not allow: above 0 missing, below 0 too much; 0 where the radius meets what is asked,
    or nearly so.
    """
    for i in range(start, stop):
        begin, end = first[i], first[i + 1]
        q = asked[i]
        if q == before[i]:
            continue
        r = min(max(math.sqrt(max(q, 0.0) / math.pi), low), high)
        a = low
        b = high
        area, arc = disc_in_cell(corner, following, begin, end, r)
        for _ in range(40):
            if abs(area - q) <= 1e-7 * abs(q):
                break
            if area < q:
                a = r
            else:
                b = r
            if b - a <= 1e-9 * high:
                break
            new = r + (q - area) / arc if arc > 0.0 else b
            if not a < new < b:
                new = b if new >= b else a
                if new == r or (new != high and new != low):
                    new = 0.5 * (a + b)
            r = new
            area, arc = disc_in_cell(corner, following, begin, end, r)
            if (r == low and area >= q) or (r == high and area <= q):
                break
        radii[i] = r
        is_met = (low < r < high) or abs(area - q) <= 1e-7 * abs(q)
        left[i] = 0.0 if is_met else q - area


@kernel
def find_room(
    start: int,
    stop: int,
    first: Array,
    corner: Array,
    following: Array,
    beyond: Array,
    low: float,
    high: float,
    radii: Array,
    left: Array,
    room: Array,
) -> None:
    """Write how much less and how much more ink each dot could lay down: ``room[i, 0..1]``.

    Only where a neighbour has ink left over; 0 elsewhere.
    """
    for i in range(start, stop):
        begin, end = first[i], first[i + 1]
        wanted = False
        for k in range(begin, end):
            j = beyond[k]
            wanted = wanted or (j >= 0 and left[j] != 0.0)
        room[i, 0] = 0.0
        room[i, 1] = 0.0
        if not wanted:
            continue
        area, _arc = disc_in_cell(corner, following, begin, end, radii[i])
        least, _arc = disc_in_cell(corner, following, begin, end, low)
        most, _arc = disc_in_cell(corner, following, begin, end, high)
        room[i, 0] = max(area - least, 0.0)
        room[i, 1] = max(most - area, 0.0)


@kernel
def sum_room(
    start: int, stop: int, first: Array, beyond: Array, left: Array, room: Array, given: Array
) -> None:
    """Write what share of its room each neighbour of a dot has to give for what the dot has left.

    0 for a dot with nothing left; at most 1 in size.
    """
    for i in range(start, stop):
        given[i] = 0.0
        q = left[i]
        if q == 0.0:
            continue
        side = 1 if q > 0.0 else 0
        total = 0.0
        for k in range(first[i], first[i + 1]):
            j = beyond[k]
            if j >= 0:
                total += room[j, side]
        if total > 0.0:
            given[i] = min(max(q / total, -1.0), 1.0)


@kernel
def pass_on(
    start: int,
    stop: int,
    first: Array,
    beyond: Array,
    room: Array,
    given: Array,
    asked: Array,
    new: Array,
) -> None:
    """Take over what neighbours could not lay down, and hand on what the dot itself could not."""
    for i in range(start, stop):
        q = asked[i]
        for k in range(first[i], first[i + 1]):
            j = beyond[k]
            if j < 0:
                continue
            if given[j] != 0.0:
                q += given[j] * room[i, 1 if given[j] > 0.0 else 0]
            if given[i] != 0.0:
                q -= given[i] * room[j, 1 if given[i] > 0.0 else 0]
        new[i] = q


@kernel
def compare_sizes(
    start: int, stop: int, first: Array, beyond: Array, area: Array, asked: Array, radii: Array,
    odd: Array, tone: Array,
) -> None:  # fmt: skip
    """Write by how much a dot is larger than its neighbours (`odd`, a logarithm), and its tone.

    The tone is the ink that its cell asks for over the cell's area.
    """
    for i in range(start, stop):
        total = 0.0
        n = 0
        for k in range(first[i], first[i + 1]):
            if beyond[k] >= 0:
                total += math.log(radii[beyond[k]])
                n += 1
        odd[i] = math.log(radii[i]) - total / n if n > 0 else 0.0
        tone[i] = asked[i] / area[i] if area[i] > 0.0 else 0.0


@kernel
def even_sizes(
    start: int,
    stop: int,
    first: Array,
    beyond: Array,
    radii: Array,
    odd: Array,
    tone: Array,
    gain: float,
    contrast: float,
    asked: Array,
    new: Array,
) -> None:
    """Let dots that are too large for their neighbours hand ink to those that are too small.

    None goes between cells whose tones differ by `contrast`: there lies an edge.
    """
    for i in range(start, stop):
        q = asked[i]
        for k in range(first[i], first[i + 1]):
            j = beyond[k]
            if j < 0:
                continue
            step = (tone[j] - tone[i]) / contrast
            alike = max(1.0 - step * step, 0.0)
            r = min(radii[i], radii[j])
            q += gain * alike * (odd[j] - odd[i]) * math.pi * r * r
        new[i] = max(q, 0.0)
