"""Which lines are chosen, and which line lies under the pointer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from stippler.editor.events import NO_MODS, Mods
from stippler.editor.line_edits import lines_of

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.drawing.line import Line

Point = tuple[float, float]


class ChosenLines:
    """The chosen lines, by id.

    Attributes
    ----------
    ids : tuple of int
        In the order they were chosen; lines that are gone may be among them.
    """

    def __init__(self) -> None:
        self.ids: tuple[int, ...] = ()

    def choose(self, k: int | None, mods: Mods = NO_MODS) -> None:
        """Choose a line, or none; Shift adds it, or takes it away."""
        if k is None:
            self.ids = self.ids if mods.shift else ()
        elif mods.shift:
            self.ids = tuple(i for i in self.ids if i != k) if k in self.ids else (*self.ids, k)
        else:
            self.ids = (k,)

    def alive(self, document: Document | None) -> list[int]:
        """Return those that are there."""
        there = lines_of(document) if document is not None else {}
        return [k for k in self.ids if k in there]


def away_mm(line: Line, at: Point) -> float:
    """Return how far a point is from a line's ink."""
    points, half = line.path.points_mm, line.half_widths()
    a, d = points[:-1], np.diff(points, axis=0)
    t = ((np.array(at) - a) * d).sum(axis=1) / np.maximum((d * d).sum(axis=1), 1e-300)
    t = np.clip(t, 0.0, 1.0)
    far = np.hypot(*(a + t[:, None] * d - at).T)
    return max(float((far - half[:-1] - t * np.diff(half)).min()), 0.0)


def line_at(document: Document, at: Point, reach_mm: float) -> int | None:
    """Return the line under a point, or the nearest within a reach."""
    best, found = reach_mm, None
    for k, line in lines_of(document).items():
        if line.hidden:
            continue
        low, high = line.path.points_mm.min(axis=0), line.path.points_mm.max(axis=0)
        pad = reach_mm + max(line.width_mm)
        if ((np.array(at) < low - pad) | (np.array(at) > high + pad)).any():
            continue
        if (away := away_mm(line, at)) <= best:
            best, found = away, k
    return found
