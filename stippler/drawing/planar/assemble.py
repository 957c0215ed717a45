"""From labelled edges back to arcs, with the curves they were taken from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.planar.graph import UNKNOWN, Graph, number_nodes
from stippler.drawing.planar.path import Curve, Path, control_points, part_of_cubic
from stippler.drawing.planar.planar_map import Arc, PlanarMap, Segments
from stippler.drawing.planar.policies import inherited

Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]

_SAME = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """Split segments of arcs and outlines, and the segments of the same arcs far from all.

    Attributes
    ----------
    xy : (n, 4) int64
    left, right : (n,) int64
        `UNKNOWN` for the outline's.
    net : (n,) int64
        1 for the outline's.
    is_line : (n,) bool
    curve : (n,) int64
        Of `cubics`; -1 where straight.
    t0, t1 : (n,) float64
        The curve's parameters at the ends.
    far : Segments
    far_curve, far_t0, far_t1 :
        The same of those.
    cubics : list of (4, 2) float64, mm
    """

    xy: Ints
    left: Ints
    right: Ints
    net: Ints
    is_line: Bools
    curve: Ints
    t0: Floats
    t1: Floats
    far: Segments
    far_curve: Ints
    far_t0: Floats
    far_t1: Floats
    cubics: list[Floats]

    @classmethod
    def of(
        cls,
        sources: Sequence[Path],
        xy: Ints,
        split: Ints,
        parent: Ints,
        is_far: Bools,
        n_old: int,
        old: Segments,
    ) -> Self:
        """Give split segments what their parents have."""
        curve, t0, t1, cubics = curves_of(sources, len(xy))
        is_line = parent >= n_old
        below = np.minimum(parent, max(n_old - 1, 0))
        left = np.where(is_line, UNKNOWN, old.left[below] if n_old else UNKNOWN)
        right = np.where(is_line, UNKNOWN, old.right[below] if n_old else UNKNOWN)
        span = (xy[:, 2:] - xy[:, :2]).astype(np.float64)
        length = np.maximum((span**2).sum(axis=1), 1.0)[parent]
        shares = [
            ((split[:, k : k + 2] - xy[parent, :2]) * span[parent]).sum(axis=1) / length
            for k in (0, 2)
        ]
        s0, s1 = (t0[parent] + s * (t1 - t0)[parent] for s in shares)
        far = np.flatnonzero(is_far)
        beyond = Segments(old.xy[far], old.left[far], old.right[far])
        return cls(
            split, left, right, is_line.astype(np.int64), is_line, curve[parent], s0, s1,
            beyond, curve[far], t0[far], t1[far], cubics,
        )  # fmt: skip


def curves_of(sources: Sequence[Path], n: int) -> tuple[Ints, Floats, Floats, list[Floats]]:
    """Return the curve of each segment of all sources, and its parameters at their ends."""
    curve, t0, t1 = np.full(n, -1, np.int64), np.zeros(n), np.zeros(n)
    cubics: list[Floats] = []
    first = 0
    for path in sources:
        for c in path.curves:
            t = c.parameters()
            where = slice(first + c.first, first + c.last)
            curve[where], t0[where], t1[where] = len(cubics), t[:-1], t[1:]
            cubics.append(control_points(path, c))
        first += len(path) - 1
    return curve, t0, t1, cubics


def assemble(
    before: PlanarMap,
    taken: list[int],
    pieces: Pieces,
    graph: Graph,
    beside: Ints,
    kept: Bools,
    relabel: Callable[[Ints, Ints], Ints],
    next_area: int | None,
) -> PlanarMap:
    """Return the map in which the arcs taken give way to those that edges make up.

    Parameters
    ----------
    beside : (m, 2) int64
        The areas left and right of the graph's edges.
    kept : (m,) bool
    """
    nothing = np.zeros(len(pieces.far.xy), np.int64)
    far_left = relabel(pieces.far.left, nothing)
    far_right = relabel(pieces.far.right, nothing)
    far = far_left != far_right
    which = graph.piece[kept]
    edges = Edges(
        np.concatenate([pieces.xy[which], pieces.far.xy[far]]),
        np.concatenate([beside[kept, 0], far_left[far]]),
        np.concatenate([beside[kept, 1], far_right[far]]),
        np.concatenate([pieces.curve[which], pieces.far_curve[far]]),
        np.concatenate([pieces.t0[which], pieces.far_t0[far]]),
        np.concatenate([pieces.t1[which], pieces.far_t1[far]]),
        pieces.cubics,
    )
    chosen = set(taken)
    fixed = {end for k, a in before.arcs.items() if k not in chosen for end in (a.start, a.end)}
    return replaced(before, taken, arcs_of_edges(edges, fixed), next_area)


def replaced(
    before: PlanarMap, taken: list[int], made: list[Arc], next_area: int | None
) -> PlanarMap:
    """Return the map with some arcs in the place of others; those that are the same keep ids."""
    known: dict[tuple[int, ...], list[int]] = {}
    for k in taken:
        known.setdefault(before.arcs[k].box, []).append(k)
    changed: dict[int, Arc | None] = dict.fromkeys(taken)
    made = inherited((before.arcs[k] for k in taken), made)
    next_arc = before.next_arc
    for arc in made:
        same = next((k for k in known.get(arc.box, ()) if _same(before.arcs[k], arc)), None)
        if same is None:
            changed[next_arc] = arc
            next_arc += 1
        else:
            changed.pop(same, None)
    return before.with_arcs(changed, next_area)


def _same(old: Arc, new: Arc) -> bool:
    """Return whether an arc is another's, run either way; rings may begin elsewhere."""
    if (old.left, old.right) == (new.left, new.right):
        path = new.path
    elif (old.left, old.right) == (new.right, new.left):
        path = new.path.reversed()
    else:
        return False
    at, mine = old.path.vertices, path.vertices
    if len(at) != len(mine):
        return False
    if (at == mine).all():
        return True
    if not (old.path.is_closed and path.is_closed):
        return False
    where = np.flatnonzero((mine[:-1] == at[0]).all(axis=1))
    return bool(len(where)) and bool((np.roll(mine[:-1], -int(where[0]), axis=0) == at[:-1]).all())


@dataclass(frozen=True, slots=True, eq=False)
class Edges:
    """Edges with the areas beside them and the curves they follow; see `Pieces`."""

    xy: Ints
    left: Ints
    right: Ints
    curve: Ints
    t0: Floats
    t1: Floats
    cubics: list[Floats]


def arcs_of_edges(edges: Edges, fixed: set[tuple[int, int]]) -> list[Arc]:
    """Chain edges into arcs that end where three meet or other arcs end."""
    from stippler.kernels.planar.faces import chain_edges

    m = len(edges.xy)
    if not m:
        return []
    nodes, number = number_nodes(edges.xy.reshape(-1, 2))
    a, b = np.ascontiguousarray(number.reshape(-1, 2).T)
    is_break = np.bincount(number, minlength=len(nodes)) != 2
    if fixed:
        is_break |= np.fromiter((p in fixed for p in map(tuple, nodes.tolist())), np.bool_)
    order, forward = np.empty(m, np.int64), np.empty(m, np.bool_)
    start = np.empty(m + 1, np.int64)
    n = int(chain_edges(a, b, edges.left, edges.right, is_break, order, forward, start))
    return [
        _arc(edges, order[start[k] : start[k + 1]], forward[start[k] : start[k + 1]])
        for k in range(n)
    ]


def _arc(edges: Edges, order: Ints, forward: Bools) -> Arc:
    order, forward = _from_a_corner(edges, order, forward)
    xy = np.where(forward[:, None], edges.xy[order], edges.xy[order][:, [2, 3, 0, 1]])
    vertices = np.vstack([xy[:, :2], xy[-1:, 2:]])
    curve = edges.curve[order]
    begin = np.where(forward, edges.t0[order], edges.t1[order])
    end = np.where(forward, edges.t1[order], edges.t0[order])
    first = order[0]
    sides = (edges.left[first], edges.right[first])
    left, right = sides if forward[0] else sides[::-1]
    curves = _runs(edges.cubics, curve, begin, end) if (curve >= 0).any() else ()
    return Arc(Path(np.ascontiguousarray(vertices), curves), int(left), int(right))


def _from_a_corner(edges: Edges, order: Ints, forward: Bools) -> tuple[Ints, Bools]:
    """Let a ring begin where a curve does, not within one."""
    first, last = order[0], order[-1]
    curve = edges.curve[order]
    if curve[0] < 0 or curve[0] != curve[-1] or len(order) < 2:
        return order, forward
    begin = edges.xy[first, :2] if forward[0] else edges.xy[first, 2:]
    end = edges.xy[last, 2:] if forward[-1] else edges.xy[last, :2]
    changes = np.flatnonzero(curve != curve[0])
    if (begin != end).any() or not len(changes):
        return order, forward
    by = -int(changes[0])
    return np.roll(order, by), np.roll(forward, by)


def _runs(cubics: list[Floats], curve: Ints, begin: Floats, end: Floats) -> tuple[Curve, ...]:
    """Return the curves along an arc: runs of edges that follow one cubic in one direction."""
    goes_on = (curve[1:] == curve[:-1]) & (np.abs(begin[1:] - end[:-1]) < _SAME)
    goes_on &= np.sign(end - begin)[1:] == np.sign(end - begin)[:-1]
    bounds = np.r_[0, np.flatnonzero(~goes_on) + 1, len(curve)]
    out: list[Curve] = []
    for k, stop in zip(bounds[:-1].tolist(), bounds[1:].tolist(), strict=True):
        t0, t1 = float(begin[k]), float(end[stop - 1])
        if curve[k] < 0 or abs(t1 - t0) < _SAME:
            continue
        part = part_of_cubic(cubics[curve[k]], t0, t1)
        at = (np.r_[begin[k:stop], t1] - t0) / (t1 - t0)
        even = np.abs(at - np.linspace(0.0, 1.0, len(at))).max() < _SAME
        handles = tuple((float(x), float(y)) for x, y in part[1:3])
        times = () if even else (0.0, *map(float, at[1:-1]), 1.0)
        out.append(Curve(k, stop, (handles[0], handles[1]), times))
    return tuple(out)
