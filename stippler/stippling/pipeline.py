"""The pipeline: a list of stages, chosen by what is asked for, that each advance a draft."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from stippler.drawing.page import Page
from stippler.stippling.disorder import jitter, mottle
from stippler.stippling.draft import Draft
from stippler.stippling.first_dots import first_dots
from stippler.stippling.last_stages import (
    onto_ink,
    onto_lines,
    part,
    radii,
    rim,
    shortfall_of,
    trim,
)
from stippler.stippling.progress import RELAXED, Progress, Step
from stippler.stippling.run_relaxation import relaxed
from stippler.stippling.task import RELAX, STIPPLE, Task

if TYPE_CHECKING:
    from stippler.stippling.relax_all import StandingDraft

Advancing = TypeVar("Advancing", Draft, "StandingDraft")

Stage = Callable[[Draft, bool], Iterator[Step]]
"""Advances a draft; yields after each piece of work, with whether anybody looks at that."""


def run(task: Task, *, snapshots: bool = True) -> Iterator[Progress]:
    """Carry out a task; yield a snapshot after every piece of work.

    Close the iterator to cancel. The result depends on the task and nothing else.

    Parameters
    ----------
    task : Task
    snapshots : bool
        Whether to fill the arrays of all snapshots, or only those of the last.

    Yields
    ------
    Progress
        The last one has the stage "done".
    """
    if task.kind == RELAX:
        from stippler.stippling.relax_all import StandingDraft, size_again, space

        yield from _through((space, size_again), StandingDraft.of(task), snapshots)
        return
    reference = task.reference
    assert reference is not None, "only relaxation does without a reference"
    Page(reference.width_mm, reference.height_mm)  # too high a page is refused before the work
    draft = Draft.of(task)
    yield from _through(stages_of(draft), draft, snapshots)


def _through(
    stages: Iterable[Callable[[Advancing, bool], Iterator[Step]]], draft: Advancing, snapshots: bool
) -> Iterator[Progress]:
    for stage in stages:
        for step in stage(draft, snapshots):
            yield draft.progress(step, snapshots)
    yield draft.finished()


def stages_of(draft: Draft) -> list[Stage]:
    """Return the stages that a draft has to go through.

    One whose dots are there enters at relaxation, and ends with just these dots.
    """
    style, task = draft.style, draft.task
    is_new, by_tone = task.kind == STIPPLE, style.sizes == "tone"
    chosen: list[tuple[Stage, bool]] = [
        (first_dots, is_new),
        (relax, style.is_relaxed and task.n_done < style.iterations),
        (trim, is_new),
        (part, by_tone and style.is_relaxed and style.weighted
         and task.n_done < style.iterations),
        (rim, by_tone and style.weighted and style.iterations > 0 and is_new
         and draft.ground.evens_rim),
        (jitter, is_new and style.jitter > 0.0),
        (onto_ink, True),
        (onto_lines, task.lines is not None),
        (radii, by_tone),
        (mottle, style.size_noise > 0.0),
        (shortfall_of, is_new),
    ]  # fmt: skip
    return [stage for stage, counts in chosen if counts]


def relax(draft: Draft, watched: bool) -> Iterator[Step]:
    """Even out the dots by the steps that are left."""
    if not len(draft.points):
        return
    there = np.concatenate((draft.ground.beyond, draft.stand))
    n, n_done = len(there), draft.task.n_done
    fixed = _still(draft, n)
    points = np.concatenate((there, draft.points)) if n else draft.points
    steps = relaxed(draft.ground, points, fixed, n_done, watched)
    for k, (moved, movement_mm) in enumerate(steps, start=n_done + 1):
        draft.points = moved[n:] if len(moved) else draft.points
        yield Step(RELAXED, k, draft.style.iterations, movement_mm)


def _still(draft: Draft, n: int) -> np.ndarray[tuple[int], np.dtype[np.bool_]] | None:
    """Tell which dots stay where they are: the first n do.

    On a page that went on without its bleed those beside the edge do: they would else draw away
    from it and leave a light rim.
    """
    fixed = draft.fixed
    if n:
        free = np.zeros(len(draft.points), np.bool_) if fixed is None else fixed
        return np.concatenate((np.ones(n, np.bool_), free))
    if not draft.goes_on or draft.task.parts_mm:
        return fixed
    raster = draft.raster
    w, h = raster.size_mm
    at = draft.points * raster.pixel_mm
    to_edge = np.minimum(np.minimum(at[:, 0], w - at[:, 0]), np.minimum(at[:, 1], h - at[:, 1]))
    beside = to_edge < raster.bleed * raster.pixel_mm
    return beside if fixed is None else beside | fixed
