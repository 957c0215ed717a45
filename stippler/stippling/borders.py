"""How dots meet the borders of their area.

*Wall*: dots see nothing beyond, and the area is solved up to the line. *Bleed*: the picture runs on
beyond the line, so dots are laid out past it and trimmed, as at the edge of a page. What areas of
like style see *through* is no border at all: they are one outline.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry import LineString, MultiPolygon, Polygon

from stippler.drawing.style import AUTOMATIC, BLEED, THROUGH, WALL
from stippler.kernels.tone.edge_ink import even_rim
from stippler.stippling.border_policies import (
    ON_LINE_MM,
    Pieces,
    edges_in,
    merged,
    policies_at,
    polygons_in,
)
from stippler.stippling.halftone_area import edges_of
from stippler.stippling.near_lines import Nearest, NearLines
from stippler.stippling.tone import DotRule

_FARTHEST = 2.0  # radii beyond a line from which a dot is drawn back to it, at most
_INSET = 1e-6  # of a radius; how far within the line a dot lies that was drawn back
_NEAR = 1.6  # radii; dots so near a line may come to touch it
_LINE = 0.15  # radii; how far inside it the ink is compared
_SAMPLES = 4.0  # of the darkness along a line for each of the smallest radii
_ON_EDGE_MM = 2e-3  # a border so near the page's edge lies on it
_WHOLE = 1e-9  # of a border

Floats = NDArray[np.float64]
Rows = NDArray[np.intp]
Outline: TypeAlias = Polygon | MultiPolygon
Side: TypeAlias = tuple[int, bool, float]


@dataclass(frozen=True, slots=True, eq=False)
class Borders:
    """An area's outline, and over which lines of it the picture runs on; all others are walls.

    Attributes
    ----------
    outline : polygon, mm
    bleeding : tuple of LineString, mm
        Those lines, joined end to end.
    sides : tuple of (axis, whether it is the far one, place in mm)
        The sides of the page that some of them lie on, where the picture is mirrored.
    open : tuple of LineString, mm
        Those of them beyond which the picture goes on as it is.
    cut : tuple of LineString, mm
        Lines at which dots are cut off, and none is drawn back to unless one is missing.
    """

    outline: Outline
    bleeding: tuple[LineString, ...] = ()
    sides: tuple[Side, ...] = ()
    open: tuple[LineString, ...] = ()
    cut: tuple[LineString, ...] = ()

    @classmethod
    def of(
        cls, outline: Outline, policy: str, size_mm: tuple[float, float], pieces: Pieces = ()
    ) -> Borders:
        """Take an area on a page by the policy of its border, and by what pieces of it say."""
        if policy == WALL and not pieces:
            return cls(outline)
        edges = edges_of(outline)
        said = policies_at(edges, pieces)
        said[said == ""] = policy
        runs_off = said == BLEED
        at_edge, sides = np.zeros(len(edges), np.bool_), list[Side]()
        for axis, is_far in ((0, False), (0, True), (1, False), (1, True)):
            on = _on_side(edges, axis, size_mm[axis] if is_far else 0.0)
            on &= (said == AUTOMATIC) | (said == THROUGH)
            if on.any():
                at_edge |= on
                sides.append((axis, is_far, outline.bounds[axis + 2 * is_far]))
        bleeding = runs_off | at_edge
        return cls(outline, joined(edges[bleeding]), tuple(sides), joined(edges[runs_off]))

    def cut_at(self, lines: Sequence[LineString]) -> Borders:
        """Return borders that bleed over some lines as before, but cut dots off there."""
        if not lines:
            return self
        edges = edges_in(shapely.multilinestrings(self.bleeding))
        stays = policies_at(edges, ((BLEED, shapely.multilinestrings(lines)),)) == ""
        return replace(self, bleeding=joined(edges[stays]), cut=(*self.cut, *lines))

    def grown(self, width_mm: float) -> Outline:
        """Return the outline with a strip of this width beyond what bleeds.

        Beyond the page's edge it is mirrored, as the picture is. Dots are laid out and relaxed in
        it; `trimmed` takes those of the strip away again.
        """
        if not (self.bleeding or self.open):
            return self.outline
        length = sum(line.length for line in self.open)
        if length >= (1.0 - _WHOLE) * self.outline.length:
            return polygons_in(shapely.buffer(self.outline, width_mm, join_style="mitre"))
        shape: shapely.Geometry = self.outline
        for side in self.sides:
            shape = self._mirrored(shape, side, width_mm)
        strips = [one for line in self.open for one in strips_beyond(line, self.outline, width_mm)]
        return polygons_in(shapely.union_all([shape, *strips]) if strips else shape)

    def _mirrored(self, shape: shapely.Geometry, side: Side, width_mm: float) -> shapely.Geometry:
        """Return a shape with what lies along a side of the page, and bleeds there, mirrored."""
        axis, is_far, at = side
        box = list(shape.bounds)
        box[axis + 2 * (not is_far)] = at - width_mm if is_far else at + width_mm
        strip = shapely.intersection(shape, shapely.box(*box))
        sign, shift = np.ones(2), np.zeros(2)
        sign[axis], shift[axis] = -1.0, 2.0 * at
        beyond = shapely.transform(strip, lambda xy: sign * xy + shift)
        lines, all_of_it = edges_in(shapely.multilinestrings(self.bleeding)), edges_of(self.outline)
        lines, all_of_it = (e[_on_side(e, axis, at)] for e in (lines, all_of_it))
        across = [1 - axis, 3 - axis]
        spans = np.sort(lines[:, across], axis=1)
        if np.ptp(spans, axis=1).sum() < np.abs(np.diff(all_of_it[:, across])).sum() - _ON_EDGE_MM:
            low, high = (at, at + width_mm) if is_far else (at - width_mm, at)
            boxes = np.empty((len(spans), 4))
            boxes[:, axis], boxes[:, axis + 2], boxes[:, across] = low, high, spans
            beyond = shapely.intersection(beyond, shapely.union_all(shapely.box(*boxes.T)))
        return shapely.union(shape, beyond)

    def trimmed(
        self, position_mm: Floats, radius_mm: Floats, n_wanted: int | None = None
    ) -> tuple[Rows, Floats]:
        """Return which dots are the area's, and their places: none lies beyond its outline.

        Those that reach in over a line that bleeds are drawn back to it; how far they have to reach
        is chosen so that there are `n_wanted`, as nearly as that goes.
        """
        inside = shapely.intersects_xy(self.outline, position_mm[:, 0], position_mm[:, 1])
        kept, beyond = np.flatnonzero(inside), np.flatnonzero(~inside)
        at = np.array(position_mm, np.float64)
        line = shapely.multilinestrings([*self.bleeding, *self.cut])
        if n_wanted is not None and len(kept) > n_wanted:
            inwards = shapely.distance(line, shapely.points(at[kept]))
            return np.sort(kept[np.argsort(inwards, kind="stable")[len(kept) - n_wanted :]]), at
        if len(beyond):
            way = shapely.shortest_line(line, shapely.points(at[beyond]))
            foot = shapely.get_coordinates(way)[::2]
            depth = shapely.length(way) / radius_mm[beyond]
            depth[self._at_cut(foot)] += DotRule.BLEED_REACH
            rank = np.argsort(depth, kind="stable")
            n = int(np.searchsorted(depth[rank], DotRule.BLEED_REACH))
            if n_wanted is not None:
                n = int(np.searchsorted(depth[rank], _FARTHEST))
                n = min(max(n_wanted - len(kept), 0), n)
            back = rank[:n]
            at[beyond[back]] = _inside_of(
                self.outline, foot[back], _INSET * radius_mm[beyond[back]]
            )
            kept = np.sort(np.concatenate([kept, beyond[back]]))
        return kept, at

    def _at_cut(self, foot: Floats) -> NDArray[np.bool_]:
        """Tell which places on the lines are on those that dots are cut off at."""
        if not self.cut:
            return np.zeros(len(foot), np.bool_)
        lines = shapely.multilinestrings(self.cut)
        return np.asarray(shapely.dwithin(shapely.points(foot), lines, ON_LINE_MM))

    def rim_evened(
        self,
        position_mm: Floats,
        radius_mm: Floats,
        darkness_at: Callable[[Floats], Floats],
        give: float,
        lines: NearLines | None = None,
        edges: dict[int, Floats] | None = None,
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
        lines : NearLines, optional
            Those that bleed, if they are known.
        edges : dict, optional
            The darkness along lines, by their numbers, where it is known; filled where it is not.
        """
        at = np.array(position_mm, np.float64)
        if not len(at):
            return at
        if lines is None:
            lines = NearLines(self.bleeding, _NEAR * float(radius_mm.max()))
        found = lines.nearest(at)
        touching = np.flatnonzero(found.away < _NEAR * radius_mm)
        touching = touching[np.argsort(found.along[touching], kind="stable")]
        for k, line in enumerate(self.bleeding):
            which = touching[found.line[touching] == k]
            if len(which):
                edge = _edge(line, k, float(radius_mm[which].min()), darkness_at, edges)
                deep = _evened(line, found, which, radius_mm[which], edge, give)
                at[which] = self._placed(line, at[which], found, which, deep)
        lost = touching[~shapely.intersects_xy(self.outline, *at[touching].T)]
        at[lost] = position_mm[lost]
        return at

    def _placed(
        self, line: LineString, at: Floats, found: Nearest, which: Rows, after: Floats
    ) -> Floats:
        """Return places so far in from the places of a line that are next to dots."""
        foot, before = found.feet[which], found.away[which]
        step = 1e-6 * line.length
        far = before > step
        inward = (at - foot) / np.maximum(before, 1e-300)[:, None]
        on = np.flatnonzero(~far)
        inward[on] = found.direction[which[on]][:, ::-1] * (-1.0, 1.0)
        out = on[~shapely.intersects_xy(self.outline, *(foot[on] + step * inward[on]).T)]
        inward[out] *= -1.0
        placed: Floats = foot + after[:, None] * inward
        return placed


def _edge(
    line: LineString,
    k: int,
    least_mm: float,
    darkness_at: Callable[[Floats], Floats],
    edges: dict[int, Floats] | None,
) -> Floats:
    """Return the darkness along a line, at equal distances of a share of the least radius."""
    if edges is not None and k in edges:
        return edges[k]
    edge = darkness_at(along_line(line, max(int(_SAMPLES * line.length / least_mm), 1)))
    if edges is not None:
        edges[k] = edge
    return edge


def _evened(
    line: LineString, found: Nearest, which: Rows, radius: Floats, edge: Floats, give: float
) -> Floats:
    """Return how far in dots are to lie that may touch a line; they are sorted along it."""
    unit = line.length / len(edge)
    asked = np.concatenate(([0.0], np.cumsum(edge, dtype=np.float64)))
    deep: Floats = found.away[which] / unit
    r = radius / unit
    even_rim(found.along[which] / unit, deep, r, asked, _LINE * float(r.min()), give)
    inwards: Floats = deep * unit
    return inwards


def along_line(line: LineString, n: int) -> Floats:
    """Return n places at equal distances along a line."""
    corners = shapely.get_coordinates(line)
    way = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(corners, axis=0).T))))
    at = (np.arange(n) + 0.5) * (way[-1] / n)
    return np.column_stack([np.interp(at, way, values) for values in corners.T])


def joined(edges: Floats) -> tuple[LineString, ...]:
    """Return edges (m, 4) as lines, joined end to end."""
    return tuple(merged(edges).geoms)


def strips_beyond(line: LineString, outline: Outline, width_mm: float) -> list[Polygon]:
    """Return what lies along a piece of an outline's border on its outside, so far from it."""
    around = shapely.buffer(line, width_mm, cap_style="flat", join_style="mitre")
    parts = shapely.get_parts(shapely.difference(around, outline))
    met = shapely.length(shapely.intersection(parts, line))
    return [p for p, n in zip(parts, met, strict=True) if isinstance(p, Polygon) and n > 0.0]


def _on_side(edges: Floats, axis: int, at: float) -> NDArray[np.bool_]:
    """Tell which edges lie on a line x = `at`, or y."""
    return np.asarray(np.abs(edges[:, [axis, axis + 2]] - at).max(axis=1) < _ON_EDGE_MM)


def _inside_of(outline: Outline, at: Floats, inset: Floats) -> Floats:
    """Return the places within an outline next to places on its border."""
    if not len(at):
        return at
    inner = shapely.buffer(outline, -float(inset.min()), join_style="mitre")
    if inner.is_empty:
        return at
    way = shapely.shortest_line(inner, shapely.points(at))
    return np.asarray(shapely.get_coordinates(way)[::2])
