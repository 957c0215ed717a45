"""A grid of dots that is kept up to date dot by dot.

Each grid cell has `room` slots, those not in use hold NaN, which no comparison finds near. So the
kernels of `relaxation` read it like sorted dots: cell k begins at slot ``room * k``.
"""

from __future__ import annotations

import math

from stippler.kernels.cells.grid import column_of
from stippler.kernels.cells.tables import F8, I4
from stippler.kernels.machine.jit import inline, kernel


@inline
def _cell_at(x: float, y: float, c: int, grid_real: F8, grid_int: I4) -> int:
    ix = column_of(x, grid_real[c, 0], grid_real[c, 3], grid_int[c, 0])
    iy = column_of(y, grid_real[c, 1], grid_real[c, 3], grid_int[c, 1])
    return int(grid_int[c, 2] + iy * grid_int[c, 0] + ix)


@inline
def _insert(
    i: int,
    x: float,
    y: float,
    c: int,
    cell: int,
    room: int,
    count: I4,
    xs: F8,
    ys: F8,
    compartment: I4,
    dot_of_slot: I4,
    slot_of_dot: I4,
) -> bool:
    """Put a dot into a cell; False if it is full."""
    if count[cell] == room:
        return False
    slot = cell * room + count[cell]
    count[cell] += 1
    xs[slot], ys[slot] = x, y
    compartment[slot] = c
    dot_of_slot[slot], slot_of_dot[i] = i, slot
    return True


@inline
def _take_out(
    i: int,
    room: int,
    count: I4,
    xs: F8,
    ys: F8,
    compartment: I4,
    dot_of_slot: I4,
    slot_of_dot: I4,
) -> None:
    """Take a dot out of its cell; the cell's last dot takes its slot."""
    slot = slot_of_dot[i]
    cell = slot // room
    count[cell] -= 1
    last = cell * room + count[cell]
    if last != slot:
        xs[slot], ys[slot], compartment[slot] = xs[last], ys[last], compartment[last]
        dot_of_slot[slot] = dot_of_slot[last]
        slot_of_dot[dot_of_slot[slot]] = slot
    xs[last] = ys[last] = math.nan
    dot_of_slot[last] = -1
    slot_of_dot[i] = -1


@kernel
def place_dots(
    dots: I4,
    x: F8,
    y: F8,
    c: I4,
    room: int,
    grid_real: F8,
    grid_int: I4,
    count: I4,
    xs: F8,
    ys: F8,
    compartment: I4,
    dot_of_slot: I4,
    slot_of_dot: I4,
) -> int:
    """Put dots at places, whether they were in the grid or not; NaN takes a dot out.

    Returns
    -------
    int
        How many were placed: fewer than asked if a grid cell is full.
    """
    for k in range(len(dots)):
        i = dots[k]
        if math.isnan(x[k]):
            if slot_of_dot[i] >= 0:
                _take_out(i, room, count, xs, ys, compartment, dot_of_slot, slot_of_dot)
            continue
        cell = _cell_at(x[k], y[k], c[k], grid_real, grid_int)
        slot = slot_of_dot[i]
        if slot >= 0 and slot // room == cell:
            xs[slot], ys[slot] = x[k], y[k]
            continue
        if count[cell] == room:
            return k
        if slot >= 0:
            _take_out(i, room, count, xs, ys, compartment, dot_of_slot, slot_of_dot)
        _insert(
            i,
            x[k],
            y[k],
            c[k],
            cell,
            room,
            count,
            xs,
            ys,
            compartment,
            dot_of_slot,
            slot_of_dot,
        )
    return len(dots)
