"""Stippling: from a picture, or with the dots that are there. The worker imports what it needs."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import TYPE_CHECKING

from stippler.drawing.style import DEFAULT_DOTS
from stippler.jobs import preflight
from stippler.jobs.preparing import prepared_kernels
from stippler.jobs.reading import read_source
from stippler.jobs.work import PREPARE, READ, Source, Work

if TYPE_CHECKING:
    from shapely.geometry import MultiPolygon, Polygon

    from stippler.drawing.drawing import Drawing
    from stippler.drawing.reference import Reference
    from stippler.drawing.style import Style
    from stippler.stippling.fill import Filling
    from stippler.stippling.task import Task


def stipple_picture(
    source: Source, style: Style, reference: Reference | None, *, is_warm: Callable[[], bool]
) -> Iterator[Work]:
    """Stipple a picture from the file, or from its reference where it has been read before.

    Where the kernels are not compiled yet (`is_warm`), a process of its own does that first: it
    can be ended at any time, and leaves the window's thread alone.
    """
    notes: tuple[str, ...] = ()
    if reference is None:
        yield Work(READ)
        reference, notes = read_source(source)
        yield Work(READ, 1, 1, reference.adjusted(source.adjustment), notes=notes)
    reference = reference.adjusted(source.adjustment)
    n_dots, n_pixels = style.n_dots or DEFAULT_DOTS, reference.source.levels.size
    note = preflight.warning("stipple", n_dots, n_pixels)
    if not is_warm():
        for n_ready, n_kernels in prepared_kernels():
            yield Work(PREPARE, n_ready, n_kernels, reference, note=note, notes=notes)
    from stippler.brushes.warm_up import warm_up_brushes
    from stippler.stippling.pipeline import run
    from stippler.stippling.task import Task

    for progress in run(Task(style, reference)):
        yield Work(
            progress.stage,
            progress.done,
            progress.total,
            reference,
            progress,
            note=note,
            notes=notes,
        )
    warm_up_brushes()


def go_on(task: Task) -> Iterator[Work]:
    """Go on with a stippling whose dots have become the drawing's; sizes come with the last."""
    from stippler.stippling.pipeline import run
    from stippler.stippling.progress import DONE

    yield Work("relax", task.n_done, task.style.iterations)
    for made in run(task):
        solved = made.radius_mm if made.stage == DONE else None
        yield Work(made.stage, made.done, made.total, None, None, made.position_mm, solved)


def relax_drawing(
    drawing: Drawing, style: Style, steps: int, areas: Collection[int] | None = None
) -> Iterator[Work]:
    """Relax the free dots of a drawing that nobody else changes, each within what its area owns.

    Spaced evenly by the tone they keep it: see `stippler.stippling.relax_all`. Dots that lie in
    another area's part stay where they are; so do those of other areas than the ones given.
    """
    yield Work("relax", 0, steps)
    import numpy as np

    from stippler.drawing.dots import NO_CURVE
    from stippler.drawing.run import Holding
    from stippler.stippling.pipeline import run
    from stippler.stippling.progress import DONE
    from stippler.stippling.tasks import relaxing
    from stippler.stippling.tone_of_run import sized_again

    task, rows, notes = relaxing(drawing, style, steps, areas)
    yield Work("relax", 0, steps, notes=notes)
    for made in run(task):
        moved = drawing.dots.position_mm.copy()
        moved[rows] = made.position_mm[: len(rows)]
        sizes = None
        if made.stage == DONE:
            sizes = drawing.dots.radius_mm.copy()
            sizes[rows] = made.radius_mm[: len(rows)]
            is_solved = sizes != drawing.dots.radius_mm
            if len(drawing.areas) > 1 and is_solved.any():
                sizes = sized_again(drawing, moved, sizes, is_solved)
        held = made.holding
        if held is not None:
            curve, along = np.full(len(moved), NO_CURVE, np.int32), np.zeros(len(moved))
            curve[rows], along[rows] = held.curve, held.along_mm
            held = Holding(curve, along)
        yield Work(made.stage, made.done, made.total, moved_mm=moved, radius_mm=sizes, held=held)


def fill(
    outlines: Sequence[Polygon | MultiPolygon], values: Filling, drawing: Drawing | None = None
) -> Iterator[Work]:
    """Find places for dots in areas that have no picture, as many in each.

    Those within reach of lines that a drawing's dots adhere to line up on these.
    """
    yield Work("fill", 0, len(outlines))
    import numpy as np

    from stippler.stippling.initial_points import fill_area
    from stippler.stippling.new_on_lines import filled_up

    found = [np.empty((0, 2))]
    for k, outline in enumerate(outlines, start=1):
        found.append(fill_area(outline, values.n_dots, values.arrangement, values.seed))
        if k < len(outlines):
            yield Work("fill", k, len(outlines))
    points, held = np.concatenate(found), None
    if drawing is not None and drawing.lines:
        points, held = filled_up(drawing, points, outlines)
    yield Work("fill", len(outlines), len(outlines), points_mm=points, held=held)
