"""Tasks of drawings: what of a drawing a task is to be given."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.area import PAGE_AREA
from stippler.drawing.dots import FREE, ON_CURVE, Dots
from stippler.drawing.drawing import Drawing
from stippler.drawing.line import ADHERE, Line
from stippler.drawing.partition import Outline, Partition
from stippler.drawing.run import Holding
from stippler.drawing.style import Style
from stippler.errors import GeometryError, ParameterError
from stippler.stippling.beyond import bled_onto, seen_of
from stippler.stippling.border_policies import BorderPolicies, polygons_in
from stippler.stippling.part_of_area import FEW, part_for_dots, parts_met
from stippler.stippling.progress import Progress
from stippler.stippling.relax_views import View, views_of
from stippler.stippling.shares import number_of_areas, number_of_some
from stippler.stippling.style_tone import toned_by_area
from stippler.stippling.task import RELAX, MetLines, Standing, Task

_LEAST_MARGIN_MM, _MARGIN = 1.0, 0.05  # around an area, of its side: there its neighbours lie
_WHOLE = 1e-9  # of the page

Rows = NDArray[np.intp]


def relaxing(
    drawing: Drawing, style: Style, steps: int, areas: Collection[int] | None = None
) -> tuple[Task, Rows, tuple[str, ...]]:
    """Return the task of relaxing a drawing's dots, the rows that it moves, and what is left out.

    Dots that areas see through their borders come after those rows in it, and stand still.

    Parameters
    ----------
    areas : collection of int, optional
        Whose dots are moved; all, if left out. Dots that lie in another area's part stay, and
        so do those between a pattern's polygons or nearer to a line than they may be, and those of
        areas that their pattern misses.
    """
    dots, partition = drawing.dots, Partition(drawing.outlines())
    reference = drawing.reference
    if reference is not None:
        seen = {k: drawing.style_of(k) for k in drawing.areas}
        changed = {k: one for k, one in seen.items() if one.has_curve or one.is_inverse}
        reference = toned_by_area(
            reference, {k: (partition.part_of(k), one) for k, one in changed.items()}
        )
    mine = partition.area_at(dots.position_mm) == dots.area
    if areas is not None:
        mine &= np.isin(dots.area, list(areas))
    part_of_row, cut, notes = _cut(drawing, partition, mine)
    lines = lines_met(drawing, dots.take(np.flatnonzero(mine))) if drawing.lines else None
    views: list[View] = []
    if lines is None:  # dots on lines stay in their areas, and see none but these
        moved = [k for k in np.unique(part_of_row[mine]).tolist() if k >= 0]
        views = list(views_of(drawing, partition, moved, mine))
    for view in views:  # an area's number stands for all that are seen with it
        own = np.flatnonzero(mine & np.isin(dots.area, view.areas))
        mine[own[~shapely.intersects_xy(view.outline, *dots.position_mm[own].T)]] = False
        part_of_row[own] = view.areas[0]
    rows = np.flatnonzero(mine)
    standing, used = _standing(drawing, partition, rows, part_of_row, views)
    if lines is not None:
        fixed = (dots.constraint[rows] != FREE) & (lines.line_of_dot < 0)
        standing = replace(standing, fixed=fixed)
    outlines = {view.areas[0]: view.outline for view in views}
    parts = tuple(
        cut[-k] if k < 0 else outlines.get(k) or partition.part_of(k) for k in used.tolist()
    )
    if cut and reference is None and len(rows) < FEW * len(parts):
        style = replace(style, spacing="lloyd")
    task = Task(style, reference, RELAX, parts, standing, steps=steps, lines=lines)
    return task, rows, notes


def _standing(
    drawing: Drawing,
    partition: Partition,
    rows: Rows,
    part_of_row: NDArray[np.int64],
    views: Sequence[View],
) -> tuple[Standing, NDArray[np.int64]]:
    """Return the dots that are moved and those that are seen, and whose parts they lie in."""
    dots = drawing.dots
    everyone = np.concatenate([rows, *(view.beyond for view in views)])
    some = dots if len(everyone) == len(dots) == len(rows) else dots.take(everyone)
    place = np.concatenate([
        part_of_row[rows], *(np.full(len(view.beyond), view.areas[0]) for view in views),
    ])  # fmt: skip
    used, part_of_dot = np.unique(place, return_inverse=True)
    fixed = some.fixed
    if len(everyone) > len(rows):
        fixed = fixed | (np.arange(len(everyone)) >= len(rows))
    homes = tuple(
        (np.flatnonzero(dots.area[rows] == k), partition.part_of(k))
        for view in views for k in view.areas
    )  # fmt: skip
    return Standing(some.position_mm, some.radius_mm, fixed, part_of_dot, homes), used


def lines_met(drawing: Drawing, dots: Dots) -> MetLines | None:
    """Return the lines that some of a drawing's dots lie on or may line up on; None without any.

    Dots of locked areas stay where they are.
    """
    if not drawing.lines:
        return None
    lines = {k: line for k, line in drawing.lines.items() if isinstance(line, Line)}
    locked = [k for k, area in drawing.areas.items() if area.locked]
    moves = ~np.isin(dots.area, locked)
    on = moves & (dots.constraint == ON_CURVE) & np.isin(dots.curve, list(lines))
    draws = any(line.meeting == ADHERE and not line.hidden for line in lines.values())
    if not (on.any() or draws):
        return None
    ids = tuple(sorted(lines))
    which = np.searchsorted(ids, dots.curve)
    return MetLines(
        tuple(lines[k] for k in ids), ids, np.where(on, which, -1).astype(np.int32),
        dots.parameter.copy(), moves & (dots.constraint == FREE),
    )  # fmt: skip


def _cut(
    drawing: Drawing, partition: Partition, mine: NDArray[np.bool_]
) -> tuple[NDArray[np.int64], dict[int, Outline], tuple[str, ...]]:
    """Return each dot's area, or below 0 which polygon of one that patterns or lines cut.

    Dots outside of all polygons are `mine` no longer, nor are those of areas that their patterns
    miss; the last tells of these.
    """
    dots, cut = drawing.dots, dict[int, Outline]()
    owner = dots.area.astype(np.int64)
    if not (drawing.patterns or drawing.lines):
        return owner, cut, ()
    wholes = {k: partition.part_of(k) for k in np.unique(owner[mine]).tolist()}
    parts, notes = parts_met(drawing, wholes)
    for k, whole in wholes.items():
        if k not in parts:
            mine[dots.area == k] = False
            continue
        part = parts[k]
        if part is whole:
            continue
        polygons = shapely.get_parts(part)
        rows = np.flatnonzero(mine & (dots.area == k))
        found = shapely.STRtree(polygons).query(
            shapely.points(dots.position_mm[rows]), predicate="intersects"
        )
        mine[rows] = False
        mine[rows[found[0]]] = True
        owner[rows[found[0]]] = -(found[1] + len(cut) + 1)
        cut.update(enumerate(polygons.tolist(), start=len(cut) + 1))
    return owner, cut, notes


@dataclass(frozen=True, slots=True, eq=False)
class AreaTask:
    """The task of stippling an area, or several that see through their borders.

    Attributes
    ----------
    areas : tuple of int
    task : Task
    neighbour_area : (m,) int32
        Which areas the neighbours of its dots are in.
    neighbour_row : (m,) int
        Which dots of the drawing these are.
    partition : Partition
        Says whose the dots of several areas are.
    outlines : dict of polygon by area
        What each has of the place that dots may lie in; areas without any are left out.
    white_areas : list of int
        Of all areas of the drawing those whose dots are white.
    """

    areas: tuple[int, ...]
    task: Task
    neighbour_area: NDArray[np.int32]
    neighbour_row: Rows
    partition: Partition
    outlines: dict[int, Outline]
    white_areas: list[int]

    @property
    def meets_others(self) -> bool:
        """Whether it is of several areas, or of one that sees others or bleeds onto them."""
        return len(self.areas) > 1 or bool(self.task.seen_mm or self.task.bleeds_onto_mm)

    def is_beside(self, other: AreaTask) -> bool:
        """Whether the boxes around the areas of two tasks meet."""
        mine, theirs = (shapely.total_bounds(list(one.outlines.values())) for one in (self, other))
        return bool((mine[:2] <= theirs[2:]).all() and (theirs[:2] <= mine[2:]).all())

    def of_each(self, made: Progress) -> tuple[tuple[int, Progress], ...]:
        """Return the dots of each area; what all fall short of is told with the first."""
        return tuple(self._of(self.areas, made))

    def of_first(self, made: Progress) -> tuple[int, Progress]:
        """Return the first area, and its dots."""
        ((area, own),) = self._of(self.areas[:1], made)
        return area, own

    def _of(self, areas: Sequence[int], made: Progress) -> Iterator[tuple[int, Progress]]:
        if len(self.areas) == 1:
            yield self.areas[0], made
            return
        owner = self.partition.area_at(made.position_mm)
        owner[~np.isin(owner, self.areas)] = self.areas[0]
        for k in areas:
            mine = owner == k
            position, radius = made.position_mm[mine], made.radius_mm[mine]
            position.flags.writeable = radius.flags.writeable = False
            lack = made.shortfall if k == self.areas[0] else None
            held = made.holding
            if held is not None:
                held = Holding(held.curve[mine], held.along_mm[mine])
            one = replace(made, position_mm=position, radius_mm=radius, shortfall=lack,
                          holding=held)  # fmt: skip
            yield k, one


def stippling(
    drawing: Drawing,
    area: int | tuple[int, ...],
    partition: Partition | None = None,
    near: Rows | None = None,
    policies: BorderPolicies | None = None,
) -> AreaTask:
    """Return the task of stippling an area of a drawing anew, in its style.

    Several, as `BorderPolicies.joined` tells them, are one outline; the style is that of the first.

    Its fixed dots stay, and new ones keep clear of those beyond its border. A number of dots is
    shared by all areas of the style, by their ink.

    Parameters
    ----------
    partition : Partition, optional
        Of the drawing, if it is known.
    near : rows, optional
        All dots that lie in the `box_around` the area.
    policies : BorderPolicies, optional
        Of the drawing's borders, if they are known.

    Raises
    ------
    ParameterError
        If there is no such area, or no picture.
    GeometryError
        If nothing of the page is the area's.
    """
    areas = (area,) if isinstance(area, int) else area
    for k in areas:
        if k not in drawing.areas:
            raise ParameterError(f"there is no area {k}", "area", _known(drawing))
    reference = drawing.reference
    if reference is None:
        raise ParameterError("there is no picture to stipple from", "area", "fill it with dots")
    partition = partition or Partition(drawing.outlines())
    policies = policies or BorderPolicies(drawing, partition)
    part = policies.part_of_all(areas)
    if part.is_empty:
        raise GeometryError("lies under others", f"area {areas[0]}", "give it room of its own")
    dots, around = drawing.dots, policies.seen_from(areas)
    seen = seen_of(policies, areas)
    if near is None:
        x0, y0, x1, y1 = box_around(part, drawing)
        x, y = dots.position_mm.T
        near = np.flatnonzero((x >= x0) & (x <= x1) & (y >= y0) & (y <= y1))
    if seen:
        near = np.union1d(near, np.flatnonzero(np.isin(dots.area, list(around))))
    mine = np.isin(dots.area[near], areas)
    fixed, others = near[mine & dots.fixed[near]], near[~mine]
    standing = None
    if len(fixed):
        standing = Standing(dots.position_mm[fixed], dots.radius_mm[fixed])
    whole_group = _drawn_as_one(policies, areas) if seen else areas
    style = number_of_areas(
        drawing, partition, whole_group, policies.part_of_all(whole_group), reference
    )
    style, pieces = replace(style, border=drawing.border_of(areas[0])), policies.own_of(areas)
    if len(whole_group) > len(areas):
        style = number_of_some(policies, style, whole_group, areas, reference)
    whole = drawing.page.width_mm * drawing.page.height_mm
    cut = part_for_dots(drawing, areas[0], part)
    is_page = PAGE_AREA in areas and cut is part and part.area >= (1.0 - _WHOLE) * whole
    is_page &= not pieces
    parts = () if is_page else (cut,)
    lines = lines_met(drawing, dots.take(fixed)) if drawing.lines else None
    seen = () if cut is not part else seen
    onto = bled_onto(policies, areas) if cut is part else ()
    task = Task(style, reference, parts_mm=parts, standing=standing, lines=lines,
                neighbours_mm=dots.position_mm[others],
                neighbours_radius_mm=dots.radius_mm[others], pieces_mm=pieces,
                seen_mm=seen, bleeds_onto_mm=onto)  # fmt: skip
    return AreaTask(areas, task, dots.area[others], others, partition,
                    _of_each(partition, areas, cut), white_areas(drawing))  # fmt: skip


def _of_each(partition: Partition, areas: Sequence[int], cut: Outline) -> dict[int, Outline]:
    """Return what each of some areas has of the place that their dots may lie in."""
    if len(areas) == 1:
        return {areas[0]: cut}
    owned = {k: polygons_in(shapely.intersection(partition.part_of(k), cut)) for k in areas}
    return {k: part for k, part in owned.items() if not part.is_empty}


def white_areas(drawing: Drawing) -> list[int]:
    """Return the areas whose dots are white."""
    white = {k for k, style in drawing.styles.items() if style.is_inverse}
    return [k for k, area in drawing.areas.items() if area.style in white] if white else []


def box_around(part: Outline, drawing: Drawing) -> tuple[float, float, float, float]:
    """Return the box in which an area's own dots, its neighbours and what reaches into it lie."""
    largest = float(drawing.dots.radius_mm.max(initial=0.0))
    margin = max(_LEAST_MARGIN_MM, _MARGIN * float(np.sqrt(part.area)), largest)
    x0, y0, x1, y1 = part.bounds
    return x0 - margin, y0 - margin, x1 + margin, y1 + margin


def _known(drawing: Drawing) -> str:
    return "one of " + ", ".join(f"{k} ({a.name})" for k, a in sorted(drawing.areas.items())[:20])


def _drawn_as_one(policies: BorderPolicies, areas: tuple[int, ...]) -> tuple[int, ...]:
    """Return all areas that would be drawn as one with some but for bleeds; these come first."""
    everyone = [*areas, *(k for k in policies.seeing if k not in areas)]
    groups = policies.joined(everyone, drawn=False)
    return next(group for group in groups if areas[0] in group)
