"""A run of the worker over the dots, as one step of the history."""

from __future__ import annotations

from stippler.drawing.dots import Dots
from stippler.drawing.edit import Change, Edit, Placed, Shift
from stippler.drawing.history import Step


class Run:
    """Where the dots were when the run began, and where its results have brought them.

    Attributes
    ----------
    step : Step
        Its place in the history.
    base : int
        The revision it began with; dots edited later are left alone.
    after : (n, 2) float64
        By the order of `ids`.
    """

    def __init__(self, step: Step, dots: Dots, base: int) -> None:
        self.step, self.base = step, base
        self.ids = dots.id.copy()
        self._before = dots.position_mm.copy()
        self.after = self._before.copy()

    def edit(self) -> Edit:
        """Return what the results have changed."""
        moved = (self.after != self._before).any(axis=1)
        change = Change(self.ids[moved], self._before[moved], self.after[moved])
        changes = {"position_mm": change} if moved.any() else {}
        return Edit(self.step.label, changes, Placed.none(), Placed.none(), Shift.none())
