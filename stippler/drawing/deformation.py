"""Deformations of patterns, dots, outlines and lines: one value, one way to apply it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.errors import GeometryError

Points = NDArray[np.float64]
XY = tuple[float, float]
Box = tuple[float, float, float, float]

UNIT_MATRIX = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
LEAST_CAGE, MOST_CAGE = 4, 64
MOST_PINS = 200
_NEWTON = 30
_FINE = 6  # samples a cage's cell, each way


@dataclass(frozen=True, slots=True)
class Cage:
    """Control points over a box, and how far each was moved.

    Attributes
    ----------
    box_mm : (x0, y0, x1, y1)
    rows, columns : int
        Control points down and across, from edge to edge; at least 4.
    moves_mm : tuple of (dx, dy)
        Row by row.
    """

    box_mm: Box
    rows: int
    columns: int
    moves_mm: tuple[XY, ...]

    def __post_init__(self) -> None:
        x0, y0, x1, y1 = self.box_mm
        if not (np.isfinite(self.box_mm).all() and x1 > x0 and y1 > y0):
            raise GeometryError("has no extent", "cage")
        if not all(LEAST_CAGE <= n <= MOST_CAGE for n in (self.rows, self.columns)):
            raise GeometryError(f"needs {LEAST_CAGE} to {MOST_CAGE} points each way", "cage")
        if len(self.moves_mm) != self.rows * self.columns:
            raise GeometryError("has another number of points than rows and columns", "cage")
        if not np.isfinite(self.moves_mm).all():
            raise GeometryError("has a point that is not finite", "cage")

    @classmethod
    def over(cls, box_mm: Box, rows: int = LEAST_CAGE, columns: int = LEAST_CAGE) -> Self:
        """Lay a cage over a box."""
        return cls(box_mm, rows, columns, ((0.0, 0.0),) * (rows * columns))

    def places_mm(self) -> Points:
        """Return where the control points are, (rows * columns, 2)."""
        return np.asarray(self.rest_mm() + np.array(self.moves_mm))

    def rest_mm(self) -> Points:
        """Return where they lay at first."""
        x0, y0, x1, y1 = self.box_mm
        x, y = np.linspace(x0, x1, self.columns), np.linspace(y0, y1, self.rows)
        return np.stack(np.meshgrid(x, y), -1).reshape(-1, 2)

    def moved(self, which: Mapping[int, XY]) -> Self:
        """Return the cage with some control points at other places."""
        rest = self.rest_mm()
        moves = list(self.moves_mm)
        for k, place in which.items():
            moves[k] = (float(place[0] - rest[k, 0]), float(place[1] - rest[k, 1]))
        return replace(self, moves_mm=tuple(moves))

    def refined(self, rows: int, columns: int) -> Self:
        """Return a cage of other numbers of points, moved as this one moves those places."""
        fresh = Cage.over(self.box_mm, rows, columns)
        rest = fresh.rest_mm()
        moved = Deformation(cage=self).apply(rest) - rest
        return replace(self, rows=rows, columns=columns, moves_mm=_pairs(moved))


@dataclass(frozen=True, slots=True)
class Deformation:
    """A homography, then a cage, then pins; each may do nothing.

    Attributes
    ----------
    matrix : tuple of 9 floats
        Homography, row by row: moves, turns, scales, shears, perspective.
    cage : Cage or None
        Interpolating cubic B-splines: a control point that is moved takes what lies on it along.
    pins_mm : tuple of ((x, y), (x, y))
        From where to where; between them a thin plate bends least.
    """

    matrix: tuple[float, ...] = UNIT_MATRIX
    cage: Cage | None = None
    pins_mm: tuple[tuple[XY, XY], ...] = ()

    def __post_init__(self) -> None:
        h = np.array(self.matrix, np.float64)
        if (
            h.shape != (9,)
            or not np.isfinite(h).all()
            or abs(np.linalg.det(h.reshape(3, 3))) < 1e-12
        ):
            raise GeometryError("cannot be inverted", "deformation")
        pins = np.array(self.pins_mm, np.float64).reshape(-1, 4)
        if len(pins) > MOST_PINS or not np.isfinite(pins).all():
            raise GeometryError(f"has pins that are not finite, or more than {MOST_PINS}", "pins")
        if len({(x, y) for x, y, _, _ in pins.tolist()}) < len(pins):
            raise GeometryError("start at one place", "two pins", "take one away")

    def apply(self, points: ArrayLike) -> Points:
        """Return points moved; those given are not changed.

        Raises
        ------
        GeometryError
            If a point lies on or beyond the horizon of the perspective.
        """
        from stippler.kernels.machine.pool import parallel_for
        from stippler.kernels.warp.deform import deform

        at = np.ascontiguousarray(np.asarray(points, np.float64).reshape(-1, 2))
        h = np.array(self.matrix).reshape(3, 3)
        if (h[2, :2] != 0.0).any() and len(at) and ((at @ h[2, :2] + h[2, 2]) <= 1e-9).any():
            raise GeometryError("lies beyond its horizon", "perspective", "turn it less")
        out = np.empty_like(at)
        box, cx, cy = _coefficients(self.cage)
        pins, weights = _plate(self.pins_mm)
        parallel_for(
            deform,
            len(at),
            at,
            h,
            self.cage is not None,
            box,
            cx,
            cy,
            pins,
            weights,
            out,
            grain=8192,
        )
        return out

    def inverse_of(self, points: ArrayLike) -> Points:
        """Return from where points came, by Newton's method; NaN where nothing leads there."""
        goal = np.asarray(points, np.float64).reshape(-1, 2)
        h = np.linalg.inv(np.array(self.matrix).reshape(3, 3))
        bent = replace(self, matrix=UNIT_MATRIX)
        at = goal.copy()
        if self.cage is not None or self.pins_mm:
            at = _solved(bent, goal)
        w = at @ h[2, :2] + h[2, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            out = (at @ h[:2, :2].T + h[:2, 2]) / w[:, None]
        return np.asarray(out)

    def followed_by(self, other: Deformation, box: Box, points: int = 9) -> Deformation:
        """Return a deformation that comes near to this one and then another, over a box in mm.

        Cage and pins become one finer cage, which is met at its points.
        """
        size = self.cage.box_mm if self.cage is not None else box
        n = max((points, self.cage.rows, self.cage.columns) if self.cage else (points, LEAST_CAGE))
        cage = Cage.over(size, min(n, MOST_CAGE), min(n, MOST_CAGE))
        rest = cage.rest_mm()
        moved = other.apply(replace(self, matrix=UNIT_MATRIX).apply(rest)) - rest
        return Deformation(self.matrix, replace(cage, moves_mm=_pairs(moved)))

    def folds(self, box: Box) -> Points:
        """Return places in a box, before the deformation, where it folds over; none is good."""
        from stippler.kernels.warp.deform import find_folds

        n = _FINE * (max(self.cage.rows, self.cage.columns) if self.cage else 8) + 1
        x, y = np.linspace(box[0], box[2], n), np.linspace(box[1], box[3], n)
        at = np.stack(np.meshgrid(x, y), -1)
        moved = self.apply(at.reshape(-1, 2)).reshape(at.shape)
        folded = np.empty((n - 1, n - 1), np.bool_)
        if not find_folds(moved, folded):
            return np.empty((0, 2))
        j, i = np.nonzero(folded)
        return np.asarray((at[j, i] + at[j + 1, i + 1]) / 2)

    def to_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        cage = None
        if self.cage is not None:
            c = self.cage
            cage = [list(c.box_mm), c.rows, c.columns, [list(m) for m in c.moves_mm]]
        pins = [[list(a), list(b)] for a, b in self.pins_mm]
        return {"matrix": list(self.matrix), "cage": cage, "pins_mm": pins}

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make it of plain values."""
        cage = None
        if data["cage"] is not None:
            box, rows, columns, moves = data["cage"]
            x0, y0, x1, y1 = map(float, box)
            cage = Cage((x0, y0, x1, y1), int(rows), int(columns), _pairs(np.array(moves, float)))
        pins = tuple((_xy(a), _xy(b)) for a, b in data["pins_mm"])
        return cls(tuple(map(float, data["matrix"])), cage, pins)


def _xy(pair: Any) -> XY:
    x, y = map(float, pair)
    return x, y


def _pairs(moves: Points) -> tuple[XY, ...]:
    return tuple((float(x), float(y)) for x, y in moves.reshape(-1, 2))


def _solved(bent: Deformation, goal: Points) -> Points:
    """Return where a deformation without perspective takes to a goal from."""
    at, step = goal.copy(), 1e-4
    size = max(float(np.ptp(goal, axis=0).max(initial=0.0)), 1.0) if len(goal) else 1.0
    for _ in range(_NEWTON):
        there = bent.apply(at)
        off = there - goal
        if len(off) == 0 or np.abs(off).max() < 1e-9:
            break
        dx = (bent.apply(np.add(at, (step, 0.0))) - there) / step
        dy = (bent.apply(np.add(at, (0.0, step))) - there) / step
        det = dx[:, 0] * dy[:, 1] - dx[:, 1] * dy[:, 0]
        det = np.where(np.abs(det) < 1e-6, np.inf, det)
        u = (off[:, 0] * dy[:, 1] - off[:, 1] * dy[:, 0]) / det
        v = (dx[:, 0] * off[:, 1] - dx[:, 1] * off[:, 0]) / det
        at -= np.clip(np.column_stack([u, v]), -0.25 * size, 0.25 * size)
    bad = np.abs(bent.apply(at) - goal).max(axis=1, initial=0.0) > 1e-6 * size
    at[bad] = np.nan
    return at


def before_fold(start: Deformation, end: Deformation, box: Box) -> Deformation:
    """Return the deformation nearest to `end`, on the way from `start`, that does not fold over.

    Both have the same matrix and numbers of points and pins.
    """
    if not len(end.folds(box)):
        return end
    low, high = 0.0, 1.0
    for _ in range(10):
        middle = (low + high) / 2
        if len(between(start, end, middle).folds(box)):
            high = middle
        else:
            low = middle
    return between(start, end, low)


def between(start: Deformation, end: Deformation, share: float) -> Deformation:
    """Return the deformation that is a share of the way from one to another."""

    def mixed(a: Any, b: Any) -> Points:
        return np.asarray((1 - share) * np.array(a, np.float64) + share * np.array(b, np.float64))

    cage = end.cage
    if cage is not None:
        first = start.cage or Cage.over(cage.box_mm, cage.rows, cage.columns)
        cage = replace(cage, moves_mm=_pairs(mixed(first.moves_mm, cage.moves_mm)))
    pins = end.pins_mm
    if pins:
        old = {a: b for a, b in start.pins_mm}
        pins = tuple((a, _xy(mixed(old.get(a, a), b))) for a, b in pins)
    matrix = tuple(mixed(start.matrix, end.matrix).tolist())
    return Deformation(matrix, cage, pins)


def onto(box: Box, corners_mm: ArrayLike) -> tuple[float, ...]:
    """Return the homography that takes a box's corners (clockwise from x0, y0) to four points.

    Raises
    ------
    GeometryError
        If three of them lie in line.
    """
    x0, y0, x1, y1 = box
    source = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    rows, values = [], []
    for (x, y), (u, v) in zip(source, np.asarray(corners_mm, float).reshape(4, 2), strict=True):
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y], [0, 0, 0, x, y, 1, -v * x, -v * y]]
        values += [u, v]
    try:
        h = np.linalg.solve(np.array(rows), np.array(values))
    except np.linalg.LinAlgError as error:
        raise GeometryError("lie in line", "corners", "draw them apart") from error
    return (*map(float, h), 1.0)


@lru_cache(maxsize=32)
def _coefficients(cage: Cage | None) -> tuple[Points, Points, Points]:
    """Return box and spline coefficients such that the spline meets each control point's move."""
    if cage is None:
        return np.zeros(4), np.zeros((6, 6)), np.zeros((6, 6))
    moves = np.array(cage.moves_mm).reshape(cage.rows, cage.columns, 2)
    down, across = _interpolation(cage.rows), _interpolation(cage.columns)
    cx, cy = (np.ascontiguousarray(down @ moves[..., k] @ across.T) for k in (0, 1))
    return np.array(cage.box_mm), cx, cy


def _interpolation(n: int) -> Points:
    """Return (n + 2, n): values to coefficients, with no bend at both ends."""
    m = np.zeros((n + 2, n + 2))
    for k in range(n):
        m[k, k : k + 3] = 1 / 6, 4 / 6, 1 / 6
    m[n, :3] = m[n + 1, -3:] = 1.0, -2.0, 1.0
    return np.asarray(np.linalg.inv(m)[:, :n])


@lru_cache(maxsize=32)
def _plate(pins_mm: tuple[tuple[XY, XY], ...]) -> tuple[Points, Points]:
    """Return where pins start, and the weights of the thin plate through them."""
    pins = np.array([a for a, _ in pins_mm], np.float64).reshape(-1, 2)
    n = len(pins)
    weights = np.zeros((n + 3, 2))
    if not n:
        return pins, weights
    moves = np.array([b for _, b in pins_mm], np.float64) - pins
    if n < 3:
        # one pin moves all; two turn and scale all
        weights[n] = moves.mean(axis=0)
        if n == 2:
            d, e = pins[1] - pins[0], moves[1] - moves[0]
            a = np.array([[d @ e, d[0] * e[1] - d[1] * e[0]]]).ravel() / (d @ d)
            weights[n + 1], weights[n + 2] = (a[0], a[1]), (-a[1], a[0])
            weights[n] = moves[0] - np.array([a[0] * pins[0, 0] - a[1] * pins[0, 1],
                                              a[1] * pins[0, 0] + a[0] * pins[0, 1]])  # fmt: skip
        return pins, weights
    r = ((pins[:, None] - pins[None]) ** 2).sum(-1)
    k = np.where(r > 0, r * np.log(np.where(r > 0, r, 1.0)), 0.0)
    p = np.column_stack([np.ones(n), pins])
    system = np.block([[k, p], [p.T, np.zeros((3, 3))]])
    goal = np.vstack([moves, np.zeros((3, 2))])
    size = np.abs(pins - pins.mean(axis=0)).max()
    if np.linalg.matrix_rank(pins - pins.mean(axis=0), tol=1e-6 * size) < 2:  # all in line
        weights = np.linalg.lstsq(system, goal, rcond=1e-12)[0]
    else:
        weights = np.linalg.solve(system, goal)
    return pins, np.ascontiguousarray(weights)
