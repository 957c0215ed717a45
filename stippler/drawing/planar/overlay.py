"""Laying an outline or a line over a map.

Every border is split where they meet, faces are told apart, and each face gets an area.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.planar.assemble import Pieces, assemble
from stippler.drawing.planar.graph import UNKNOWN, Graph
from stippler.drawing.planar.noding import contacts, node_segments
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import OUTSIDE, Arc, Box, PlanarMap, Segments
from stippler.errors import GeometryError

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

Relabel = Callable[[Ints, Ints], Ints]
"""From the areas before, and the windings of the outline, to the areas afterwards."""

_MARGIN = 4


@dataclass(frozen=True, slots=True, eq=False)
class Laid:
    """What is laid over a map.

    Attributes
    ----------
    paths : list of Path
    relabel : callable
        Which area each face has afterwards.
    barrier_in : int or None
        An area in which its paths stay as borders of the area with itself where they part it.
    also : tuple of int
        Arcs to take part wherever they lie.
    """

    paths: Sequence[Path]
    relabel: Relabel
    barrier_in: int | None = None
    also: tuple[int, ...] = ()


def overlay(before: PlanarMap, laid: Laid, next_area: int | None = None) -> PlanarMap:
    """Return the map with outlines or lines laid over it.

    Raises
    ------
    GeometryError
        If borders would lie across each other.
    """
    box = grown(joined([p.box() for p in laid.paths]), _MARGIN)
    for _ in range(6):
        taken = [k for k, a in before.arcs.items() if meets(a.box, box) or k in laid.also]
        pieces, box_needed = _noded(before, taken, laid.paths, box)
        if box_needed == box:
            return _faces(before, taken, pieces, laid, box, next_area)
        box = box_needed
    raise GeometryError("lie too close together here", "borders", "draw with more room")


def renode(before: PlanarMap, moved: dict[int, Arc]) -> PlanarMap:
    """Return the map with arcs replaced by others that may touch the rest.

    Raises
    ------
    GeometryError
        If borders would lie across each other.
    """
    between = before.with_arcs(moved)
    box = grown(joined([a.box for k in moved for a in (moved[k], before.arcs[k])]), _MARGIN)
    laid = Laid([], lambda old, winding: old)
    for _ in range(6):
        taken = [k for k, a in between.arcs.items() if meets(a.box, box)]
        pieces, box_needed = _noded(between, taken, [], box, set(moved))
        if box_needed == box:
            after = _faces(between, taken, pieces, laid, box, None)
            touched = {x for k in moved for x in (moved[k].left, moved[k].right)}
            return after.inherit(before, touched | set(_touched(before, after)))
        box = box_needed
    raise GeometryError("lie too close together here", "borders", "draw with more room")


def _touched(before: PlanarMap, after: PlanarMap) -> set[int]:
    pairs = after.changes(before).values()
    return {x for pair in pairs for a in pair if a is not None for x in (a.left, a.right)}


def _noded(
    before: PlanarMap,
    taken: list[int],
    paths: Sequence[Path],
    box: Box,
    new_arcs: set[int] | None = None,
) -> tuple[Pieces, Box]:
    """Split what lies in the box; return also the box within which borders have to be split."""
    old = Segments.of([before.arcs[k] for k in taken])
    sources = [before.arcs[k].path for k in taken] + list(paths)
    line = [p.segments() for p in paths]
    xy = np.concatenate([old.xy, *line])
    n_old = len(old.xy)
    is_new = np.arange(len(xy)) >= n_old
    if new_arcs:
        counts = [len(before.arcs[k].path) - 1 for k in taken]
        is_new[:n_old] = np.repeat([k in new_arcs for k in taken], counts)
    local = is_new | in_box(xy, box)
    near = np.flatnonzero(local)
    split, parent, moved = node_segments(xy[near], is_new[near])
    needed = _box_needed(before, taken, xy[~local], split[moved], box)
    return Pieces.of(sources, xy, split, near[parent], ~local, n_old, old), needed


def _box_needed(before: PlanarMap, taken: list[int], far: Ints, moved: Ints, box: Box) -> Box:
    """Return the box, larger where a split border comes close to one that was left out."""
    out = ~within(moved, box)
    if not out.any():
        return box
    chosen = set(taken)
    reach = grown(joined([tuple(_boxes(moved[out]).tolist())]), _MARGIN)
    rest = [a for k, a in before.arcs.items() if k not in chosen and meets(a.box, reach)]
    others = np.concatenate([far, Segments.of(rest).xy])
    others = others[in_box(others, reach)]
    both = np.concatenate([moved[out], others])
    which, _ = contacts(both, np.arange(len(both)) < int(out.sum()))
    return joined([box, reach]) if len(which) else box


def _boxes(xy: Ints) -> Ints:
    low = np.minimum(xy[:, :2], xy[:, 2:]).min(axis=0)
    high = np.maximum(xy[:, :2], xy[:, 2:]).max(axis=0)
    return np.concatenate([low, high])


def _faces(
    before: PlanarMap,
    taken: list[int],
    pieces: Pieces,
    laid: Laid,
    box: Box,
    next_area: int | None,
) -> PlanarMap:
    """Tell faces apart, give them areas, and put arcs together."""
    graph = Graph.of(pieces.xy, pieces.left, pieces.right, pieces.net, pieces.is_line)
    outside = before.arcs
    chosen = set(taken)
    rest = [a for k, a in outside.items() if k not in chosen] if _floats(graph) else []
    areas, windings = _label(graph, box, rest, pieces.far)
    relabelled = laid.relabel(areas.reshape(-1), windings.reshape(-1)).reshape(-1, 2)
    kept = relabelled[:, 0] != relabelled[:, 1]
    if laid.barrier_in is not None:
        kept |= _barriers(graph, kept, graph.is_line & (relabelled == laid.barrier_in).all(axis=1))
    return assemble(before, taken, pieces, graph, relabelled, kept, laid.relabel, next_area)


def _barriers(graph: Graph, kept: Bools, is_line: Bools) -> Bools:
    """Return the edges of a line that do not end in the open."""
    from stippler.kernels.planar.faces import clear_slack

    which = np.flatnonzero(kept | is_line)
    a, b = graph.a[which], graph.b[which]
    degree = np.bincount(np.concatenate([a, b]), minlength=len(graph.nodes))
    gone = np.zeros(len(which), np.bool_)
    clear_slack(a, b, is_line[which] & ~kept[which], degree, gone)
    out = np.zeros(len(kept), np.bool_)
    out[which[~gone]] = True
    return out


def _floats(graph: Graph) -> bool:
    return bool((graph.left == UNKNOWN).any())


def _label(graph: Graph, box: Box, rest: list[Arc], far: Segments) -> tuple[Ints, Ints]:
    """Return (m, 2) areas and windings left and right of each edge."""
    from stippler.kernels.planar.faces import find_roots, join_sides, join_through

    start, around = graph.around()
    x, y = graph.nodes.T
    inner = (x >= box[0] + 2) & (y >= box[1] + 2) & (x <= box[2] - 2) & (y <= box[3] - 2)
    sides = np.arange(2 * len(graph.a))
    join_sides(start, around, inner, sides)
    old_root, wind_root = sides.copy(), sides.copy()
    join_through(graph.left == UNKNOWN, old_root)
    join_through(graph.net == 0, wind_root)
    find_roots(old_root)
    find_roots(wind_root)
    component = _components(graph, inner)
    outer = _outer_sides(graph, component, start, around)
    context = _Context(graph, component, outer, inner, rest, far)
    areas = _old_areas(context, old_root)
    windings = _windings(context, wind_root)
    return areas[old_root].reshape(-1, 2), windings[wind_root].reshape(-1, 2)


@dataclass(frozen=True, slots=True, eq=False)
class _Context:
    graph: Graph
    component: Ints
    outer: dict[int, tuple[int, int]]
    inner: Bools
    rest: list[Arc]
    far: Segments


def _components(graph: Graph, inner: Bools) -> Ints:
    """Return the component of each edge; nodes beyond the box do not connect."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    m = len(graph.a)
    ends = np.concatenate([graph.a, graph.b])
    edges = np.tile(np.arange(m), 2)
    held = inner[ends]
    shape = (m + len(graph.nodes),) * 2
    links = coo_matrix((np.ones(held.sum()), (edges[held], m + ends[held])), shape)
    return np.asarray(connected_components(links, directed=False)[1][:m], np.int64)


def _outer_sides(
    graph: Graph, component: Ints, start: Ints, around: Ints
) -> dict[int, tuple[int, int]]:
    """Return for each component a node at its left end, and a side that faces out there."""
    nodes = graph.nodes
    order = np.lexsort((nodes[:, 1], nodes[:, 0]))
    rank = np.empty(len(nodes), np.int64)
    rank[order] = np.arange(len(nodes))
    best = np.minimum(rank[graph.a], rank[graph.b])
    n = int(component.max(initial=-1)) + 1
    least = np.full(n, len(nodes), np.int64)
    np.minimum.at(least, component, best)
    out = {}
    for c in range(n):
        node = int(order[least[c]])
        x, y = nodes[node].tolist()
        last = upper = -1
        for h in around[start[node] : start[node + 1]].tolist():
            far = int(graph.b[h // 2] if h % 2 == 0 else graph.a[h // 2])
            dx, dy = int(nodes[far, 0]) - x, int(nodes[far, 1]) - y
            last = h
            if dy > 0 or (dy == 0 and dx > 0):
                upper = h
        out[c] = (node, upper if upper >= 0 else last)
    return out


def _old_areas(context: _Context, root: Ints) -> Ints:
    """Return the old area of each class of sides."""
    graph = context.graph
    found = np.full(len(root), UNKNOWN, np.int64)
    beside = np.column_stack([graph.left, graph.right]).reshape(-1)
    known = beside != UNKNOWN
    found[root[known]] = beside[known]
    if (found[root[known]] != beside[known]).any():
        raise GeometryError("would lie across each other", "borders")
    unknown = np.unique(context.component[(found[root] == UNKNOWN).reshape(-1, 2).any(axis=1)])
    if not len(unknown):
        return found
    jump = np.where(graph.left == UNKNOWN, 0, graph.left - graph.right)
    more = Segments.of(context.rest)
    xy = np.concatenate([graph.segments(), more.xy, context.far.xy])
    jumps = np.concatenate([jump, more.left - more.right, context.far.left - context.far.right])
    for c in unknown.tolist():
        around = _around(context, c, xy, jumps)
        _, side = context.outer[c]
        found[root[side]] = OUTSIDE + around
    if (found[root] == UNKNOWN).any():  # pragma: no cover: no case is known
        raise GeometryError("would lie across each other", "borders")
    return found


def _around(context: _Context, c: int, xy: Ints, jumps: Ints) -> int:
    from stippler.kernels.planar.faces import winding_around

    component = np.full(len(xy), -1, np.int64)
    component[: len(context.component)] = context.component
    x, y = context.graph.nodes[context.outer[c][0]].tolist()
    return int(winding_around(x, y, xy, jumps, c, component))


def _windings(context: _Context, root: Ints) -> Ints:
    """Return the outline's winding number of each class of sides."""
    from stippler.kernels.planar.faces import spread_windings

    graph, inner = context.graph, context.inner
    winding = np.zeros(len(root), np.int64)
    known = np.zeros(len(root), np.bool_)
    leaves = ~(inner[graph.a] & inner[graph.b])
    known[root[np.repeat(leaves, 2)]] = True
    reached = np.zeros(int(context.component.max(initial=-1)) + 1, np.bool_)
    reached[context.component[leaves]] = True
    xy = graph.segments()
    for c in np.flatnonzero(~reached).tolist():
        _, side = context.outer[c]
        winding[root[side]] = _around(context, c, xy, graph.net)
        known[root[side]] = True
    if not spread_windings(root, graph.net, winding, known):
        raise GeometryError("does not close", "outline")
    return winding


def meets(a: Box, b: Box) -> bool:
    """Return whether two boxes meet."""
    return a[0] <= b[2] and a[2] >= b[0] and a[1] <= b[3] and a[3] >= b[1]


def joined(boxes: Sequence[Box]) -> Box:
    """Return the box around boxes."""
    x0, y0, x1, y1 = zip(*boxes, strict=True)
    return min(x0), min(y0), max(x1), max(y1)


def grown(box: Box, by: int) -> Box:
    """Return a box that is larger on each side."""
    return box[0] - by, box[1] - by, box[2] + by, box[3] + by


def in_box(xy: Ints, box: Box) -> Bools:
    """Return which segments' boxes meet a box."""
    return np.asarray(
        (np.minimum(xy[:, 0], xy[:, 2]) <= box[2])
        & (np.maximum(xy[:, 0], xy[:, 2]) >= box[0])
        & (np.minimum(xy[:, 1], xy[:, 3]) <= box[3])
        & (np.maximum(xy[:, 1], xy[:, 3]) >= box[1])
    )


def within(xy: Ints, box: Box) -> Bools:
    """Return which segments lie in a box."""
    x, y = xy[:, 0::2], xy[:, 1::2]
    return np.asarray(((x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])).all(axis=1))
