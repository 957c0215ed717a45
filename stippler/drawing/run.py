"""A run of the worker over the dots, as one step of the history."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dot_edit import Change, DotEdit, DotRows, Shift, differs
from stippler.drawing.dots import Dots
from stippler.drawing.edit import Edit
from stippler.drawing.history import Step
from stippler.drawing.partition import Partition
from stippler.drawing.store import DotStore, Rows
from stippler.kernels.dots.merge_results import merge_positions


class Run:
    """Where the dots were when the run began, and what its results have made of them.

    Parameters
    ----------
    dots : Dots
        Those that the worker has, in the order of their ids.

    Attributes
    ----------
    step : Step
        Its place in the history.
    base : int
        The revision it began with; dots edited later are left alone.
    position_mm : (n, 2) float64
        Where it has brought them.
    radius_mm : (n,) float32
    """

    def __init__(self, step: Step, dots: Dots, base: int) -> None:
        self.step, self.base = step, base
        self.ids = dots.id
        self.position_mm, self.radius_mm = dots.position_mm.copy(), dots.radius_mm.copy()
        self._first = (dots.position_mm.copy(), dots.radius_mm.copy())
        self._told = self._first
        self._rows: tuple[int, Rows] = (-1, np.empty(0, np.int64))

    def move(
        self, store: DotStore, result: NDArray[np.float64], locked: NDArray[np.int32] | None = None
    ) -> tuple[int, float]:
        """Merge positions; return how many dots they moved, and the longest way one went.

        Parameters
        ----------
        locked : (k,) int32, optional
            Areas whose dots stay.
        """
        if result.shape != self.position_mm.shape:
            raise ValueError("the result is not one of this run")
        dots = store.dots
        places = np.ascontiguousarray(result, np.float64).view()
        places.flags.writeable = False  # whoever made them: kernels are compiled for one kind
        return merge_positions(
            self._rows_in(store, locked),
            places,
            store.edited,
            self.base,
            dots.constraint,
            dots.position_mm,
            self.position_mm,
        )

    def kept_in_areas(
        self, store: DotStore, partition: Partition, position_mm: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Return places without those that areas drawn since the run began forbid."""
        rows = store.rows(self.ids)
        wrong = rows >= 0
        area = partition.area_at(np.ascontiguousarray(position_mm[wrong], np.float64))
        wrong[wrong] = area != store.dots.area[rows[wrong]]
        out = position_mm.copy()
        out[wrong] = store.dots.position_mm[rows[wrong]]
        return out

    def size(
        self,
        store: DotStore,
        radius_mm: NDArray[np.float32],
        locked: NDArray[np.int32] | None = None,
    ) -> int:
        """Merge radii, as `move` does positions; return how many dots got one."""
        if radius_mm.shape != self.radius_mm.shape:
            raise ValueError("the result is not one of this run")
        rows = self._rows_in(store, locked)
        mine = rows >= 0
        mine[mine] = (store.edited[rows[mine]] <= self.base) & ~store.dots.is_fixed(rows[mine])
        self.radius_mm[mine] = radius_mm[mine]
        store.write("radius_mm", rows[mine], radius_mm[mine])
        return int(mine.sum())

    def edit(self) -> Edit:
        """Return all that the results have changed."""
        return self._since(self._first)

    def part(self) -> Edit:
        """Return what they have changed since the last call; these parts join to the whole."""
        edit = self._since(self._told)
        self._told = (self.position_mm.copy(), self.radius_mm.copy())
        return edit

    def _rows_in(self, store: DotStore, locked: NDArray[np.int32] | None) -> Rows:
        if self._rows[0] != store.n_layouts:
            self._rows = (store.n_layouts, store.rows(self.ids))
        rows = self._rows[1]
        if locked is not None:
            rows = rows.copy()
            rows[np.isin(store.dots.area[rows], locked)] = -1
        return rows

    def _since(self, before: tuple[NDArray[Any], NDArray[Any]]) -> Edit:
        changes: dict[str, Change] = {}
        for k, name in enumerate(("position_mm", "radius_mm")):
            old, new = before[k], getattr(self, name)
            which = differs(old, new)
            if which.any():
                changes[name] = Change(self.ids[which], old[which], new[which])
        return Edit(self.step.label, DotEdit(changes, DotRows.none(), DotRows.none(), Shift.none()))
