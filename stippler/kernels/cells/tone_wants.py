"""What the few dots under a brush want of their neighbours, by the tone and their sizes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from stippler.kernels.cells.spacing import HEXAGONAL
from stippler.kernels.cells.spacing_lanes import FAR, MASS, NEIGHBOUR, RADIUS
from stippler.kernels.cells.tables import F8, I4, U1
from stippler.kernels.machine.jit import inline, inner, kernel

ALIKE = 0.08
"""Dots whose cells are so near in darkness have sizes in common."""

OWN = 0.7
"""Of a dot's area; what differs by more from that of the dots around is meant."""

SOLVED = 0.1
"""A size nearer to what its cell's ink asks for than this share of it was solved for the tone."""

Flags = NDArray[np.bool_]


@kernel
def find_wants(
    rows: I4, compartment: I4, n_parts: int, around: I4, n_star: U1, cells: F8, radius: F8,
    is_met: Flags, ink_table: F8, wants: F8, is_solved: Flags,
) -> None:  # fmt: skip
    """Find what measured dots want, made to fit how many there are in each compartment.

    Sizes solved for the tone follow their cells, whatever the spacing; so what counts is their mean
    among neighbours of about the same tone. Dots that stand out among these have a size of their
    own. Dots that were not measured, beyond cells of very many sides, want what others do.

    Parameters
    ----------
    rows : (k,) int32
        Of the dots that were measured.
    around, n_star, cells : by row
    radius : (k,) float64
        By place in `rows`; empty where dots are to be equally dense.
    is_met : (k,) bool
        Dots whose mass counts as what they want; empty for none.
    ink_table : (2, m) float64
        Darkness and the ink for it, see `stippler.stippling.tone`.
    wants : (n, 3) float64
        Result, by row, see `Spacing`.
    is_solved : (k,) bool
        Result: whether dots have the size that the ink of their cells asks for.
    """
    k = len(rows)
    place = np.full(len(n_star), -1, np.int32)
    darkness, squared, per_area = np.zeros(k), np.zeros(k), np.ones(k)
    count, total = np.zeros(n_parts), np.zeros(n_parts)
    for w in range(k):
        i = rows[w]
        place[i] = w
        darkness[w] = cells[i, 0] / max(cells[i, 3], FAR)
        if len(radius):
            squared[w] = radius[w] * radius[w]
    for w in range(k):
        i = rows[w]
        is_solved[w] = False
        if len(radius):
            ink = _ink_for(darkness[w], ink_table)
            asked = math.sqrt(cells[i, 3] * ink / math.pi)
            is_solved[w] = abs(radius[w] - asked) < SOLVED * asked
            typical = _typical(w, i, around, n_star, place, darkness, squared)
            per_area[w] = ink / max(math.pi * typical, FAR)
            wants[i, RADIUS] = math.sqrt(typical)
        count[compartment[i]] += 1.0
        total[compartment[i]] += cells[i, 3] * per_area[w]
    mean_h = mean_radius = 0.0
    for w in range(k):
        i = rows[w]
        c = compartment[i]
        unit = count[c] / total[c] if total[c] > 0.0 else 1.0
        wants[i, MASS] = cells[i, 3] * per_area[w] * unit
        if len(is_met) and is_met[w]:
            wants[i, MASS] = 1.0
        wants[i, NEIGHBOUR] = math.sqrt(HEXAGONAL / max(per_area[w] * unit, FAR))
        if not len(radius):
            wants[i, RADIUS] = 0.0
        mean_h += wants[i, NEIGHBOUR] / k
        mean_radius += wants[i, RADIUS] / k
    for i in range(len(wants)):
        if place[i] < 0:
            wants[i, MASS], wants[i, NEIGHBOUR], wants[i, RADIUS] = 1.0, mean_h, mean_radius


@inner
def _typical(w: int, i: int, around: I4, n_star: U1, place: I4, darkness: F8, squared: F8) -> float:
    """Return the mean squared size among a dot and those around it of its tone, or its own."""
    total, count = squared[w], 1.0
    for k in range(n_star[i]):
        j = around[i, k]
        if j < 0 or place[j] < 0:
            continue
        at = place[j]
        if abs(darkness[at] - darkness[w]) < ALIKE:
            total += squared[at]
            count += 1.0
    mean = total / count
    return float(mean if abs(squared[w] - mean) < OWN * mean else squared[w])


@inline
def _ink_for(darkness: float, table: F8) -> float:
    """Return the summed disc area that covers a share of the page."""
    last = table.shape[1] - 1
    if darkness <= table[0, 0]:
        return float(table[1, 0])
    if darkness >= table[0, last]:
        return float(table[1, last])
    k = 0
    while darkness >= table[0, k + 1]:
        k += 1
    t = (darkness - table[0, k]) / (table[0, k + 1] - table[0, k])
    return float(table[1, k] + t * (table[1, k + 1] - table[1, k]))
