"""Pulse-density modulation: regions grown until they hold one pulse.

Eschbach 1990, as Deussen et al. 2000, section 4.2, use it. The charge of a cell is the share of a
pulse (dot) that it asks for; a cell that a region has used up is marked `USED`, and one that asks
for nothing (white) stays exactly 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.machine.jit import inline, kernel

Array = NDArray[Any]

USED = np.float32(-1.0)


@kernel
def fill_cells(start: int, stop: int, density: Array, s: int, factor: float, charge: Array) -> None:
    """Spread a multiple of the dots that pixels ask for evenly over their s by s cells, by rows."""
    w = density.shape[1]
    share = np.float32(factor / (s * s))
    for y in range(start, stop):
        for k in range(s):
            row = charge[y * s + k]
            for x in range(w):
                c = density[y, x] * share
                for j in range(s):
                    row[x * s + j] = c


@inline
def _pick(chance: int, n: int, options: int) -> int:
    """Choose one of some options, as if by chance (the finaliser of splitmix64)."""
    z = np.uint64(n + 1) * np.uint64(0x9E3779B97F4A7C15) + np.uint64(chance)
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    z ^= z >> np.uint64(31)
    return int((z >> np.uint64(33)) % np.uint64(options))


@kernel
def grow(
    charge: Array,
    order: Array,
    cursor: Array,
    dy: Array,
    dx: Array,
    chance: int,
    points: Array,
    areas: Array,
    max_points: int,
) -> int:
    """Grow regions from one seed after another.

    Parameters
    ----------
    charge : (h, w) float32
        Used up in place.
    order : (m,) int32
        Flat indices of the seeds.
    cursor : (2,) float64
        Dots so far, and the charge taken that no dot stands for yet; updated.
    dy, dx : (t, k) int16
        Offsets from the seed in order of growth; each region takes one of the t orders.
    chance : int
        Says which; any number, and always the same for the same one.
    points : (max_points, 2) float64, cells
    areas : (max_points,) float32, cells
        Size of the region of each dot.

    Notes
    -----
    A region that finds no full pulse within reach hands what it has to the next one, so that the
    number of dots is the sum of the charge, to one dot, whatever the picture.
    """
    h, w = charge.shape
    seed = 0
    n = int(cursor[0])
    left = cursor[1]
    while seed < len(order) and n < max_points:
        at = order[seed]
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
        which = _pick(chance, n, len(dy))
        for k in range(dy.shape[1]):
            y = y0 + dy[which, k]
            x = x0 + dx[which, k]
            if y < 0 or y >= h or x < 0 or x >= w:
                continue
            c = charge[y, x]
            if not c > 0.0:
                continue
            if total + c >= 1.0:
                part = 1.0 - total
                charge[y, x] = c - part
                if not charge[y, x] > 1e-6:
                    charge[y, x] = USED
                total = 1.0
                mass += part
                mx += part * (x + 0.5)
                my += part * (y + 0.5)
                if charge[y, x] == USED or area == 0.0:
                    area += 1.0  # a cell divided between regions counts for the last
                break
            charge[y, x] = USED
            total += c
            mass += c
            mx += c * (x + 0.5)
            my += c * (y + 0.5)
            area += 1.0
        if charge[y0, x0] > 0.0:
            seed -= 1  # what is left of the seed's own cell starts the next region
        if total < 1.0:
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
                y = y0 + dy[which, j]
                x = x0 + dx[which, j]
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
    cursor[0] = n
    cursor[1] = left
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
