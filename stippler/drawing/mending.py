"""Borders that are no map, made anew from the outlines of the areas."""

from __future__ import annotations

from dataclasses import astuple, replace

import numpy as np

from stippler.drawing import records
from stippler.drawing.area import PAGE_AREA
from stippler.drawing.area_edits import map_of
from stippler.drawing.drawing import Drawing
from stippler.drawing.planar.planar_map import Arc
from stippler.drawing.planar.policies import inherited
from stippler.drawing.planar.soundness import fault_of, invalid_outline


def with_sound_borders(drawing: Drawing) -> tuple[Drawing, str]:
    """Return a drawing whose borders are a map of its areas, and what had to be mended.

    Raises
    ------
    GeometryError
        If the outlines make no map, either.

    Notes
    -----
    Outlines are laid over each other in the order of their ids, as in a drawing without borders; of
    borders with a policy of their own, those that are the same keep it.
    """
    page, outlines = drawing.page, drawing.outlines()
    arcs = [arc for arc in drawing.borders.values() if isinstance(arc, Arc)]
    fault = (
        fault_of(dict(zip(drawing.borders, arcs, strict=True)), outlines, astuple(page))
        if arcs
        else invalid_outline(outlines)
    )
    if fault is None:
        return drawing, ""
    made = map_of(replace(drawing, borders={}))
    kept = inherited([arc for arc in arcs if arc.policies], list(made.arcs.values()))
    areas = {k: replace(area, outline_mm=made.outline(k)) for k, area in drawing.areas.items()}
    dots = drawing.dots.copy()
    dots.area[:] = np.maximum(made.area_at(dots.position_mm), PAGE_AREA)
    borders: dict[int, records.Record] = dict(zip(made.arcs, kept, strict=True))
    mended = replace(drawing, areas=areas, borders=borders, dots=dots)
    return mended, f"its borders were made anew from the outlines of its areas ({fault})"
