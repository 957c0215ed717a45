"""Patterns that follow a picture: bands along its contours of tone, or across its edges.

Bands are drawn about streamlines that keep a distance from each other (Jobard and Lefer 1997), in
the direction that the picture's structure tensor has, smoothed so that flat places follow those
around them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import MultiPolygon, Polygon

from stippler.drawing.deformation import Deformation
from stippler.drawing.pattern import Pattern, PolygonSet
from stippler.drawing.reference import Reference
from stippler.errors import GeometryError, ParameterError

ALONG, ACROSS = "along", "across"
FOLLOWS = (ALONG, ACROSS)

Floats = NDArray[np.float64]
XY = tuple[float, float]

_SIDE = 200  # samples of the longer side
_SMOOTH = 2.0  # samples that the picture is smoothed over, and its tensor by three times as much
_STEP = 0.2  # of a band, along a line
_NEAR = 0.7  # of a band, at which a line ends beside another
_WIDTH = 0.62  # of a band, that its polygon is wide
_SHORTEST = 1.2  # bands
_MOST_LINES = 50_000


def following(
    area: int, part: Polygon | MultiPolygon, reference: Reference, band_mm: float, way: str = ALONG
) -> Pattern:
    """Return a pattern of bands over an area that follow the tone under it.

    Parameters
    ----------
    band_mm : float
        From one band's middle to the next.
    way : {"along", "across"}
        Along the contours of tone, or across the edges of the picture.

    Raises
    ------
    GeometryError
        If the picture has no slope there.
    """
    if way not in FOLLOWS:
        raise ParameterError(f"{way!r} is unknown", "pattern", f"one of {', '.join(FOLLOWS)}")
    x0, y0, x1, y1 = part.bounds
    size = max(x1 - x0, y1 - y0)
    if not (math.isfinite(band_mm) and band_mm > 0.0):
        raise ParameterError(f"{band_mm:g} mm is no width", "pattern", "give more than 0")
    if (x1 - x0) * (y1 - y0) / band_mm**2 > _MOST_LINES:
        raise ParameterError(f"{band_mm:g} mm makes too many bands", "pattern", "make them wider")
    field = _Directions.of(reference, part.bounds, way)
    lines = _streamlines(field, part, band_mm)
    made = shapely.buffer(lines, _WIDTH * band_mm / 2, cap_style="flat", quad_segs=4)
    made = shapely.simplify(made, 0.02 * band_mm)
    rings = [ring for shape in made.tolist() for ring in _without_holes(shape)]
    name = "bands along the tone" if way == ALONG else "bands across edges"
    polygons = PolygonSet.of(name, [(ring - (x0, y0)) / size for ring in rings], 0.02)
    return Pattern(area, polygons, 1, 1, Deformation((size, 0, x0, 0, size, y0, 0, 0, 1)))


def _without_holes(shape: Polygon | MultiPolygon) -> list[Floats]:
    """Return the rings of polygons; one about a hole is cut in two through it."""
    out: list[Floats] = []
    todo = list(shapely.get_parts(shape))
    while todo:
        polygon = todo.pop()
        if not isinstance(polygon, Polygon) or polygon.is_empty:
            continue
        if not polygon.interiors:
            out.append(np.asarray(polygon.exterior.coords)[:-1])
            continue
        x0, y0, x1, y1 = polygon.bounds
        middle = polygon.interiors[0].centroid.x
        for low, high in ((x0, middle), (middle, x1)):
            todo += list(shapely.get_parts(polygon.intersection(shapely.box(low, y0, high, y1))))
    return out


@dataclass(frozen=True, slots=True, eq=False)
class _Directions:
    """Unit vectors over a box, by samples; which of both ways they point does not matter."""

    low: XY
    step: float
    x: Floats
    y: Floats

    @classmethod
    def of(
        cls, reference: Reference, box: tuple[float, float, float, float], way: str
    ) -> _Directions:
        from scipy.ndimage import gaussian_filter

        x0, y0, x1, y1 = box
        step = max(x1 - x0, y1 - y0) / (_SIDE - 1)
        x, y = np.arange(x0, x1 + step, step), np.arange(y0, y1 + step, step)
        at = np.stack(np.meshgrid(x, y), -1).reshape(-1, 2)
        tone = reference.at(at).astype(np.float64).reshape(len(y), len(x))
        gy, gx = np.gradient(gaussian_filter(tone, _SMOOTH, mode="nearest"))
        if np.hypot(gx, gy).max() < 1e-5:
            raise GeometryError("has no slope here", "the picture", "take another pattern")
        wide = [
            gaussian_filter(v, 3 * _SMOOTH, mode="nearest") for v in (gx * gx, gx * gy, gy * gy)
        ]
        far = [gaussian_filter(v, 0.1 * _SIDE, mode="nearest") for v in wide]
        xx, xy, yy = (a + 0.02 * b for a, b in zip(wide, far, strict=True))
        angle = 0.5 * np.arctan2(2 * xy, xx - yy)
        if way == ALONG:
            angle += math.pi / 2
        return cls((x0, y0), step, np.cos(angle), np.sin(angle))

    def at(self, x: float, y: float, before: XY) -> XY:
        """Return the direction at a place that goes on from the one before."""
        i = min(max(round((x - self.low[0]) / self.step), 0), self.x.shape[1] - 1)
        j = min(max(round((y - self.low[1]) / self.step), 0), self.x.shape[0] - 1)
        u, v = float(self.x[j, i]), float(self.y[j, i])
        return (u, v) if u * before[0] + v * before[1] >= 0.0 else (-u, -v)


class _Taken:
    """Where lines are already, in a grid of cells as wide as they keep from each other."""

    def __init__(self, near: float) -> None:
        self._near, self._cells = near, dict[tuple[int, int], list[XY]]()

    def add(self, points: list[XY]) -> None:
        for x, y in points:
            self._cells.setdefault((int(x // self._near), int(y // self._near)), []).append((x, y))

    def is_near(self, x: float, y: float) -> bool:
        i, j = int(x // self._near), int(y // self._near)
        for a in (i - 1, i, i + 1):
            for b in (j - 1, j, j + 1):
                for u, v in self._cells.get((a, b), ()):
                    if (u - x) * (u - x) + (v - y) * (v - y) < self._near * self._near:
                        return True
        return False


def _streamlines(
    field: _Directions, part: Polygon | MultiPolygon, band_mm: float
) -> NDArray[np.object_]:
    """Return lines a band apart that fill an area."""
    x0, y0, x1, y1 = part.bounds
    taken, lines, step = _Taken(_NEAR * band_mm), [], _STEP * band_mm
    rows = np.arange(y0 + 0.5 * band_mm, y1 + band_mm, 0.87 * band_mm)
    shapely.prepare(part)
    for k, y in enumerate(rows.tolist()):
        seeds = np.arange(x0 + (0.25 + 0.5 * (k % 2)) * band_mm, x1 + band_mm, band_mm)
        inside = shapely.contains_xy(part, seeds, np.full(len(seeds), y))
        for x in seeds[inside].tolist():
            if taken.is_near(x, y):
                continue
            u, v = field.at(x, y, (1.0, 0.0))
            box = (x0 - band_mm, y0 - band_mm, x1 + band_mm, y1 + band_mm)
            ahead = _traced(field, (x, y), (u, v), step, taken, box)
            behind = _traced(field, (x, y), (-u, -v), step, taken, box)
            line = [*behind[::-1], (x, y), *ahead]
            if len(line) * step >= _SHORTEST * band_mm:
                taken.add(line)
                lines.append(shapely.linestrings(line))
    if not lines:
        raise GeometryError("has no room for a band", "the area", "make bands narrower")
    return np.asarray(shapely.simplify(np.array(lines), 0.03 * band_mm))


def _traced(
    field: _Directions, start: XY, way: XY, step: float, taken: _Taken,
    box: tuple[float, float, float, float],
) -> list[XY]:  # fmt: skip
    """Follow a field from a place until another line, itself, or the edge of the box is near."""
    (x, y), out = start, list[XY]()
    own = _Taken(4 * step)  # of what lies well behind
    for n in range(4000):
        mx, my = field.at(x, y, way)
        way = field.at(x + 0.5 * step * mx, y + 0.5 * step * my, (mx, my))
        x, y = x + step * way[0], y + step * way[1]
        if not (box[0] < x < box[2] and box[1] < y < box[3]) or taken.is_near(x, y):
            break
        if own.is_near(x, y):
            break
        out.append((x, y))
        if n >= 8:
            own.add([out[n - 8]])
    return out
