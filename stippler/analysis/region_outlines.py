"""Outlines of labelled pixels: each border between two regions once, smoothed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.planar.assemble import Edges, arcs_of_edges
from stippler.drawing.planar.path import UNIT_MM, Path, Points, shifted
from stippler.drawing.planar.planar_map import OUTSIDE, Arc
from stippler.drawing.planar.rings import HalfEdge, parts_of

_ROUNDS = 6  # of smoothing; each takes half of a staircase's steps away
_APART_PX = 0.45  # how far the smoothed line may be from the one with fewer vertices


@dataclass(frozen=True, slots=True, eq=False)
class RegionOutlines:
    """Borders between regions of pixels.

    Attributes
    ----------
    arcs : dict of int to Arc
        Along the pixels' edges; what lies beside them.
    smooth : dict of int to Path
        The same without staircases.
    """

    arcs: dict[int, Arc]
    smooth: dict[int, Path]

    def rings(self, region: int) -> list[Path]:
        """Return the outlines of a region, its holes among them."""
        return [self._ring(ring) for part in parts_of(region, self.arcs) for ring in part.rings]

    def _ring(self, ring: tuple[HalfEdge, ...]) -> Path:
        vertices, curves, n = [], [], 0
        for k, forward in ring:
            path = self.smooth[k] if forward else self.smooth[k].reversed()
            curves += [shifted(c, n) for c in path.curves]
            vertices.append(path.vertices[:-1])
            n += len(path) - 1
        vertices.append(vertices[0][:1])
        return Path(np.concatenate(vertices), tuple(curves))


def outlines_of(
    labels: NDArray[np.int32], pixel_mm: float, *, curved: bool = False
) -> RegionOutlines:
    """Return the borders between regions of pixels, and around all of them.

    Parameters
    ----------
    labels : (h, w) int32
        Not negative.
    pixel_mm : float
        Side of a pixel; (0, 0) is the corner of the first.
    curved : bool
        Make curves of them; else lines of many points, which is quicker.
    """
    xy, left, right = _edges(labels)
    unit = pixel_mm / UNIT_MM
    nothing = np.full(len(xy), -1, np.int64)
    zero = np.zeros(len(xy))
    on_grid = np.floor(xy * unit + 0.5).astype(np.int64)
    made = arcs_of_edges(Edges(on_grid, left, right, nothing, zero, zero, []), set())
    arcs = dict(enumerate(made))
    return RegionOutlines(arcs, {k: _smoothed(a, pixel_mm, curved=curved) for k, a in arcs.items()})


def _edges(
    labels: NDArray[np.int32],
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return the pixels' edges between unlike labels, and what lies left and right of each."""
    padded = np.pad(labels.astype(np.int64), 1, constant_values=OUTSIDE)
    y, x = np.nonzero(padded[1:, 1:-1] != padded[:-1, 1:-1])
    across = np.column_stack([x, y, x + 1, y])
    left, right = padded[y + 1, x + 1], padded[y, x + 1]
    y, x = np.nonzero(padded[1:-1, 1:] != padded[1:-1, :-1])
    down = np.column_stack([x, y, x, y + 1])
    xy = np.concatenate([across, down])
    return (
        xy,
        np.concatenate([left, padded[y + 1, x]]),
        np.concatenate([right, padded[y + 1, x + 1]]),
    )


def _smoothed(arc: Arc, pixel_mm: float, *, curved: bool) -> Path:
    """Return an arc without its staircase; along the picture's rim it stays straight."""
    from stippler.drawing.planar.moves import smooth_path

    at = arc.path.points_mm
    closed = arc.path.is_closed
    if OUTSIDE in (arc.left, arc.right) or len(at) < 4:
        return Path.polyline(_straightened(at))
    at = _rounded(at, closed=closed)
    line = shapely.simplify(shapely.linestrings(at), _APART_PX * pixel_mm, preserve_topology=closed)
    path = Path.polyline(shapely.get_coordinates(line))
    if len(path) < (4 if closed else 2):
        return arc.path
    return smooth_path(path) if curved and len(path) > 2 else path


def _rounded(at: Points, *, closed: bool) -> Points:
    out = at.copy()
    for _ in range(_ROUNDS):
        if closed:
            ring = out[:-1]
            ring = 0.25 * np.roll(ring, 1, axis=0) + 0.5 * ring + 0.25 * np.roll(ring, -1, axis=0)
            out = np.vstack([ring, ring[:1]])
        else:
            out[1:-1] = 0.25 * out[:-2] + 0.5 * out[1:-1] + 0.25 * out[2:]
    return out


def _straightened(at: Points) -> Points:
    """Leave out what lies between two others on a line."""
    way = np.diff(at, axis=0)
    turns = np.abs(way[:-1, 0] * way[1:, 1] - way[:-1, 1] * way[1:, 0]) > 1e-12
    return np.asarray(at[np.r_[True, turns, True]])
