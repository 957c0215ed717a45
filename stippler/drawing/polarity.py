"""Which areas are white dots on a black ground, which are not shown, and where the ground is.

The only place that asks areas and styles for it; the screen and every export go by what it says.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

if TYPE_CHECKING:
    from stippler.drawing.drawing import Drawing
    from stippler.drawing.partition import Partition

Outline: TypeAlias = Polygon | MultiPolygon

BLACK, WHITE, HIDDEN = 0, 1, 2
"""How a dot is painted: in ink, in paper on a ground of ink, or not at all."""


@dataclass(frozen=True, slots=True)
class Polarity:
    """How the dots of areas are painted.

    Attributes
    ----------
    white, hidden : sorted tuples of int
        Ids of areas; all others are black dots on white. What is hidden is in `hidden` alone.
    """

    white: tuple[int, ...] = ()
    hidden: tuple[int, ...] = ()

    @property
    def is_plain(self) -> bool:
        """Whether all areas are shown as black dots on white."""
        return not (self.white or self.hidden)

    def of(self, area: NDArray[np.int32]) -> NDArray[np.uint8]:
        """Return `BLACK`, `WHITE` or `HIDDEN` for each dot, by its area."""
        paint = np.full(len(area), BLACK, np.uint8)
        for ids, value in ((self.white, WHITE), (self.hidden, HIDDEN)):
            if ids:
                paint[np.isin(area, np.array(ids, np.int64))] = value
        return paint


def polarity_of(drawing: Drawing) -> Polarity:
    """Return how the dots of a drawing's areas are painted."""
    hidden = tuple(sorted(k for k, area in drawing.areas.items() if area.hidden))
    inverse = {k for k, style in drawing.styles.items() if style.is_inverse}
    white = (k for k, area in drawing.areas.items() if area.style in inverse and not area.hidden)
    return Polarity(tuple(sorted(white)), hidden)


def grounds_of(
    drawing: Drawing, polarity: Polarity, partition: Callable[[], Partition] | None = None
) -> dict[int, Outline]:
    """Return the part of the page of each area that has a ground of ink; none is empty.

    `partition` gives the drawing's, where there is one already.
    """
    if not polarity.white:
        return {}
    from stippler.drawing.partition import Partition

    parted = partition() if partition else Partition(drawing.outlines())
    parts = {k: parted.part_of(k) for k in polarity.white}
    return {k: part for k, part in parts.items() if not part.is_empty}
