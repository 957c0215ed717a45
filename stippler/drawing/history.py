"""Undo and redo without limit: edits in memory up to a budget, older ones on disk."""

from __future__ import annotations

import logging
import tempfile
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NoReturn

import numpy as np

from stippler.drawing.dot_edit import DotEdit
from stippler.drawing.edit import Edit
from stippler.errors import HistoryError

BUDGET_BYTES = 256 * 2**20

_log = logging.getLogger("stippler")


@dataclass(slots=True, eq=False, weakref_slot=True)
class Step:
    """One line of the history.

    Attributes
    ----------
    edit : Edit or None
        None while the step is still being made, or lies on disk.
    of_job : bool
        Whether no hand but a job has made it, which can make it again.
    rest : Edit or None
        What stays in memory of an edit whose dots lie on disk.
    """

    label: str
    n_dots: int = 0
    n_bytes: int = 0
    edit: Edit | None = None
    path: Path | None = None
    of_job: bool = False
    rest: Edit | None = None

    @property
    def is_open(self) -> bool:
        """Whether the step is still being made."""
        return self.edit is None and self.path is None


def edit_of(step: Step) -> Edit | None:
    """Return a step's edit, from disk if it lies there; None if it is lost. The step stays.

    Raises
    ------
    ValueError
        If the step is still being made.
    """
    if step.edit is not None:
        return step.edit
    if step.path is None or step.rest is None:
        raise ValueError("a step that is still being made cannot be undone")
    try:
        with np.load(step.path) as arrays:
            return replace(step.rest, dots=DotEdit.from_arrays(dict(arrays)))
    except (OSError, EOFError, ValueError, KeyError, zipfile.BadZipFile) as error:
        _log.warning("a step of the history cannot be read (%s)", error)
        return None


class History:
    """Steps that were done, and steps that were undone and can be done again.

    Parameters
    ----------
    budget_bytes : int
        Of memory; beyond it the steps furthest from now lie in a temporary folder, which goes
        when the history does.

    Attributes
    ----------
    n_bytes : int
        Memory the steps take.
    n_done : int
        The first `n_done` of `steps` are in effect.
    """

    def __init__(self, budget_bytes: int = BUDGET_BYTES) -> None:
        self._budget = budget_bytes
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        self._n_files = 0
        self._can_spill = True
        self.n_bytes = 0
        self.steps: list[Step] = []
        self.n_done = 0

    @property
    def undone(self) -> Step | None:
        """The step that undoing would take back."""
        return self.steps[self.n_done - 1] if self.n_done else None

    @property
    def redone(self) -> Step | None:
        """The step that redoing would do again."""
        return self.steps[self.n_done] if self.n_done < len(self.steps) else None

    def push(self, edit: Edit, *, of_job: bool = False) -> None:
        """Add a step that has just been done; what was undone is gone."""
        self.fill(self.open(edit.label, of_job=of_job), edit)

    def open(self, label: str, *, of_job: bool = False) -> Step:
        """Add a step that is still being made; what was undone is gone."""
        for step in self.steps[self.n_done :]:
            self._forget(step)
        del self.steps[self.n_done :]
        step = Step(label, of_job=of_job)
        self.steps.append(step)
        self.n_done += 1
        return step

    def fill(self, step: Step, edit: Edit) -> None:
        """Give an open step its edit; one that changes nothing is taken out of the history."""
        if edit.is_empty:
            self.n_done -= self.steps.index(step) < self.n_done
            self.steps.remove(step)
            return
        step.label, step.n_dots, step.n_bytes = edit.label, edit.n_dots, edit.n_bytes
        self._hold(step, edit)
        self._spill()

    def undo(self) -> Edit | None:
        """Return the edit that takes the last step back, and count it as undone.

        Raises
        ------
        HistoryError
            If it lay on disk and is lost. It and all older steps are gone then.
        """
        step = self.undone
        if step is None:
            return None
        edit = self._edit(step)
        if edit is None:
            self._lose(slice(0, self.n_done), -1, "older")
        self.n_done -= 1
        self._spill()
        return edit.inverse()

    def redo(self) -> Edit | None:
        """Return the edit that does the last undone step again, and count it as done.

        Raises
        ------
        HistoryError
            If it lay on disk and is lost. It and all later steps are gone then.
        """
        step = self.redone
        if step is None:
            return None
        edit = self._edit(step)
        if edit is None:
            self._lose(slice(self.n_done, None), 0, "later")
        self.n_done += 1
        self._spill()
        return edit

    def go_to(self, n_done: int) -> None:
        """Count so many steps as done, as far as there are so many; nothing is undone or done."""
        self.n_done = min(max(n_done, 0), len(self.steps))

    def restore(self, steps: Iterable[tuple[Edit, bool]], n_done: int) -> None:
        """Begin with steps made elsewhere, each with whether a job made it; nothing is done."""
        for edit, of_job in steps:
            self.push(edit, of_job=of_job)
        self.go_to(n_done)

    def close(self) -> None:
        """Forget all, and what lies on disk."""
        self.steps, self.n_done, self.n_bytes = [], 0, 0
        if self._folder is not None:
            self._folder.cleanup()
            self._folder = None

    def _hold(self, step: Step, edit: Edit) -> None:
        step.edit = edit
        self.n_bytes += step.n_bytes

    def _edit(self, step: Step) -> Edit | None:
        """Return a step's edit, from disk if it lies there; None if it is lost."""
        if step.edit is not None:
            return step.edit
        edit = edit_of(step)
        if edit is not None:
            self._forget(step)
            self._hold(step, edit)
        return edit

    def _lose(self, which: slice, nearest: int, where: str) -> NoReturn:
        """Let go of steps that cannot be done any more, and say so; name the one nearest to now."""
        lost = self.steps[which]
        for step in lost:
            self._forget(step)
        del self.steps[which]
        if where == "older":
            self.n_done = 0
        more = f" and {len(lost) - 1:,} {where}" if len(lost) > 1 else ""
        raise HistoryError(
            f"“{lost[nearest].label}”{more} lay in a temporary folder that is gone; "
            "the drawing is as it was",
            "history",
        )

    def _spill(self) -> None:
        """Write the steps furthest from now to disk until the rest fits the budget."""
        if self.n_bytes <= self._budget:
            return
        now = self.n_done - 0.5
        far_first = sorted(range(len(self.steps)), key=lambda i: abs(i - now), reverse=True)
        for i in far_first:  # pragma: no branch: the last ones are near, and end it
            step = self.steps[i]
            if self.n_bytes <= self._budget or not self._can_spill or abs(i - now) < 1.0:
                return
            if step.edit is not None:
                self._write(step, step.edit)

    def _write(self, step: Step, edit: Edit) -> None:
        try:
            if self._folder is None or not Path(self._folder.name).is_dir():
                self._folder = tempfile.TemporaryDirectory(prefix="stippler-history-")
            path = Path(self._folder.name) / f"{self._n_files}.npz"
            np.savez(path, **dict(edit.dots.arrays()))  # type: ignore[arg-type]
        except OSError as error:
            self._can_spill = False
            _log.warning("the history stays in memory: it cannot be written (%s)", error)
            return
        self._n_files += 1
        self._forget(step)
        step.path, step.rest = path, replace(edit, dots=DotEdit.none())

    def _forget(self, step: Step) -> None:
        """Let go of a step's edit, in memory and on disk."""
        if step.edit is not None:
            step.edit = None
            self.n_bytes -= step.n_bytes
        if step.path is not None:
            step.path.unlink(missing_ok=True)
            step.path = step.rest = None
