"""The pipeline: from a reference and a style to dots whose ink meets the tone."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.drawing import Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import DEFAULT_DOTS, Style
from stippler.kernels.tone.union_share import shares_of_union
from stippler.stippling.default_number import with_number
from stippler.stippling.halftone import DROPPED, sizes_by_region
from stippler.stippling.halftone import pulse_density as pulses
from stippler.stippling.halftone_area import pulses_inside
from stippler.stippling.initial_points import floyd_steinberg, hexagonal, random_dots
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.postprocess import at_edge, even_rim, part_close
from stippler.stippling.radii import solve_radii
from stippler.stippling.run_relaxation import relaxed
from stippler.stippling.tone import Shortfall, shortfall, too_small_to_print

_TRIES = 6  # to meet the number of dots asked for
_NOTED, _BANDS = 0.03, 10  # tone that may lack without a note, in so many bands of darkness
_GIVES = (0.6, 0.3, 0.2, 0.1)  # how far a dot may move across the page's edge, in its radius


@dataclass(frozen=True, slots=True, eq=False)
class Progress:
    """A snapshot of the work; its arrays are fresh and read-only.

    Attributes
    ----------
    stage : {"first dots", "relax", "tone", "done"}
    done, total : int
        Of this stage.
    position_mm : (n, 2) float64
        Empty if snapshots are off, but for the last one.
    radius_mm : (n,) float32
    movement_mm : float
        Mean movement of the last relaxation step; NaN outside relaxation.
    shortfall : Shortfall or None
        On "done".
    """

    stage: str
    done: int
    total: int
    position_mm: NDArray[np.float64]
    radius_mm: NDArray[np.float32]
    movement_mm: float = math.nan
    shortfall: Shortfall | None = None


def stages(reference: Reference, style: Style, *, snapshots: bool = True) -> Iterator[Progress]:
    """Stipple a reference; yield a snapshot after every piece of work.

    Close the iterator to cancel. The result depends on the reference, the style and nothing else.

    Parameters
    ----------
    reference : Reference
    style : Style
    snapshots : bool
        Whether to fill the arrays of all snapshots, or only those of the last.

    Yields
    ------
    Progress
        The last one has the stage "done".
    """
    Page(reference.width_mm, reference.height_mm)  # too high a page is refused before the work
    style = with_number(style, reference)
    raster = raster_for(reference, style)
    if style.sizes == "regions":
        yield from _stages_by_region(raster, style, snapshots)
        return
    nothing = np.empty((0, 2)), np.empty(0, np.float32)

    def snapshot(
        stage: str, done: int, total: int, px: NDArray[np.float64], movement_mm: float = math.nan
    ) -> Progress:
        shown = nothing
        if snapshots:
            px = raster.trim(px, style.n_dots)
            shown = raster.on_page(px, raster.radii(px))
        return Progress(stage, done, total, *shown, movement_mm)

    points = np.empty((0, 2))
    yield snapshot("first dots", 0, 1000, points)  # nothing yet, but a chance to cancel
    for share, points in _first_dots(raster, style):
        yield snapshot("first dots", round(1000 * share), 1000, points)
    if len(points) and style.iterations:
        for k, (moved, movement_mm) in enumerate(
            relaxed(raster, style, points, raster.outline_mm(), watched=snapshots)
        ):
            points = moved if len(moved) else points
            yield snapshot("relax", k + 1, style.iterations, points, movement_mm)
    points = raster.trim(points, style.n_dots)
    if style.weighted and style.iterations:
        for share, finished in _finish(raster, points):
            points = finished
            yield snapshot("tone", round(200 * share), 1000, points)
    points = raster.onto_ink(points)
    radii = np.empty(0)
    for share, solved in solve_radii(points, raster.darkness, raster.rule):
        radii = solved
        if share < 1.0:
            yield snapshot("tone", round(200 + 800 * share), 1000, points)
    lack = shortfall(raster.darkness, raster.rule, raster.pixel_mm, len(points), style.n_dots)
    lack = replace(lack, notes=lack.notes + too_small_to_print(radii * raster.pixel_mm))
    yield Progress("done", 1, 1, *raster.on_page(points, radii), shortfall=lack)


def _stages_by_region(raster: PageRaster, style: Style, snapshots: bool) -> Iterator[Progress]:
    """Draw as the paper does: sizes follow from the regions, and stay with their dots."""

    def snapshot(
        stage: str, done: int, total: int, px: NDArray[np.float64], radii: NDArray[np.float64],
        movement_mm: float = math.nan,
    ) -> Progress:  # fmt: skip
        n = len(px) if snapshots else 0
        return Progress(stage, done, total, *raster.on_page(px[:n], radii[:n]), movement_mm)

    points, radii = np.empty((0, 2)), np.empty(0)
    yield snapshot("first dots", 0, 1000, points, radii)
    for share, first in pulses(raster.density(), style.growth, start=style.start, seed=style.seed):
        radii, keep = sizes_by_region(first.region_px, raster.rule)
        points, radii = first.position_px[keep], radii[keep]
        yield snapshot("first dots", round(1000 * share), 1000, points, radii)
    if len(points) and style.iterations:
        for k, (moved, movement_mm) in enumerate(
            relaxed(raster, style, points, raster.outline_mm(), watched=snapshots)
        ):
            points = moved if len(moved) else points
            yield snapshot("relax", k + 1, style.iterations, points, radii, movement_mm)
    points = raster.onto_ink(raster.trim(points, None))
    notes = shortfall(
        raster.darkness, raster.rule, raster.pixel_mm, len(points), style.n_dots
    ).notes
    notes += _off_the_tone(raster, points, radii) + too_small_to_print(radii * raster.pixel_mm)
    yield Progress("done", 1, 1, *raster.on_page(points, radii), shortfall=Shortfall(notes=notes))


def _off_the_tone(
    raster: PageRaster, points: NDArray[np.float64], radii: NDArray[np.float64]
) -> tuple[str, ...]:
    """Say how far the ink of dots whose sizes were not solved is off the picture's, at worst.

    Tones are compared in ten bands of darkness; those that hardly occur are not.
    """
    shares = shares_of_union(np.column_stack((points, radii)).astype(np.float32))
    ink = math.pi * shares * np.square(radii)
    band = np.minimum((raster.darkness * _BANDS).astype(np.intp), _BANDS - 1).ravel()
    n_pixels = np.bincount(band, minlength=_BANDS)
    asked = np.bincount(band, raster.darkness.ravel(), _BANDS)
    x, y = np.minimum(points.astype(np.intp), np.array(raster.darkness.shape[::-1]) - 1).T
    laid = np.bincount(band[y * raster.darkness.shape[1] + x], ink, _BANDS)
    many = n_pixels >= _NOTED * band.size
    tones = np.stack((asked, laid)) / np.maximum(n_pixels, 1) * many
    worst = int(np.argmax(np.abs(tones[1] - tones[0])))
    wanted, drawn = tones[:, worst]
    if abs(drawn - wanted) < _NOTED:
        return ()
    return (
        f"sizes by region draw a darkness of {100 * wanted:.0f} % as {100 * drawn:.0f} %; "
        "sizes by tone meet it",
    )


def notes_on(result: Progress) -> tuple[str, ...]:
    """Say in words what a finished run fell short of."""
    lack = result.shortfall
    if lack is None:
        return ()
    notes = list(lack.notes)
    if lack.share > 0.0005:
        where = ""
        if lack.box_mm is not None:
            x0, y0, x1, y1 = lack.box_mm
            where = f", between {x0:.1f}, {y0:.1f} and {x1:.1f}, {y1:.1f} mm"
        notes.append(
            f"{100 * lack.share:.1f} % of the page is too dark for these dots "
            f"(by {lack.missing:.2f} of 1{where}); allow larger dots, or more of them"
        )
    return tuple(notes)


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
    style = Style(n_dots=dots, iterations=0, seed=seed, growth=growth, start=start, weighted=False)
    reference = Reference(darkness, float(darkness.shape[1]))
    if area is not None:
        found = pulses_inside(reference, style, area)
        return found.position_mm, found.radius_mm
    raster = raster_for(reference, style)
    *_, (_, points) = _first_dots(raster, style)
    points = raster.onto_ink(raster.trim(points, None))
    return points * raster.pixel_mm, raster.radii(points) * raster.pixel_mm


def raster_for(reference: Reference, style: Style) -> PageRaster:
    """Prepare the raster that a style lays its dots out on."""
    by_region = style.sizes == "regions"
    return PageRaster.of(
        reference,
        style.n_dots,
        style.size_range_mm,
        bleeds=style.weighted and not by_region,
        faintest=DROPPED if by_region else None,
    )


def _first_dots(raster: PageRaster, style: Style) -> Iterator[tuple[float, NDArray[np.float64]]]:
    """Yield the share done and the dots so far, in pixels from the page's corner."""
    density = raster.density()
    yield 0.0, np.empty((0, 2))
    if style.first_dots == "pulse-density":
        halftone = pulses(density, style.growth, start=style.start, seed=style.seed)
        for share, first in halftone:
            yield share, first.position_px - raster.bleed
        return
    if style.first_dots == "random":
        yield 1.0, random_dots(density, style.seed) - raster.bleed
        return
    place = floyd_steinberg if style.first_dots == "floyd-steinberg" else hexagonal
    yield 1.0, _trimmed_to(raster, style.n_dots, density, place)


def _trimmed_to(
    raster: PageRaster,
    n_wanted: int | None,
    density: NDArray[np.float32],
    place: Callable[[NDArray[np.float32]], NDArray[np.float64]],
) -> NDArray[np.float64]:
    """Place dots, in rows that may lie along the edge, so that as many as asked for are left."""
    best, off, share = np.empty((0, 2)), np.inf, 1.0
    for _ in range(_TRIES):
        points = place(density * np.float32(share)) - raster.bleed
        missing = 0 if n_wanted is None else n_wanted - len(raster.trim(points, n_wanted))
        if abs(missing) < off:
            best, off = points, abs(missing)
        if not missing or not len(points):
            break
        share *= 1.0 + missing / len(points)
    return best


def _finish(
    raster: PageRaster, points: NDArray[np.float64]
) -> Iterator[tuple[float, NDArray[np.float64]]]:
    """Part dots that lie too close, and even out the ink along the edge of a page that bleeds."""
    points = part_close(points, raster)
    yield 0.2, points
    if not raster.bleed:
        return
    for k, give in enumerate(_GIVES):
        points = even_rim(points, raster, give)
        yield 0.2 + 0.8 * (k + 0.5) / len(_GIVES), points
        points = part_close(points, raster, at_edge(points, raster))
        yield 0.2 + 0.8 * (k + 1) / len(_GIVES), points
