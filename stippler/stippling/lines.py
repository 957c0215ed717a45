"""Dots and lines: distances kept, dots that line up, spacing in one dimension, rows."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.line import Line
from stippler.drawing.planar.path import Path
from stippler.drawing.reference import Reference
from stippler.errors import GeometryError, ParameterError

Points: TypeAlias = NDArray[np.float64]
Ints: TypeAlias = NDArray[np.int64]
Tone: TypeAlias = Callable[[Points], Points]
"""From places to how many dots they want, relatively."""

_SAMPLES = 8  # of the tone, in a dot's part of a line
_SAME_PLACE_MM = 1e-6
_LEAST_TANGLE, _LOOKED_AT, _MOST_MET = 1000, 64, 300_000  # segments, and pairs of their boxes
_FAINTEST = 0.05  # darkness that is added along lines, so that none is left without dots
MOST_ROW = 1_000_000


def spread(
    line: Line,
    along: Points,
    tone: Tone | None = None,
    fixed: NDArray[np.bool_] | None = None,
    share: float = 1.0,
) -> Points:
    """Spread dots along a line, so that each has the same part of its tone.

    Parameters
    ----------
    along : (n,) float64
        Arc lengths; in any order, which is kept.
    tone : callable, optional
        How dense dots are to lie; even if left out.
    fixed : (n,) bool, optional
        Dots that stay, and that the others are spread between.
    share : float
        How much of the way to go.

    Returns
    -------
    (n,) float64

    Notes
    -----
    In the measure that the tone gives, even spacing is where the energy of one-dimensional Lloyd
    relaxation is least, and it is convex: no share of the way raises it.
    """
    n = len(along)
    if n == 0:
        return np.empty(0)
    length = line.length_mm
    s, mass = _measure(line, tone, n)
    whole = float(mass[-1])
    order = np.argsort(along, kind="stable")
    m = np.interp(along[order] % length if line.is_closed else along[order], s, mass)
    if line.is_closed:
        order, m = order[np.argsort(m, kind="stable")], np.sort(m)
    still = np.zeros(n, np.bool_) if fixed is None else np.asarray(fixed, np.bool_)[order]
    goal = _even(m, still, whole, line.is_closed)
    at = m + share * (goal - m)
    out = np.empty(n)
    out[order] = np.interp(at % whole if line.is_closed else at, mass, s)
    if fixed is not None:
        out[fixed] = along[fixed]
    return out


def _measure(line: Line, tone: Tone | None, n: int) -> tuple[Points, Points]:
    """Return arc lengths, and the tone's integral up to them."""
    length = line.length_mm
    if tone is None:
        return np.array([0.0, length]), np.array([0.0, length])
    s = np.linspace(0.0, length, max(64, _SAMPLES * n) + 1)
    middle = (s[1:] + s[:-1]) / 2
    wanted = np.maximum(np.asarray(tone(line.at(middle)), np.float64), 0.0)
    wanted = np.maximum(wanted, 1e-6 * max(float(wanted.max(initial=0.0)), 1e-300))
    mass = np.r_[0.0, np.cumsum(wanted * np.diff(s))]
    return s, mass


def _even(m: Points, still: NDArray[np.bool_], whole: float, closed: bool) -> Points:
    """Return where sorted dots lie evenly between those that stay."""
    n = len(m)
    rank = np.arange(n)
    if not still.any():
        if not closed:
            return np.asarray((rank + 0.5) / n * whole)
        step = whole / n
        return np.asarray(rank * step + float((m - rank * step).mean()))
    anchors = np.flatnonzero(still)
    xp, fp = anchors.astype(np.float64), m[anchors]
    if closed:
        xp = np.r_[xp[-1] - n, xp, xp[0] + n]
        fp = np.r_[fp[-1] - whole, fp, fp[0] + whole]
    else:  # as if half a step lay beyond both ends
        first, last = anchors[0], anchors[-1]
        lead = fp[0] / (first + 0.5)
        rest = (whole - fp[-1]) / (n - 1 - last + 0.5)
        xp = np.r_[-0.5, xp, n - 0.5]
        fp = np.r_[fp[0] - lead * (first + 0.5), fp, fp[-1] + rest * (n - 1 - last + 0.5)]
    return np.interp(rank, xp, fp)


def tone_along(reference: Reference | None) -> Tone | None:
    """Return how dense dots are to lie along lines by a picture: spaced like those around them.

    As many as have the darkness in the plane: the root of it along a line. None without a picture.
    """
    if reference is None:
        return None
    return lambda places: np.sqrt(_FAINTEST + reference.at(places).astype(np.float64))


def crossings(lines: Sequence[Line]) -> list[tuple[int, float, int, float]]:
    """Return where lines cross: (line, arc length, other line, arc length), each pair once.

    Where a line crosses itself it is its own other. In a tangle of hundred thousands of crossings
    none is found.
    """
    if not lines or _is_tangle(lines):
        return []
    shapes = np.array([shapely.linestrings(line.path.points_mm) for line in lines])
    a, b = shapely.STRtree(shapes).query(shapes, predicate="crosses")
    once = np.flatnonzero(a < b)
    once = once[np.lexsort((b[once], a[once]))]
    a, b = a[once], b[once]
    parts, pair = shapely.get_parts(shapely.intersection(shapes[a], shapes[b]), return_index=True)
    xy, part = shapely.get_coordinates(parts, return_index=True)
    places = shapely.points(xy[np.searchsorted(part, np.arange(len(parts)))])
    s, t = (shapely.line_locate_point(shapes[k[pair]], places) for k in (a, b))
    found = zip(a[pair].tolist(), s.tolist(), b[pair].tolist(), t.tolist(), strict=True)
    loops = [(k, s, k, t) for k, line in enumerate(lines) for s, t in _own_crossings(line)]
    return [*found, *loops]


def _is_tangle(lines: Sequence[Line]) -> bool:
    """Tell by some of the segments whether there would be too many crossings to look at."""
    ends = np.concatenate([line.segments()[:, :4] for line in lines]).reshape(-1, 2, 2)
    if len(ends) < _LEAST_TANGLE:
        return False
    boxes = shapely.box(*ends.min(axis=1).T, *ends.max(axis=1).T)
    some = boxes[:: max(len(boxes) // _LOOKED_AT, 1)]
    met = len(shapely.STRtree(boxes).query(some)[0])
    return (met / len(some) - 3.0) * len(boxes) / 2 > _MOST_MET  # beside its neighbours


def _own_crossings(line: Line) -> list[tuple[float, float]]:
    """Return the arc lengths at which a line crosses itself, the lower first."""
    at, s = line.path.points_mm, line.arc_lengths()
    if shapely.is_simple(shapely.linestrings(at)):
        return []
    segments = shapely.linestrings(np.stack([at[:-1], at[1:]], axis=1))
    a, b = shapely.STRtree(segments).query(segments, predicate="intersects")
    ends = line.is_closed & (a == 0) & (b == len(segments) - 1)
    apart = np.flatnonzero((b - a > 1) & ~ends)  # those beside one another meet anyway
    apart = apart[np.lexsort((b[apart], a[apart]))]
    a, b = a[apart], b[apart]
    met = shapely.intersection(segments[a], segments[b])
    is_point = shapely.get_type_id(met) == 0
    xy, a, b = shapely.get_coordinates(met[is_point]), a[is_point], b[is_point]
    _, once = np.unique(np.round(xy / _SAME_PLACE_MM).astype(np.int64), axis=0, return_index=True)
    once = np.sort(once)  # at a vertex several segments meet
    sides = (s[k[once]] + np.hypot(*(xy[once] - at[k[once]]).T) for k in (a, b))
    return list(zip(*(side.tolist() for side in sides), strict=True))


def spread_all(
    lines: Sequence[Line], line_of: Ints, along: Points, tone: Tone | None = None
) -> tuple[Points, Points]:
    """Spread dots along many lines; where two cross, one dot lies in the crossing for both.

    Returns
    -------
    along : (n,) float64
    points : (n, 2) float64
    """
    along = np.array(along, np.float64)
    fixed = np.zeros(len(along), np.bool_)
    ghosts: dict[int, list[float]] = {}
    for i, s, j, t in crossings(lines):
        near = _nearest_on(lines[i], np.flatnonzero((line_of == i) & ~fixed), along, s)
        if near is None:
            continue
        along[near], fixed[near] = s, True
        ghosts.setdefault(j, []).append(t)
    points = np.empty((len(along), 2))
    for k, line in enumerate(lines):
        mine = np.flatnonzero(line_of == k)
        if not len(mine):
            continue
        more = np.array(ghosts.get(k, []))
        held = np.r_[fixed[mine], np.ones(len(more), np.bool_)]
        found = spread(line, np.r_[along[mine], more], tone, held if held.any() else None)
        along[mine] = found[: len(mine)]
        points[mine] = line.at(along[mine])
    return along, points


def _nearest_on(line: Line, mine: NDArray[np.intp], along: Points, s: float) -> int | None:
    """Return the dot nearest along a line, if it is no farther than the mean spacing."""
    if not len(mine):
        return None
    off = np.abs(along[mine] - s)
    if line.is_closed:
        off = np.minimum(off, line.length_mm - off)
    k = int(np.argmin(off))
    return int(mine[k]) if off[k] <= line.length_mm / len(mine) else None


def row(line: Line, n: int | None = None, distance_mm: float | None = None,
        tone: Tone | None = None) -> Points:  # fmt: skip
    """Return a row of dots along a line: so many, or about so far apart.

    An open line's first and last dot lie half a distance from its ends.
    """
    return line.at(row_along(line, n, distance_mm, tone))


def row_along(line: Line, n: int | None = None, distance_mm: float | None = None,
              tone: Tone | None = None) -> Points:  # fmt: skip
    """Return the arc lengths of a row of dots; see `row`."""
    if (n is None) == (distance_mm is None):
        raise ParameterError("give a number or a distance, not both", "row")
    if n is None:
        if not (distance_mm and math.isfinite(distance_mm) and distance_mm > 0):
            raise ParameterError(f"{distance_mm} mm is no distance", "row", "give more than 0")
        n = max(1, round(line.length_mm / distance_mm))
    if not 1 <= n <= MOST_ROW:
        raise ParameterError(f"{n} dots cannot be laid", "row", f"give 1 to {MOST_ROW:,}")
    start = np.arange(n) / n * line.length_mm
    return spread(line, start, tone)


INSIDE, OUTSIDE, ON = "inside", "outside", "on"


def border_lines(outline: Polygon | MultiPolygon, side: str, away_mm: float = 0.0) -> list[Line]:
    """Return closed lines along an area's border: inside or outside by a distance, or on it."""
    if side not in (INSIDE, OUTSIDE, ON):
        raise ParameterError(f"{side!r} is unknown", "row", "one of inside, outside, on")
    by = {INSIDE: -away_mm, OUTSIDE: away_mm, ON: 0.0}[side]
    shape = outline.buffer(by) if by else outline
    polygons = list(shape.geoms) if isinstance(shape, MultiPolygon) else [shape]
    rings = [r for p in polygons if not p.is_empty for r in (p.exterior, *p.interiors)]
    if not rings:
        raise GeometryError("is too narrow for this distance", "area", "take a smaller one")
    return [
        Line("border", Path.polyline(shapely.get_coordinates(ring), closed=True), (0.0, 0.0))
        for ring in rings
    ]


def hatch_lines(
    outline: Polygon | MultiPolygon, distance_mm: float, angle_rad: float = 0.0
) -> list[Line]:
    """Return parallel lines that fill an area."""
    if not (math.isfinite(distance_mm) and distance_mm > 0 and math.isfinite(angle_rad)):
        raise ParameterError("need a distance above 0 and an angle", "hatching")
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    along, across = np.array([c, s]), np.array([-s, c])
    corners = np.array(shapely.box(*outline.bounds).exterior.coords)
    low, high = (corners @ across).min(), (corners @ across).max()
    first, last = (corners @ along).min() - 1.0, (corners @ along).max() + 1.0
    n = int((high - low) / distance_mm) + 1
    if n > 100_000:
        raise ParameterError(f"would be {n:,} lines", "hatching", "take a larger distance")
    at = np.arange(n) * distance_mm + low + 0.5 * ((high - low) - (n - 1) * distance_mm)
    ends = np.stack([first * along + at[:, None] * across, last * along + at[:, None] * across], 1)
    found = shapely.get_parts(shapely.intersection(shapely.linestrings(ends), outline))
    found = found[(shapely.get_type_id(found) == 1) & (shapely.length(found) > 1e-3)]
    return [
        Line("hatch", Path.polyline(shapely.get_coordinates(part)), (0.0, 0.0)) for part in found
    ]
