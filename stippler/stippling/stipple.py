"""Pictures to dots: the page as a task of the pipeline, and first dots alone."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.reference import Reference
from stippler.drawing.style import DEFAULT_DOTS, Style
from stippler.stippling.draft import Draft
from stippler.stippling.first_dots import placed
from stippler.stippling.pipeline import run
from stippler.stippling.progress import Progress, notes_on
from stippler.stippling.task import Task

__all__ = ["Progress", "notes_on", "pulse_density", "stages"]


def stages(reference: Reference, style: Style, *, snapshots: bool = True) -> Iterator[Progress]:
    """Stipple the page of a reference; see `stippler.stippling.pipeline.run`."""
    return run(Task(style, reference), snapshots=snapshots)


def pulse_density(
    darkness: NDArray[np.float32],
    dots: int = DEFAULT_DOTS,
    *,
    growth: str = "circular",
    start: str = "top",
    seed: int = 1,
    area: Polygon | MultiPolygon | None = None,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Place first dots by pulse-density modulation, without relaxation.

    Parameters
    ----------
    darkness : (h, w) float32, 0..1
    dots : int
        How many.
    growth : {"circular", "triangular"}
    start : {"top", "border"}
    seed : int
    area : polygon in pixels, optional
        Only what lies inside gets dots.

    Returns
    -------
    points : (n, 2) float64, pixels
    radii : (n,) float64, pixels
        By the rule for radius and density; not solved for the tone.
    """
    from stippler.stippling.halftone_area import pulses_inside

    style = Style(n_dots=dots, iterations=0, seed=seed, growth=growth, start=start, weighted=False)
    reference = Reference(darkness, float(darkness.shape[1]))
    if area is not None:
        found = pulses_inside(reference, style, area)
        return found.position_mm, found.radius_mm
    draft = Draft.of(Task(style, reference))
    raster = draft.raster
    *_, (_, points) = placed(draft)
    points = raster.onto_ink(raster.trim(points, None))
    return points * raster.pixel_mm, raster.radii(points) * raster.pixel_mm
