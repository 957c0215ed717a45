"""Finds nodes, handles and pieces of many paths near a point; kept up as paths change."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.planar.nodes import Side, handles_at
from stippler.drawing.planar.path import Path, Points, to_grid
from stippler.editor.tools.node_source import Node
from stippler.editor.tools.tool import Point

Place = tuple[int, int]
Owned = tuple[int, Place]
"""Who has a node (the path, or -1 where paths share their nodes), and where on the grid it is."""

SHARED = -1


@dataclass(frozen=True, slots=True)
class Grabbed:
    """A handle of a node."""

    node: Node
    side: Side


class NodeIndex:
    """All nodes of some paths; paths that stay the same objects are not looked at again."""

    def __init__(self, *, joins: bool) -> None:
        self._joins = joins
        self.paths: Mapping[int, Path] = {}
        self._of: dict[int, tuple[Path, NDArray[np.int64], Points]] = {}
        self._at: Points = np.empty((0, 2))
        self._path: NDArray[np.int64] = np.empty(0, np.int64)
        self._vertex: NDArray[np.int64] = np.empty(0, np.int64)

    def update(self, paths: Mapping[int, Path]) -> None:
        """Take over other paths."""
        old, self._of = self._of, {}
        for k, path in paths.items():
            known = old.get(k)
            if known is None or known[0] is not path:
                nodes = np.array(path.nodes()[:-1] if path.is_closed else path.nodes(), np.int64)
                known = (path, nodes, path.points_mm)
            self._of[k] = known
        self.paths = paths
        self._at = np.concatenate([np.empty((0, 2)), *(p[n] for _, n, p in self._of.values())])
        counts = [len(n) for _, n, _ in self._of.values()]
        self._path = np.repeat(np.array(list(self._of), np.int64), counts)
        self._vertex = np.concatenate(
            [np.empty(0, np.int64), *(n for _, n, _ in self._of.values())]
        )

    # --- by place -----------------------------------------------------------------------------

    def owned(self, node: Node) -> Owned:
        """Return what stays the same as long as a node stays where it is."""
        x, y = self.paths[node[0]].vertices[node[1]].tolist()
        return (SHARED if self._joins else node[0]), (x, y)

    def nodes(self, chosen: Collection[Owned]) -> list[Node]:
        """Return the nodes that are chosen, of each path that has them."""
        if not chosen:
            return []
        grid = to_grid(self._at) if len(self._at) else np.empty((0, 2), np.int64)
        places = {place for _, place in chosen}
        near = np.flatnonzero(np.isin(grid[:, 0], [x for x, _ in places]))
        found = []
        for i in near.tolist():
            k, place = int(self._path[i]), (int(grid[i, 0]), int(grid[i, 1]))
            if ((SHARED if self._joins else k), place) in chosen:
                found.append((k, int(self._vertex[i])))
        return found

    def place_mm(self, node: Node) -> Point:
        """Return where a node is."""
        x, y = self._of[node[0]][2][node[1]].tolist()
        return x, y

    # --- near a point -------------------------------------------------------------------------

    def node_at(self, at: Point, within_mm: float) -> Node | None:
        """Return the nearest node within a distance."""
        if not len(self._at):
            return None
        away = np.hypot(*(self._at - at).T)
        i = int(np.argmin(away))
        return (int(self._path[i]), int(self._vertex[i])) if away[i] <= within_mm else None

    def handle_at(self, at: Point, nodes: Iterable[Node], within_mm: float) -> Grabbed | None:
        """Return the nearest handle of some nodes within a distance."""
        best, found = within_mm, None
        for node in nodes:
            for side, place in handles_at(self.paths[node[0]], node[1]).items():
                if (away := math.dist(place, at)) <= best:
                    best, found = away, Grabbed(node, side)
        return found

    def piece_at(self, at: Point, within_mm: float) -> tuple[Node, Node] | None:
        """Return the nodes at both ends of the piece that is nearest within a distance."""
        best, found = within_mm, None
        for k, (path, _, points) in self._of.items():
            low, high = points.min(axis=0), points.max(axis=0)
            if (np.subtract(at, high) > best).any() or (np.subtract(low, at) > best).any():
                continue
            d = np.diff(points, axis=0)
            t = np.clip(((at - points[:-1]) * d).sum(axis=1) / (d * d).sum(axis=1), 0.0, 1.0)
            away = np.hypot(*(points[:-1] + t[:, None] * d - at).T)
            j = int(np.argmin(away))
            if away[j] <= best:
                best = float(away[j])
                stops = path.nodes()
                i = int(np.searchsorted(stops, j, side="right")) - 1
                first, last = stops[i], stops[i + 1]
                if path.is_closed and last == len(path) - 1:
                    last = 0
                found = ((k, first), (k, last))
        return found

    def in_box(self, low: Point, high: Point) -> list[Node]:
        """Return the nodes in a box."""
        inside = ((self._at >= low) & (self._at <= high)).all(axis=1)
        return [(int(self._path[i]), int(self._vertex[i])) for i in np.flatnonzero(inside).tolist()]
