"""Sizes of areas that were made or relaxed, by which each meets the tone beside all others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon

from stippler.drawing.drawing import Drawing
from stippler.drawing.partition import Outline, Partition
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.area_tone import ink_asked, sizes_of_areas
from stippler.stippling.border_policies import BorderPolicies
from stippler.stippling.part_of_area import met_and_missed
from stippler.stippling.picture_field import PictureField
from stippler.stippling.progress import Progress
from stippler.stippling.style_tone import curves_of
from stippler.stippling.tasks import AreaTask, white_areas

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]

_MANY = 30  # dots by which a polygon of an area is one to meet the tone by itself

Finished: TypeAlias = tuple[tuple[int, Progress], ...]


def sized(tasks: Sequence[AreaTask], finished: Finished) -> Finished:
    """Return what is finished with other sizes, where areas are off the tone.

    Each counts what dots of others lay down in it, those of the run and those that were there. What
    keeps its sizes is the same object. Dots of one size, long ones and sizes by other rules stay.

    Parameters
    ----------
    tasks : sequence of AreaTask
        Some that are done.
    finished : (area, Progress) for each area that is done
    """
    made = dict(finished)
    for is_white in (False, True):
        some = [one for one in tasks if one.task.style.is_inverse == is_white]
        if any(made[k].limits_mm is not None for one in some for k in one.areas):
            made |= _sized(some, made, is_white)
    return tuple((k, made[k]) for k, _ in finished)


def _sized(
    tasks: Sequence[AreaTask], made: dict[int, Progress], is_white: bool
) -> dict[int, Progress]:
    """Return those areas that get other sizes, of tasks whose dots have one colour."""
    areas, each = [k for one in tasks for k in one.areas], [made[k] for t in tasks for k in t.areas]
    stay = [one.task.standing for one in tasks if one.task.standing is not None]
    around, around_mm = _others(tasks, made, is_white)
    position = np.concatenate(
        [*(one.position_mm for one in each), *(one.position_mm for one in stay), around]
    )
    radii = np.concatenate(
        [*(one.radius_mm for one in each), *(one.radius_mm for one in stay), around_mm],
        dtype=np.float64,
    )
    units, rows, first = _Units(), dict[int, slice](), 0
    unit_of_dot = np.full(len(radii), -1)
    for task in tasks:
        for k in task.areas:
            one = made[k]
            rows[k] = slice(first, first + len(one.radius_mm))
            first = rows[k].stop
            if k in task.outlines:
                limits = one.limits_mm or (0.0, 0.0)
                kind = task.task.style, limits, task.meets_others
                unit = units.add(task.outlines[k], one.position_mm, *kind)
                unit_of_dot[rows[k]] = -1 if one.limits_mm is None else unit
    reference = tasks[0].task.reference
    assert reference is not None, "areas are stippled from a picture"
    found = units.sized(reference, position, radii, unit_of_dot)
    changed = dict[int, Progress]()
    for k in areas:
        if (found[rows[k]] != radii[rows[k]]).any():
            new = found[rows[k]].astype(np.float32)
            new.flags.writeable = False
            changed[k] = replace(made[k], radius_mm=new)
    return changed


def _others(
    tasks: Sequence[AreaTask], made: dict[int, Progress], is_white: bool
) -> tuple[NDArray[np.float64], NDArray[np.float32]]:
    """Return dots of the same colour around the areas that are no area's of the run, each once."""
    position, radius, row = list[NDArray[np.float64]](), list[NDArray[np.float32]](), []
    for one in tasks:
        at, size = one.task.neighbours_mm, one.task.neighbours_radius_mm
        assert at is not None, "an area is told of its neighbours"
        assert size is not None, "and of their sizes"
        stays = ~np.isin(one.neighbour_area, list(made))
        stays &= np.isin(one.neighbour_area, one.white_areas) == is_white
        position.append(at[stays])
        radius.append(size[stays])
        row.append(one.neighbour_row[stays])
    _, first = np.unique(np.concatenate(row), return_index=True)
    return np.concatenate(position)[first], np.concatenate(radius)[first]


def sized_again(
    drawing: Drawing,
    position_mm: NDArray[np.float64],
    radius_mm: NDArray[np.float32],
    is_solved: NDArray[np.bool_],
) -> NDArray[np.float32]:
    """Return sizes of a drawing's dots that were moved, by which their areas meet the tone.

    Parameters
    ----------
    position_mm : (n, 2) float64, radius_mm : (n,) float32
        Of all its dots, as they are now.
    is_solved : (n,) bool
        Those whose sizes were solved there, and may change.
    """
    dots, partition = drawing.dots, Partition(drawing.outlines())
    areas = np.unique(dots.area[is_solved]).tolist()
    parts = {k: partition.part_of(k) for k in areas if k in drawing.areas}
    outlines, _ = met_and_missed(drawing, parts)
    seeing = BorderPolicies(drawing, partition).seeing
    radii, reference = radius_mm.astype(np.float64), drawing.reference
    for is_white in (False, True):
        mine = [k for k in outlines if drawing.style_of(k).is_inverse == is_white]
        if not mine or reference is None:
            continue
        alike = np.isin(dots.area, white_areas(drawing)) == is_white
        sizes = radii[is_solved & alike]
        units, unit_of_dot = _Units(), np.full(len(radii), -1)
        for k in mine:
            rows = np.flatnonzero(is_solved & (dots.area == k))
            unit_of_dot[rows] = units.add(
                outlines[k], position_mm[rows], drawing.style_of(k), (sizes.min(), sizes.max()),
                k in seeing,
            )  # fmt: skip
        radii[alike] = units.sized(reference, position_mm[alike], radii[alike], unit_of_dot[alike])
    return np.where(radii == radius_mm, radius_mm, radii.astype(np.float32))


class _Units:
    """What is to meet the tone by itself: areas, and their polygons that hold many dots."""

    def __init__(self) -> None:
        self._outlines, self._styles = list[Outline](), list[Style]()
        self._limits, self._is_cut = list[tuple[float, float]](), list[bool]()

    def add(
        self,
        outline: Outline,
        position_mm: Floats,
        style: Style,
        limits: tuple[float, float],
        is_cut: bool,
    ) -> Rows:
        """Add an area; return in which unit each of its dots lies, -1 where in none.

        Parameters
        ----------
        is_cut : bool
            Whether cells of its dots may go on beyond its border.
        """
        polygons, first = shapely.get_parts(outline), len(self._outlines)
        unit_of_dot = np.full(len(position_mm), first)
        parts = [outline]
        if len(polygons) > 1:
            dot, polygon = shapely.STRtree(polygons).query(
                shapely.points(position_mm), predicate="intersects"
            )
            is_many = np.bincount(polygon, minlength=len(polygons)) >= _MANY
            parts, rest = polygons[is_many].tolist(), polygons[~is_many].tolist()
            parts += [MultiPolygon(rest)] if rest else []
            unit = first + np.where(is_many, np.cumsum(is_many) - 1, is_many.sum())
            unit_of_dot[:] = -1
            unit_of_dot[dot] = unit[polygon]
        self._outlines += parts
        self._styles += [style] * len(parts)
        self._limits += [limits] * len(parts)
        self._is_cut += [is_cut] * len(parts)
        return unit_of_dot

    def sized(
        self, reference: Reference, position_mm: Floats, radii: Floats, unit_of_dot: Rows
    ) -> Floats:
        """Return the sizes of dots, mm; -1 is the unit of those that keep theirs."""
        if not self._outlines:
            return radii
        return sizes_of_areas(
            self._outlines, self._asked(reference), position_mm, radii, unit_of_dot,
            np.array(self._limits), np.array(self._is_cut),
        )  # fmt: skip

    def _asked(self, reference: Reference) -> Floats:
        """Return how much ink each asks for, by the picture as its style sees it."""
        keys = [(s.tone_white, s.tone_black, s.tone_gamma, s.tone_deepest) for s in self._styles]
        curves = dict(zip(keys, map(curves_of, self._styles), strict=True))
        number = {key: k for k, key in enumerate(curves)}
        which = [number[key] for key in keys]
        field = PictureField.of(reference, list(curves.values()), which)
        return ink_asked(self._outlines, field)
