"""Processing areas, one after the other; all others stay untouched."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from stippler.errors import GeometryError
from stippler.jobs.work import Work

if TYPE_CHECKING:
    from stippler.drawing.document import Document
    from stippler.stippling.progress import Progress
    from stippler.stippling.task import Task
    from stippler.stippling.tasks import AreaTask


def tasks_of(document: Document, areas: Sequence[int]) -> tuple[list[AreaTask], tuple[str, ...]]:
    """Return what stippling some areas of a document takes, and what there is to say of others.

    Areas that see through their borders have one task together. Those that have no room for dots,
    for others or a pattern leave them none, are left out, so that the rest can go on.

    Raises
    ------
    ParameterError
        If there is no such area, or no picture.
    GeometryError
        If none is left.
    """
    from stippler.stippling.border_policies import BorderPolicies, part_of_all
    from stippler.stippling.part_of_area import left_out, none_left
    from stippler.stippling.tasks import box_around, stippling

    drawing, partition = document.drawing, document.partition
    policies = BorderPolicies(drawing, partition)
    tasks: list[AreaTask] = []
    missed: dict[tuple[int, ...], GeometryError] = {}
    for group in policies.joined(areas):
        near = None
        if all(k in drawing.areas for k in group):
            part = part_of_all(partition, group)
            near = None if part.is_empty else document.in_box(box_around(part, drawing))
        try:
            tasks.append(stippling(drawing, group, partition, near, policies))
        except GeometryError as error:
            missed[group] = error
    if missed and not tasks:
        raise none_left(missed.values())
    return tasks, tuple(left_out(drawing, group, error) for group, error in missed.items())


def process_areas(tasks: Sequence[AreaTask], *, snapshots: bool = True) -> Iterator[Work]:
    """Stipple areas one after the other; each result tells of all that are done.

    New dots keep clear of those that were made just before, too. Once all are made, sizes of areas
    whose tone is off, for others' dots reach into them, are found anew; so results may tell of
    other sizes of areas that were done before. Areas that see others do not wait for that.
    """
    from stippler.stippling.pipeline import run
    from stippler.stippling.progress import DONE
    from stippler.stippling.tone_of_run import sized

    finished: tuple[tuple[int, Progress], ...] = ()
    for k, one in enumerate(tasks):
        for progress in run(_beside(one, finished), snapshots=snapshots):
            area, shown = one.of_first(progress)
            if progress.stage == DONE:
                finished = (*finished, *one.of_each(progress))
                if k + 1 == len(tasks):
                    finished = sized(tasks, finished)
                elif one.meets_others:
                    finished = sized([t for t in tasks[: k + 1] if t.is_beside(one)], finished)
                shown = dict(finished)[area]
            yield Work(progress.stage, progress.done, progress.total, progress=shown,
                       area=area, finished=finished)  # fmt: skip


def _beside(one: AreaTask, finished: Sequence[tuple[int, Progress]]) -> Task:
    import numpy as np

    position, radius = one.task.neighbours_mm, one.task.neighbours_radius_mm
    if not finished or position is None or radius is None:
        return one.task
    stay = ~np.isin(one.neighbour_area, [area for area, _ in finished])
    made = [progress for _, progress in finished]
    return replace(
        one.task,
        neighbours_mm=np.concatenate((position[stay], *(one.position_mm for one in made))),
        neighbours_radius_mm=np.concatenate((radius[stay], *(one.radius_mm for one in made))),
    )


def process_now(document: Document, areas: Sequence[int]) -> tuple[str, ...]:
    """Stipple areas of a document, each as a step of its history; return what they fall short of.

    Raises
    ------
    ParameterError, GeometryError
        As `tasks_of`; then nothing has changed.
    """
    from stippler.stippling.progress import notes_on

    tasks, left = tasks_of(document, areas)
    notes = list(left)
    results = list(process_areas(tasks, snapshots=False))
    for area, made in results[-1].finished if results else ():
        begin(document, area)
        document.draft(made.position_mm, made.radius_mm, made.holding)
        document.end_draft()
        notes += notes_on(made, f"area {document.drawing.areas[area].name!r}")
    return tuple(notes)


def begin(document: Document, area: int) -> None:
    """Begin the draft of an area's new dots; its fixed dots stay."""
    drawing = document.drawing
    name = drawing.areas[area].name
    document.begin_draft(f"Process {name}", area, drawing.style_of(area), keeps_fixed=True)
