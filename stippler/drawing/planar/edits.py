"""Edits of areas: each returns a new map, or refuses and says why."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.planar.borders import welded
from stippler.drawing.planar.overlay import Laid, overlay
from stippler.drawing.planar.path import UNIT_MM, Path
from stippler.drawing.planar.planar_map import OUTSIDE, PAGE, PlanarMap
from stippler.drawing.planar.rings import HalfEdge
from stippler.drawing.planar.slivers import (
    LEAST_AREA_MM2,
    give,
    is_sliver,
    with_sides,
    without_slivers,
)
from stippler.errors import GeometryError, ParameterError

Ints = NDArray[np.int64]

TAKES, IS_CUT, REFUSED = "takes", "is-cut", "refused"
CHOICES = (TAKES, IS_CUT, REFUSED)
"""What a new area does where others lie: takes from them, is cut by them, or is refused."""

NON_ZERO, EVEN_ODD = "non-zero", "even-odd"
_MOST_VERTICES = 200_000


@dataclass(frozen=True, slots=True, eq=False)
class Outcome:
    """What an edit made.

    Attributes
    ----------
    map : PlanarMap
    made : tuple of int
        New areas.
    gone : tuple of int
        Areas that lost their place.
    notes : tuple of str
        What was repaired or left out.
    """

    map: PlanarMap
    made: tuple[int, ...] = ()
    gone: tuple[int, ...] = ()
    notes: tuple[str, ...] = ()


def add(
    before: PlanarMap,
    outline: Sequence[Path] | Path,
    where_others_lie: str = TAKES,
    *,
    locked: Iterable[int] = (),
    rule: str = NON_ZERO,
) -> Outcome:
    """Add an area by its outline.

    Parameters
    ----------
    outline : Path or list of Path
        Closed; several for holes and islands.
    where_others_lie : {"takes", "is-cut", "refused"}
    locked : iterable of int
        Areas that give nothing away.
    rule : {"non-zero", "even-odd"}
        What counts as inside where an outline crosses itself.

    Raises
    ------
    GeometryError
        If the outline has no extent, lies off the page or within others, or is refused.
    """
    if where_others_lie not in CHOICES:
        raise ParameterError(f"{where_others_lie!r} is unknown", "add", f"of {', '.join(CHOICES)}")
    paths, notes = _checked_outline(before, outline)
    new = before.next_area
    held = set(locked)
    taken_from: set[int] = set()

    def relabel(old: Ints, winding: Ints) -> Ints:
        inside = _inside(winding, rule) & (old != OUTSIDE)
        taken_from.update(np.unique(old[inside]).tolist())
        inside &= ~np.isin(old, list(held))
        if where_others_lie == IS_CUT:
            inside &= old == PAGE
        return np.where(inside, new, old)

    after = overlay(before, Laid(paths, relabel), new + 1)
    others = sorted(taken_from - {PAGE})
    if where_others_lie == REFUSED and others:
        raise GeometryError(
            f"lies on {_names(others)}", "the new area", "draw it beside, or let it take from them"
        )
    outcome = _finished(before, after, notes, new)
    if _reaches_out(before, paths):
        return Outcome(outcome.map, outcome.made, outcome.gone, (*outcome.notes, _CLIPPED))
    return outcome


_CLIPPED = "what lay off the page was left out"


def _finished(
    before: PlanarMap, after: PlanarMap, notes: Sequence[str] = (), new: int | None = None
) -> Outcome:
    """Give slivers away and tell what came and went."""
    after = without_slivers(after, touched(before, after))
    present, had = set(after.areas), set(before.areas)
    if new is not None and new not in present:
        raise GeometryError(
            "has no place of its own",
            "the new area",
            "draw it larger, on the page, off locked areas",
        )
    return Outcome(after, tuple(sorted(present - had)), tuple(sorted(had - present)), tuple(notes))


def touched(before: PlanarMap, after: PlanarMap) -> set[int]:
    """Return the areas of which an edit changed a border."""
    pairs = after.changes(before).values()
    found = {x for pair in pairs for a in pair if a is not None for x in (a.left, a.right)}
    return found - {OUTSIDE}


def _inside(winding: Ints, rule: str) -> NDArray[np.bool_]:
    return np.asarray((winding % 2 == 1) if rule == EVEN_ODD else (winding != 0))


def _names(areas: Iterable[int]) -> str:
    return ", ".join(f"area {k}" for k in areas)


def _checked_outline(
    before: PlanarMap, outline: Sequence[Path] | Path
) -> tuple[list[Path], list[str]]:
    """Close rings, drop those without extent, weld to borders, say what crosses itself."""
    given = [outline] if isinstance(outline, Path) else list(outline)
    paths: list[Path] = []
    notes: list[str] = []
    if sum(len(p) for p in given) > _MOST_VERTICES:
        raise GeometryError(
            f"has more than {_MOST_VERTICES:,} vertices", "outline", "simplify it first"
        )
    for path in given:
        if len(path) >= 2 and not path.is_closed:
            path = Path(np.vstack([path.vertices, path.vertices[:1]]), path.curves)
        if len(path) < 4:
            continue
        paths.append(path)
        if not shapely.is_simple(shapely.linestrings(path.points_mm)):
            notes.append("the outline crossed itself; it was cut at its crossings")
    if not paths or sum(_extent(p) for p in paths) < LEAST_AREA_MM2:
        raise GeometryError("has no extent", "outline", "draw around a place")
    paths = [welded(before, path) for path in paths]
    return paths, list(dict.fromkeys(notes))


def _extent(path: Path) -> float:
    x0, y0, x1, y1 = path.box()
    return (x1 - x0) * (y1 - y0) * UNIT_MM**2


def _reaches_out(before: PlanarMap, paths: Sequence[Path]) -> bool:
    page = page_box(before)
    boxes = [p.box() for p in paths]
    return any(b[0] < page[0] or b[1] < page[1] or b[2] > page[2] or b[3] > page[3] for b in boxes)


def page_box(before: PlanarMap) -> tuple[int, int, int, int]:
    """Return the page's box in units of the grid."""
    boxes = np.array([a.box for a in before.arcs.values() if OUTSIDE in (a.left, a.right)])
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    return int(low[0]), int(low[1]), int(high[0]), int(high[1])


def subtract(
    before: PlanarMap, outline: Sequence[Path] | Path, areas: Iterable[int], to: int = PAGE,
    rule: str = NON_ZERO,
) -> Outcome:  # fmt: skip
    """Take what lies within an outline from some areas, and give it to another."""
    paths, notes = _checked_outline(before, outline)
    mine = list(areas)

    def relabel(old: Ints, winding: Ints) -> Ints:
        return np.where(_inside(winding, rule) & np.isin(old, mine), to, old)

    return _finished(before, overlay(before, Laid(paths, relabel)), notes)


def extend(
    before: PlanarMap, outline: Sequence[Path] | Path, area: int,
    where_others_lie: str = TAKES, locked: Iterable[int] = (), rule: str = NON_ZERO,
) -> Outcome:  # fmt: skip
    """Add what lies within an outline to an area that is there."""
    paths, notes = _checked_outline(before, outline)
    held = list(locked)

    def relabel(old: Ints, winding: Ints) -> Ints:
        inside = _inside(winding, rule) & (old != OUTSIDE) & ~np.isin(old, held)
        if where_others_lie == IS_CUT:
            inside &= old == PAGE
        return np.where(inside, area, old)

    return _finished(before, overlay(before, Laid(paths, relabel)), notes)


def cut(
    before: PlanarMap, outline: Sequence[Path] | Path, area: int, rule: str = NON_ZERO
) -> Outcome:
    """Make what lies within an outline and an area an area of its own."""
    paths, notes = _checked_outline(before, outline)
    new = before.next_area

    def relabel(old: Ints, winding: Ints) -> Ints:
        return np.where(_inside(winding, rule) & (old == area), new, old)

    return _finished(before, overlay(before, Laid(paths, relabel), new + 1), notes, new)


def unite(before: PlanarMap, areas: Sequence[int]) -> Outcome:
    """Let the first of some areas take all places of the others; borders between them go."""
    present = set(before.areas)
    if len(set(areas)) < 2 or not set(areas) <= present:
        raise GeometryError("are not two areas or more", "unite", "choose areas that are there")
    first, rest = areas[0], set(areas[1:]) - {areas[0]}
    sides = {
        k: (first if a.left in rest else a.left, first if a.right in rest else a.right)
        for k, a in before.arcs.items()
        if a.left in rest or a.right in rest
    }
    after = with_sides(before, sides)
    gone = tuple(sorted(rest - {PAGE}))
    return Outcome(without_slivers(after, [first]), (), gone)


def remove(before: PlanarMap, area: int, to: int = PAGE) -> Outcome:
    """Give all places of an area to another, the page's if none is named."""
    if area == PAGE:
        raise GeometryError("cannot be removed", "the page's area")
    if area not in before.areas:
        raise GeometryError("is not there", f"area {area}")
    if to == PAGE and PAGE not in before.areas:
        sides = {
            k: (PAGE if a.left == area else a.left, PAGE if a.right == area else a.right)
            for k, a in before.arcs.items()
            if area in (a.left, a.right)
        }
        return Outcome(with_sides(before, sides), (), (area,))
    return unite(before, [to, area])


def split(before: PlanarMap, line: Path, area: int) -> Outcome:
    """Cut an area along a line; the largest part keeps its number, the others become areas.

    Raises
    ------
    GeometryError
        If the line does not part the area.
    """
    if len(line) < 2:
        raise GeometryError("has no length", "line", "draw it across the area")
    if area not in before.areas:
        raise GeometryError("is not there", f"area {area}")

    def same(old: Ints, winding: Ints) -> Ints:
        return old

    # out and back again, so that the line winds around nothing
    there_and_back = [line, line.reversed()]
    laid = Laid(there_and_back, same, barrier_in=area, also=tuple(before.arcs_of(area)))
    between = overlay(before, laid)
    parts = sorted(between.parts(area), key=lambda part: -part.polygon.area)
    n_before = len(before.parts(area))
    parts = [part for part in parts if not is_sliver(part)]
    if len(parts) <= n_before:
        raise GeometryError("does not part the area", "line", "draw it from border to border")
    given: dict[HalfEdge, int] = {}
    new = before.next_area
    for old in before.parts(area):
        inside = [p for p in parts if old.polygon.contains(p.polygon.representative_point())]
        for part in inside[1:]:
            given.update(dict.fromkeys(part.half_edges, new))
            new += 1
    return _finished(before, give(between, given, new))
