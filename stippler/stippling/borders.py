"""How dots meet the borders of their area: arc by arc, by a policy.

*Wall*: dots see nothing beyond, and the area is solved up to the line. *Bleed*: the picture runs on
beyond the line, so dots are laid out past it and trimmed, as at the edge of a page. *Through*: dots
beyond are seen, so that areas of like style join without a seam.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, MultiPolygon, Polygon

from stippler.drawing.planar.planar_map import OUTSIDE, Arc, PlanarMap
from stippler.errors import ParameterError
from stippler.kernels.tone.edge_ink import even_rim
from stippler.stippling.tone import DotRule

BLEED, WALL, THROUGH = "bleed", "wall", "through"
POLICIES = (BLEED, WALL, THROUGH)

_FARTHEST = 2.0  # radii beyond a line from which a dot is drawn back to it, at most
_INSET = 1e-6  # of a radius; how far within the line a dot lies that was drawn back
_NEAR = 1.6  # radii; dots so near a line may come to touch it
_LINE = 0.1  # radii; how far inside it the ink is compared
_SAMPLES = 4.0  # of the darkness along a line for each of the smallest radii

Floats = NDArray[np.float64]
Outline: TypeAlias = Polygon | MultiPolygon


@dataclass(frozen=True, slots=True, eq=False)
class Borders:
    """An area's outline and what each part of it means to dots.

    Attributes
    ----------
    outline : polygon, mm
    bleeding, seen_through : tuple of LineString, mm
        Those parts of the outline, joined end to end, that dots bleed over and that they see
        through; all others are walls.
    """

    outline: Outline
    bleeding: tuple[LineString, ...] = ()
    seen_through: tuple[LineString, ...] = ()

    @classmethod
    def of(cls, outline: Outline, arcs: Iterable[tuple[Floats, str]]) -> Borders:
        """Name the policies of an outline's arcs: their points (k, 2) in mm, `POLICIES`.

        What is not named is a wall.
        """
        lines: dict[str, list[LineString]] = {policy: [] for policy in POLICIES}
        for points, policy in arcs:
            if policy not in lines:
                raise ParameterError(
                    f"{policy!r} is unknown", "border", f"one of {', '.join(POLICIES)}"
                )
            lines[policy].append(LineString(points))
        return cls(outline, _joined(lines[BLEED]), _joined(lines[THROUGH]))

    @classmethod
    def of_area(
        cls, areas: PlanarMap, area: int, policy_of: Callable[[int, Arc], str] | None = None
    ) -> Borders:
        """Take an area of a map; by default the page's edge bleeds, and all others are walls.

        `policy_of` is asked for each arc along the area, by its id.
        """
        asked = policy_of or _by_place
        arcs = [
            (areas.arcs[k].path.points_mm, asked(k, areas.arcs[k])) for k in areas.arcs_of(area)
        ]
        return cls.of(areas.outline(area), arcs)

    def grown(self, width_mm: float) -> Outline:
        """Return the outline with a strip of this width beyond what is no wall.

        Dots are laid out and relaxed in it; `trimmed` takes those of the strip away again.
        """
        strips = [self._strip(line, width_mm) for line in (*self.bleeding, *self.seen_through)]
        if not strips:
            return self.outline
        grown = shapely.union_all([self.outline, *strips])
        parts: list[Polygon] = [p for p in shapely.get_parts(grown) if p.area > 0.0]
        return parts[0] if len(parts) == 1 else MultiPolygon(parts)

    def _strip(self, line: LineString, width_mm: float) -> shapely.Geometry:
        if line.is_closed:
            ring = Polygon(line)
            side = width_mm if self._is_inside_left(line) == shapely.is_ccw(line) else -width_mm
            return shapely.buffer(ring, side, join_style="mitre").symmetric_difference(ring)
        side = -width_mm if self._is_inside_left(line) else width_mm
        return shapely.buffer(line, side, single_sided=True, join_style="mitre", cap_style="flat")

    def _is_inside_left(self, line: LineString) -> bool:
        """Tell whether the area lies to the left of a part of its outline."""
        at = shapely.get_coordinates(line)
        along = np.diff(at, axis=0)
        k = int(np.argmax(np.hypot(*along.T)))
        length = float(np.hypot(*along[k]))
        middle, left = 0.5 * (at[k] + at[k + 1]), np.array([-along[k, 1], along[k, 0]]) / length
        reach = 1e-6 * length
        inside, outside = shapely.contains_xy(
            self.outline, *np.stack([middle + reach * left, middle - reach * left]).T
        )
        return bool(inside and not outside)

    def trimmed(
        self, position_mm: Floats, radius_mm: Floats, n_wanted: int | None = None
    ) -> tuple[NDArray[np.intp], Floats]:
        """Return which dots are the area's, and their places: none lies beyond its outline.

        Those that reach in over a line that bleeds are drawn back to it; how far they have to reach
        is chosen so that there are `n_wanted`, as nearly as that goes.
        """
        inside = shapely.intersects_xy(self.outline, position_mm[:, 0], position_mm[:, 1])
        kept, beyond = np.flatnonzero(inside), np.flatnonzero(~inside)
        at = np.array(position_mm, np.float64)
        if len(self.bleeding) and len(beyond):
            line = shapely.multilinestrings(self.bleeding)
            way = shapely.shortest_line(line, shapely.points(at[beyond]))
            foot = shapely.get_coordinates(way)[::2]
            depth = shapely.length(way) / radius_mm[beyond]
            rank = np.argsort(depth, kind="stable")
            n = int(np.searchsorted(depth[rank], DotRule.BLEED_REACH))
            if n_wanted is not None:
                n = int(np.searchsorted(depth[rank], _FARTHEST))
                n = min(max(n_wanted - len(kept), 0), n)
            back = rank[:n]
            drawn = _inside_of(self.outline, foot[back], _INSET * radius_mm[beyond[back]])
            at[beyond[back]] = drawn
            kept = np.sort(np.concatenate([kept, beyond[back]]))
        return kept, at[kept]

    def rim_evened(
        self,
        position_mm: Floats,
        radius_mm: Floats,
        darkness_at: Callable[[Floats], Floats],
        give: float,
    ) -> Floats:
        """Move dots across lines that bleed until the ink along them meets the tone, end to end.

        Parameters
        ----------
        position_mm : (n, 2) float64
            Trimmed; not modified.
        radius_mm : (n,) float64
        darkness_at : callable
            Of points (k, 2) of the page, mm.
        give : float
            How far a dot may move, in its radius.
        """
        at = np.array(position_mm, np.float64)
        if not len(at):
            return at
        tree = shapely.STRtree(shapely.points(at))
        for line in self.bleeding:
            largest = float(radius_mm.max())
            near = tree.query(line, predicate="dwithin", distance=_NEAR * largest)
            near = np.sort(near)
            at[near] = self._evened(line, at[near], radius_mm[near], darkness_at, give)
        return at

    def _evened(
        self,
        line: LineString,
        at: Floats,
        radius: Floats,
        darkness_at: Callable[[Floats], Floats],
        give: float,
    ) -> Floats:
        points = shapely.points(at)
        inwards = shapely.distance(line, points)
        along = shapely.line_locate_point(line, points)
        which = np.flatnonzero(inwards < _NEAR * radius)
        if not len(which):
            return at
        which = which[np.argsort(along[which], kind="stable")]
        unit = line.length / max(int(_SAMPLES * line.length / float(radius[which].min())), 1)
        n = round(line.length / unit)
        middles = shapely.line_interpolate_point(line, (np.arange(n) + 0.5) * unit)
        edge = darkness_at(shapely.get_coordinates(middles))
        asked = np.concatenate(([0.0], np.cumsum(edge, dtype=np.float64)))
        deep = inwards[which] / unit
        r = radius[which] / unit
        even_rim(along[which] / unit, deep, r, asked, _LINE * float(r.min()), give)
        out = at.copy()
        out[which] = self._placed(line, at[which], along[which], inwards[which], deep * unit)
        lost = ~shapely.intersects_xy(self.outline, out[:, 0], out[:, 1])
        out[lost] = at[lost]
        return out

    def _placed(
        self, line: LineString, at: Floats, along: Floats, before: Floats, after: Floats
    ) -> Floats:
        """Return places so far in from the places of a line that are next to dots."""
        foot = shapely.get_coordinates(shapely.line_interpolate_point(line, along))
        step = 1e-6 * line.length
        low, high = np.maximum(along - step, 0.0), np.minimum(along + step, line.length)
        tangent = shapely.get_coordinates(shapely.line_interpolate_point(line, high))
        tangent -= shapely.get_coordinates(shapely.line_interpolate_point(line, low))
        tangent /= np.maximum(np.hypot(*tangent.T), 1e-300)[:, None]
        side = 1.0 if self._is_inside_left(line) else -1.0
        inward = side * np.column_stack([-tangent[:, 1], tangent[:, 0]])
        far = before > step
        inward[far] = (at[far] - foot[far]) / before[far, None]
        placed: Floats = foot + after[:, None] * inward
        return placed


def _joined(lines: list[LineString]) -> tuple[LineString, ...]:
    if not lines:
        return ()
    merged = shapely.line_merge(shapely.multilinestrings(lines))
    return tuple(shapely.get_parts(merged))


def _by_place(_: int, arc: Arc) -> str:
    return BLEED if OUTSIDE in (arc.left, arc.right) else WALL


def _inside_of(outline: Outline, at: Floats, inset: Floats) -> Floats:
    """Return the places within an outline next to places on its border."""
    if not len(at):
        return at
    inner = shapely.buffer(outline, -float(inset.min()), join_style="mitre")
    if inner.is_empty:
        return at
    way = shapely.shortest_line(inner, shapely.points(at))
    return np.asarray(shapely.get_coordinates(way)[::2])
