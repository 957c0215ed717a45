"""Edits of a document's areas: borders, outlines and the dots that change hands, in one step."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TypeVar
from weakref import WeakKeyDictionary

import numpy as np

from stippler.drawing import records
from stippler.drawing.area import PAGE_AREA, Area
from stippler.drawing.document import Document
from stippler.drawing.drawing import Drawing
from stippler.drawing.one_step import as_one_step
from stippler.drawing.partition import Outline
from stippler.drawing.planar.edits import Outcome, touched
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import Arc, PlanarMap
from stippler.drawing.planar.policies import inherited
from stippler.drawing.planar.slivers import LEAST_WIDTH_MM
from stippler.drawing.planar.swept import dots_in_strip
from stippler.errors import GeometryError

Whole = TypeVar("Whole", bound=Drawing)

_COLOURS = (
    "#c65d57", "#5d86c6", "#6aa86a", "#c9a24b", "#8d6bb3", "#4fa3a0", "#b3708f", "#7d8a4f",
)  # fmt: skip


def map_of(drawing: Drawing) -> PlanarMap:
    """Return the areas of a drawing as faces over its borders.

    A drawing whose areas were made without borders gets them: its areas are laid over each other
    in their order.
    """
    borders: Mapping[int, Arc] = drawing.table(records.BORDER)
    next_area = drawing.first_free(records.AREA)
    if borders:
        return PlanarMap(dict(borders), drawing.first_free(records.BORDER), next_area)
    made = PlanarMap.of_page(drawing.page.width_mm, drawing.page.height_mm)
    return _with_outlines(made, drawing, next_area)


def _with_outlines(made: PlanarMap, drawing: Drawing, next_area: int) -> PlanarMap:
    from stippler.drawing.planar.borders import paths_of
    from stippler.drawing.planar.edits import EVEN_ODD, add

    for k, outline in drawing.outlines().items():
        if k and not outline.is_empty:
            ready = PlanarMap(made.arcs, made.next_arc, k)
            made = add(ready, paths_of(outline), rule=EVEN_ODD).map
    return PlanarMap(made.arcs, made.next_arc, next_area)


def with_policies_of(before: Drawing, after: Whole, factor: float) -> Whole:
    """Return a drawing that was scaled, with borders that are to dots what they were.

    As it is where no piece of a border has a policy of its own: then its borders can wait.
    """
    spoken = [
        replace(arc, path=Path(np.rint(arc.path.vertices * factor).astype(np.int64)))
        for arc in before.borders.values()
        if isinstance(arc, Arc) and arc.policies
    ]
    if not spoken:
        return after
    made = map_of(after)
    borders: dict[int, records.Record] = dict(
        zip(made.arcs, inherited(spoken, list(made.arcs.values())), strict=True)
    )
    areas = {k: replace(a, outline_mm=made.outline(k)) for k, a in after.areas.items()}
    return replace(after, borders=borders, areas=areas)


def edit_areas(
    document: Document,
    label: str,
    edit: Callable[[PlanarMap], Outcome],
    style: int | None = None,
    names: Mapping[int, str] | None = None,
    also: Callable[[Outcome], None] | None = None,
) -> Outcome:
    """Edit areas as one step of the history.

    Parameters
    ----------
    edit : callable
        From the map before to what one of the edits in `planar` makes of it.
    style : int, optional
        Of new areas; else that of the area in whose place they are.
    names : mapping of int to str, optional
        Of new areas.
    also : callable, optional
        Changes the document further within the same step.

    Raises
    ------
    GeometryError
        If the edit is refused; then nothing has changed.

    Notes
    -----
    Dots change hands where borders swept over them, and nowhere else.
    """
    before = current_map(document)
    outcome = edit(before)
    refuse_locked(document.drawing, before, outcome.map)

    def act(document: Document) -> None:
        _take(document, before, outcome, style, names or {})
        if also is not None:
            also(outcome)

    as_one_step(document, label, act)
    _last[document] = outcome.map
    return outcome


def edit_areas_within(document: Document, edit: Callable[[PlanarMap], Outcome]) -> Outcome:
    """Edit areas within a stroke that has begun, with whatever else is in it; see `edit_areas`."""
    before = current_map(document)
    outcome = edit(before)
    refuse_locked(document.drawing, before, outcome.map)
    _take(document, before, outcome, None, {})
    return outcome


def _take(
    document: Document,
    before: PlanarMap,
    outcome: Outcome,
    style: int | None,
    names: Mapping[int, str],
) -> None:
    _set_borders(document, outcome.map)
    _set_areas(document, before, outcome, style, names)
    _hand_over(document, before, outcome.map)
    _adopt(document, outcome)


_last: WeakKeyDictionary[Document, PlanarMap] = WeakKeyDictionary()


def current_map(document: Document) -> PlanarMap:
    """Return the areas of a document as a map; the same one until they change."""
    known = _last.get(document)
    drawing = document.drawing
    borders: Mapping[int, Arc] = drawing.table(records.BORDER)
    if not borders:
        return _borderless_map(document)
    if known is not None and len(borders) == len(known.arcs):
        fresh = known.next_area == drawing.first_free(records.AREA)
        if fresh and all(borders.get(k) is arc for k, arc in known.arcs.items()):
            return known
    _last[document] = made = map_of(drawing)
    return made


_borderless: WeakKeyDictionary[Document, tuple[object, PlanarMap]] = WeakKeyDictionary()


def _borderless_map(document: Document) -> PlanarMap:
    """Return the map of a drawing that has no borders yet."""
    drawing = document.drawing
    key = (drawing.page, dict(drawing.areas), drawing.first_free(records.AREA))
    known = _borderless.get(document)
    if known is not None and known[0] == key:
        return known[1]
    made = map_of(drawing)
    _borderless[document] = (key, made)
    return made


def _set_borders(document: Document, after: PlanarMap) -> None:
    old: Mapping[int, Arc] = document.drawing.table(records.BORDER)
    for k in [k for k in old if k not in after.arcs]:
        document.set(records.BORDER, k, None)
    for k, arc in after.arcs.items():
        if old.get(k) is not arc:
            document.set(records.BORDER, k, arc)
    document.drawing.next_id[records.BORDER] = after.next_arc


def _set_areas(
    document: Document,
    before: PlanarMap,
    outcome: Outcome,
    style: int | None,
    names: Mapping[int, str],
) -> None:
    areas: dict[int, Area] = document.drawing.table(records.AREA)
    for k in sorted(touched(before, outcome.map) | set(outcome.made)):
        if k in outcome.gone and k != PAGE_AREA:  # the page's owns nothing then, and stays
            continue
        outline = outcome.map.outline(k)
        if k in areas:
            document.set(records.AREA, k, replace(areas[k], outline_mm=outline))
        else:
            own = areas[_came_from(before, outline)].style if style is None else style
            made = Area(names.get(k) or f"area {k}", outline, own, _COLOURS[k % len(_COLOURS)])
            document.set(records.AREA, k, made)
    for k in outcome.gone:
        if k in areas and k != PAGE_AREA:
            document.set(records.AREA, k, None)
    document.drawing.next_id[records.AREA] = max(
        outcome.map.next_area, document.drawing.first_free(records.AREA)
    )


def _came_from(before: PlanarMap, outline: Outline) -> int:
    """Return the area in whose place a new one is."""
    point = outline.representative_point()
    return max(int(before.area_at([(point.x, point.y)])[0]), 0)


def _hand_over(document: Document, before: PlanarMap, after: PlanarMap) -> None:
    dots = document.dots
    which, area = dots_in_strip(before, after, dots.position_mm, dots.area)
    kept = area >= 0
    if kept.any():
        document.change("area", which[kept], area[kept].astype(np.int32))


def _adopt(document: Document, outcome: Outcome) -> None:
    """Give dots that areas which are gone have left, on the very rim, to those that are there."""
    gone = [k for k in outcome.gone if k != PAGE_AREA]
    rows = np.flatnonzero(np.isin(document.dots.area, gone)) if gone else np.empty(0, np.int64)
    if len(rows):
        area = outcome.map.area_at(document.dots.position_mm[rows])
        document.change("area", rows, np.maximum(area, PAGE_AREA).astype(np.int32))


def refuse_locked(drawing: Drawing, before: PlanarMap, after: PlanarMap) -> None:
    """Raise GeometryError if a locked area would have another outline.

    Nodes that a neighbour's border sets on its border do not count.
    """
    held = [k for k in held_areas(drawing) if k in before.areas]
    if not held:
        return
    for k in sorted(touched(before, after) & set(held)):
        old, new = before.outline(k), after.outline(k)
        if old.symmetric_difference(new).area > LEAST_WIDTH_MM * old.length:
            name = drawing.areas[k].name
            raise GeometryError("is locked", f"area {name}", "unlock it in the list of areas")


def held_areas(drawing: Drawing) -> list[int]:
    """Return the areas that are locked, and so give nothing away."""
    return [k for k, area in drawing.areas.items() if area.locked]
