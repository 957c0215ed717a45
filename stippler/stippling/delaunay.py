"""What the paper tried or cites beside Lloyd's method, for comparison (section 4.3).

Both move a dot by its Delaunay neighbours alone, know no border, and are kept inside the
compartment by force: a dot that would leave stays. Nothing but comparisons uses them.
"""

from __future__ import annotations

import numpy as np
import shapely
from numpy.typing import NDArray
from scipy.spatial import Delaunay, QhullError

from stippler.stippling.compartments import Compartments

SPRING_GAIN = 0.1
"""Share of a spring's excess length that a step takes back."""


def step_by_neighbours(
    xy: NDArray[np.float64],
    fixed: NDArray[np.bool_],
    compartment_of_dot: NDArray[np.int32],
    parts: Compartments,
    method: str,
) -> NDArray[np.float64]:
    """Move dots once, by ``"delaunay-mean"`` or ``"springs"``; return the new places."""
    new = xy.copy()
    for c, polygon in enumerate(parts.polygons):
        rows = np.flatnonzero(compartment_of_dot == c)
        pull = _mean_of_neighbours if method == "delaunay-mean" else _springs
        try:
            there = pull(xy[rows])
        except (QhullError, ValueError):  # fewer than three dots, or all in a line: no triangles
            continue
        shapely.prepare(polygon)
        free = ~fixed[rows] & shapely.contains_xy(polygon, there[:, 0], there[:, 1])
        new[rows[free]] = there[free]
    return new


def _edges(xy: NDArray[np.float64]) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return both ends of each Delaunay edge, each edge once in either direction."""
    start, other = Delaunay(xy).vertex_neighbor_vertices
    return np.repeat(np.arange(len(xy), dtype=np.int32), np.diff(start)), other


def _mean_of_neighbours(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the mean of each dot's Delaunay neighbours."""
    a, b = _edges(xy)
    n = np.bincount(a, minlength=len(xy))
    there = np.column_stack(
        [np.bincount(a, xy[b, axis], minlength=len(xy)) / np.maximum(n, 1) for axis in (0, 1)]
    )
    there[n == 0] = xy[n == 0]
    return there


def _springs(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return where springs of the mean edge length along Delaunay edges push the dots.

    After Ostromoukhov 1993, as the paper cites him.
    """
    a, b = _edges(xy)
    along = xy[b] - xy[a]
    length = np.maximum(np.hypot(along[:, 0], along[:, 1]), 1e-300)
    pull = SPRING_GAIN * (length - np.median(length)) / length
    return xy + np.column_stack(
        [np.bincount(a, pull * along[:, axis], minlength=len(xy)) for axis in (0, 1)]
    )
