"""The stages after relaxation: dots that lie too close, the rim of the page, sizes."""

from __future__ import annotations

import math
from collections.abc import Generator, Iterator
from dataclasses import replace

import numpy as np
import shapely

from stippler.kernels.tone.union_share import shares_of_union
from stippler.stippling.draft import Draft, Floats
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.postprocess import part_close
from stippler.stippling.progress import TONED, Step
from stippler.stippling.radii import Sizes
from stippler.stippling.stretched import InkOfShapes, is_stretched, shapes_of
from stippler.stippling.tessellation import Making, Tessellation
from stippler.stippling.tone import Shortfall, shortfall, too_small_to_print

_PARTED, _LAST = 40, 200  # thousandths of the work on the tone before sizes are solved
_GIVES = (0.6, 0.3, 0.2, 0.1)  # how far a dot may move across the page's edge, in its radius
_NOTED, _BANDS = 0.03, 10  # tone that may lack without a note, in so many bands of darkness
_APART = 0.6  # spacings that dots keep at least from those beyond the border
_ROUNDS = 4
_ROUNDS_OF_LONG = 3  # of sizes solved anew for dots that are not round


def trim(draft: Draft, watched: bool) -> Iterator[Step]:
    """Leave out the dots of the bleed; who lies off the ground comes back to it."""
    before, after = draft.ground, draft.ground.after_trim
    draft.points = before.trimmed(draft.points, draft.n_wanted)
    if after is not before:
        shift = np.array(before.origin_mm) - np.array(after.origin_mm)
        stand = after.inside(draft.stand * before.raster.pixel_mm + shift)
        draft.stand, draft.ground = stand / after.raster.pixel_mm, after
    yield from ()


def part(draft: Draft, watched: bool) -> Iterator[Step]:
    """Push dots apart that lie too close."""
    points = draft.points
    if not draft.task.parts_mm:
        draft.points = part_close(points, draft.raster)
    elif len(points):
        everyone = np.concatenate((draft.stand, points))
        awake = np.arange(len(everyone)) >= len(draft.stand)
        within = draft.ground.within(everyone)
        parted = part_close(everyone, draft.raster, awake, within)[len(draft.stand) :]
        draft.points = _clear_of_neighbours(draft, parted)
    yield Step(TONED, _PARTED, 1000)


def rim(draft: Draft, watched: bool) -> Iterator[Step]:
    """Even out the ink along edges that bleed: the page's, or an area's."""
    for k, give in enumerate(_GIVES):
        evened = draft.ground.rim_evened(draft.points, give)
        yield _rim_step(k + 0.5)
        draft.points = points = evened.points
        some = slice(None) if evened.around is None else np.flatnonzero(evened.around)
        within = draft.ground.within(points[some])
        points[some] = part_close(points[some], draft.raster, evened.beside[some], within)
        yield _rim_step(k + 1.0)


def _rim_step(k: float) -> Step:
    return Step(TONED, round(_PARTED + (_LAST - _PARTED) * k / len(_GIVES)), 1000)


def onto_ink(draft: Draft, watched: bool) -> Iterator[Step]:
    """Move dots off white; those without ink anywhere are left out, unless they are to stay."""
    inked = draft.raster.onto_ink(draft.points)
    if draft.task.parts_mm:
        inked = draft.ground.inside(inked * draft.raster.pixel_mm) / draft.raster.pixel_mm
    if draft.radii is None or len(inked) == len(draft.points):
        draft.points = inked
    yield from ()


def onto_lines(draft: Draft, watched: bool) -> Iterator[Step]:
    """Let dots within reach of lines that they adhere to line up on these; others make room."""
    met, ground, pixel = draft.task.lines, draft.ground, draft.raster.pixel_mm
    if met is None or not len(draft.points):
        return
    from stippler.stippling.lines import tone_along
    from stippler.stippling.new_on_lines import Place, lined_up, with_new

    n = len(draft.stand)
    local = ground.inside(np.concatenate((draft.stand, draft.points)) * pixel)
    corner = (0.0, 0.0, *draft.raster.size_mm)
    parts = [ground.outline_mm if draft.task.parts_mm else shapely.box(*corner)]
    place = Place(parts, ground.ink_field(), ground.origin_mm)
    still = np.arange(len(local)) < n
    tone = tone_along(draft.task.reference) if draft.style.weighted else None
    on_page = local + np.array(ground.origin_mm)
    found = lined_up(with_new(met, len(draft.points)), on_page, still, place, tone)
    draft.points = (found.position_mm[n:] - np.array(ground.origin_mm)) / pixel
    draft.holding = met.holding(found.line_of_dot[n:], found.along_mm[n:])
    yield Step(TONED, _LAST, 1000)


def radii(draft: Draft, watched: bool) -> Iterator[Step]:
    """Solve the sizes, so that the ink meets the tone."""
    there, is_long = draft.stand, is_stretched(draft.style)
    if not is_long:
        there = np.concatenate((draft.ground.sized_among, there))
    n = len(there)
    points = np.concatenate((there, draft.points)) if n else draft.points
    cells = yield from _told(draft.ground.cells(points))
    sizes = Sizes(cells, draft.raster.rule)
    for share in sizes.solve():
        yield Step(TONED, round(1000 - (1000 - _LAST) * 0.2 * (1.0 - share)), 1000)
    if is_long and len(points) and draft.raster.rule.varies:
        _for_long_dots(draft, points, sizes)
    draft.radii = sizes.radii[n:]
    if draft.raster.rule.radius_min < draft.raster.rule.radius_max and not is_long:
        draft.is_sized = True


def _told(making: Making) -> Generator[Step, None, Tessellation]:
    """Compute cells, and tell how far that is."""
    while True:
        try:
            share = next(making)
        except StopIteration as end:
            return end.value  # type: ignore[no-any-return]
        yield Step(TONED, round(_LAST + (1000 - _LAST) * 0.8 * share), 1000)


def _for_long_dots(draft: Draft, points: Floats, sizes: Sizes) -> None:
    """Solve the sizes anew until what long dots ink meets the tone."""
    raster, reference = draft.raster, draft.task.reference
    assert reference is not None, "sizes by tone need a picture"
    ink = InkOfShapes(raster.darkness, points, draft.style.seed)
    at_mm = points * raster.pixel_mm + np.array(draft.ground.origin_mm)
    dots = shapes_of(at_mm, sizes.radii * raster.pixel_mm, draft.style, reference)
    for _ in range(_ROUNDS_OF_LONG):
        for _share in sizes.solve(ink.gain(sizes.radii, dots)):
            pass


def shortfall_of(draft: Draft, watched: bool) -> Iterator[Step]:
    """Find what the ink falls short of."""
    raster, sizes = draft.raster, draft.radii
    assert sizes is not None, "sizes are known by now"
    lack = shortfall(
        raster.darkness, raster.rule, raster.pixel_mm, len(draft.points), draft.n_wanted
    )
    notes = lack.notes
    if draft.style.sizes == "regions":
        lack, notes = Shortfall(), notes + _off_the_tone(raster, draft.points, sizes)
    notes += too_small_to_print(sizes * raster.pixel_mm)
    draft.shortfall = replace(lack, notes=notes)
    yield from ()


def _clear_of_neighbours(draft: Draft, points: Floats) -> Floats:
    """Move dots away from those beyond the border that they would touch, within their area."""
    beyond = draft.task.neighbours_mm
    if beyond is None or not len(beyond):
        return points
    from scipy.spatial import KDTree  # which takes a while to import

    pixel = draft.raster.pixel_mm
    others = (beyond - np.array(draft.ground.origin_mm)) / pixel
    tree = KDTree(others)
    least = _APART / np.sqrt(np.maximum(draft.raster.density_under(points), 1e-12))
    for _ in range(_ROUNDS):
        found = tree.query(points, distance_upper_bound=float(least.max()))
        distance, which = np.asarray(found[0]), np.asarray(found[1])
        near = np.flatnonzero(distance < least)
        if not len(near):
            break
        away = points[near] - others[which[near]]
        lack = ((least - distance)[near] / np.maximum(distance[near], 1e-9))[:, None]
        moved = points[near] + away * lack
        stays = (draft.ground.inside(moved * pixel) != moved * pixel).any(axis=1)
        moved[stays] = points[near][stays]
        points = points.copy()
        points[near] = moved
    return points


def _off_the_tone(raster: PageRaster, points: Floats, radii: Floats) -> tuple[str, ...]:
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
