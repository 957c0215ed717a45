"""Stippling carried on over dots that a person paints on: none comes, none goes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.reference import Reference
from stippler.stippling.density import DensityField
from stippler.stippling.plan import Plan
from stippler.stippling.relax import Relaxation
from stippler.stippling.sheet import Sheet
from stippler.stippling.stipple import Progress, sheet_for
from stippler.stippling.tone import solve_radii


def carry_on(
    reference: Reference, plan: Plan, position_mm: NDArray[np.float64], n_done: int
) -> Iterator[Progress]:
    """Relax a page's dots for the steps that are left, then solve their radii for the tone.

    The dots of the bleed are gone. Those beside it hold still: they would else draw away from the
    edge of the page and leave a light rim.

    Yields
    ------
    Progress
        As `stages` does, with the dots in the order given; the stage is "relax", then "tone",
        and radii are those of the rule until the last, which has the stage "done".
    """
    sheet = sheet_for(reference, plan)
    w, h = sheet.size_mm
    points = np.clip(position_mm, 0.0, (w, h)) / sheet.pixel_mm
    for k, moved in enumerate(_relaxed(sheet, plan, points, n_done), start=n_done + 1):
        points = moved
        shown = sheet.on_page(points, sheet.radii(points))
        yield Progress("relax", k, plan.iterations, *shown)
    inked = sheet.onto_ink(points)
    points = inked if len(inked) == len(points) else points
    radii = sheet.radii(points)
    for share, radii in solve_radii(points, sheet.darkness, sheet.rule):
        yield Progress("tone", round(1000 * share), 1000, *sheet.on_page(points, radii))
    yield Progress("done", 1, 1, *sheet.on_page(points, radii))


def _relaxed(
    sheet: Sheet, plan: Plan, points: NDArray[np.float64], n_done: int
) -> Iterator[NDArray[np.float64]]:
    """Yield the dots after each step that is left, in pixels."""
    if n_done >= plan.iterations or not len(points):
        return
    at = points * sheet.pixel_mm
    w, h = sheet.size_mm
    to_edge = np.minimum(np.minimum(at[:, 0], w - at[:, 0]), np.minimum(at[:, 1], h - at[:, 1]))
    beside = to_edge < sheet.bleed * sheet.pixel_mm
    density = sheet.density()
    weight = np.square(density / density.max()) if plan.weighted else np.sign(density)
    x, y = sheet.outline_mm()[0]
    field = DensityField(weight, sheet.pixel_mm, (float(x), float(y)))
    page = np.array([(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)])
    engine = Relaxation(at, page, beside, density=field)
    for _ in range(n_done, plan.iterations):
        engine.step()
        yield np.asarray(engine.points) / sheet.pixel_mm
