"""What the kernels of relaxation are handed: flat arrays, grouped by what they describe."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

F8 = NDArray[np.float64]
I4 = NDArray[np.int32]
U1 = NDArray[np.uint8]


class Dots(NamedTuple):
    """Dots by row, those of a grid cell together; `x` and `y` have `simd.SCAN` numbers more.

    `fixed` may be empty: no dot is.
    """

    x: F8
    y: F8
    fixed: NDArray[np.bool_]
    compartment: I4


class Grid(NamedTuple):
    """The grid of each compartment, see `grid`, and its crowded cells, see `cell_trees`.

    Dots may have gone as far as `slack` from the grid cell they are listed in. `root` holds by
    compartment the node that all its dots lie below, or -1, or is empty, see `curve_trees`.
    """

    real: F8
    whole: I4
    cell_start: I4
    slack: float
    tree_of_cell: I4
    node: F8
    arc: F8
    link: I4
    root: I4


class Border(NamedTuple):
    """Border edges, the edge after each, and which of them touch a grid cell, see `grid`."""

    edge: F8
    next_edge: I4
    cell_start: I4
    edge_of_slot: I4
    clear: I4
    most_edges: int


class Field(NamedTuple):
    """Running sums of the density, see `field`; empty for a uniform one.

    Each compartment has a window of it: `window` holds where its sums begin, its rows and columns;
    `frame` its origin and the sides of a pixel. Compartments may share one.
    """

    sums: F8
    frame: F8
    window: NDArray[np.int64]


class Moves(NamedTuple):
    """Results by row: the new place, and how far that is.

    `kind` is what the cell is, see `relaxation`; within `free` of the new place lies no border.
    """

    x: F8
    y: F8
    gone: F8
    kind: U1
    free: F8


class Stars(NamedTuple):
    """Results by row, unless empty: the dots around each dot, counter-clockwise, and their number.

    `suspect`, unless empty, is set to 1 for the old and new neighbours of dots whose star changes.
    """

    around: I4
    n: U1
    suspect: U1


class Spacing(NamedTuple):
    """What the rules of even spacing go by, see `spacing`; an empty `table` is Lloyd alone.

    `wants` holds by row what each dot wanted in the step before, `found` what it wants now.
    `table` gives dots per area and radius by levels of the field's mean, one row without a field.
    `of_part` says by compartment where its rows begin, how many there are, what turns a mean into
    a level, and what dots per area are multiplied by. `radius` holds dots' own by row, or is empty.
    """

    wants: F8
    found: F8
    table: F8
    of_part: F8
    radius: F8
    rule: F8


class Outlines(NamedTuple):
    """Results of a range of dots, unless empty: the outlines of their cells, one after another.

    A side has its first corner, seen from the dot, the number of what lies beyond (see `border`),
    and the number of the side after it. `n_sides` is by place in the list of dots; ``used[0]``
    sides are in use, and more than there is room for if there was too little.
    """

    corner: F8
    beyond: I4
    following: I4
    n_sides: I4
    used: NDArray[np.int64]


class Spot(NamedTuple):
    """A dot's place, its grid cell, and the grid and the compartment's box around it.

    `x0`, `y0`, `x1`, `y1` is the box, seen from the dot.
    """

    x: float
    y: float
    ix: int
    iy: int
    nx: int
    ny: int
    first_cell: int
    gx: float
    gy: float
    h: float
    x0: float
    y0: float
    x1: float
    y1: float


class Pads(NamedTuple):
    """Scratch of one range: a big cell and a second one, and the border near a cell.

    `seen` holds by edge the stamp of the last dot it was gathered for, `stamp` the next one.
    """

    cell: F8
    cell2: F8
    near: I4
    seen: NDArray[np.int64]
    stamp: NDArray[np.int64]
    chains: F8
    trace: F8
    out: F8
