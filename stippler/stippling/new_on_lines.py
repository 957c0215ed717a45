"""New dots that lines take: those within reach line up, and the dots around make room."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.drawing import Drawing
from stippler.drawing.line import ADHERE
from stippler.drawing.line_index import LineIndex
from stippler.drawing.run import Holding
from stippler.stippling.compartments import Shape
from stippler.stippling.field_sums import Weights
from stippler.stippling.lines import Tone
from stippler.stippling.on_lines import OnLines
from stippler.stippling.relax import Relaxation
from stippler.stippling.task import MetLines
from stippler.stippling.tasks import lines_met

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_STEPS = 10
_AROUND = 4.0  # mean spacings beyond the reach, within which dots make room


@dataclass(frozen=True, slots=True, eq=False)
class LinedUp:
    """Dots after some of them came onto lines.

    Attributes
    ----------
    position_mm : (n, 2) float64
    line_of_dot : (n,) int64
        As the lines are numbered; -1 for none.
    along_mm : (n,) float64
    """

    position_mm: Floats
    line_of_dot: NDArray[np.int64]
    along_mm: Floats


@dataclass(frozen=True, slots=True, eq=False)
class Place:
    """Where dots are relaxed: polygons and a weight, from a corner of their own.

    Attributes
    ----------
    parts : sequence of polygons, mm from the corner
    field : Weights or None
        The same.
    origin_mm : (float, float)
        Where the corner lies on the page.
    """

    parts: Sequence[Shape]
    field: Weights | None = None
    origin_mm: tuple[float, float] = (0.0, 0.0)


def lined_up(
    met: MetLines, position_mm: Floats, still: Flags, place: Place, tone: Tone | None = None
) -> LinedUp:
    """Let new dots that lie within reach of lines come onto them, up to the room there is.

    Parameters
    ----------
    met : MetLines
    position_mm : (n, 2) float64
        On the page, within the place; those that are there already, too.
    still : (n,) bool
        Those that were there, which stay.
    tone : callable, optional
        How dense dots are to lie along lines, by places on the page.
    """
    origin = np.array(place.origin_mm)
    parts = [shapely.transform(part, lambda xy: xy + origin) for part in place.parts]
    chooser = OnLines(met, position_mm, parts, tone, stays=still)
    if chooser.is_idle or not len(position_mm):
        return LinedUp(position_mm, chooser.line, chooser.along)
    spacing = np.sqrt(sum(part.area for part in parts) / len(position_mm))
    far = ~_near(met, position_mm, _AROUND * float(spacing))
    shifted = _Shifted(chooser, origin)
    engine = Relaxation(
        position_mm - origin, list(place.parts), still | far, density=place.field, method="lloyd"
    )
    for _ in range(_STEPS):
        engine.step(redirect=shifted)
    found = engine.points + origin
    chooser.take_back_refused(found)
    found[far | still] = position_mm[far | still]
    return LinedUp(found, chooser.line, chooser.along)


def filled_up(
    drawing: Drawing, points_mm: Floats, parts: Sequence[Shape]
) -> tuple[Floats, Holding | None]:
    """Let dots that are to fill parts of a drawing line up; dots that are there stay."""
    dots = drawing.dots
    whole = shapely.union_all(list(parts))
    shapely.prepare(whole)
    there = dots.take(shapely.intersects_xy(whole, *dots.position_mm.T))
    met = lines_met(drawing, there)
    if met is None or not len(points_mm):
        return points_mm, None
    n = len(there)
    still = np.arange(n + len(points_mm)) < n
    everyone = np.concatenate([there.position_mm, points_mm])
    found = lined_up(with_new(met, len(points_mm)), everyone, still, Place(list(parts)))
    return found.position_mm[n:], met.holding(found.line_of_dot[n:], found.along_mm[n:])


def with_new(met: MetLines, n_new: int) -> MetLines:
    """Return lines met by dots that are there, with new ones after these that may join."""
    return replace(
        met,
        line_of_dot=np.concatenate([met.line_of_dot, np.full(n_new, -1, np.int32)]),
        along_mm=np.concatenate([met.along_mm, np.zeros(n_new)]),
        may_join=np.arange(len(met.may_join) + n_new) >= len(met.may_join),
    )


class _Shifted:
    """What chooses on the page, for dots whose places are told from a corner."""

    def __init__(self, chooser: OnLines, origin: Floats) -> None:
        self._chooser, self._origin = chooser, origin
        self.may_cross = chooser.may_cross

    def __call__(self, before: Floats, wanted: Floats) -> Floats:
        chosen = self._chooser(before + self._origin, wanted + self._origin)
        self.may_cross = self._chooser.may_cross
        return chosen - self._origin


def _near(met: MetLines, position_mm: Floats, beyond_mm: float) -> Flags:
    """Tell which dots lie about lines that dots adhere to."""
    lines = [line for line in met.lines if line.meeting == ADHERE and not line.hidden]
    reach = [line.reach_mm + beyond_mm for line in lines]
    which, _, away = LineIndex(lines, reach).nearest(position_mm)
    return np.asarray((which >= 0) & (away <= np.array([*reach, 0.0])[which]))
