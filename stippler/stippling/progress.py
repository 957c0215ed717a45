"""How far the dots of an area have come."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from stippler.stippling.tone import Shortfall

if TYPE_CHECKING:
    from stippler.drawing.run import Holding

FIRST, RELAXED, TONED, DONE = "first dots", "relax", "tone", "done"


class Step(NamedTuple):
    """A piece of a stage that is done: how far the stage is, and how far dots went in it."""

    stage: str
    done: int
    total: int
    movement_mm: float = math.nan


@dataclass(frozen=True, slots=True, eq=False)
class Progress:
    """A snapshot of the work; its arrays are fresh and read-only.

    Attributes
    ----------
    stage : {"first dots", "relax", "tone", "done"}
    done, total : int
        Of this stage.
    position_mm : (n, 2) float64
        Empty if snapshots are off, but for the last one.
    radius_mm : (n,) float32
    movement_mm : float
        Mean movement of the last relaxation step; NaN outside relaxation.
    shortfall : Shortfall or None
        On "done".
    holding : Holding or None
        Which of the drawing's lines hold the dots then.
    limits_mm : (float, float) or None
        On "done": the range in which radii were solved for the tone; None where they were not.
    """

    stage: str
    done: int
    total: int
    position_mm: NDArray[np.float64]
    radius_mm: NDArray[np.float32]
    movement_mm: float = math.nan
    shortfall: Shortfall | None = None
    holding: Holding | None = None
    limits_mm: tuple[float, float] | None = None


def notes_on(result: Progress, what: str = "page") -> tuple[str, ...]:
    """Say in words what a finished run fell short of; `what` it was a run over."""
    lack = result.shortfall
    if lack is None:
        return ()
    notes = list(lack.notes)
    if lack.share > 0.0005:
        where = ""
        if lack.box_mm is not None:
            x0, y0, x1, y1 = lack.box_mm
            where = f", between {x0:.1f}, {y0:.1f} and {x1:.1f}, {y1:.1f} mm"
        notes.append(
            f"{100 * lack.share:.1f} % of the {what} is too dark for these dots "
            f"(by {lack.missing:.2f} of 1{where}); allow larger dots, or more of them"
        )
    return tuple(notes)
