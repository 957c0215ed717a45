"""Every dot's cell, clipped by its compartment: made once, read by whoever asks about cells."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
import shapely
from numpy.typing import ArrayLike, NDArray

from stippler.stippling.compartments import Compartments, Shape

if TYPE_CHECKING:
    from stippler.stippling.cells import Cells
    from stippler.stippling.field_sums import Weights

Floats = NDArray[np.float64]
Rows = NDArray[np.int32]


@dataclass(frozen=True, slots=True, eq=False)
class Tessellation:
    """The cells of n dots as flat outlines of m sides; all arrays are read-only.

    A cell's sides are ``start[i]..start[i + 1]``: its outer ring first, counter-clockwise for x to
    the right and y up, then the rings of holes that lie within it, clockwise. Side k runs from
    ``corner[k]`` to ``corner[following[k]]``, the cell on its left.

    Attributes
    ----------
    position : (n, 2) float64, mm
    start : (n + 1,) int32
    corner : (m, 2) float64, mm
        Seen from the dot.
    following : (m,) int32
        Number of the side after.
    beyond : (m,) int32
        The dot beyond a side; or, below 0, ``-1 - e`` for border edge e of `compartments`. A dot
        beyond need not have this cell's dot among its own: where the border cuts a cell apart,
        the piece without its dot is nobody's. `ELSEWHERE` is a dot whose cell is not among these.
    mass : (n,) float64
        Integral of the density; the area without one.
    centroid : (n, 2) float64, mm
        Of the mass; the dot's own place where there is none.
    area, second_moment : (n,) float64, mm² and mm⁴
        The latter about the dot.
    compartments : Compartments
    compartment_of_dot : (n,) int32
    """

    position: Floats
    start: Rows
    corner: Floats
    following: Rows
    beyond: Rows
    mass: Floats
    centroid: Floats
    area: Floats
    second_moment: Floats
    compartments: Compartments
    compartment_of_dot: Rows

    @classmethod
    def of(
        cls,
        points: ArrayLike,
        polygon: Shape | Sequence[Shape] | ArrayLike,
        compartment_of_dot: ArrayLike | None = None,
        density: Weights | None = None,
        which: NDArray[np.integer] | None = None,
    ) -> Tessellation:
        """Compute the cells of dots; parameters and errors as for `Relaxation`.

        With `which`, (k,) int, those of some dots alone, in that order: as they are among all.
        """
        return made(cls.making(points, polygon, compartment_of_dot, density, which))

    @classmethod
    def making(
        cls,
        points: ArrayLike,
        polygon: Shape | Sequence[Shape] | ArrayLike,
        compartment_of_dot: ArrayLike | None = None,
        density: Weights | None = None,
        which: NDArray[np.integer] | None = None,
    ) -> Making:
        """Compute the cells as `of` does, a part after the other."""
        from stippler.stippling.relax import Relaxation

        return Relaxation(points, polygon, None, compartment_of_dot, density).outlining(which=which)

    @classmethod
    def of_cells(
        cls, cells: Cells, weighted: bool = True, which: NDArray[np.integer] | None = None
    ) -> Making:
        """Read the cells of an engine, in the order that its dots were given in, or of some."""
        some = None if which is None else np.asarray(which, np.int32)
        outlines, row, measured = yield from cells.outline(weighted, some)
        position = np.column_stack([cells.xs[row], cells.ys[row]])
        start = np.zeros(len(row) + 1, np.int32)
        np.cumsum(outlines.n_sides, out=start[1:])
        owner = cells.compartment_of_dot[row]
        arrays = (
            position, start, outlines.corner, outlines.following, outlines.beyond, measured[0],
            position + measured[1:3].T, measured[3], measured[4],
        )  # fmt: skip
        for array in (*arrays, owner):
            array.flags.writeable = False
        return cls(*arrays, cells.parts, owner)

    def __len__(self) -> int:
        return len(self.position)

    @property
    def n_sides(self) -> Rows:
        """How many sides each cell has."""
        return np.diff(self.start)

    @property
    def dot_of_side(self) -> Rows:
        """Whose cell each side bounds."""
        return np.repeat(np.arange(len(self), dtype=np.int32), self.n_sides)

    @property
    def end(self) -> Floats:
        """Where each side ends, seen from the dot."""
        return self.corner[self.following]

    @property
    def length(self) -> Floats:
        """How long each side is, mm."""
        along = self.end - self.corner
        return np.hypot(along[:, 0], along[:, 1])

    def rings(self, i: int) -> list[Floats]:
        """Return the rings of dot i's cell, (k, 2) mm each, the outer one first."""
        out, k, stop = [], int(self.start[i]), int(self.start[i + 1])
        while k < stop:
            first = k
            while self.following[k] > k:
                k += 1
            k += 1
            out.append(self.corner[first:k] + self.position[i])
        return out

    def polygon(self, i: int) -> shapely.Polygon:
        """Return dot i's cell as a polygon, mm."""
        rings = self.rings(i)
        return shapely.Polygon(rings[0], rings[1:]) if rings else shapely.Polygon()


Making: TypeAlias = Generator[float, None, Tessellation]
"""A tessellation that is being computed: yields the share done, and returns it."""


def made(making: Making) -> Tessellation:
    """Return a tessellation once it is computed."""
    while True:
        try:
            next(making)
        except StopIteration as end:
            return end.value  # type: ignore[no-any-return]
