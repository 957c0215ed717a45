"""A drawing while it is edited: its dots found by id and by place, strokes, runs and history."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.edit import Edit
from stippler.drawing.history import BUDGET_BYTES, History
from stippler.drawing.index import DotIndex
from stippler.drawing.partition import Bounds
from stippler.drawing.recorder import Recorder
from stippler.drawing.run import Run
from stippler.drawing.store import DotStore, Rows, union
from stippler.kernels.dots.merge_results import merge_positions

_MOST_PARTS = 256


@dataclass(frozen=True, slots=True, eq=False)
class Changed:
    """What is to be shown anew.

    Attributes
    ----------
    rows : array or None
        Of dots that a person has changed; None is all.
    places : bool
        Whether a result has moved or sized dots all over the drawing, besides.
    """

    rows: Rows | None
    places: bool


class Document:
    """All changes of a drawing's dots go through here; for one thread.

    A person's changes are made within a stroke, between `begin` and `commit` or `cancel`; a
    stroke is one step of the history. The worker's results are merged into a run, which is one
    step too, and leave alone whatever a person has changed since the run began; so strokes and
    a run may go on at the same time, and can be undone in any state of the run.

    Parameters
    ----------
    drawing : Drawing
        Its `dots` are replaced by views that this object keeps up to date.

    Attributes
    ----------
    revision : int
        Grows with every change of the dots.
    """

    def __init__(self, drawing: Drawing, budget_bytes: int = BUDGET_BYTES) -> None:
        self.drawing = drawing
        self.bounds = Bounds(drawing.areas)
        self.history = History(budget_bytes)
        self.revision = 0
        self._store = DotStore(drawing.dots)
        self._index = DotIndex(
            self._store.dots.position_mm, (drawing.page.width_mm, drawing.page.height_mm)
        )
        self._edited = np.zeros(self._store.next_id + 1024, np.int32)  # revision, by id
        self._stroke: Recorder | None = None
        self._run: Run | None = None
        self._changed: list[Rows] = []
        self._all_changed, self._places_changed = True, False
        drawing.dots = self._store.dots

    @property
    def dots(self) -> Dots:
        """The dots as they are; to be read only."""
        return self._store.dots

    @property
    def n_bytes(self) -> int:
        """Memory all this takes, without the history."""
        return self._store.n_bytes + self._index.n_bytes + self._edited.nbytes

    # --- finding ----------------------------------------------------------------------------

    def in_box(self, box: tuple[float, float, float, float]) -> Rows:
        """Return the rows of the dots in a closed box x0, y0, x1, y1 in mm; sorted."""
        return self._index.in_box(box, self.dots.position_mm)

    def nearest(self, x: float, y: float, reach_mm: float) -> int | None:
        """Return the row of the dot nearest to a point within a reach."""
        return self._index.nearest(x, y, reach_mm, self.dots.position_mm)

    def nearest_distances(self, rows: Rows, reach_mm: float) -> NDArray[np.float64]:
        """Return how far each row's nearest neighbour is; `reach_mm` where none is nearer."""
        return self._index.nearest_distances(rows, reach_mm, self.dots.position_mm)

    def apart(self, points: NDArray[np.float64], distance_mm: float) -> NDArray[np.bool_]:
        """Return which points keep a distance to all dots and to the points kept before them."""
        return self._index.apart(points, distance_mm, self.dots.position_mm)

    def rows(self, ids: NDArray[np.int64]) -> Rows:
        """Return the rows of ids; -1 for dots that are not there."""
        return self._store.rows(ids)

    # --- a person's strokes -----------------------------------------------------------------

    @property
    def in_stroke(self) -> bool:
        """Whether a stroke has begun and not ended."""
        return self._stroke is not None

    def begin(self, label: str) -> None:
        """Begin a stroke."""
        if self._stroke is not None:
            raise ValueError("a stroke has begun already")
        self._stroke = Recorder(self._store, label)

    def move(self, rows: Rows, position_mm: NDArray[np.float64]) -> None:
        """Move the free ones of some dots, as far as their areas let them."""
        free = ~self.dots.fixed[rows]
        if not free.all():
            rows, position_mm = rows[free], position_mm[free]
        old = self.dots.position_mm[rows]
        new = self.bounds.confine(old, position_mm, self.dots.area[rows])
        self.change("position_mm", rows, new)

    def change(self, field: str, rows: Rows, values: NDArray[np.generic]) -> None:
        """Set one field of some rows."""
        if not len(rows):
            return
        stroke = self._in_stroke()
        stroke.change(field, rows, values)
        self._note(rows, self.dots.id[rows], moved=field == "position_mm")

    def insert(self, dots: Dots) -> Rows:
        """Add dots, which get new ids and the areas they lie in; those off the page are not."""
        stroke = self._in_stroke()
        area = self.bounds.area_at(dots.position_mm)
        if (area < 0).any():
            dots = dots.take(area >= 0)
        dots.area[:] = area[area >= 0]
        if not len(dots):
            return np.empty(0, np.int64)
        dots.id[:] = self._store.new_ids(len(dots))
        rows = stroke.insert(dots)
        self.drawing.dots = self.dots
        self._note(rows, dots.id, moved=True)
        return rows

    def remove(self, rows: Rows) -> None:
        """Remove dots; rows of others change."""
        if not len(rows):
            return
        stroke = self._in_stroke()
        rows = union([rows], len(self.dots))
        ids = self.dots.id[rows]
        touched = stroke.remove(rows)
        self.drawing.dots = self.dots
        self._note(touched, ids, moved=True)

    def commit(self) -> Edit:
        """End the stroke; it is a step of the history, if it has changed anything."""
        edit = self._in_stroke().finish()
        self._stroke = None
        if not edit.is_empty:
            self.history.push(edit)
        return edit

    def cancel(self) -> None:
        """End the stroke and take back all it has changed."""
        edit = self._in_stroke().finish()
        self._stroke = None
        self._apply(edit.inverse())

    # --- history ----------------------------------------------------------------------------

    def undo(self) -> bool:
        """Take the last step back; return whether there was one. A run that goes on ends.

        Where that run has not moved anything yet, ending it is all there is to take back.
        """
        self._no_stroke()
        step = self.history.undone
        if step is not None and step.is_open:
            self.end_run()
            if self.history.undone is not step:
                return True
        return self._step(self.history.undo())

    def redo(self) -> bool:
        """Do the last undone step again; return whether there was one."""
        self._no_stroke()
        return self._step(self.history.redo())

    def _step(self, edit: Edit | None) -> bool:
        if edit is not None:
            self._apply(edit)
        return edit is not None

    # --- the worker's runs ------------------------------------------------------------------

    @property
    def in_run(self) -> bool:
        """Whether results are still being merged."""
        return self._run is not None

    def begin_run(self, label: str) -> Dots:
        """Begin a run; return a copy of the dots for the worker."""
        self._no_stroke()
        self.end_run()
        self._run = Run(self.history.open(label, of_job=True), self.dots, self.revision)
        return self.dots.copy()

    def merge(self, position_mm: NDArray[np.float64]) -> int:
        """Move the dots of the run to a result's positions; return how many moved.

        Dots that are gone, fixed, or changed by a person since the run began stay as they are.
        """
        run = self._run
        if run is None:
            return 0
        result = np.ascontiguousarray(position_mm, np.float64)
        if result.shape != run.after.shape:
            raise ValueError("the result is not one of this run")
        n, furthest_mm = merge_positions(
            run.ids,
            result,
            self._store.row_of_id,
            self._edited,
            run.base,
            self.dots.fixed,
            self.dots.position_mm,
            run.after,
        )
        self.revision += 1
        self._index.drift(furthest_mm)
        self._places_changed = True
        return n

    def merge_radii(self, radius_mm: NDArray[np.float32]) -> int:
        """Give the dots of the run a result's radii, as `merge` does; return how many got one."""
        run = self._run
        if run is None:
            return 0
        if radius_mm.shape != run.radius_after.shape:
            raise ValueError("the result is not one of this run")
        rows = self._store.rows(run.ids)
        mine = (rows >= 0) & (self._edited[run.ids] <= run.base)
        mine[mine] = ~self.dots.fixed[rows[mine]]
        run.radius_after[mine] = radius_mm[mine]
        self._store.write("radius_mm", rows[mine], radius_mm[mine])
        self.revision += 1
        self._places_changed = True
        return int(mine.sum())

    def end_run(self) -> None:
        """End the run; it is a step of the history, if it has changed anything."""
        if self._run is not None:
            run, self._run = self._run, None
            self.history.fill(run.step, run.edit())

    # --- what has changed -------------------------------------------------------------------

    def take_changed(self) -> Changed:
        """Return what has changed since the last call."""
        parts, everything, places = self._changed, self._all_changed, self._places_changed
        self._changed, self._all_changed, self._places_changed = [], False, False
        if everything:
            return Changed(None, places)
        n = len(self.dots)
        return Changed(union([rows[rows < n] for rows in parts], n), places)

    def _apply(self, edit: Edit) -> None:
        rows = self._store.apply(edit)
        self.drawing.dots = self.dots
        ids = [change.ids for change in edit.changes.values()]
        ids += [edit.removed.dots.id, edit.inserted.dots.id]
        places = bool("position_mm" in edit.changes or len(edit.removed) or len(edit.inserted))
        self._note(rows, np.concatenate(ids), moved=places)

    def _note(self, rows: Rows, ids: NDArray[np.int64], *, moved: bool) -> None:
        """Take note of changed rows, and of the ids of the dots that a person changed."""
        self.revision += 1
        if self._store.next_id > len(self._edited):
            more = np.zeros(self._store.next_id + self._store.next_id // 4 + 1024, np.int32)
            more[: len(self._edited)] = self._edited
            self._edited = more
        self._edited[ids] = self.revision
        if moved:
            self._index.update(rows, self.dots.position_mm)
        if self._all_changed:
            return
        self._changed.append(rows)
        if len(rows) == len(self.dots) or len(self._changed) > _MOST_PARTS:
            self._changed, self._all_changed = [], True

    def _in_stroke(self) -> Recorder:
        if self._stroke is None:
            raise ValueError("no stroke has begun")
        return self._stroke

    def _no_stroke(self) -> None:
        if self._stroke is not None:
            raise ValueError("a stroke has begun and not ended")
