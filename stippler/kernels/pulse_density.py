"""Pulse-density modulation: regions grown until they hold one pulse.

Eschbach 1990, as Deussen et al. 2000, section 4.2, use it. The charge of a cell is the share of a
pulse (dot) that it asks for; a cell that a region has used up is marked `USED`, and one that asks
for nothing (white) stays exactly 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.jit import kernel

Array = NDArray[Any]

USED = np.float32(-1.0)


@kernel
def grow(
    charge: Array,
    order: Array,
    cursor: Array,
    stop: int,
    dy: Array,
    dx: Array,
    pulse: float,
    points: Array,
    areas: Array,
    max_points: int,
) -> int:
    """Grow regions from the seeds `cursor[0]..stop`, in raster order or along `order`.

    Parameters
    ----------
    charge : (h, w) float32
        Used up in place.
    order : (m,) int32
        Flat indices of the seeds; empty: raster order.
    cursor : (3,) float64
        Next seed, dots so far, and the charge taken that no dot stands for yet; updated.
    stop : int
        Seed before which to stop.
    dy, dx : (k,) int16
        Offsets from the seed in order of growth.
    points : (max_points, 2) float64, cells
    areas : (max_points,) float32, cells
        Size of the region of each dot.

    Notes
    -----
    A region that finds no full pulse within reach hands what it has to the next one, so that the
    number of dots is the sum of the charge, to one dot, whatever the picture.
    """
    h, w = charge.shape
    in_order = len(order) > 0
    seed = int(cursor[0])
    n = int(cursor[1])
    left = cursor[2]
    while seed < stop and n < max_points:
        at = order[seed] if in_order else seed
        y0 = at // w
        x0 = at - y0 * w
        seed += 1
        if not charge[y0, x0] > 0.0:
            continue
        total = left
        mass = 0.0
        mx = 0.0
        my = 0.0
        area = 0.0
        k = 0
        for k in range(len(dy)):
            y = y0 + dy[k]
            x = x0 + dx[k]
            if y < 0 or y >= h or x < 0 or x >= w:
                continue
            c = charge[y, x]
            if not c > 0.0:
                continue
            if total + c >= pulse:
                part = pulse - total
                charge[y, x] = c - part
                if not charge[y, x] > 1e-6 * pulse:
                    charge[y, x] = USED
                total = pulse
                mass += part
                mx += part * (x + 0.5)
                my += part * (y + 0.5)
                area += part / c
                break
            charge[y, x] = USED
            total += c
            mass += c
            mx += c * (x + 0.5)
            my += c * (y + 0.5)
            area += 1.0
        if charge[y0, x0] > 0.0:
            seed -= 1  # what is left of the seed's own cell starts the next region
        if total < pulse:
            left = total
            continue
        px = mx / mass
        py = my / mass
        left = 0.0
        cx = min(max(int(px), 0), w - 1)
        cy = min(max(int(py), 0), h - 1)
        if charge[cy, cx] == 0.0:  # the centroid is in white: take the used cell nearest to it
            best = np.inf
            bx = x0
            by = y0
            for j in range(k + 1):
                y = y0 + dy[j]
                x = x0 + dx[j]
                if y < 0 or y >= h or x < 0 or x >= w or charge[y, x] == 0.0:
                    continue
                d = (x + 0.5 - px) ** 2 + (y + 0.5 - py) ** 2
                if d < best:
                    best = d
                    bx = x
                    by = y
            px = bx + 0.5
            py = by + 0.5
        points[n, 0] = px
        points[n, 1] = py
        areas[n] = area
        n += 1
    cursor[0] = seed
    cursor[1] = n
    cursor[2] = left
    return n


@kernel
def diffuse(charge: Array, points: Array) -> int:
    """Floyd-Steinberg error diffusion, serpentine; returns the number of dots."""
    h, w = charge.shape
    n = 0
    for y in range(h):
        right = y % 2 == 0
        step = 1 if right else -1
        for i in range(w):
            x = i if right else w - 1 - i
            c = charge[y, x]
            out = 0.0
            if c >= 0.5:
                out = 1.0
                if n < len(points):
                    points[n, 0] = x + 0.5
                    points[n, 1] = y + 0.5
                n += 1
            e = c - out
            ahead = 0 <= x + step < w
            behind = 0 <= x - step < w
            if ahead:
                charge[y, x + step] += e * (7.0 / 16.0)
            if y + 1 < h:
                charge[y + 1, x] += e * (5.0 / 16.0)
                if behind:
                    charge[y + 1, x - step] += e * (3.0 / 16.0)
                if ahead:
                    charge[y + 1, x + step] += e * (1.0 / 16.0)
    return n
