"""Stippling carried on over dots that a person paints on: none comes, none goes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.default_number import with_number
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.postprocess import part_close
from stippler.stippling.radii import solve_radii
from stippler.stippling.run_relaxation import relaxed
from stippler.stippling.stipple import Progress, raster_for


def carry_on(
    reference: Reference,
    style: Style,
    position_mm: NDArray[np.float64],
    radius_mm: NDArray[np.float32],
    n_done: int,
) -> Iterator[Progress]:
    """Relax a page's dots for the steps that are left, then solve their radii for the tone.

    Sizes by region stay with their dots. The dots of the bleed are gone. Those beside it hold
    still: they would else draw away from the edge of the page and leave a light rim.

    Yields
    ------
    Progress
        As `stages` does, with the dots in the order given; the stage is "relax", then "tone",
        and radii are those given until the last, which has the stage "done".
    """
    style = with_number(style, reference)
    raster = raster_for(reference, style)
    radii = np.asarray(radius_mm, np.float64) / raster.pixel_mm
    points = np.clip(position_mm, 0.0, raster.size_mm) / raster.pixel_mm
    for k, moved in enumerate(_relaxed(raster, style, points, n_done), start=n_done + 1):
        points = moved
        yield Progress("relax", k, style.iterations, *raster.on_page(points, radii))
    if style.weighted and n_done < style.iterations and style.sizes == "tone":
        points = part_close(points, raster)
    inked = raster.onto_ink(points)
    points = inked if len(inked) == len(points) else points
    if style.sizes == "tone":
        for share, solved in solve_radii(points, raster.darkness, raster.rule):
            yield Progress("tone", round(1000 * share), 1000, *raster.on_page(points, radii))
            if share == 1.0:
                radii = solved
    yield Progress("done", 1, 1, *raster.on_page(points, radii))


def _relaxed(
    raster: PageRaster, style: Style, points: NDArray[np.float64], n_done: int
) -> Iterator[NDArray[np.float64]]:
    """Yield the dots after each step that is left, in pixels."""
    if not len(points):
        return
    w, h = raster.size_mm
    at = points * raster.pixel_mm
    to_edge = np.minimum(np.minimum(at[:, 0], w - at[:, 0]), np.minimum(at[:, 1], h - at[:, 1]))
    beside = to_edge < raster.bleed * raster.pixel_mm
    page = np.array([(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)])
    for moved, _ in relaxed(raster, style, points, page, beside, n_done):
        yield moved
