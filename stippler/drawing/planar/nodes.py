"""Nodes and handles of one path: moved, added, taken out, made smooth or a corner.

A person sees the nodes of `Path.nodes`; between two of them lies a piece, straight or a cubic.
Nothing here knows of areas: borders and lines are edited alike.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Literal

import numpy as np

from stippler.drawing.planar.path import Path, Points, on_cubic, path_of_cubics, pieces_of
from stippler.errors import GeometryError

XY = tuple[float, float]
Side = Literal["in", "out"]
"""Which handle of a node: the one before it along the path, or the one after it."""

_STRAIGHT = 1e-3
"""Sine of the angle below which two handles count as one line."""


def pieces_at(path: Path, vertex: int) -> tuple[int | None, int | None]:
    """Return the numbers of the pieces before and after a node; None at the end of a path."""
    nodes = path.nodes()
    if vertex not in nodes:
        raise GeometryError("is no node of its path", f"vertex {vertex}")
    j, n = nodes.index(vertex), len(nodes) - 1
    before = j - 1 if j > 0 else (n - 1 if path.is_closed else None)
    after = j if j < n else (0 if path.is_closed else None)
    return before, after


def handles_at(path: Path, vertex: int) -> dict[Side, XY]:
    """Return where the handles of a node are; straight pieces have none, nor have corners."""
    before, after = pieces_at(path, vertex)
    pieces, at = pieces_of(path), path.points_mm[vertex]
    found: dict[Side, XY] = {}
    if before is not None and len(pieces[before]) == 4 and (pieces[before][2] != at).any():
        found["in"] = _xy(pieces[before][2])
    if after is not None and len(pieces[after]) == 4 and (pieces[after][1] != at).any():
        found["out"] = _xy(pieces[after][1])
    return found


def is_smooth(path: Path, vertex: int) -> bool:
    """Return whether a path goes through a node without a corner, by its two handles."""
    handles = handles_at(path, vertex)
    if len(handles) < 2:
        return False
    at = path.points_mm[vertex]
    a, b = np.array(handles["in"]) - at, np.array(handles["out"]) - at
    lengths = float(np.hypot(*a) * np.hypot(*b))
    cross = float(a[0] * b[1] - a[1] * b[0])
    return lengths > 0.0 and float(a @ b) < 0.0 and abs(cross) <= _STRAIGHT * lengths


def move_nodes(path: Path, to_mm: Mapping[int, XY]) -> Path:
    """Return a path whose nodes are elsewhere; their handles go with them."""
    at, nodes = path.points_mm, path.nodes()
    places = {0: to_mm[len(path) - 1]} if path.is_closed and len(path) - 1 in to_mm else {}
    places.update(to_mm)
    if path.is_closed and 0 in places:
        places[len(path) - 1] = places[0]
    shift = [np.subtract(places[k], at[k]) if k in places else np.zeros(2) for k in nodes]
    moved = []
    for j, piece in enumerate(pieces_of(path)):
        out = piece.copy()
        out[: len(out) // 2] += shift[j]
        out[len(out) // 2 :] += shift[j + 1]
        moved.append(out)
    return _checked(moved)


def move_handle(path: Path, vertex: int, side: Side, to_mm: XY, *, free: bool = False) -> Path:
    """Return a path one of whose handles is elsewhere; a smooth node stays smooth.

    Parameters
    ----------
    free : bool
        Let the handle across be, so that the node becomes a corner.
    """
    before, after = pieces_at(path, vertex)
    pieces = [piece.copy() for piece in pieces_of(path)]
    mine, other = (before, after) if side == "in" else (after, before)
    if mine is None or len(pieces[mine]) != 4:
        raise GeometryError("has no handle there", f"vertex {vertex}")
    turns = not free and is_smooth(path, vertex)
    pieces[mine][2 if side == "in" else 1] = to_mm
    if turns and other is not None:
        at = path.points_mm[vertex]
        k = 1 if side == "in" else 2
        away = at - np.asarray(to_mm)
        length = float(np.hypot(*(pieces[other][k] - at)))
        if float(np.hypot(*away)) > 0.0:
            pieces[other][k] = at + away / np.hypot(*away) * length
    return _checked(pieces)


def make_smooth(path: Path, vertices: Collection[int]) -> Path:
    """Return a path that goes through some of its nodes without a corner.

    The pieces beside them become curves; the ends of an open path stay as they are.
    """
    pieces = [_curved(piece) for piece in pieces_of(path)]
    straight = [len(piece) == 2 for piece in pieces_of(path)]
    for vertex in _distinct(path, vertices):
        before, after = pieces_at(path, vertex)
        if before is None or after is None:
            continue
        p, q = pieces[before], pieces[after]
        at, along = q[0], q[3] - p[0]
        length = float(np.hypot(*along))
        if length == 0.0:
            continue
        tangent = along / length
        p[2] = at - tangent * np.hypot(*(at - p[0])) / 3
        q[1] = at + tangent * np.hypot(*(q[3] - at)) / 3
        straight[before] = straight[after] = False
    return _checked([p[[0, 3]] if s else p for p, s in zip(pieces, straight, strict=True)])


def make_corner(path: Path, vertices: Collection[int]) -> Path:
    """Return a path with the handles of some nodes drawn in.

    A piece with no handle left is straight.
    """
    pieces = [piece.copy() for piece in pieces_of(path)]
    for vertex in _distinct(path, vertices):
        before, after = pieces_at(path, vertex)
        if before is not None and len(pieces[before]) == 4:
            pieces[before][2] = pieces[before][3]
        if after is not None and len(pieces[after]) == 4:
            pieces[after][1] = pieces[after][0]
    return _checked([_as_straight(piece) for piece in pieces])


def remove_nodes(path: Path, vertices: Collection[int]) -> Path:
    """Return a path without some of its nodes; pieces on both sides become one.

    The ends of an open path can go, too.
    """
    gone = set(_distinct(path, vertices))
    nodes, pieces = path.nodes(), pieces_of(path)
    closed, n = path.is_closed, len(pieces)
    stays = [k for k in range(n if closed else n + 1) if nodes[k] not in gone]
    if len(stays) < (3 if closed else 2):
        raise GeometryError("would lose its extent", "the path", "delete it instead")
    made: list[Points] = []
    for i, k in enumerate(stays):
        following = stays[(i + 1) % len(stays)] if closed else stays[i + 1 : i + 2]
        if isinstance(following, list):
            if not following:
                break
            following = following[0]
        run = [pieces[m % n] for m in range(k, following + (n if following <= k else 0))]
        made.append(run[0] if len(run) == 1 else _one_of(run))
    return _checked(made)


def middles(path: Path, vertices: Collection[int]) -> list[XY]:
    """Return the middle of each piece both of whose ends are among some nodes."""
    chosen = set(_distinct(path, vertices))
    nodes, last = path.nodes(), len(path) - 1
    ends = [0 if path.is_closed and k == last else k for k in nodes]
    found = []
    for j, piece in enumerate(pieces_of(path)):
        if ends[j] in chosen and ends[j + 1] in chosen:
            half = on_cubic(piece, np.array([0.5]))[0] if len(piece) == 4 else piece.mean(axis=0)
            found.append(_xy(half))
    return found


def _one_of(run: list[Points]) -> Points:
    """Return one piece for several: a curve of their outer tangents, if any was a curve."""
    first, last = run[0], run[-1]
    if all(len(piece) == 2 for piece in run):
        return np.array([first[0], last[-1]])
    a, b = _curved(first), _curved(last)
    chord = float(np.hypot(*(b[3] - a[0])))
    whole = sum(float(np.hypot(*(p[-1] - p[0]))) for p in run)
    share = whole / max(float(np.hypot(*(a[3] - a[0]))), 1e-12)
    other = whole / max(float(np.hypot(*(b[3] - b[0]))), 1e-12)
    most = max(chord, whole)
    out, back = (a[1] - a[0]) * share, (b[2] - b[3]) * other
    return np.array([a[0], a[0] + _held(out, most), b[3] + _held(back, most), b[3]])


def _held(v: Points, most: float) -> Points:
    length = float(np.hypot(*v))
    return v * (most / length) if length > most else v


def _curved(piece: Points) -> Points:
    if len(piece) == 4:
        return piece.copy()
    a, b = piece
    return np.array([a, a + (b - a) / 3, b - (b - a) / 3, b])


def _as_straight(piece: Points) -> Points:
    is_drawn_in = len(piece) == 4 and (piece[1] == piece[0]).all() and (piece[2] == piece[3]).all()
    return piece[[0, 3]] if is_drawn_in else piece


def _distinct(path: Path, vertices: Collection[int]) -> list[int]:
    """Return nodes, each once: a closed path's last is its first."""
    last = len(path) - 1
    return sorted({0 if path.is_closed and v == last else v for v in vertices})


def _checked(pieces: list[Points]) -> Path:
    path = path_of_cubics(pieces)
    if len(path) < 2:
        raise GeometryError("would lose its length", "the path", "delete it instead")
    return path


def _xy(point: Points) -> XY:
    return float(point[0]), float(point[1])
