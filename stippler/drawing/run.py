"""A run of the worker over the dots, as one step of the history."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dot_edit import Change, DotEdit, DotRows, Shift, differs
from stippler.drawing.dots import FIXED, NO_CURVE, ON_CURVE, Dots
from stippler.drawing.edit import Edit
from stippler.drawing.history import Step
from stippler.drawing.partition import Partition
from stippler.drawing.store import DotStore, Rows
from stippler.kernels.dots.merge_results import merge_positions

_HELD = ("constraint", "curve", "parameter", "area")
"""What a line that comes to hold a dot changes of it, beside its place."""

_Fields = dict[str, NDArray[Any]]


@dataclass(frozen=True, slots=True, eq=False)
class Holding:
    """Which lines a worker's result has hold dots, in the order of their ids.

    Attributes
    ----------
    curve : (n,) int32
        `NO_CURVE` where none does.
    along_mm : (n,) float64
    """

    curve: NDArray[np.int32]
    along_mm: NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Limits:
    """What a run may not do, since a person has changed it or locked it.

    Attributes
    ----------
    partition : Partition
        Whose places are.
    areas_changed : bool
        Whether areas are others than when the run began: no dot goes over to another one then.
    lines : collection of int
        Those that are others than when the run began, or gone.
    locked : (k,) int32 or None
        Areas whose dots stay.
    """

    partition: Partition
    areas_changed: bool = False
    lines: Collection[int] = field(default_factory=frozenset)
    locked: NDArray[np.int32] | None = None


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
        self._held: _Fields = {}
        self._first: _Fields = {
            "position_mm": dots.position_mm.copy(),
            "radius_mm": dots.radius_mm.copy(),
        }
        self._told = self._first
        self._dots = dots
        self._rows: tuple[int, Rows] = (-1, np.empty(0, np.int64))

    def merge(
        self,
        store: DotStore,
        position_mm: NDArray[np.float64],
        limits: Limits,
        holding: Holding | None = None,
    ) -> tuple[int, float]:
        """Merge positions; return how many free dots they moved, and the longest way one went."""
        if position_mm.shape != self.position_mm.shape:
            raise ValueError("the result is not one of this run")
        on_lines_mm = 0.0
        if holding is not None:
            position_mm, on_lines_mm = self._hold(store, position_mm, holding, limits)
        if limits.areas_changed:
            position_mm = self._kept_in_areas(store, limits.partition, position_mm)
        dots = store.dots
        places = np.ascontiguousarray(position_mm, np.float64).view()
        places.flags.writeable = False  # whoever made them: kernels are compiled for one kind
        n, furthest_mm = merge_positions(
            self._rows_in(store, limits.locked),
            places,
            store.edited,
            self.base,
            dots.constraint,
            dots.position_mm,
            self.position_mm,
        )
        return n, max(furthest_mm, on_lines_mm)

    def _kept_in_areas(
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

    def _hold(
        self,
        store: DotStore,
        position_mm: NDArray[np.float64],
        holding: Holding,
        limits: Limits,
    ) -> tuple[NDArray[np.float64], float]:
        """Merge dots that lie on lines; return places for all others, and the longest way one went.

        Dots that are held by lines which are others by now stay where they are.
        """
        rows = self._rows_in(store, limits.locked)
        dots, out = store.dots, position_mm.copy()
        on = holding.curve != NO_CURVE
        which = np.flatnonzero(on & (rows >= 0))
        at = rows[which]
        area = limits.partition.area_at(np.ascontiguousarray(position_mm[which]))
        kept = (area != dots.area[at]) if limits.areas_changed else area < 0
        kept |= np.isin(holding.curve[which], list(limits.lines))
        out[which] = dots.position_mm[at]
        fine = ~kept & (store.edited[at] <= self.base) & (dots.constraint[at] != FIXED)
        which, at, area = which[fine], at[fine], area[fine]
        if not len(which):
            return out, 0.0
        self._begin_holding()
        old = dots.position_mm[at].copy()
        n = len(which)
        for name, values in (
            ("position_mm", position_mm[which]), ("constraint", np.full(n, ON_CURVE, np.int8)),
            ("curve", holding.curve[which]), ("parameter", holding.along_mm[which]), ("area", area),
        ):  # fmt: skip
            store.write(name, at, values)
            self._after()[name][which] = values
        out[which] = position_mm[which]
        return out, float(np.hypot(*(position_mm[which] - old).T).max())

    def _begin_holding(self) -> None:
        """Follow what lines change of dots from now on, too."""
        if not self._held:
            before: _Fields = {name: getattr(self._dots, name) for name in _HELD}
            self._held = {name: values.copy() for name, values in before.items()}
            self._first, self._told = self._first | before, self._told | before

    def _after(self) -> _Fields:
        return {"position_mm": self.position_mm, "radius_mm": self.radius_mm, **self._held}

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
        mine[mine] = (store.edited[rows[mine]] <= self.base) & (
            store.dots.constraint[rows[mine]] != FIXED
        )
        self.radius_mm[mine] = radius_mm[mine]
        store.write("radius_mm", rows[mine], radius_mm[mine])
        return int(mine.sum())

    def edit(self) -> Edit:
        """Return all that the results have changed."""
        return self._since(self._first)

    def part(self) -> Edit:
        """Return what they have changed since the last call; these parts join to the whole."""
        edit = self._since(self._told)
        self._told = {name: values.copy() for name, values in self._after().items()}
        return edit

    def _rows_in(self, store: DotStore, locked: NDArray[np.int32] | None) -> Rows:
        if self._rows[0] != store.n_layouts:
            self._rows = (store.n_layouts, store.rows(self.ids))
        rows = self._rows[1]
        if locked is not None:
            rows = rows.copy()
            rows[np.isin(store.dots.area[rows], locked)] = -1
        return rows

    def _since(self, before: _Fields) -> Edit:
        changes: dict[str, Change] = {}
        for name, new in self._after().items():
            old = before[name]
            which = differs(old, new)
            if which.any():
                changes[name] = Change(self.ids[which], old[which], new[which])
        return Edit(self.step.label, DotEdit(changes, DotRows.none(), DotRows.none(), Shift.none()))
