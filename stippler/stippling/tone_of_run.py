"""Sizes of the areas that a run has made, by which each meets the tone beside all others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from stippler.stippling.area_tone import ink_asked, sizes_of_areas
from stippler.stippling.picture_field import PictureField
from stippler.stippling.progress import Progress
from stippler.stippling.style_tone import curves_of
from stippler.stippling.tasks import AreaTask

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
    outlines = {k: outline for one in tasks for k, outline in one.outlines.items()}
    if not outlines:
        return {}
    areas, each = list(outlines), [made[k] for one in tasks for k in one.areas]
    number = {k: i for i, k in enumerate(areas) if made[k].limits_mm is not None}
    stay = [one.task.standing for one in tasks if one.task.standing is not None]
    position, radius = _others(tasks, made, is_white)
    position = np.concatenate(
        [*(one.position_mm for one in each), *(one.position_mm for one in stay), position]
    )
    radii = np.concatenate(
        [*(one.radius_mm for one in each), *(one.radius_mm for one in stay), radius],
        dtype=np.float64,
    )
    area_of_dot = np.full(len(radii), -1)
    rows, first = dict[int, slice](), 0
    for k, one in zip((k for task in tasks for k in task.areas), each, strict=True):
        rows[k] = slice(first, first + len(one.radius_mm))
        area_of_dot[rows[k]] = number.get(k, -1)
        first += len(one.radius_mm)
    found = sizes_of_areas(
        list(outlines.values()),
        _asked(tasks),
        position,
        radii,
        area_of_dot,
        np.array([made[k].limits_mm or (0.0, 0.0) for k in areas]),
    )
    changed = dict[int, Progress]()
    for k in number:
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


def _asked(tasks: Sequence[AreaTask]) -> NDArray[np.float64]:
    """Return how much ink each area asks for, by the picture as its style sees it."""
    outlines = [outline for one in tasks for outline in one.outlines.values()]
    styles = [one.task.style for one in tasks for _ in one.outlines]
    reference = tasks[0].task.reference
    assert reference is not None, "areas are stippled from a picture"
    curves = {(s.tone_white, s.tone_black, s.tone_gamma, s.tone_deepest): s for s in styles}
    tables = {key: k for k, key in enumerate(curves)}
    which = [tables[s.tone_white, s.tone_black, s.tone_gamma, s.tone_deepest] for s in styles]
    field = PictureField.of(reference, [curves_of(s) for s in curves.values()], which)
    return ink_asked(outlines, field)
