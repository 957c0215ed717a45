"""A drawing while it is edited: the only way to change it, with history, runs and drafts."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing import records
from stippler.drawing.changes import Changes
from stippler.drawing.derived import Derived
from stippler.drawing.dots import Dots
from stippler.drawing.draft import Draft
from stippler.drawing.drawing import Drawing
from stippler.drawing.edit import Edit
from stippler.drawing.history import BUDGET_BYTES, History, Step
from stippler.drawing.index import DotIndex
from stippler.drawing.log import ENDED, MADE, OPENED, PART, REDONE, STEP, UNDONE, Entry, Follower
from stippler.drawing.partition import NOWHERE, Partition
from stippler.drawing.recorder import Recorder
from stippler.drawing.reference import Reference
from stippler.drawing.run import Holding, Run
from stippler.drawing.store import DotStore, Rows, union
from stippler.drawing.style import Style

if TYPE_CHECKING:
    from stippler.drawing.line_meetings import LineMeetings


class Document:
    """All changes of a drawing go through here; for one thread.

    A person's changes are made within a stroke, between `begin` and `commit` or `cancel`; a
    stroke is one step of the history, whatever kinds of values it changes. The worker's results
    are merged into a run, which is one step too, and leave alone whatever a person has changed
    since the run began; so strokes and a run may go on at the same time, and can be undone in any
    state of the run. Dots that a worker makes are a draft: they stand among the others as they
    come, and their end is one step.

    Parameters
    ----------
    drawing : Drawing
        Its `dots` are replaced by views that this object keeps up to date.

    Attributes
    ----------
    changes : Changes
        Whoever follows this document asks it with a cursor of their own.
    """

    def __init__(self, drawing: Drawing, budget_bytes: int = BUDGET_BYTES) -> None:
        self.drawing = drawing
        self.history = History(budget_bytes)
        self.changes = Changes()
        self._store = DotStore(drawing.dots, drawing.first_free(records.DOT))
        self._stroke: Recorder | None = None
        self._run: Run | None = None
        self._draft: Draft | None = None
        self._derived = Derived(drawing)
        self._followers: list[Follower] = []
        self._replayed: Edit = Edit("")
        self._replayed_step: Step | None = None
        drawing.dots = self._store.dots
        self._find_by_place()

    @property
    def dots(self) -> Dots:
        """The dots as they are, those of a draft among them; to be read only."""
        return self._store.dots

    @property
    def revision(self) -> int:
        """Grows with every change."""
        return self.changes.now

    @property
    def partition(self) -> Partition:
        """Which area owns which part of the page."""
        return self._derived.partition

    @property
    def meetings(self) -> LineMeetings | None:
        """What lines ask of dots that are laid or moved; None without lines."""
        return self._derived.meetings

    @property
    def n_bytes(self) -> int:
        """Memory all this takes, without the history."""
        return self._store.n_bytes + self._index.n_bytes

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
        """Begin a stroke; not while a draft is made."""
        if self._draft is not None:
            raise ValueError("dots are being made")
        if self._stroke is not None:
            raise ValueError("a stroke has begun already")
        self._stroke = Recorder(self.drawing, self._store, label)

    def move(self, rows: Rows, position_mm: NDArray[np.float64], *, hops: bool = False) -> None:
        """Move the free ones of some dots, as far as their areas and lines let them.

        With `hops`, as when a person takes them, they may end beyond a line that dots keep off.
        """
        free = ~self.dots.is_fixed(rows) & self._yielding(rows)
        if not free.all():
            rows, position_mm = rows[free], position_mm[free]
        old = self.dots.position_mm[rows]
        new = self.partition.confine(old, position_mm, self.dots.area[rows])
        if (lines := self.meetings) is not None:
            area, confine = self.dots.area[rows], self.partition.confine
            new = lines.stopped(old, new, lambda at: confine(old, at, area), hops=hops)
        self.change("position_mm", rows, new)

    def change(self, field: str, rows: Rows, values: NDArray[np.generic]) -> None:
        """Set one field of some rows; dots of locked areas only change hands."""
        if self._derived.locked is not None and field != "area":
            kept = self._yielding(rows)
            rows, values = rows[kept], values[kept]
        if not len(rows):
            return
        self._in_stroke().change(field, rows, values)
        self._note(rows, rows, moved=field == "position_mm")

    def insert(self, dots: Dots) -> Rows:
        """Add dots, which get new ids and the areas they lie in.

        Those that lie off the page, or in locked areas, are not added.
        """
        stroke = self._in_stroke()
        area = self.partition.area_at(dots.position_mm)
        if self._derived.locked is not None:
            area[np.isin(area, self._derived.locked)] = NOWHERE
        if (area == NOWHERE).any():
            dots = dots.take(area != NOWHERE)
        dots.area[:] = area[area != NOWHERE]
        if not len(dots):
            return np.empty(0, np.int64)
        dots.id[:] = self._store.new_ids(len(dots))
        rows = stroke.insert(dots)
        self._note(rows, rows, moved=True)
        return rows

    def remove(self, rows: Rows) -> None:
        """Remove dots, but for those of locked areas; rows of others change."""
        rows = rows[self._yielding(rows)]
        if not len(rows):
            return
        touched = self._in_stroke().remove(union([rows], len(self.dots)))
        self._note(touched, touched[:0], moved=True)

    def _yielding(self, rows: Rows) -> NDArray[np.bool_]:
        """Return which rows are of areas that are not locked."""
        return self._derived.are_unlocked(self.dots.area[rows])

    def set(self, kind: str, i: int, value: Any) -> None:
        """Set a value of another kind than dots, as `stippler.drawing.records` lists them.

        Parameters
        ----------
        i : int
            0 for page and reference.
        value : object or None
            None takes it out.
        """
        if value is None and kind == records.PAGE:
            raise ValueError("there is always a page")
        self._in_stroke().set(kind, i, value)
        self._note_value(kind, i)

    def add(self, kind: str, value: Any) -> int:
        """Add a value under a new id, which is returned."""
        i = self.drawing.first_free(kind)
        self.set(kind, i, value)
        self.drawing.next_id[kind] = i + 1
        return i

    def own_by_place(self, rows: Rows) -> Rows:
        """Give dots to the areas that they lie in, after outlines changed; return who moved.

        Those that lie in none keep theirs.
        """
        area = self.partition.area_at(self.dots.position_mm[rows])
        moves = (area != self.dots.area[rows]) & (area != NOWHERE)
        self.change("area", rows[moves], area[moves])
        return np.asarray(rows[moves])

    def commit(self, *, of_job: bool = False) -> Edit:
        """End the stroke; it is a step of the history, if it has changed anything."""
        edit = self._in_stroke().finish()
        self._stroke = None
        if not edit.is_empty:
            self._push(edit, of_job=of_job)
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

        Raises
        ------
        HistoryError
            If the step lay on disk and is lost; it and all older ones are gone, and nothing else.
        """
        self._no_stroke()
        step = self.history.undone
        if step is not None and step.is_open:
            self.end_run()
            if self.history.undone is not step:
                return True
        n_done = self.history.n_done
        return self._step(self.history.undo(), UNDONE, n_done)

    def redo(self) -> bool:
        """Do the last undone step again; return whether there was one.

        Raises
        ------
        HistoryError
            If the step lay on disk and is lost; it and all later ones are gone, and nothing else.
        """
        self._no_stroke()
        n_done = self.history.n_done
        return self._step(self.history.redo(), REDONE, n_done)

    def steps(self) -> list[Step] | None:
        """Return copies of all steps as they are now, a run's among them, for a file to keep.

        None while a stroke or a draft goes on: what they have changed is no step yet.
        """
        if self._stroke is not None or self._draft is not None:
            return None
        run, steps = self._run, self.history.steps
        known = [run.edit() if run is not None and s is run.step else s.edit for s in steps]
        return [replace(s, edit=edit) for s, edit in zip(steps, known, strict=True)]

    def _step(self, edit: Edit | None, what: str, n_before: int) -> bool:
        if edit is not None:
            try:
                self._apply(edit)
            except BaseException:  # for want of memory: it was not done
                self.history.go_to(n_before)
                raise
            self._tell(Entry(what, edit))
        return edit is not None

    # --- the worker's runs ------------------------------------------------------------------

    @property
    def in_run(self) -> bool:
        """Whether results are still being merged."""
        return self._run is not None

    def begin_run(self, label: str) -> Dots:
        """Begin a run; return a copy of the dots for the worker, in the order of their ids."""
        self._no_stroke()
        self.end_run()
        dots = self.dots.by_id()
        self._run = Run(self.history.open(label, of_job=True), dots, self.changes.now)
        self._tell(Entry(OPENED, Edit(label)))
        return dots

    def merge(self, position_mm: NDArray[np.float64], holding: Holding | None = None) -> int:
        """Move the dots of the run to a result's positions; return how many free ones moved.

        Dots that are gone, fixed, or changed by a person since the run began stay as they are.
        """
        if self._run is None:
            return 0
        limits = self._derived.limits(self._run.base)
        n, furthest_mm = self._run.merge(self._store, position_mm, limits, holding)
        self._index.drift(furthest_mm)
        self.changes.note_places()
        return n

    def merge_radii(self, radius_mm: NDArray[np.float32]) -> int:
        """Give the dots of the run a result's radii, as `merge` does; return how many got one."""
        if self._run is None:
            return 0
        n = self._run.size(self._store, radius_mm, self._derived.locked)
        self.changes.note_places()
        return n

    def end_run(self) -> None:
        """End the run; it is a step of the history, if it has changed anything."""
        if self._run is not None:
            self.tell_run()
            run, self._run = self._run, None
            edit = run.edit()
            self.history.fill(run.step, edit)
            self._tell(Entry(ENDED))
            if not edit.is_empty:
                self.changes.note_all(len(self.dots))  # what followers left out meanwhile

    # --- drafts -----------------------------------------------------------------------------

    @property
    def in_draft(self) -> bool:
        """Whether dots are being made."""
        return self._draft is not None

    def begin_draft(
        self,
        label: str,
        area: int,
        style: Style,
        reference: Reference | None = None,
        *,
        keeps_fixed: bool = False,
    ) -> None:
        """Begin to make the dots of an area anew; those that it has give way at once.

        A draft that was being made is dropped.

        Parameters
        ----------
        style : Style
            What they are made with, which the area has from now on.
        reference : Reference or None
            What they are made from; None leaves the drawing's.
        keeps_fixed : bool
            Whether its fixed dots stay.
        """
        self._no_stroke()
        self.end_run()
        self.drop_draft()
        gives_way = self.dots.area == area
        if keeps_fixed:
            gives_way &= ~self.dots.fixed
        replaced = np.flatnonzero(gives_way)
        self._draft = Draft(self.drawing, self._store, label, area, replaced, style)
        i = self.drawing.areas[area].style
        for kind, k, value in ((records.STYLE, i, style), (records.REFERENCE, 0, reference)):
            if value is not None and value != self.drawing.get(kind, k):
                self._draft.set(kind, k, value)
                self._note_value(kind, k)
        self._renewed()

    def drop_draft(self) -> None:
        """End the draft, if there is one, and take back all it has changed."""
        if self._draft is not None:
            draft, self._draft = self._draft, None
            self._apply(draft.finish().inverse())

    def draft(self, position_mm: NDArray[np.float64], radius_mm: NDArray[np.float32],
              holding: Holding | None = None) -> None:  # fmt: skip
        """Show the dots of the draft as they are now; ignored where there is none."""
        if self._draft is None:
            return
        if self._draft.show(position_mm, radius_mm, holding):
            self._index.lose()
            self.changes.note_places()
        else:
            self._renewed()

    @property
    def draft_ids(self) -> NDArray[np.int64]:
        """The dots of the draft, in the order in which they were given; none without one."""
        return np.empty(0, np.int64) if self._draft is None else self._draft.ids

    def draft_sizes(self, ids: NDArray[np.int64], old_mm: NDArray[np.float32],
                    new_mm: NDArray[np.float32]) -> None:  # fmt: skip
        """Give other dots than the draft's new sizes as a part of it; ignored where there is none.

        Those that are gone, locked, or no longer of the old size stay as they are.
        """
        if self._draft is None:
            return
        rows = self.rows(ids)
        stays = rows < 0
        stays[~stays] = (self.dots.radius_mm[rows[~stays]] != old_mm[~stays]) | ~self._yielding(
            rows[~stays]
        )
        self._draft.size_others(rows[~stays], new_mm[~stays])
        self._note(rows[~stays], rows[~stays], moved=False)

    def end_draft(self) -> Edit | None:
        """End the draft; it is one step, or how the drawing begins where nothing was there."""
        if self._draft is None:
            return None
        draft, self._draft = self._draft, None
        edit = draft.finish()
        self._renewed()
        if edit.is_empty:
            return edit
        if self.history.steps or len(edit.dots.removed):
            self._push(edit, of_job=True)
        else:
            self._tell(Entry(MADE, edit))
        return edit

    # --- who follows ------------------------------------------------------------------------

    def follow(self, follower: Follower) -> None:
        """Call a function with each `Entry` from now on; `replay` of all makes the same drawing."""
        self._followers.append(follower)

    def tell_run(self) -> None:
        """Tell followers what the run has changed so far; a journal asks for it now and then."""
        if self._run is not None and self._followers:
            part = self._run.part()
            if not part.is_empty:
                self._tell(Entry(PART, part))

    def replay(self, entry: Entry) -> None:
        """Do what an entry tells of, to the state that it was told in."""
        edit = entry.edit
        if entry.what == OPENED and edit is not None:
            self._replayed_step, self._replayed = self.history.open(edit.label, of_job=True), edit
        elif entry.what == ENDED and self._replayed_step is not None:
            self.history.fill(self._replayed_step, self._replayed)
        elif entry.what in (UNDONE, REDONE) and edit is not None:
            self._apply(edit)
            self.history.go_to(entry.n_done)
        elif edit is not None:
            self._apply(edit)
            if entry.what == PART:
                self._replayed = self._replayed.then(edit)
            elif entry.what == STEP:
                self._push(edit, of_job=entry.of_job)

    # --- inside -----------------------------------------------------------------------------

    def _push(self, edit: Edit, *, of_job: bool) -> None:
        self.history.push(edit, of_job=of_job)
        self._tell(Entry(STEP, edit, of_job))

    def _tell(self, entry: Entry) -> None:
        entry = replace(entry, n_done=self.history.n_done)
        for follower in self._followers:
            follower(entry)

    def _apply(self, edit: Edit) -> None:
        rows, edited = self._store.apply(edit.dots)
        for kind, i in edit.next_id.items():
            self.drawing.next_id[kind] = max(i, self.drawing.next_id.get(kind, 0))
        self._store.next_id = max(self._store.next_id, edit.next_id.get(records.DOT, 0))
        for kind, values in edit.values.items():
            for i, (_, after) in values.items():
                self.drawing.put(kind, i, after)
                self._note_value(kind, i)
        if not edit.dots.is_empty:
            changes = edit.dots.changes
            came = len(edit.dots.removed) or len(edit.dots.inserted)
            self._note(rows, edited, moved=bool("position_mm" in changes or came))

    def _note(self, rows: Rows, edited: Rows, *, moved: bool) -> None:
        """Take note of changed rows, and of the rows of the dots that a person changed."""
        self._use_dots()
        self.changes.note_rows(rows, len(self.dots))
        self._store.edited[edited] = self.changes.now
        if moved:
            self._index.update(rows, self.dots.position_mm)

    def _note_value(self, kind: str, i: int) -> None:
        self.changes.note_record(kind, i)
        self._derived.note(kind, i, self.changes.now)
        if kind == records.PAGE:
            self._find_by_place()

    def _use_dots(self) -> None:
        self.drawing.dots = self._store.dots
        self.drawing.next_id[records.DOT] = self._store.next_id

    def _renewed(self) -> None:
        """Take note that dots may be others altogether."""
        self._use_dots()
        self._index.lose()
        self.changes.note_all(len(self.dots))

    def _find_by_place(self) -> None:
        page = self.drawing.page
        self._index = DotIndex(self.dots.position_mm, (page.width_mm, page.height_mm))

    def _in_stroke(self) -> Recorder:
        if self._stroke is None:
            raise ValueError("no stroke has begun")
        return self._stroke

    def _no_stroke(self) -> None:
        if self._stroke is not None:
            raise ValueError("a stroke has begun and not ended")
