"""Dots that a run is making: in the document like all others, and one step when it ends."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import FREE, NO_CURVE, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.edit import Edit
from stippler.drawing.recorder import Recorder
from stippler.drawing.run import Holding
from stippler.drawing.store import DotStore, Rows
from stippler.drawing.style import Style
from stippler.drawing.style_shape import shaped, turns_with_edges


class Draft:
    """The dots of one area while they are made; they stand in the last rows.

    Their ids are the first that were free when the draft began, so they do not depend on how many
    results a person got to see.

    Parameters
    ----------
    replaced : rows
        Of the dots that give way.
    style : Style
        Gives them their shapes.
    """

    def __init__(
        self,
        drawing: Drawing,
        store: DotStore,
        label: str,
        area: int,
        replaced: Rows,
        style: Style,
    ) -> None:
        self._store, self._style, self.area = store, style, area
        self._drawing = drawing
        self._recorder = Recorder(drawing, store, label)
        self._first_id = store.next_id
        if len(replaced):
            self._recorder.remove(replaced)
        self._n_others = len(store)

    @property
    def ids(self) -> NDArray[np.int64]:
        """Those of its dots, in the order in which they were given."""
        return self._store.dots.id[self._n_others :].copy()

    @property
    def n_dots(self) -> int:
        """How many dots it has so far."""
        return len(self._store) - self._n_others

    def show(
        self,
        position_mm: NDArray[np.float64],
        radius_mm: NDArray[np.float32],
        holding: Holding | None = None,
    ) -> bool:
        """Take the dots as they are now; return whether they are the same ones, moved or sized."""
        is_same = self._show(position_mm, radius_mm)
        if holding is not None:
            self._hold(holding)
        return is_same

    def _show(self, position_mm: NDArray[np.float64], radius_mm: NDArray[np.float32]) -> bool:
        store, n = self._store, len(position_mm)
        if n == self.n_dots:
            rows = slice(self._n_others, len(store))
            store.dots.position_mm[rows] = position_mm
            store.dots.radius_mm[rows] = radius_mm
            return True
        store.cut(self._n_others, self._first_id)
        dots = Dots.round(position_mm, radius_mm, area=self.area)
        dots = shaped(dots, self._style, self._drawing.reference)
        store.append(replace(dots, id=store.new_ids(n)))
        return False

    def size_others(self, rows: Rows, radius_mm: NDArray[np.float32]) -> None:
        """Give dots that are not its own other sizes as a part of it."""
        self._recorder.change("radius_mm", rows, radius_mm)

    def _hold(self, holding: Holding) -> None:
        """Let lines hold the dots."""
        curve, along_mm = holding.curve, holding.along_mm
        rows = np.arange(self._n_others, len(self._store))
        on = np.where(curve == NO_CURVE, FREE, ON_CURVE).astype(np.int8)
        for name, values in (("constraint", on), ("curve", curve), ("parameter", along_mm)):
            self._store.write(name, rows, values)

    def set(self, kind: str, i: int, value: Any) -> None:
        """Set a value of another kind as a part of it."""
        self._recorder.set(kind, i, value)

    def finish(self) -> Edit:
        """Return the edit that it amounts to."""
        if turns_with_edges(self._style):
            self._turn_again()
        self._recorder.note_inserted(self.ids)
        return self._recorder.finish()

    def _turn_again(self) -> None:
        """Lay dots along the edges of where they have come to lie."""
        rows = np.arange(self._n_others, len(self._store))
        dots = self._store.dots.take(rows)
        plain = Dots.round(dots.position_mm, dots.radius_mm, area=self.area)
        new = shaped(replace(plain, seed=dots.seed), self._style, self._drawing.reference)
        for name in ("elongation", "angle_rad"):
            self._store.write(name, rows, getattr(new, name))
