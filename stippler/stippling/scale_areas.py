"""Level of detail of single areas: at another size or number of dots; all else stays.

Deussen et al. 2000, section 7.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import fields, replace

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely import affinity

from stippler.drawing import records
from stippler.drawing.bend_areas import bend_borders, clear_grown_over
from stippler.drawing.deformation import Deformation
from stippler.drawing.document import Document
from stippler.drawing.dots import ON_CURVE
from stippler.drawing.drawing import Drawing
from stippler.drawing.one_step import as_one_step
from stippler.drawing.partition import Outline
from stippler.drawing.replace_dots import replace_dots
from stippler.errors import GeometryError, ParameterError
from stippler.stippling.ground import brought_into
from stippler.stippling.part_of_area import met_and_missed
from stippler.stippling.scale import (
    Scaling,
    Whole,
    hand_sizes,
    scaled_dots,
    scaled_pattern,
    solve_sizes,
)

_EDGE_MM = 1e-3  # of the page: it stays
_WITHIN_MM = 1e-4  # a border, where a dot is brought back across it


def scale_areas(document: Document, areas: Collection[int], scaling: Scaling) -> None:
    """Scale areas with their dots and patterns, each about its middle, as one step.

    Borders that areas share with others move with them. What an
    area grows over loses its free dots there. The picture does not move: where the size changes
    the ink of the dots is kept, and else what the picture asks for. Dots on lines stay.

    Raises
    ------
    ParameterError
        If there is no such area.
    GeometryError
        If borders would cross, or an area would reach the page's edge. Nothing has changed then.
    """
    drawing = document.drawing
    for k in areas:
        if k not in drawing.areas:
            known = ", ".join(f"{i} ({a.name})" for i, a in sorted(drawing.areas.items())[:20])
            raise ParameterError(f"there is no area {k}", "area", f"one of {known}")
        if drawing.areas[k].locked:
            raise ParameterError(f"{drawing.areas[k].name} is locked", "area", "unlock it")
    names = " and ".join(drawing.areas[k].name for k in areas)

    def act(document: Document) -> None:
        for k in areas:
            _scale(document, k, scaling)

    as_one_step(document, f"Scale {names}", act)


def _scale(document: Document, area: int, scaling: Scaling) -> None:
    drawing, f = document.drawing, scaling.factor
    own = document.dots.id[document.dots.area == area].copy()
    part = document.partition.part_of(area)
    if not part.is_empty and f != 1.0:
        about = _middle(document, area, part, f)
        _bend(document, area, f, about)
        part = document.partition.part_of(area)
        clear_grown_over(document, (area,), own)
    else:
        about = (0.0, 0.0)
    rows = document.rows(own)
    before = document.dots.take(rows[document.dots.constraint[rows] != ON_CURVE])
    local = before.copy()
    local.position_mm -= about
    found, _ = met_and_missed(document.drawing, {area: part})
    shape = affinity.translate(found.get(area, part), -about[0], -about[1])
    tones = drawing.reference is not None and drawing.style_of(area).sizes == "tone" and f == 1.0
    dots = scaled_dots(local, {area: shape}, scaling, frozenset({area} if tones else ()))
    dots.position_mm += about
    if tones and len(dots) != len(before):
        by_hand = hand_sizes(document.drawing, [area]).get(area)
        made = replace(document.drawing, dots=dots)
        solve_sizes(made, area, found.get(area, part), scaling, by_hand)
    dots.position_mm[:] = _inside(dots.position_mm, part)
    dots.area[:] = area
    replace_dots(document, before.id, dots)


def _middle(document: Document, area: int, part: Outline, f: float) -> tuple[float, float]:
    """Return what an area is scaled about, if it has the room."""
    x0, y0, x1, y1 = part.bounds
    x, y = (x0 + x1) / 2.0, (y0 + y1) / 2.0
    page, name = document.drawing.page, document.drawing.areas[area].name
    half_x, half_y = ((x1 - x0) / 2.0 * max(f, 1.0), (y1 - y0) / 2.0 * max(f, 1.0))
    if min(x - half_x, y - half_y) < _EDGE_MM:
        raise _no_room(name)
    if x + half_x > page.width_mm - _EDGE_MM or y + half_y > page.height_mm - _EDGE_MM:
        raise _no_room(name)
    return x, y


def _no_room(name: str) -> GeometryError:
    return GeometryError(
        "would reach the page's edge, which does not move", name,
        "give another size, keep the size and change the number, or scale the whole drawing",
    )  # fmt: skip


def _bend(document: Document, area: int, f: float, about: tuple[float, float]) -> None:
    """Scale an area's borders and pattern about a point."""
    x, y = (v * (1.0 - f) for v in about)
    bend_borders(document, (area,), Deformation((f, 0.0, x, 0.0, f, y, 0.0, 0.0, 1.0)))
    for k, pattern in list(document.drawing.patterns.items()):
        if getattr(pattern, "area", None) == area:
            document.set(records.PATTERN, k, scaled_pattern(pattern, f, (x, y)))


def _inside(position_mm: NDArray[np.float64], part: Outline) -> NDArray[np.float64]:
    """Return places brought into an area."""
    out = np.flatnonzero(~shapely.intersects_xy(part, *position_mm.T))
    if not len(out) or part.is_empty:
        return position_mm
    found = position_mm.copy()
    found[out] = brought_into(part, position_mm[out], _WITHIN_MM)
    return found


def scaled_areas(drawing: Whole, areas: Collection[int], scaling: Scaling) -> Whole:
    """Return a drawing with some areas scaled; see `scale_areas`."""
    document = Document(drawing.snapshot())
    scale_areas(document, areas, scaling)
    made = document.drawing
    return replace(drawing, **{f.name: getattr(made, f.name) for f in fields(Drawing)})
