"""Level of detail: a drawing at another size or number of dots, its tone kept.

Deussen et al. 2000, section 7: dots are inserted or deleted, and what is near them relaxes.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray
from shapely import affinity

from stippler.drawing.deformation import Deformation
from stippler.drawing.dots import FREE, NO_CURVE, Dots, first_seeds
from stippler.drawing.reference import Reference
from stippler.drawing.style import MAX_DOTS
from stippler.errors import GeometryError, ParameterError
from stippler.stippling.density import DensityField

if TYPE_CHECKING:
    from shapely.geometry import MultiPolygon, Polygon

    from stippler.drawing.drawing import Drawing

Points = NDArray[np.float64]
Whole = TypeVar("Whole", bound="Drawing")

_STEPS = 6
_SETTLING = 8  # steps by the tone, where there is a picture
_FEWEST = 20
_PARENTS = 3  # dots that share the ink of one that goes


@dataclass(frozen=True, slots=True)
class Scaling:
    """How a drawing is scaled.

    Attributes
    ----------
    factor : float
        Of all lengths.
    n_dots : int or None
        How many dots there are afterwards; None: as many as the smallest radius allows.
    least_radius_mm : float
        No dot is smaller afterwards; 0 keeps all dots.
    seed : int
    """

    factor: float = 1.0
    n_dots: int | None = None
    least_radius_mm: float = 0.0
    seed: int = 1

    def __post_init__(self) -> None:
        if not (math.isfinite(self.factor) and 1e-3 <= self.factor <= 1e3):
            raise ParameterError(f"{self.factor:g} is no scale", "scale", "give 0.001 to 1000")
        if self.n_dots is not None and not 1 <= self.n_dots <= MAX_DOTS:
            raise ParameterError(f"{self.n_dots} dots cannot be drawn", "scale", "give 1 or more")
        if not (math.isfinite(self.least_radius_mm) and self.least_radius_mm >= 0.0):
            raise ParameterError(f"{self.least_radius_mm:g} mm is no radius", "scale")


def scaled_dots(
    dots: Dots,
    outlines: dict[int, Polygon | MultiPolygon],
    scaling: Scaling,
    resting: frozenset[int] = frozenset(),
) -> Dots:
    """Return dots scaled, fewer or more, each area by itself.

    Parameters
    ----------
    outlines : dict of area to polygon
        Scaled; what dots are relaxed in.
    resting : set of areas
        Whose dots are not relaxed.

    Notes
    -----
    The ink of a dot that goes is shared by the nearest that stay, so that tone is kept where it
    was; dots that come take theirs from the dots around them. Fixed dots stay, in place and size.
    """
    f = scaling.factor
    position = dots.position_mm * f
    ink = (dots.radius_mm.astype(np.float64) * f) ** 2
    wanted = _numbers(dots, ink, scaling)
    parts: list[Dots] = []
    next_id = int(dots.id.max(initial=-1)) + 1
    for k, area in enumerate(np.unique(dots.area).tolist()):
        mine = np.flatnonzero(dots.area == area)
        rng = np.random.default_rng([scaling.seed, k])
        part = _part(dots, mine, position, ink, wanted[mine], rng, next_id, scaling)
        next_id = max(next_id, int(part.id.max(initial=-1)) + 1)
        if len(part) != len(mine) and area not in resting:
            _relax(part, outlines.get(area))
        parts.append(part)
    if not parts:
        return dots.copy()
    names = [x.name for x in fields(Dots)]
    return Dots(**{name: np.concatenate([getattr(p, name) for p in parts]) for name in names})


def scaled_drawing(drawing: Whole, scaling: Scaling) -> Whole:
    """Return a drawing at another size: page, areas, lines, patterns, reference and dots."""
    from stippler.drawing.area_edits import with_policies_of
    from stippler.drawing.drawing import Page
    from stippler.drawing.partition import Partition
    from stippler.stippling.part_of_area import met_and_missed

    f, original = scaling.factor, drawing
    reference = drawing.reference
    if reference is not None:
        reference = Reference.of(reference.source, reference.width_mm * f, reference.adjustment)
    if f != 1.0:
        by = Deformation((f, 0.0, 0.0, 0.0, f, 0.0, 0.0, 0.0, 1.0))
        outlines = {
            k: affinity.scale(area.outline_mm, f, f, origin=(0.0, 0.0))
            for k, area in drawing.areas.items()
        }
        drawing = replace(
            drawing,
            page=Page(drawing.page.width_mm * f, drawing.page.height_mm * f),
            areas={k: replace(a, outline_mm=outlines[k]) for k, a in drawing.areas.items()},
            lines={k: _scaled_line(line, by, f) for k, line in drawing.lines.items()},
            patterns={k: scaled_pattern(p, f) for k, p in drawing.patterns.items()},
            borders={},  # made anew from the outlines, on the grid
        )
        drawing = with_policies_of(original, drawing, f)
    before = drawing.dots
    toned: frozenset[int] = frozenset()
    if reference is not None:
        toned = frozenset(k for k in drawing.areas if drawing.style_of(k).sizes == "tone")
    partition = Partition(drawing.outlines())
    owned = {k: partition.part_of(k) for k in drawing.areas}
    parts = owned | met_and_missed(drawing, owned)[0]
    dots = scaled_dots(before, parts, scaling, toned)
    drawing = replace(drawing, dots=dots, reference=reference)
    differ = [k for k in sorted(toned) if (before.area == k).sum() != (dots.area == k).sum()]
    by_hand = hand_sizes(original, differ)
    for area in differ:
        solve_sizes(drawing, area, parts[area], scaling, by_hand.get(area))
    return drawing


def patterns_aside(drawing: Drawing) -> tuple[str, ...]:
    """Return what there is to say of areas that are scaled as if they had no pattern."""
    from stippler.drawing.partition import Partition
    from stippler.stippling.part_of_area import met_and_missed, pattern_of

    partition = Partition(drawing.outlines())
    laid = [k for k in drawing.areas if pattern_of(drawing, k) is not None]
    _, missed = met_and_missed(drawing, {k: partition.part_of(k) for k in laid})
    return tuple(
        f"area {drawing.areas[k].name!r} is scaled as if it had no pattern: {error}"
        for k, error in missed.items()
    )


@dataclass(frozen=True, slots=True, eq=False)
class HandSizes:
    """Which dots of an area a person has made larger or smaller than their tone asks for.

    Attributes
    ----------
    position_mm : (n, 2) float64
    share : (n,) float64
        Of the size that the tone asks for; 1 for most.
    """

    position_mm: Points
    share: Points

    def at(self, position_mm: Points, factor: float) -> Points:
        """Return the shares of dots that have come to lie elsewhere: the nearest one's."""
        from scipy.spatial import cKDTree

        nearest = cKDTree(self.position_mm * factor).query(position_mm, workers=-1)[1]
        return np.asarray(self.share[nearest])


def hand_sizes(drawing: Drawing, areas: Collection[int]) -> dict[int, HandSizes]:
    """Return what a person has done to the sizes of areas' dots, where it is anything."""
    from stippler.stippling.relax_all import sizes_over_solved
    from stippler.stippling.tasks import relaxing

    if drawing.reference is None or not areas:
        return {}
    try:
        task, rows, _ = relaxing(drawing, drawing.style_of(min(areas)), 1, areas)
    except GeometryError:  # patterns miss them all: there are no cells to solve sizes in
        return {}
    if len(rows) < _FEWEST:
        return {}
    dots, share = drawing.dots, sizes_over_solved(task)
    share[dots.is_fixed(rows)] = 1.0
    owner = dots.area[rows]
    changed = np.unique(owner[share != 1.0]).tolist()
    return {k: HandSizes(dots.position_mm[rows[owner == k]], share[owner == k]) for k in changed}


def solve_sizes(
    drawing: Drawing,
    area: int,
    part: Polygon | MultiPolygon,
    scaling: Scaling,
    by_hand: HandSizes | None,
) -> None:
    """Let an area's dots settle in its tone, and size them for it, as when they were made.

    Those that a person has made larger or smaller are so again.
    """
    import shapely

    from stippler.stippling.pipeline import run
    from stippler.stippling.task import SETTLE, Standing, Task

    style, reference, dots = drawing.style_of(area), drawing.reference, drawing.dots
    rows = np.flatnonzero(dots.area == area)
    if len(rows) < _FEWEST or reference is None:
        return
    rows = rows[shapely.contains_xy(part, *dots.position_mm[rows].T)]
    style = replace(style, n_dots=len(rows), size_range_mm=None, iterations=_SETTLING)
    fixed = dots.fixed[rows]
    standing = Standing(dots.position_mm[rows], dots.radius_mm[rows], fixed)
    *_, made = run(Task(style, reference, SETTLE, (part,), standing), snapshots=False)
    free = rows[~fixed]
    dots.position_mm[free] = made.position_mm[~fixed]
    sizes = made.radius_mm[~fixed].astype(np.float64)
    if by_hand is not None:
        sizes *= by_hand.at(dots.position_mm[free], scaling.factor)
    dots.radius_mm[free] = np.maximum(sizes, scaling.least_radius_mm)


def _scaled_line(line: Any, by: Deformation, f: float) -> Any:
    width = (line.width_mm[0] * f, line.width_mm[1] * f)
    sizes = {"distance_mm": line.distance_mm * f, "reach_mm": line.reach_mm * f}
    return replace(line.deformed(by), width_mm=width, **sizes)


def scaled_pattern(pattern: Any, f: float, shift_mm: tuple[float, float] = (0.0, 0.0)) -> Any:
    """Return a pattern with all lengths scaled about the page's corner, and moved then."""
    old, (dx, dy) = pattern.deformation, shift_mm
    by = np.array([[f, 0.0, dx], [0.0, f, dy], [0.0, 0.0, 1.0]])
    matrix = by @ np.array(old.matrix).reshape(3, 3)
    cage = old.cage
    if cage is not None:
        x0, y0, x1, y1 = (v * f for v in cage.box_mm)
        moves = tuple((x * f, y * f) for x, y in cage.moves_mm)
        cage = replace(cage, box_mm=(x0 + dx, y0 + dy, x1 + dx, y1 + dy), moves_mm=moves)
    pins = tuple(
        ((a * f + dx, b * f + dy), (c * f + dx, d * f + dy)) for (a, b), (c, d) in old.pins_mm
    )
    return replace(pattern, deformation=Deformation(tuple(matrix.ravel().tolist()), cage, pins))


def _numbers(dots: Dots, ink: Points, scaling: Scaling) -> Points:
    """Return for each dot how many there are to be in its place."""
    share = np.ones(len(dots))
    if scaling.n_dots is not None:
        n_fixed = int(np.count_nonzero(dots.fixed))
        share *= max(scaling.n_dots - n_fixed, 0) / max(len(dots) - n_fixed, 1)
    least = scaling.least_radius_mm**2
    if least > 0.0:
        share = np.minimum(share, ink / np.maximum(least, ink / np.maximum(share, 1e-12)))
        share = np.minimum(share, ink / least) if scaling.n_dots is None else share
    share[dots.fixed] = 1.0
    return share


def _part(
    dots: Dots, mine: NDArray[np.intp], position: Points, ink: Points, wanted: Points,
    rng: np.random.Generator, next_id: int, scaling: Scaling,
) -> Dots:  # fmt: skip
    """Return an area's dots after some went or some came, with the ink of all of them."""
    from scipy.spatial import cKDTree

    at, own, least_ink = position[mine], ink[mine], scaling.least_radius_mm**2
    count = _rounded(at, wanted, dots.is_fixed(mine))
    stays = np.flatnonzero(count > 0)
    if not len(stays):
        stays = np.array([int(np.argmax(own))])
        count[stays] = 1
    out = dots.take(mine[stays])
    out.position_mm[:] = at[stays]
    out.parameter *= scaling.factor
    new_ink = own[stays].copy()
    goes = np.flatnonzero(count == 0)
    free = np.flatnonzero(~out.fixed)
    if len(goes) and len(free):
        near = min(_PARENTS, len(free))
        far, who = cKDTree(at[stays][free]).query(at[goes], k=near)
        far, who = np.reshape(far, (len(goes), near)), np.reshape(who, (len(goes), near))
        weight = 1.0 / np.maximum(far, 1e-9) ** 2
        weight *= (own[goes] / weight.sum(axis=1))[:, None]
        np.add.at(new_ink, free[who], weight)
    more = count[stays] - 1
    new_ink /= 1 + more
    _at_least(new_ink, least_ink, free)
    out.radius_mm[:] = np.sqrt(new_ink)
    return _with_new(out, more, rng, next_id) if more.any() else out


def _at_least(ink: Points, least: float, free: NDArray[np.intp]) -> None:
    """Give free dots that have less than the least ink as much, taken from all that have more."""
    if least <= 0.0 or not len(free):
        return
    own = ink[free]
    lack = float(np.maximum(least - own, 0.0).sum())
    over = np.maximum(own - least, 0.0)
    share = min(lack / max(float(over.sum()), 1e-300), 1.0)
    ink[free] = np.maximum(own, least) - share * over


def _rounded(at: Points, wanted: Points, fixed: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Round numbers so that they add up everywhere: along a curve that fills the plane."""
    order = np.lexsort((np.arange(len(at)), _hilbert(at)))
    total = np.cumsum(wanted[order])
    steps = np.floor(total + 0.5).astype(np.int64)
    count = np.empty(len(at), np.int64)
    count[order] = np.diff(steps, prepend=0)
    count[fixed] = 1
    return count


def _hilbert(at: Points, bits: int = 12) -> NDArray[np.int64]:
    """Return places along a Hilbert curve."""
    low = at.min(axis=0)
    size = max(float(np.ptp(at, axis=0).max()), 1e-12)
    x, y = np.minimum((at - low) / size * (1 << bits), (1 << bits) - 1).astype(np.int64).T
    d = np.zeros(len(at), np.int64)
    s = 1 << (bits - 1)
    while s:
        rx, ry = ((x & s) > 0).astype(np.int64), ((y & s) > 0).astype(np.int64)
        d += s * s * ((3 * rx) ^ ry)
        turn = ry == 0
        flip = turn & (rx == 1)
        x, y = np.where(flip, s - 1 - x, x), np.where(flip, s - 1 - y, y)
        x, y = np.where(turn, y, x), np.where(turn, x, y)
        s >>= 1
    return d


def _with_new(dots: Dots, more: NDArray[np.int64], rng: np.random.Generator, next_id: int) -> Dots:
    """Return dots with copies beside some of them, a radius or so away."""
    parent = np.repeat(np.arange(len(dots)), more)
    new = dots.take(parent)
    turn = rng.random(len(parent)) * 2 * np.pi
    away = 2.2 * new.radius_mm * np.sqrt(0.2 + rng.random(len(parent)))
    new.position_mm += away[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    new.id[:] = np.arange(next_id, next_id + len(parent))
    new.seed[:] = first_seeds(new.id)
    new.constraint[:], new.curve[:], new.parameter[:] = FREE, NO_CURVE, 0.0
    return Dots(
        **{x.name: np.concatenate([getattr(d, x.name) for d in (dots, new)]) for x in fields(Dots)}
    )


def _relax(dots: Dots, outline: Polygon | MultiPolygon | None) -> None:
    """Let dots find their places anew, by their ink, in the outline of their area."""
    import shapely

    from stippler.stippling.relax import Relaxation

    if outline is None or outline.is_empty or len(dots) < 4:
        return
    shape = outline
    at = dots.position_mm
    outside = ~shapely.intersects_xy(shape, at[:, 0], at[:, 1])
    if outside.any():
        inner = shapely.shortest_line(shape, shapely.points(at[outside]))
        dots.position_mm[outside] = shapely.get_coordinates(inner)[::2]
    inside = np.flatnonzero(shapely.intersects_xy(shape, *dots.position_mm.T))
    density = _density(dots, shape)
    box = np.array(shape.bounds)
    bounds = shapely.box(*box) if isinstance(shape, shapely.MultiPolygon) else shape
    engine = Relaxation(dots.position_mm[inside], bounds, dots.is_fixed(inside), density=density)
    engine.run(_STEPS)
    moved = engine.points
    stays = shapely.intersects_xy(shape, *moved.T) & ~dots.is_fixed(inside)
    dots.position_mm[inside[stays]] = moved[stays]


def _density(dots: Dots, shape: Polygon | MultiPolygon) -> DensityField:
    """Return how dense dots lie, smoothed over some of them, as what relaxation weighs by."""
    from scipy.ndimage import gaussian_filter

    x0, y0, x1, y1 = shape.bounds
    pixel = math.sqrt((x1 - x0) * (y1 - y0) / max(len(dots), 1))
    columns, rows = (max(2, math.ceil(v / pixel)) for v in (x1 - x0, y1 - y0))
    i = ((dots.position_mm - (x0, y0)) / pixel).astype(np.int64)
    i = np.clip(i, 0, (columns - 1, rows - 1))
    counts = np.bincount(i[:, 1] * columns + i[:, 0], minlength=rows * columns)
    smooth = gaussian_filter(counts.reshape(rows, columns).astype(np.float64), 1.5, mode="nearest")
    weight = np.square(np.maximum(smooth, 0.02 * smooth.max()))
    return DensityField(weight.astype(np.float32), pixel, (x0, y0))
