"""A run of the worker over the dots, as one step of the history."""

from __future__ import annotations

from stippler.drawing.dots import Dots
from stippler.drawing.edit import Change, DotRows, Edit, Shift
from stippler.drawing.history import Step


class Run:
    """Where the dots were when the run began, and what its results have made of them.

    Attributes
    ----------
    step : Step
        Its place in the history.
    base : int
        The revision it began with; dots edited later are left alone.
    after : (n, 2) float64
        By the order of `ids`.
    radius_after : (n,) float32
        By the order of `ids`.
    """

    def __init__(self, step: Step, dots: Dots, base: int) -> None:
        self.step, self.base = step, base
        self.ids = dots.id.copy()
        self._before = dots.position_mm.copy()
        self.after = self._before.copy()
        self._radius_before = dots.radius_mm.copy()
        self.radius_after = self._radius_before.copy()

    def edit(self) -> Edit:
        """Return what the results have changed."""
        changes: dict[str, Change] = {}
        moved = (self.after != self._before).any(axis=1)
        sized = self.radius_after != self._radius_before
        for name, which, before, after in (
            ("position_mm", moved, self._before, self.after),
            ("radius_mm", sized, self._radius_before, self.radius_after),
        ):
            if which.any():
                changes[name] = Change(self.ids[which], before[which], after[which])
        return Edit(self.step.label, changes, DotRows.none(), DotRows.none(), Shift.none())
