"""What is to be done with the dots of an area, as one frozen value; importing it costs nothing.

The command line, Python and the window make a `Task` each, and `stippler.stippling.pipeline.run`
carries all of them out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from shapely.geometry import MultiLineString, MultiPolygon, Polygon

    from stippler.drawing.line import Line
    from stippler.drawing.reference import Reference
    from stippler.drawing.run import Holding
    from stippler.drawing.style import Style
    from stippler.stippling.beyond import Seen

STIPPLE, SETTLE, RELAX = "stipple", "settle", "relax"
"""Make dots; go on with those that a person paints on, none comes, none goes; space them anew."""


@dataclass(frozen=True, slots=True, eq=False)
class Standing:
    """Dots that are there when a task begins.

    Attributes
    ----------
    position_mm : (n, 2) float64
    radius_mm : (n,) float32
    fixed : (n,) bool or None
        Those that stay where they are; None is none.
    part_of_dot : (n,) int or None
        Which of the task's parts each lies in; None where there is only one.
    homes : tuple of (rows, polygon)
        Within which dots have to be that see beyond it.
    """

    position_mm: NDArray[np.float64]
    radius_mm: NDArray[np.float32]
    fixed: NDArray[np.bool_] | None = None
    part_of_dot: NDArray[np.integer] | None = None
    homes: tuple[tuple[NDArray[np.intp], Polygon | MultiPolygon], ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class MetLines:
    """Lines that dots lie on, or line up on, and which dots do so already.

    Attributes
    ----------
    lines : tuple of Line
    ids : tuple of int
        What the drawing calls them.
    line_of_dot : (n,) int32
        Index into `lines`, -1 for a dot on none.
    along_mm : (n,) float64
        Arc length there.
    may_join : (n,) bool
        Dots that may be drawn onto a line that they adhere to.
    """

    lines: tuple[Line, ...]
    ids: tuple[int, ...]
    line_of_dot: NDArray[np.int32]
    along_mm: NDArray[np.float64]
    may_join: NDArray[np.bool_]

    def holding(self, line_of_dot: NDArray[np.integer], along_mm: NDArray[np.float64]) -> Holding:
        """Return which lines hold dots by what the drawing calls them."""
        import numpy as np

        from stippler.drawing.dots import NO_CURVE
        from stippler.drawing.run import Holding

        on = line_of_dot >= 0
        curve = np.full(len(line_of_dot), NO_CURVE, np.int32)
        curve[on] = np.array(self.ids, np.int32)[line_of_dot[on]]
        return Holding(curve, np.where(on, along_mm, 0.0))


@dataclass(frozen=True, slots=True, eq=False)
class Task:
    """Dots to be made or moved within an area.

    Attributes
    ----------
    style : Style
        How the area is drawn.
    reference : Reference or None
        What tone is taken from; only `RELAX` does without.
    kind : {"stipple", "settle", "relax"}
    parts_mm : tuple of shapely Polygon or MultiPolygon
        What is the area's; none is the whole page, whose edge bleeds. Only `RELAX` takes several.
    standing : Standing or None
        For `STIPPLE`, dots that stay as they are; else those that are moved.
    n_done : int
        How many steps of relaxation are done already.
    steps : int or None
        How many to take; None is as many as the style says.
    neighbours_mm : (m, 2) float64 or None
        Dots beyond the border, from which new ones keep their distance.
    neighbours_radius_mm : (m,) float32 or None
        Theirs.
    pieces_mm : tuple of (policy, MultiLineString)
        Pieces of the border that are to dots something else than the style says.
    seen_mm : tuple of Seen
        Through which pieces of the border which neighbours' dots are seen.
    bleeds_onto_mm : tuple of Seen
        Over which pieces of the border dots run off onto which neighbours.
    lines : MetLines or None
        What the standing dots line up on while they are moved.
    """

    style: Style
    reference: Reference | None
    kind: str = STIPPLE
    parts_mm: tuple[Polygon | MultiPolygon, ...] = ()
    standing: Standing | None = None
    n_done: int = 0
    steps: int | None = None
    neighbours_mm: NDArray[np.float64] | None = None
    neighbours_radius_mm: NDArray[np.float32] | None = None
    pieces_mm: tuple[tuple[str, MultiLineString], ...] = ()
    seen_mm: tuple[Seen, ...] = ()
    bleeds_onto_mm: tuple[Seen, ...] = ()
    lines: MetLines | None = None
