"""Whether borders that were read are a map: what is wrong with them, and where."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.planar.graph import number_nodes
from stippler.drawing.planar.noding import contacts, one_way, pairs_beside
from stippler.drawing.planar.path import UNIT_MM
from stippler.drawing.planar.planar_map import OUTSIDE, PAGE, Arc, PlanarMap, Segments
from stippler.drawing.planar.slivers import LEAST_WIDTH_MM

Ints = NDArray[np.int64]

MOST_PAIRS = 400_000_000
"""Pairs of segments to be looked at, about a second's; more are too crowded to be checked."""


@dataclass(frozen=True, slots=True)
class Fault:
    """What is wrong, and where on the page."""

    what: str
    at_mm: tuple[float, float]

    def __str__(self) -> str:
        return f"{self.what}, at {self.at_mm[0]:.3f}, {self.at_mm[1]:.3f} mm"


def fault_of(
    arcs: Mapping[int, Arc],
    outlines: Mapping[int, Polygon | MultiPolygon],
    size_mm: tuple[float, float],
) -> Fault | None:
    """Return the first fault of borders, or of outlines that are to be theirs.

    Parameters
    ----------
    arcs : mapping of int to Arc
        At least one.
    outlines : mapping of int to polygon, mm
        Of the areas, by their ids.
    size_mm
        Of the page.

    Notes
    -----
    Borders are a map if they meet in nodes only, if around every node and every island the areas
    beside them agree, and if what is not outside fills the page.
    """
    ids, listed = list(arcs), list(arcs.values())
    counts = np.array([len(arc.path) - 1 for arc in listed])
    arc_of = np.repeat(np.arange(len(ids)), counts)
    segments = Segments.of(listed)
    strange = _strange_side(ids, listed, outlines)
    return (
        strange
        or _crossing(segments.xy, arc_of, ids)
        or _disagreement(segments, arc_of, ids)
        or _uncovered(segments, size_mm)
        or _other_outline(arcs, segments, outlines)
    )


def invalid_outline(outlines: Mapping[int, Polygon | MultiPolygon]) -> Fault | None:
    """Return the first outline that crosses itself."""
    ids = list(outlines)
    shapes = np.array([outlines[k] for k in ids], object)
    for n in np.flatnonzero(~shapely.is_valid(shapes)).tolist():
        why = shapely.is_valid_reason(shapes[n])
        what, _, place = why.partition("[")
        x, y = (float(text) for text in place.rstrip("]").split()[:2])
        return Fault(f"area {ids[n]} is no outline ({what.strip().lower()})", (x, y))
    return None


def _strange_side(
    ids: list[int], arcs: list[Arc], outlines: Mapping[int, Polygon | MultiPolygon]
) -> Fault | None:
    for k, arc in zip(ids, arcs, strict=True):
        for side in (arc.left, arc.right):
            if side != OUTSIDE and side not in outlines:
                what = f"border {k} has area {side} beside it, which is not there"
                return Fault(what, _mm(arc.path.vertices[0]))
    return None


def _crossing(xy: Ints, arc_of: Ints, ids: list[int]) -> Fault | None:
    if (xy[:, :2] == xy[:, 2:]).all(axis=1).any():
        k = int(np.flatnonzero((xy[:, :2] == xy[:, 2:]).all(axis=1))[0])
        return Fault(f"border {ids[arc_of[k]]} stands still", _mm(xy[k, :2]))
    turned = np.ascontiguousarray(xy[:, [1, 0, 3, 2]])
    n_pairs, axis = min((pairs_beside(xy), 0), (pairs_beside(turned), 1))
    if n_pairs > MOST_PAIRS:
        return Fault("borders are too crowded to be checked", _mm(np.median(xy[:, :2], axis=0)))
    which, at = contacts(turned if axis else xy, np.ones(len(xy), np.bool_))
    if not len(which):
        return _doubled(xy, arc_of, ids)
    place = at[0][::-1] if axis else at[0]
    there = which[(at == at[0]).all(axis=1)]
    names = sorted({ids[arc_of[k]] for k in there.tolist()})
    who = " and ".join(f"border {k}" for k in names[:2])
    return Fault(f"{who} {'cross' if len(names) > 1 else 'meets others or itself'}", _mm(place))


def _doubled(xy: Ints, arc_of: Ints, ids: list[int]) -> Fault | None:
    """Return where two borders run along the same segment."""
    same_way = one_way(xy)
    order = np.lexsort(same_way.T)
    equal = (same_way[order[1:]] == same_way[order[:-1]]).all(axis=1)
    for n in np.flatnonzero(equal)[:1].tolist():
        first, second = sorted(ids[arc_of[order[k]]] for k in (n, n + 1))
        return Fault(f"border {first} and border {second} lie on one another", _mm(xy[order[n]]))
    return None


def _disagreement(s: Segments, arc_of: Ints, ids: list[int]) -> Fault | None:
    """Return where borders tell different areas of one place."""
    from stippler.kernels.planar.faces import find_roots, join_sides, sort_around, winding_around

    nodes, number = number_nodes(s.xy.reshape(-1, 2))
    a, b = np.ascontiguousarray(number.reshape(-1, 2).T)
    ends = np.concatenate([a, b])
    start = np.r_[0, np.cumsum(np.bincount(ends, minlength=len(nodes)))]
    around = np.full(len(ends), -1, np.int64)
    sort_around(nodes, a, b, start, around)
    sides = np.arange(2 * len(a))
    join_sides(start, around, np.ones(len(nodes), np.bool_), sides)
    find_roots(sides)
    beside = np.column_stack([s.left, s.right]).reshape(-1)
    wrong = np.flatnonzero(beside != beside[sides])
    if len(wrong):
        k = int(wrong[0])
        one, other = int(beside[k]), int(beside[sides[k]])
        what = f"the place beside border {ids[arc_of[k // 2]]} is {_area(one)}"
        return Fault(f"{what} and {_area(other)} at once", _mm(s.xy[k // 2]))
    return _misplaced(s, arc_of, ids, a, b, winding_around)


def _misplaced(
    s: Segments, arc_of: Ints, ids: list[int], a: Ints, b: Ints, winding_around: object
) -> Fault | None:
    """Return an island that lies in another area than its borders tell."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    n_nodes = int(max(a.max(), b.max())) + 1
    links = coo_matrix((np.ones(len(a)), (a, b)), (n_nodes, n_nodes))
    n, of_node = connected_components(links, directed=False)
    component = of_node[a].astype(np.int64)
    leftmost = _leftmost(s.xy, component, n)
    jump = s.left - s.right
    for c in range(n):
        k, forward = leftmost[c]
        x, y = (s.xy[k, :2] if forward else s.xy[k, 2:]).tolist()
        around = OUTSIDE + int(winding_around(x, y, s.xy, jump, c, component))  # type: ignore[operator]
        # seen from its leftmost node, the uppermost edge has the outer side on its upper hand
        told = int(s.left[k] if forward else s.right[k])
        if told != around:
            what = f"what border {ids[arc_of[k]]} bounds lies in {_area(around)}"
            return Fault(f"{what}, and its outer side is {_area(told)}", _mm((x, y)))
    return None


def _leftmost(xy: Ints, component: Ints, n: int) -> list[tuple[int, bool]]:
    """Return for each component the uppermost segment at its left end, and if it begins there."""
    at = np.concatenate([xy[:, :2], xy[:, 2:]])
    to = np.concatenate([xy[:, 2:], xy[:, :2]])
    of = np.concatenate([component, component])
    order = np.lexsort((at[:, 1], at[:, 0], of))
    first = order[np.r_[True, of[order][1:] != of[order][:-1]]]
    best: dict[int, int] = {int(of[h]): int(h) for h in first}
    corner = np.zeros((n, 2), np.int64)
    corner[of[first]] = at[first]
    for h in np.flatnonzero((at == corner[of]).all(axis=1)).tolist():
        old = best[int(of[h])]
        (ox, oy), (hx, hy) = (to[old] - at[old]).tolist(), (to[h] - at[h]).tolist()
        if ox * hy - oy * hx > 0:  # further towards greater y
            best[int(of[h])] = h
    m = len(xy)
    return [(best[c] % m, best[c] < m) for c in range(n)]


def _uncovered(s: Segments, size_mm: tuple[float, float]) -> Fault | None:
    """Return whether what is not outside is other than the page."""
    rim = (s.left == OUTSIDE) != (s.right == OUTSIDE)
    xy = s.xy[rim].astype(np.float64) * UNIT_MM
    size = np.array(size_mm)
    near = 2.0 * UNIT_MM
    at = xy.reshape(-1, 2)
    beyond = ((at < -near) | (at > size + near)).any(axis=1)
    if beyond.any():
        return Fault("the page's border leaves the page", tuple(at[beyond][0].tolist()))
    cross = xy[:, 0] * xy[:, 3] - xy[:, 2] * xy[:, 1]
    area = abs(0.5 * float(np.where(s.left[rim] == OUTSIDE, -cross, cross).sum()))
    whole = float(size.prod())
    if abs(area - whole) > 4.0 * near * float(size.sum()):
        return Fault(f"borders bound {area:.6g} of the page's {whole:.6g} mm²", (0.0, 0.0))
    return None


def _other_outline(
    arcs: Mapping[int, Arc], s: Segments, outlines: Mapping[int, Polygon | MultiPolygon]
) -> Fault | None:
    """Return an area that is not what its borders bound."""
    made = PlanarMap(arcs, max(arcs) + 1, max(outlines, default=PAGE) + 1)
    for k in _odd_areas(s, outlines):
        if (fault := invalid_outline({k: outlines[k]})) is not None:
            return fault
        told, bounded = outlines[k], made.outline(k)
        rest = shapely.symmetric_difference(told, bounded)
        if rest.area > LEAST_WIDTH_MM * max(told.length, bounded.length):
            at = rest.representative_point()
            return Fault(f"area {k} is not what its borders bound", (at.x, at.y))
    return None


def _odd_areas(s: Segments, outlines: Mapping[int, Polygon | MultiPolygon]) -> list[int]:
    """Return the areas whose outlines do not run along the same segments as their borders."""
    ids = np.fromiter(outlines, np.int64)
    parts, area_of_part = shapely.get_parts(list(outlines.values()), return_index=True)
    rings, part_of_ring = shapely.get_rings(parts, return_index=True)
    area_of_ring = area_of_part[part_of_ring]
    at, ring_of = shapely.get_coordinates(rings, return_index=True)
    grid = np.rint(at / UNIT_MM).astype(np.int64)
    same = ring_of[1:] == ring_of[:-1]
    told = np.column_stack([ids[area_of_ring[ring_of]][:-1], grid[:-1], grid[1:]])[same]
    told = told[(told[:, 1:3] != told[:, 3:]).any(axis=1)]
    part = s.left != s.right
    both = [np.column_stack([side[part], s.xy[part]]) for side in (s.left, s.right)]
    bounded = np.concatenate(both)
    bounded = bounded[bounded[:, 0] != OUTSIDE]
    odd = np.zeros(max(int(bounded[:, 0].max(initial=0)), int(ids.max())) + 1, np.uint64)
    np.add.at(odd, told[:, 0], _mixed(told[:, 1:]))
    np.subtract.at(odd, bounded[:, 0], _mixed(bounded[:, 1:]))
    return [int(k) for k in ids if odd[k]]


def _mixed(xy: Ints) -> NDArray[np.uint64]:
    """Return numbers by which sets of segments are told apart, whatever way they run."""
    ends = xy.view(np.uint64) if xy.flags.c_contiguous else np.ascontiguousarray(xy).view(np.uint64)
    a, b = (_spread(_spread(ends[:, k]) + ends[:, k + 1]) for k in (0, 2))
    return _spread((a + b) ^ (a * b))


def _spread(x: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Mix the bits of numbers; Steele et al. 2014 (splitmix64)."""
    x = x + np.uint64(0x9E3779B97F4A7C15)
    x = (x ^ (x >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    x = (x ^ (x >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return x ^ (x >> np.uint64(31))


def _area(k: int) -> str:
    return "outside" if k == OUTSIDE else f"area {k}"


def _mm(at: object) -> tuple[float, float]:
    x, y = np.asarray(at, np.float64)[:2] * UNIT_MM
    return float(x), float(y)
