"""Areas that a deformation moves: their borders, and how these lie while it is dragged."""

from __future__ import annotations

import itertools
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.area_edits import current_map, edit_areas_within
from stippler.drawing.deformation import Deformation
from stippler.drawing.document import Document
from stippler.drawing.planar.edits import page_box
from stippler.drawing.planar.moves import follow
from stippler.drawing.planar.path import (
    TOLERANCE_MM,
    UNIT_MM,
    Path,
    part_of_cubic,
    path_of_cubics,
    pieces_of,
)
from stippler.drawing.planar.planar_map import OUTSIDE, Arc, PlanarMap

Points = NDArray[np.float64]
_STRAIGHT_MM = TOLERANCE_MM / 4  # off its chord, a bent piece is straight yet
_OFF_MM = 4 * TOLERANCE_MM  # in its middle, a curve is parted in two
_MOST_PARTINGS = 4
_STEP_MM = 1e-3  # of derivatives
_MOST_SAMPLES = 400  # of a piece, as shown


def bend_borders(document: Document, areas: Collection[int], bent: Deformation) -> None:
    """Bend the areas' borders, within a stroke; nodes on the page's edge stay.

    What is straight becomes a curve where the deformation bends it, of several pieces where one
    does not do.

    Raises
    ------
    GeometryError
        If borders would cross.
    """
    moving = MovingBorders.of(current_map(document), areas)
    if moving.arcs:
        paths = moving.bent(bent)
        edit_areas_within(document, lambda before: follow(before, paths))


def clear_grown_over(document: Document, areas: Collection[int], own: NDArray[np.int64]) -> None:
    """Take away the free dots that areas have grown over, all but some: ink would lie there twice.

    Parameters
    ----------
    own : ids of dots
        That were the areas' before.
    """
    dots = document.dots
    came = np.isin(dots.area, list(areas)) & ~dots.fixed
    document.remove(np.flatnonzero(came & ~np.isin(dots.id, own)))


@dataclass(frozen=True, slots=True)
class MovingBorders:
    """Borders of areas that a deformation bends, as cubics; the page's own are none of them.

    Attributes
    ----------
    arcs : tuple of int
    cubics : (n, 4, 2) float64, mm
        All arcs' pieces in order; straight ones by their thirds.
    first : (number of arcs + 1,) int64
        Which pieces are an arc's.
    straight : (n,) bool
    stays : (n, 2) bool
        Whether an end lies on the page's edge, and so stays; the piece's other points make up.
    page_mm : ((x0, y0), (x1, y1))
        Nothing goes beyond.
    """

    arcs: tuple[int, ...]
    cubics: Points
    first: NDArray[np.int64]
    straight: NDArray[np.bool_]
    stays: NDArray[np.bool_]
    page_mm: Points

    @classmethod
    def of(cls, before: PlanarMap, areas: Collection[int]) -> MovingBorders:
        """Find them."""
        chosen = set(areas)
        moving = {
            k: arc for k, arc in before.arcs.items()
            if OUTSIDE not in (arc.left, arc.right) and {arc.left, arc.right} & chosen
        }  # fmt: skip
        paths = [pieces_of(arc.path) for arc in moving.values()]
        pieces = [piece for path in paths for piece in path]
        first = np.r_[0, np.cumsum([len(path) for path in paths])].astype(np.int64)
        cubics = np.array([_as_cubic(piece) for piece in pieces]).reshape(-1, 4, 2)
        straight = np.array([len(piece) == 2 for piece in pieces], np.bool_)
        page = np.array(page_box(before), np.float64).reshape(2, 2) * UNIT_MM
        return cls(tuple(moving), cubics, first, straight, _stays(before, moving), page)

    def bent(self, bent: Deformation) -> dict[int, Path]:
        """Return their paths as a deformation takes them."""
        parts = _Parts(self.cubics, np.arange(len(self.cubics)), np.array([[0.0, 1.0]]).repeat(
            len(self.cubics), axis=0))  # fmt: skip
        by = self.held_back(bent)
        done: list[tuple[int, float, Points]] = []
        for turn in range(_MOST_PARTINGS + 1):
            fitted, off = parts.fitted(bent, by)
            fitted = np.clip(fitted, *self.page_mm)
            fits = (off <= _OFF_MM) | (turn == _MOST_PARTINGS)
            done += [
                (int(k), float(s), piece)
                for k, s, piece in zip(parts.of[fits], parts.span[fits, 0], fitted[fits],
                                       strict=True)
            ]  # fmt: skip
            parts = parts.halved(~fits)
        done.sort(key=lambda one: one[:2])
        owner = np.searchsorted(self.first, [k for k, _, _ in done], side="right") - 1
        shapes: dict[int, list[Points]] = {k: [] for k in self.arcs}
        for a, (k, _, piece) in zip(owner.tolist(), done, strict=True):
            shapes[self.arcs[a]].append(_simplest(piece) if self.straight[k] else piece)
        return {k: path_of_cubics(pieces) for k, pieces in shapes.items()}

    def held_back(self, bent: Deformation) -> Points:
        """Return by how much ends that stay would have moved, (n, 2, 2)."""
        ends = self.cubics[:, [0, 3]]
        moved = bent.apply(ends.reshape(-1, 2)).reshape(ends.shape) - ends
        return np.where(self.stays[:, :, None], moved, 0.0)


@dataclass(frozen=True, slots=True)
class ShownBorders:
    """Points of borders that follow while a person drags: quick, and near to what will be.

    Attributes
    ----------
    borders : MovingBorders
    at_mm : (n, 2) float64
        Points of what is bent, arc after arc.
    which, t : (n,)
        Piece of each point, and its place on that.
    ends : (arcs - 1,) int64
        Where the next arc's points begin.
    others : tuple of (k, 2) arrays
        Borders that are not bent.
    links : tuple of (which of others, 0 or -1, which of `at_mm`)
        Ends of others that are moved with what is bent.
    """

    borders: MovingBorders
    at_mm: Points
    which: NDArray[np.int64]
    t: Points
    ends: NDArray[np.int64]
    others: tuple[Points, ...]
    links: tuple[tuple[int, int, int], ...]

    @classmethod
    def of(cls, before: PlanarMap, areas: Collection[int], apart_mm: float) -> ShownBorders:
        """Take points of the borders, so far apart."""
        moving = MovingBorders.of(before, areas)
        length = np.hypot(*np.moveaxis(np.diff(moving.cubics, axis=1), 2, 0)).sum(axis=1)
        n = np.clip(np.ceil(length / apart_mm), 1, _MOST_SAMPLES).astype(np.int64)
        which = np.repeat(np.arange(len(n)), n)
        t = (np.arange(len(which)) - np.repeat(np.cumsum(n) - n, n)) / n[which]
        last = moving.first[1:] - 1  # each arc ends where its last piece does
        ends = np.cumsum(n)[last]
        which, t = np.insert(which, ends, last), np.insert(t, ends, 1.0)
        at = _on(moving.cubics[which], t)
        stops = np.cumsum(np.diff(np.r_[0, ends]) + 1)
        others = [
            arc.path.points_mm for k, arc in before.arcs.items()
            if k not in moving.arcs and OUTSIDE not in (arc.left, arc.right)
        ]  # fmt: skip
        tips = np.r_[stops - 1, np.r_[0, stops[:-1]][: len(stops)]].astype(np.int64)
        places = {(x, y): i for i, (x, y) in zip(tips.tolist(), at[tips].tolist(), strict=True)}
        links = tuple(
            (k, end, places[x, y])
            for k, points in enumerate(others)
            for end, (x, y) in ((0, points[0].tolist()), (-1, points[-1].tolist()))
            if (x, y) in places
        )
        return cls(moving, at, which, t, stops[:-1], tuple(others), links)

    def bent(self, bent: Deformation) -> list[Points]:
        """Return the points of all borders but the page's, as a deformation takes them."""
        out = bent.apply(self.at_mm)
        if self.borders.stays.any():
            by = self.borders.held_back(bent)[self.which]
            out -= by[:, 0] + (by[:, 1] - by[:, 0]) * self.t[:, None]
        out = np.clip(out, *self.borders.page_mm)
        others = list(self.others)
        for k, end, i in self.links:
            others[k] = others[k].copy()
            others[k][end] = out[i]
        return [*np.split(out, self.ends), *others] if self.borders.arcs else others


@dataclass(frozen=True, slots=True)
class _Parts:
    """Pieces of pieces: cubics before the deformation, and which span of which piece each is."""

    cubics: Points
    of: NDArray[np.int64]
    span: Points

    def fitted(self, bent: Deformation, by: Points) -> tuple[Points, Points]:
        """Return cubics of the same ends and tangents as the bent parts, and how far they are off.

        `by` is what is held back at the ends of each whole piece, in between by share.
        """
        n, back = len(self.cubics), by[self.of]

        def moved(at: Points, s: Points) -> Points:
            held = back[:, 0] + (back[:, 1] - back[:, 0]) * s[:, None]
            return np.asarray(bent.apply(at) - held)

        c, (s0, s1) = self.cubics, self.span.T
        a, b = moved(c[:, 0], s0), moved(c[:, 3], s1)
        middle = moved(_on(c, np.full(n, 0.5)), (s0 + s1) / 2)
        slip = (back[:, 1] - back[:, 0]) * ((s1 - s0) / 3)[:, None]
        p = a + _carried(bent, c[:, 0], c[:, 1] - c[:, 0]) - slip
        q = b + _carried(bent, c[:, 3], c[:, 2] - c[:, 3]) + slip
        fitted = np.stack([a, p, q, b], axis=1)
        return fitted, np.asarray(np.hypot(*(_on(fitted, np.full(n, 0.5)) - middle).T))

    def halved(self, which: NDArray[np.bool_]) -> _Parts:
        """Return the halves of some."""
        chosen = np.flatnonzero(which)
        cubics = [
            part_of_cubic(self.cubics[k], *span) for k in chosen for span in ((0, 0.5), (0.5, 1))
        ]
        s0, s1 = self.span[chosen].T
        m = (s0 + s1) / 2
        spans = np.stack([np.stack([s0, m], 1), np.stack([m, s1], 1)], 1)
        return _Parts(np.array(cubics).reshape(-1, 4, 2), self.of[chosen].repeat(2),
                      spans.reshape(-1, 2))  # fmt: skip


def _stays(before: PlanarMap, moving: dict[int, Arc]) -> NDArray[np.bool_]:
    """Return which ends of pieces lie on the page's edge."""
    edge = {
        (x, y) for arc in before.arcs.values() if OUTSIDE in (arc.left, arc.right)
        for x, y in arc.path.vertices.tolist()
    }  # fmt: skip
    found: list[list[bool]] = []
    for arc in moving.values():
        on = [tuple(arc.path.vertices[i].tolist()) in edge for i in arc.path.nodes()]
        found += [[a, b] for a, b in itertools.pairwise(on)]
    return np.array(found, np.bool_).reshape(-1, 2)


def _as_cubic(piece: Points) -> Points:
    if len(piece) == 4:
        return piece
    a, b = piece
    return np.array([a, (2 * a + b) / 3, (a + 2 * b) / 3, b])


def _simplest(cubic: Points) -> Points:
    """Return a piece's two ends where it is straight but for what nobody sees."""
    off = np.abs(cubic - _as_cubic(cubic[[0, 3]])).max()
    return cubic[[0, 3]] if off <= _STRAIGHT_MM else cubic


def _on(cubics: Points, t: Points) -> Points:
    """Return a point of each cubic."""
    t = t[:, None]
    s = 1.0 - t
    a, p, q, b = np.moveaxis(cubics, 1, 0)
    return np.asarray(s**3 * a + 3 * s * s * t * p + 3 * s * t * t * q + t**3 * b)


def _carried(bent: Deformation, at: Points, vector: Points) -> Points:
    """Return vectors as a deformation carries them, by its derivative along them."""
    length = np.maximum(np.hypot(*vector.T), 1e-12)[:, None]
    step = vector / length * _STEP_MM
    return np.asarray((bent.apply(at + step) - bent.apply(at - step)) / (2 * _STEP_MM) * length)
