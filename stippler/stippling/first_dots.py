"""The first stage: dots before they are evened out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
from numpy.typing import NDArray

from stippler.stippling.draft import Draft, Floats
from stippler.stippling.ground import without_dots_at
from stippler.stippling.halftone import pulse_density as pulses
from stippler.stippling.halftone import sizes_by_region
from stippler.stippling.progress import FIRST, Step

_TRIES = 6  # to meet the number of dots asked for


def first_dots(draft: Draft, watched: bool) -> Iterator[Step]:
    """Set the dots by the style's method, sized by region where it asks for that."""
    yield Step(FIRST, 0, 1000)  # nothing yet, but a chance to cancel
    place = _by_regions if draft.style.sizes == "regions" else _placed
    for share in place(draft):
        yield Step(FIRST, round(1000 * share), 1000)


def _by_regions(draft: Draft) -> Iterator[float]:
    """Draw as the paper does: sizes follow from the regions, and stay with their dots."""
    raster, style = draft.raster, draft.style
    halftone = pulses(density_of(draft), style.growth, start=style.start, seed=style.seed)
    for share, first in halftone:
        radii, keep = sizes_by_region(first.region_px, raster.rule)
        draft.points, draft.radii = first.position_px[keep], radii[keep]
        yield share
    draft.radii = np.empty(0) if draft.radii is None else draft.radii


def _placed(draft: Draft) -> Iterator[float]:
    for share, points in placed(draft):
        draft.points = points
        yield share


def placed(draft: Draft) -> Iterator[tuple[float, Floats]]:
    """Yield the share done and the dots so far, in pixels from the corner."""
    raster, style = draft.raster, draft.style
    density, angle = density_of(draft), math.radians(style.direction_deg)
    if style.is_grid:
        from stippler.stippling.grids import grid

        yield 1.0, grid(density, style.spacing, angle, draft.n_wanted)
        return
    if style.spacing == "along":
        from stippler.stippling.grids import rows_along

        yield 1.0, rows_along(density, angle, draft.n_wanted, style.seed)
        return
    if style.first_dots == "pulse-density":
        halftone = pulses(
            density, style.growth, start=style.start, seed=style.seed, origin_px=raster.bleed
        )
        for share, first in halftone:
            yield share, first.position_px
        return
    from stippler.stippling.initial_points import floyd_steinberg, hexagonal, random_dots

    if style.first_dots == "random":
        yield 1.0, random_dots(density, style.seed) - raster.bleed
        return
    place = floyd_steinberg if style.first_dots == "floyd-steinberg" else hexagonal
    yield 1.0, _trimmed_to(draft, density, place)


def density_of(draft: Draft) -> NDArray[np.float32]:
    """Return dots per square pixel; none where dots stand already."""
    density = draft.ground.open_to_dots(draft.raster.density())
    if not len(draft.stand):
        return density
    there = draft.stand + draft.raster.bleed
    from_rows = draft.style.start == "border" and draft.style.first_dots == "pulse-density"
    behind = None
    if from_rows:
        from stippler.stippling.border_rows import behind_rows

        behind = behind_rows(density, there)
    density = without_dots_at(density, there)
    if behind is not None:
        density[behind] = 0.0
    total = float(density.sum(dtype=np.float64))
    if draft.n_wanted is not None and total > 0.0:
        density *= np.float32(draft.n_wanted / total)
    return density


def _trimmed_to(
    draft: Draft, density: NDArray[np.float32], place: Callable[[NDArray[np.float32]], Floats]
) -> Floats:
    """Place dots, in rows that may lie along the edge, so that as many as asked for are left."""
    raster, n_wanted = draft.raster, draft.n_wanted
    best, off, share = np.empty((0, 2)), np.inf, 1.0
    for _ in range(_TRIES):
        points = place(density * np.float32(share)) - raster.bleed
        missing = 0 if n_wanted is None else n_wanted - len(draft.ground.trimmed(points, n_wanted))
        if abs(missing) < off:
            best, off = points, abs(missing)
        if not missing or not len(points):
            break
        share *= 1.0 + missing / len(points)
    return best
