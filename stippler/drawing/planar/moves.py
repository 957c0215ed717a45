"""Moving nodes, segments and handles of borders: all areas beside them follow."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
import shapely
from numpy.typing import NDArray

from stippler.drawing.planar.edits import Outcome, page_box
from stippler.drawing.planar.noding import contacts
from stippler.drawing.planar.overlay import grown, in_box, joined, renode
from stippler.drawing.planar.path import (
    UNIT_MM,
    Path,
    path_of_cubics,
    pieces_of,
    to_grid,
    with_handles,
)
from stippler.drawing.planar.planar_map import OUTSIDE, Arc, PlanarMap, Segments
from stippler.drawing.planar.policies import with_policies_of
from stippler.drawing.planar.slivers import is_sliver, without_slivers
from stippler.drawing.planar.swept import jumps_of
from stippler.errors import GeometryError

Ints = NDArray[np.int64]
Node = tuple[int, int]
"""A vertex of a border: (arc, index of the vertex)."""

Place = tuple[int, int]


def move_nodes(before: PlanarMap, to_mm: Mapping[Node, tuple[float, float]]) -> Outcome:
    """Move nodes to new places; every border that meets there follows.

    Parameters
    ----------
    to_mm : mapping of (arc, vertex) to (x, y)
        A node where several arcs end may be named by any of them. Handles beside a node move with
        it.

    Raises
    ------
    GeometryError
        If there is no such node, or borders would then cross, or an area lose its extent.
    """
    places = _places(before, to_mm)
    return _moved(before, {k: _at_places(a, places) for k, a in _meeting(before, places)})


def move_by(before: PlanarMap, nodes: Iterable[Node], by_mm: tuple[float, float]) -> Outcome:
    """Move nodes together: a segment is moved by its two."""
    to = {}
    for k, i in nodes:
        x, y = _vertex(before, k, i)
        to[k, i] = (x * UNIT_MM + by_mm[0], y * UNIT_MM + by_mm[1])
    return move_nodes(before, to)


def move_handles(
    before: PlanarMap, arc: int, curve: int, handles_mm: tuple[tuple[float, float], ...]
) -> Outcome:
    """Give a curve of an arc other handles."""
    if arc not in before.arcs or not 0 <= curve < len(before.arcs[arc].path.curves):
        raise GeometryError("is not there", f"curve {curve} of border {arc}")
    old = before.arcs[arc]
    to_grid(handles_mm)  # refuses what is not finite
    path = with_handles(old.path, curve, (handles_mm[0], handles_mm[1]))
    return _moved(before, {arc: Arc(path, old.left, old.right)})


def reshape(before: PlanarMap, paths: Mapping[int, Path]) -> Outcome:
    """Give borders other paths between the same ends.

    Raises
    ------
    GeometryError
        If there is no such border, an end is elsewhere, or borders would then cross.
    """
    changed = {}
    for k, path in paths.items():
        if k not in before.arcs:
            raise GeometryError("is not there", f"border {k}")
        old = before.arcs[k]
        both_closed = path.is_closed and old.path.is_closed
        if not both_closed and (path.vertices[[0, -1]] != old.path.vertices[[0, -1]]).any():
            raise GeometryError("would end elsewhere", f"border {k}", "move its nodes")
        changed[k] = Arc(path, old.left, old.right)
    return _moved(before, changed)


def follow(before: PlanarMap, paths: Mapping[int, Path]) -> Outcome:
    """Give borders other paths whose ends may lie elsewhere; every border that meets there follows.

    Raises
    ------
    GeometryError
        If there is no such border, or borders would then cross, or an area lose its extent.
    """
    places: dict[Place, Place] = {}
    changed: dict[int, Arc] = {}
    for k, path in paths.items():
        if k not in before.arcs:
            raise GeometryError("is not there", f"border {k}")
        old = before.arcs[k]
        changed[k] = Arc(path, old.left, old.right)
        for a, b in zip(old.path.vertices[[0, -1]], path.vertices[[0, -1]], strict=True):
            x, y, to_x, to_y = (int(v) for v in (*a, *b))
            places[x, y] = (to_x, to_y)
    for k, arc in _meeting(before, places) if places else ():
        if k not in changed:
            changed[k] = _at_places(arc, places)
    return _moved(before, changed)


def add_node(before: PlanarMap, arc: int, near_mm: tuple[float, float]) -> tuple[Outcome, int]:
    """Add a vertex to a border where it is nearest to a point; return also its index."""
    old = before.arcs[arc]
    path, index = with_node(old.path, near_mm)
    return _moved(before, {arc: Arc(path, old.left, old.right)}), index


def with_node(path: Path, near_mm: tuple[float, float]) -> tuple[Path, int]:
    """Return a path with a node more; one of a curve parts the curve in two."""
    from stippler.drawing.planar.path import control_points, part_of_cubic

    x, y = to_grid(near_mm)[0]
    s = path.segments().astype(np.float64)
    d = s[:, 2:] - s[:, :2]
    t = np.clip(((x, y) - s[:, :2]) * d, None, None).sum(axis=1) / (d * d).sum(axis=1)
    t = np.clip(t, 0.0, 1.0)
    foot = s[:, :2] + t[:, None] * d
    k = int(np.argmin(((foot - (x, y)) ** 2).sum(axis=1)))
    curve = next((c for c in path.curves if c.first <= k < c.last), None)
    if curve is None:
        point = np.floor(foot[k] + 0.5).astype(np.int64)
        if (point == path.vertices[k]).all() or (point == path.vertices[k + 1]).all():
            return path, k + int(t[k] > 0.5)
        at = np.insert(path.vertices, k + 1, point, axis=0)
        moved = [replace(c, first=c.first + 1, last=c.last + 1) if c.first > k else c
                 for c in path.curves]  # fmt: skip
        return Path(at, tuple(moved)), k + 1
    times = curve.parameters()
    share = times[k - curve.first] * (1 - t[k]) + times[k - curve.first + 1] * t[k]
    share = min(max(float(share), 0.02), 0.98)
    cubic = control_points(path, curve)
    which = path.curves.index(curve)
    pieces = pieces_of(path)
    spot = [i for i, p in enumerate(pieces) if len(p) == 4][which]
    pieces[spot : spot + 1] = [part_of_cubic(cubic, 0, share), part_of_cubic(cubic, share, 1)]
    made = path_of_cubics(pieces)
    return made, made.curves[which].last


def remove_nodes(before: PlanarMap, nodes: Iterable[Node]) -> Outcome:
    """Take vertices out of borders; nodes where borders meet stay."""
    gone: dict[int, set[int]] = {}
    for k, i in nodes:
        _vertex(before, k, i)
        gone.setdefault(k, set()).add(i)
    changed = {}
    for k, out in gone.items():
        a = before.arcs[k]
        kept = [i for i in range(len(a.path)) if i not in out or i in (0, len(a.path) - 1)]
        if len(kept) < (4 if a.path.is_closed else 2):
            raise GeometryError("would lose its extent", f"border {k}")
        changed[k] = Arc(_only(a.path, kept), a.left, a.right)
    return _moved(before, changed)


def simplify(before: PlanarMap, arcs: Iterable[int], tolerance_mm: float) -> Outcome:
    """Leave out vertices of borders that a tolerance does not need; ends stay.

    Where borders would then cross, the tolerance is halved for them, up to five times; what still
    would is left as it is and said.
    """
    after, notes = before, []
    for k in list(arcs):
        if k not in after.arcs:
            continue
        arc, width = after.arcs[k], tolerance_mm
        for _ in range(6):
            path = _simplified(arc.path, width)
            if len(path) == len(arc.path):
                break
            try:
                after = _moved(after, {k: Arc(path, arc.left, arc.right)}).map
                break
            except GeometryError:
                width *= 0.5
        else:
            notes.append(f"border {k} stays as it is: simpler, it would cross another")
    return Outcome(after, (), (), tuple(notes))


def smooth(before: PlanarMap, arcs: Iterable[int]) -> Outcome:
    """Turn borders into curves through their nodes; ends and corners of three stay."""
    changed = {}
    for k in arcs:
        a = before.arcs[k]
        changed[k] = Arc(smooth_path(a.path), a.left, a.right)
    return _moved(before, changed)


def smooth_path(path: Path) -> Path:
    """Return a path of curves through the nodes of another (Catmull and Rom's tangents)."""
    at = path.points_mm[path.nodes()]
    closed = path.is_closed
    n = len(at) - 1
    if n < 2:
        return path
    before = np.vstack([at[-2] if closed else at[0], at[:-1]])
    after = np.vstack([at[1:], at[1] if closed else at[-1]])
    chord = np.hypot(*(np.diff(at, axis=0)).T)
    tangent = after - before
    tangent /= np.maximum(np.hypot(*tangent.T), 1e-12)[:, None]
    pieces = [
        np.array([
            at[i], at[i] + tangent[i] * chord[i] / 3, at[i + 1] - tangent[i + 1] * chord[i] / 3,
            at[i + 1],
        ])
        for i in range(n)
    ]  # fmt: skip
    return path_of_cubics(pieces)


def _simplified(path: Path, tolerance_mm: float) -> Path:
    at = path.points_mm
    if path.is_closed:  # keep three corners, so that a ring stays one
        far = int(np.argmax(((at - at[0]) ** 2).sum(axis=1)))
        d = at[far] - at[0]
        off = np.abs(d[0] * (at[:, 1] - at[0, 1]) - d[1] * (at[:, 0] - at[0, 0]))
        corner = int(np.argmax(off))
        stops = sorted({0, far, corner, len(at) - 1})
    else:
        stops = [0, len(at) - 1]
    kept: list[int] = []
    for i, j in itertools.pairwise(stops):
        line = shapely.simplify(
            shapely.linestrings(at[i : j + 1]), tolerance_mm, preserve_topology=False
        )
        run = shapely.get_coordinates(line)
        k = i
        for point in run[:-1]:
            while (at[k] != point).any():
                k += 1
            kept.append(k)
    return _only(path, [*kept, len(at) - 1])


def _only(path: Path, kept: list[int]) -> Path:
    """Return a path of some of its vertices; curves that lose any are straight there."""
    number = {old: new for new, old in enumerate(kept)}
    curves = [
        replace(c, first=number[c.first], last=number[c.last])
        for c in path.curves
        if all(i in number for i in range(c.first, c.last + 1))
    ]
    return Path(np.ascontiguousarray(path.vertices[kept]), tuple(curves))


def _vertex(before: PlanarMap, k: int, i: int) -> Place:
    if k not in before.arcs or not 0 <= i < len(before.arcs[k].path):
        raise GeometryError("is not there", f"node {i} of border {k}")
    x, y = before.arcs[k].path.vertices[i].tolist()
    return x, y


def _places(before: PlanarMap, to_mm: Mapping[Node, tuple[float, float]]) -> dict[Place, Place]:
    """Return from where to where on the grid; nodes of the page's border only slide along it."""
    x0, y0, x1, y1 = page_box(before)
    places = {}
    for (k, i), to in to_mm.items():
        x, y = _vertex(before, k, i)
        tx, ty = to_grid(to)[0].tolist()
        tx, ty = min(max(tx, x0), x1), min(max(ty, y0), y1)
        if x in (x0, x1):
            tx = x
        if y in (y0, y1):
            ty = y
        places[x, y] = (tx, ty)
    return places


def _meeting(before: PlanarMap, places: Mapping[Place, Place]) -> list[tuple[int, Arc]]:
    """Return the arcs that have a vertex at one of some places."""
    x, y = np.array(list(places), np.int64).T
    x0, x1, y0, y1 = x.min(), x.max(), y.min(), y.max()
    out = []
    for k, a in before.arcs.items():
        b = a.box
        if b[0] <= x1 and b[2] >= x0 and b[1] <= y1 and b[3] >= y0:
            at = a.path.vertices
            if np.isin(at[:, 0], x).any() and any(p in places for p in map(tuple, at.tolist())):
                out.append((k, a))
    return out


def _at_places(arc: Arc, places: Mapping[Place, Place]) -> Arc:
    """Return an arc whose vertices at some places are elsewhere; handles go with their nodes."""
    path = arc.path
    old = path.vertices
    new = np.array([places.get((x, y), (x, y)) for x, y in old.tolist()], np.int64)
    by = (new - old) * UNIT_MM
    touched_curves = [c for c in path.curves if by[c.first : c.last + 1].any()]
    if not touched_curves:
        return Arc(_clean(Path(new, path.curves)), arc.left, arc.right)
    pieces = pieces_of(path)
    moved, k = [], 0
    for piece in pieces:
        step = 1
        out = piece.copy()
        if len(piece) == 4:
            step = next(c.last - c.first for c in path.curves if c.first == k)
        out[: len(out) // 2] += by[k]
        out[len(out) // 2 :] += by[k + step]
        moved.append(out)
        k += step
    return Arc(path_of_cubics(moved), arc.left, arc.right)


def _clean(path: Path) -> Path:
    """Drop vertices that fell together; a border that loses its length is refused."""
    same = (np.diff(path.vertices, axis=0) == 0).all(axis=1)
    if not same.any():
        return path
    kept = [0, *(np.flatnonzero(~same) + 1).tolist()]
    if len(kept) < 2:
        raise GeometryError("would lose its length", "the border", "unite the areas instead")
    return _only(path, kept)


def _moved(before: PlanarMap, changed: dict[int, Arc]) -> Outcome:
    """Put moved arcs in place, if areas keep apart."""
    changed = {k: with_policies_of(before.arcs[k], a) for k, a in changed.items()}
    changed = {k: a for k, a in changed.items() if a != before.arcs[k]}
    if not changed:
        return Outcome(before)
    if any(len(a.path) < 2 for a in changed.values()):
        raise GeometryError("would lose its length", "the border", "unite the areas instead")
    _check_page(before, changed)
    if _keeps_clear(before, changed):
        after = before.with_arcs(changed)
        after.groups = before.groups
        _check_order(after, changed)
    else:
        try:
            after = renode(before, changed)
        except GeometryError as error:
            raise GeometryError(
                "would lie across another", "the border", "move it less far"
            ) from error
    pairs = after.changes(before)
    _check_swept(before, pairs)
    _check_outside(after, [k for k, (_, a) in pairs.items() if a is not None])
    areas = {x for pair in pairs.values() for a in pair if a for x in (a.left, a.right)} - {OUTSIDE}
    if any(is_sliver(part) for k in areas for part in after.parts(k)):
        after = without_slivers(after, areas)
    gone = tuple(sorted(set(before.areas) - set(after.areas) - {0}))
    if gone:
        raise GeometryError("would lose its extent", f"area {gone[0]}", "remove it instead")
    return Outcome(after)


def _check_page(before: PlanarMap, changed: Mapping[int, Arc]) -> None:
    """Refuse to change the page's own border."""
    at_edge = [a for a in changed.values() if OUTSIDE in (a.left, a.right)]
    if at_edge:
        x0, y0, x1, y1 = page_box(before)
        for a in at_edge:
            s = a.path.segments()
            on = [
                (s[:, i] == v) & (s[:, i + 2] == v) for i, v in ((0, x0), (0, x1), (1, y0), (1, y1))
            ]
            if not np.logical_or.reduce(on).all():
                raise GeometryError("cannot be moved", "the page's edge", "set another page size")


def _keeps_clear(before: PlanarMap, changed: Mapping[int, Arc]) -> bool:
    """Return whether moved arcs meet nothing but at their ends."""
    moved = Segments.of(list(changed.values())).xy
    box = grown(joined([a.box for a in changed.values()]), 2)
    near = [
        a for k, a in before.arcs.items()
        if k not in changed and a.box[0] <= box[2] and a.box[2] >= box[0]
        and a.box[1] <= box[3] and a.box[3] >= box[1]
    ]  # fmt: skip
    others = Segments.of(near).xy
    others = others[in_box(others, box)]
    old = {tuple(s) for k in changed for s in before.arcs[k].path.segments().tolist()}
    is_new = np.array([tuple(s) not in old for s in moved.tolist()], np.bool_)
    xy = np.concatenate([moved, others])
    fresh = np.concatenate([is_new, np.zeros(len(others), np.bool_)])
    return not len(contacts(xy, fresh)[0]) and not _doubled(xy)


def _doubled(xy: Ints) -> bool:
    """Return whether two segments lie on each other."""
    turned = xy[:, [2, 3, 0, 1]]
    back = (xy[:, 0] > xy[:, 2]) | ((xy[:, 0] == xy[:, 2]) & (xy[:, 1] > xy[:, 3]))
    both = np.where(back[:, None], turned, xy)
    order = np.lexsort(both.T)
    return bool((both[order][1:] == both[order][:-1]).all(axis=1).any())


def _check_order(after: PlanarMap, changed: Mapping[int, Arc]) -> None:
    """Refuse moves after which areas around a node do not follow each other."""
    from stippler.drawing.planar.rings import sectors

    nodes = {e for k in changed for e in (after.arcs[k].start, after.arcs[k].end)}
    if not sectors(nodes, after.arcs):
        raise GeometryError("would lie across another", "the border", "move it less far")


def _check_outside(after: PlanarMap, changed: Iterable[int]) -> None:
    """Refuse moves that put islands into another area, or turn them inside out."""
    from stippler.kernels.planar.faces import winding_around

    group = after.groups
    page = next(group[k] for k, a in after.arcs.items() if OUTSIDE in (a.left, a.right))
    for c in {group[k] for k in changed} - {page}:
        mine = {k: a for k, a in after.arcs.items() if group[k] == c}
        (x, y), outer = _left_end(mine)
        rest = Segments.of([a for k, a in after.arcs.items() if k not in mine])
        skip = np.zeros(len(rest.xy), np.int64)
        around = OUTSIDE + winding_around(x, y, rest.xy, rest.left - rest.right, -1, skip)
        if around != outer:
            raise GeometryError("would jump over another", "the border", "move it less far")


def _left_end(arcs: Mapping[int, Arc]) -> tuple[Place, int]:
    """Return the leftmost vertex of some arcs that hang together, and the area out there."""
    place = min(
        tuple(a.path.vertices[np.lexsort(a.path.vertices.T[::-1])[0]].tolist())
        for a in arcs.values()
    )
    found: list[tuple[tuple[int, int], int]] = []
    for a in arcs.values():
        at = a.path.vertices
        for i in np.flatnonzero((at == place).all(axis=1)).tolist():
            if i < len(at) - 1:
                dx, dy = (at[i + 1] - at[i]).tolist()
                found.append(((dx, dy), a.left))
            if i > 0:
                dx, dy = (at[i - 1] - at[i]).tolist()
                found.append(((dx, dy), a.right))
    # all go right of up and down; the one nearest to up has what lies out there on its left
    steepest = found[0]
    for one in found[1:]:
        (ax, ay), (bx, by) = steepest[0], one[0]
        if ax * by - ay * bx > 0:
            steepest = one
    return (int(place[0]), int(place[1])), steepest[1]


def _check_swept(before: PlanarMap, pairs: Mapping[int, tuple[Arc | None, Arc | None]]) -> None:
    """Refuse moves that jump over another border."""
    from stippler.kernels.planar.faces import winding_around

    changed = jumps_of(pairs)
    jump = changed.left - changed.right
    component = np.zeros(len(jump), np.int64)
    ends = set(map(tuple, changed.xy.reshape(-1, 2).tolist()))
    x0, y0, x1, y1 = joined([a.box for pair in pairs.values() for a in pair if a is not None])
    for k, a in before.arcs.items():
        b = a.box
        if b[0] > x1 or b[2] < x0 or b[1] > y1 or b[3] < y0 or k in pairs:
            continue
        at = next((p for p in map(tuple, a.path.vertices.tolist()) if p not in ends), None)
        if at is not None and winding_around(at[0], at[1], changed.xy, jump, -1, component) != 0:
            raise GeometryError("would jump over another", "the border", "move it less far")
