"""From an area and a pattern to compartments; sets of polygons from files and from pictures."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.pattern import FREE, Pattern, PolygonSet
from stippler.errors import GeometryError

Shape: TypeAlias = Polygon | MultiPolygon

LEAST_AREA_MM2 = 1e-4
_MOST_CUT = 20_000


@dataclass(frozen=True, slots=True, eq=False)
class PatternCells:
    """What a pattern makes of an area.

    Attributes
    ----------
    polygons : tuple of Polygon
        Its compartments; they do not overlap.
    between : Polygon, MultiPolygon or None
        The rest of the area; None if it is to stay free of dots, or there is none.
    notes : tuple of str
        What was cut or dropped.
    """

    polygons: tuple[Polygon, ...]
    between: Shape | None
    notes: tuple[str, ...] = ()

    @property
    def compartments(self) -> list[Shape]:
        """The polygons, and what is between them where it gets dots."""
        return [*self.polygons, *([] if self.between is None else [self.between])]


def cells_of(outline: Shape, pattern: Pattern) -> PatternCells:
    """Lay a pattern over an area; the answer is kept for the same outline and pattern.

    Raises
    ------
    GeometryError
        If no polygon meets the area.
    """
    return _cells_of(shapely.to_wkb(outline), pattern)


@lru_cache(maxsize=16)
def _cells_of(wkb: bytes, pattern: Pattern) -> PatternCells:
    outline = shapely.from_wkb(wkb)
    shapely.prepare(outline)
    notes: list[str] = []
    shapes = _polygons(pattern, notes)
    near = shapely.intersects(outline, shapes)
    shapes = shapes[near]
    if not len(shapes):
        raise GeometryError("does not meet its area", "pattern", "move it over the area")
    shapes = _without_overlaps(shapes, notes)
    whole = shapely.contains_properly(outline, shapes)
    shapes[~whole] = shapely.intersection(shapes[~whole], outline)
    parts = shapely.get_parts(shapes)
    parts = parts[shapely.get_type_id(parts) == 3]
    parts = parts[shapely.area(parts) > LEAST_AREA_MM2]
    if not len(parts):
        raise GeometryError("does not meet its area", "pattern", "move it over the area")
    between = None
    if pattern.between != FREE:
        rest = shapely.difference(outline, shapely.union_all(parts))
        pieces = [p for p in shapely.get_parts(rest) if p.area > LEAST_AREA_MM2]
        between = MultiPolygon(pieces) if pieces else None
    return PatternCells(tuple(parts.tolist()), between, tuple(notes))


def _polygons(pattern: Pattern, notes: list[str]) -> NDArray[np.object_]:
    """Return the polygons on the page; those that fold over are repaired, and said."""
    corners, start = pattern.rings_mm()
    sizes = np.diff(start)
    ring = np.repeat(np.arange(len(sizes)), sizes + 1)
    closed = np.insert(corners, start[1:], corners[start[:-1]], axis=0)
    shapes = np.array(shapely.polygons(shapely.linearrings(closed, indices=ring)))
    bad = ~shapely.is_valid(shapes)
    if bad.any():
        notes.append(f"{int(bad.sum())} polygons cross themselves; they were cut there")
        shapes[bad] = shapely.make_valid(shapes[bad])
    return shapes


def _without_overlaps(shapes: NDArray[np.object_], notes: list[str]) -> NDArray[np.object_]:
    """Cut polygons by those before them where they overlap."""
    tree = shapely.STRtree(shapes)
    first, second = tree.query(shapes, predicate="intersects")
    later = first < second
    first, second = first[later], second[later]
    if not len(first):
        return shapes
    if len(first) > _MOST_CUT * 10:
        raise GeometryError("overlap everywhere", "the pattern's polygons", "take another set")
    shared = shapely.area(shapely.intersection(shapes[first], shapes[second]))
    over = shared > LEAST_AREA_MM2
    if not over.any():
        return shapes
    out = shapes.copy()
    for i, j in zip(first[over].tolist(), second[over].tolist(), strict=True):
        out[j] = shapely.difference(out[j], shapes[i])
    notes.append(f"{int(over.sum())} pairs of polygons overlap; the later ones were cut")
    return out


def builtin_names() -> list[str]:
    """Return the names of the sets that come with the program."""
    from stippler.resources import assets

    return sorted(path.stem for path in (assets() / "patterns").glob("*.svg"))


@lru_cache(maxsize=32)
def builtin(name: str) -> PolygonSet:
    """Return a set that comes with the program: a square of 100 that can be repeated."""
    from stippler.resources import assets

    if name not in builtin_names():
        raise GeometryError("is unknown", f"pattern {name}", f"one of {', '.join(builtin_names())}")
    lines = (assets() / "patterns" / f"{name}.svg").read_text().split('points="')[1:]
    rings = []
    for line in lines:
        numbers = line.partition('"')[0].replace(",", " ").split()
        rings.append(np.array(numbers, np.float64).reshape(-1, 2) / 100.0)
    return PolygonSet.of(name, rings)


def set_of_rings(name: str, rings_mm: list[NDArray[np.float64]]) -> tuple[PolygonSet, list[str]]:
    """Make a set of rings of any size, scaled into the square from 0 to 1."""
    notes: list[str] = []
    good = [r for r in rings_mm if len(r) >= 3 and Polygon(r).area > 0]
    if len(good) < len(rings_mm):
        notes.append(f"{len(rings_mm) - len(good)} paths without extent were left out")
    if not good:
        raise GeometryError("has no polygon", f"pattern {name}", "draw closed paths")
    every = np.concatenate(good)
    low, size = every.min(axis=0), float(np.ptp(every, axis=0).max())
    return PolygonSet.of(name, [(r - low) / size for r in good]), notes
