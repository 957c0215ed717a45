"""What a pen does to draw a layer: taps for dots of its size, spirals for larger ones, strokes."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import Dots
from stippler.files.write.raster import bit_strips
from stippler.files.write.sheet import Layer, Line, Sheet
from stippler.kernels.raster.bits import SAMPLES
from stippler.kernels.shapes.dot_shape import outlines
from stippler.stippling.tour import tour
from stippler.units import MM_PER_INCH

TAP_UP_TO = 1.1
"""Dots at most so much larger than the pen are taps."""

_PITCH = 0.85  # of the pen's width, between the turns of a spiral
_PER_TURN = 24
_HATCH = 0.9  # of the pen's width, between the lines that fill an area
_FIRST, _MIDDLE, _LAST, _ONLY = 0, 1, 2, 3

Points = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class Paths:
    """Paths in the order they are drawn: those of path k are `points_mm[starts[k]:starts[k+1]]`."""

    points_mm: Points
    starts: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.starts) - 1

    @property
    def kinds(self) -> NDArray[np.uint8]:
        """Of each point: 0 begins a path, 1 goes on, 2 ends it, 3 is all of it."""
        kinds = np.full(len(self.points_mm), _MIDDLE, np.uint8)
        first, last = self.starts[:-1], self.starts[1:] - 1
        kinds[first], kinds[last] = _FIRST, _LAST
        kinds[first[first == last]] = _ONLY
        return kinds

    @property
    def drawn_mm(self) -> float:
        """How far the pen goes on paper."""
        return float(self._steps[~self._travels].sum())

    @property
    def travelled_mm(self) -> float:
        """How far it goes above it, from the first point on."""
        return float(self._steps[self._travels].sum())

    @property
    def _steps(self) -> Points:
        step = np.diff(self.points_mm, axis=0)
        return np.hypot(step[:, 0], step[:, 1])

    @property
    def _travels(self) -> NDArray[np.bool_]:
        travels = np.zeros(max(len(self.points_mm) - 1, 0), np.bool_)
        travels[self.starts[1:-1] - 1] = True
        return travels

    def duration_s(self, feed: float, travel: float, lift_s: float) -> float:
        """Return the time that drawing takes, in s; speeds in mm a minute, without acceleration."""
        moving = self.drawn_mm / feed + self.travelled_mm / travel
        return 60.0 * moving + lift_s * len(self)


def paths_of(layer: Layer, sheet: Sheet, pen_mm: float, *, sort: bool = True) -> Paths:
    """Return what a pen of a width does for a layer of a sheet."""
    if _is_all_taps(layer, pen_mm):
        points = layer.dots.position_mm
        return Paths(points[tour(points)] if sort else points, np.arange(len(points) + 1))
    parts = list(_dots(layer.dots, pen_mm)) if not layer.inverse else []
    if layer.inverse or layer.shapes:
        parts += _hatched(layer, sheet, pen_mm)
    if not layer.inverse:
        parts += [one for line in layer.lines for one in _passes(line, pen_mm)]
    if sort:
        parts = _sorted(parts)
    if not parts:
        return Paths(np.empty((0, 2)), np.zeros(1, np.int64))
    return Paths(np.concatenate(parts), np.cumsum([0, *map(len, parts)]))


def _is_all_taps(layer: Layer, pen_mm: float) -> bool:
    if layer.inverse or layer.lines or layer.shapes:
        return False
    long = layer.dots.radius_mm * np.sqrt(layer.dots.elongation)
    return bool((long <= TAP_UP_TO * pen_mm / 2).all())


def _dots(dots: Dots, pen_mm: float) -> Iterator[Points]:
    """Yield a path a dot."""
    long = dots.radius_mm * np.sqrt(dots.elongation)
    is_tap = long <= TAP_UP_TO * pen_mm / 2
    yield from dots.position_mm[is_tap][:, None]
    rows = np.flatnonzero(~is_tap)
    n_turns = np.maximum(np.ceil((long[rows] - pen_mm / 2) / (_PITCH * pen_mm)), 1).astype(int)
    for n in np.unique(n_turns):
        yield from _spirals(dots.take(rows[n_turns == n]), int(n), pen_mm)


def _spirals(dots: Dots, n_turns: int, pen_mm: float) -> Points:
    """Return (n, m, 2): from the middle outwards, and once around inside the outline."""
    ring = outlines(dots, _PER_TURN)
    away = ring - dots.position_mm[:, None]
    reach = np.hypot(away[..., 0], away[..., 1])[..., None]
    away *= np.maximum(reach - pen_mm / 2, 0.0) / reach
    share = np.minimum(np.arange((n_turns + 1) * _PER_TURN + 1) / (n_turns * _PER_TURN), 1.0)
    at = np.arange(len(share)) % _PER_TURN
    return dots.position_mm[:, None] + away[:, at] * share[None, :, None]


def _passes(line: Line, pen_mm: float) -> Iterator[Points]:
    """Yield the ways of the pen that make up a line: one, or several side by side."""
    import shapely

    points = line.points_mm
    if line.closed:
        points = np.vstack([points, points[:1]])
    yield points
    if line.width_mm <= TAP_UP_TO * pen_mm or len(points) < 2:
        return
    n = math.ceil((line.width_mm - pen_mm) / 2 / (_PITCH * pen_mm))
    middle = shapely.linestrings(points)
    for away in np.linspace(0.0, (line.width_mm - pen_mm) / 2, n + 1)[1:]:
        outline = middle.buffer(away)
        parts: Any = getattr(outline, "geoms", [outline])
        for part in parts:
            for ring in (part.exterior, *part.interiors):
                yield np.asarray(ring.coords, np.float64)


def _hatched(layer: Layer, sheet: Sheet, pen_mm: float) -> list[Points]:
    """Return lines across what a layer fills, left out what it leaves white."""
    filled = layer if layer.inverse else replace(layer, dots=Dots.none(), lines=())
    alone = replace(sheet, layers=(filled,))
    pitch = _HATCH * pen_mm
    per_mm = SAMPLES / pitch
    lines: list[Points] = []
    first_row = 0
    for bits in bit_strips(alone, per_mm * MM_PER_INCH):
        chosen = (np.arange(first_row, first_row + len(bits)) % SAMPLES) == SAMPLES // 2
        for k in np.flatnonzero(chosen):
            y = (first_row + int(k) + 0.5) / per_mm
            lines += _runs(np.unpackbits(bits[k]), per_mm, y, pen_mm, len(lines))
        first_row += len(bits)
    return lines


def _runs(row: NDArray[np.uint8], per_mm: float, y: float, pen_mm: float, n: int) -> list[Points]:
    """Return the runs of a row, shorter by the pen at both ends, in turns from left and right."""
    edges = np.flatnonzero(np.diff(row, prepend=0, append=0))
    runs = edges.reshape(-1, 2) / per_mm + (pen_mm / 2, -pen_mm / 2)
    runs = runs[runs[:, 1] >= runs[:, 0]]
    found = [np.array([(a, y), (b, y)]) for a, b in runs]
    return found


def _sorted(parts: list[Points]) -> list[Points]:
    """Order paths so that little is travelled; open ones may be drawn from their other end."""
    if len(parts) < 3:
        return parts
    begins = np.array([path[0] for path in parts])
    ends = np.array([path[-1] for path in parts])
    order = tour((begins + ends) / 2)
    result, at = [], begins[order[0]]
    for k in order:
        path = parts[int(k)]
        to_begin, to_end = begins[k] - at, ends[k] - at
        if to_end @ to_end < to_begin @ to_begin:
            path = path[::-1]
        result.append(path)
        at = path[-1]
    return result
