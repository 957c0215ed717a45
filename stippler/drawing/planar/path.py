"""Paths on the grid: polylines of which runs may be cubic Bézier curves."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.errors import GeometryError

UNIT_MM = 2.0**-13
"""The grid all borders lie on: 0.12 micrometres, and an exact number in binary."""

TOLERANCE_MM = 0.005
"""How far a flattened curve may lie from the curve."""

REACH_MM = 30_000.0
"""Coordinates beyond this make no border: cross products have to be exact."""

Vertices = NDArray[np.int64]
Points = NDArray[np.float64]
Handle = tuple[float, float]

_MOST_SEGMENTS = 512


@dataclass(frozen=True, slots=True)
class Curve:
    """A run of vertices that lie on one cubic Bézier curve.

    Attributes
    ----------
    first, last : int
        Its vertices in the path.
    handles_mm : ((x, y), (x, y))
        The two inner control points; the outer ones are the vertices first and last.
    at : tuple of float
        The curve's parameter at each vertex from first to last; empty: at equal steps.
    """

    first: int
    last: int
    handles_mm: tuple[Handle, Handle]
    at: tuple[float, ...] = ()

    def parameters(self) -> Points:
        """Return the curve's parameter at each of its vertices."""
        if self.at:
            return np.array(self.at)
        return np.linspace(0.0, 1.0, self.last - self.first + 1)


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """Vertices on the grid, and which runs of them are curves.

    Attributes
    ----------
    vertices : (n, 2) int64
        In units of `UNIT_MM`; the first is repeated at the end of a closed path.
    curves : tuple of Curve
        In order; they do not overlap.
    """

    vertices: Vertices
    curves: tuple[Curve, ...] = ()

    def __post_init__(self) -> None:
        self.vertices.flags.writeable = False

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, Path)
            and self.curves == other.curves
            and np.array_equal(self.vertices, other.vertices)
        )

    __hash__ = None  # type: ignore[assignment]

    def __len__(self) -> int:
        return len(self.vertices)

    @property
    def is_closed(self) -> bool:
        """Whether it ends where it begins."""
        return bool((self.vertices[0] == self.vertices[-1]).all())

    @property
    def points_mm(self) -> Points:
        """The vertices in mm."""
        return np.asarray(self.vertices * UNIT_MM)

    def box(self) -> tuple[int, int, int, int]:
        """Return x0, y0, x1, y1 in units of the grid."""
        x, y = self.vertices[:, 0], self.vertices[:, 1]
        return int(x.min()), int(y.min()), int(x.max()), int(y.max())

    def nodes(self) -> list[int]:
        """Return the vertices that a person sees: all but those within curves."""
        hidden = {k for c in self.curves for k in range(c.first + 1, c.last)}
        return [k for k in range(len(self)) if k not in hidden]

    def segments(self) -> NDArray[np.int64]:
        """Return (n - 1, 4): x0, y0, x1, y1 of each segment."""
        return np.hstack([self.vertices[:-1], self.vertices[1:]])

    def reversed(self) -> Path:
        """Return the path run the other way."""
        n = len(self) - 1
        curves = [
            Curve(n - c.last, n - c.first, c.handles_mm[::-1], tuple(1.0 - t for t in c.at[::-1]))
            for c in reversed(self.curves)
        ]
        return Path(self.vertices[::-1].copy(), tuple(curves))

    @classmethod
    def polyline(cls, points_mm: ArrayLike, *, closed: bool = False) -> Self:
        """Make a path of straight segments; points that fall together are one."""
        at = to_grid(points_mm)
        if closed and len(at) and (at[0] != at[-1]).any():
            at = np.vstack([at, at[:1]])
        return cls(_without_repeats(at))

    @classmethod
    def bezier(cls, nodes_mm: Sequence[Sequence[Handle]], *, closed: bool = False) -> Path:
        """Make a path of nodes, each (handle in, node, handle out); see `path_of_cubics`."""
        n = len(nodes_mm)
        pieces = []
        for k in range(n if closed else n - 1):
            here, there = nodes_mm[k], nodes_mm[(k + 1) % n]
            pieces.append((here[1], here[2], there[0], there[1]))
        return path_of_cubics(pieces)

    def to_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        curves = [[c.first, c.last, *c.handles_mm, list(c.at)] for c in self.curves]
        return {"vertices": self.vertices.tolist(), "curves": curves}

    @classmethod
    def from_json(cls, data: dict[str, Any]) -> Self:
        """Make it of plain values; refuse what is no path."""
        try:
            at = np.array(data["vertices"], np.int64).reshape(-1, 2)
            curves = tuple(
                Curve(int(c[0]), int(c[1]), (_pair(c[2]), _pair(c[3])), tuple(map(float, c[4])))
                for c in data.get("curves", ())
            )
        except (KeyError, TypeError, ValueError, IndexError, OverflowError) as error:
            raise GeometryError("is no path", "border", "the file is damaged") from error
        last = 0
        for c in curves:
            n = c.last - c.first
            if c.first < last or n < 1 or c.last >= len(at) or len(c.at) not in (0, n + 1):
                raise GeometryError("has a curve that is none", "border", "the file is damaged")
            last = c.last
        limit = REACH_MM / UNIT_MM  # not by size: of the least number there is none
        if len(at) < 2 or at.min() < -limit or at.max() > limit:
            raise GeometryError("is no path", "border", "the file is damaged")
        if not (np.diff(at, axis=0) != 0).any(axis=1).all():
            raise GeometryError("is no path", "border", "the file is damaged")
        return cls(at, curves)


def _pair(value: Any) -> Handle:
    x, y = map(float, value)
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError("not finite")
    return x, y


def to_grid(points_mm: ArrayLike) -> Vertices:
    """Round points to the grid.

    Raises
    ------
    GeometryError
        If one is not finite, or farther out than any page.
    """
    points = np.asarray(points_mm, np.float64).reshape(-1, 2)
    if not np.isfinite(points).all():
        raise GeometryError("has a point that is not finite", "outline")
    if len(points) and np.abs(points).max() > REACH_MM:
        raise GeometryError(f"reaches beyond {REACH_MM:,.0f} mm", "outline", "use mm on the page")
    return np.floor(points / UNIT_MM + 0.5).astype(np.int64)


def _without_repeats(at: Vertices) -> Vertices:
    if len(at) < 2:
        return at
    return np.ascontiguousarray(at[np.r_[True, (np.diff(at, axis=0) != 0).any(axis=1)]])


def n_steps(cubic_mm: Points, tolerance_mm: float) -> int:
    """Return into how many equal steps a cubic has to be taken to keep to a tolerance."""
    bend = np.abs(np.diff(cubic_mm, 2, axis=0)).max(initial=0.0) * math.sqrt(2.0) * 6.0
    return min(max(1, math.ceil(math.sqrt(bend / (8.0 * tolerance_mm)))), _MOST_SEGMENTS)


def on_cubic(cubic_mm: Points, t: Points) -> Points:
    """Return the points of a cubic at parameters."""
    t = t[:, None]
    s = 1.0 - t
    p = cubic_mm
    return np.asarray(s**3 * p[0] + 3 * s * s * t * p[1] + 3 * s * t * t * p[2] + t**3 * p[3])


def part_of_cubic(cubic_mm: Points, t0: float, t1: float) -> Points:
    """Return the control points of the part of a cubic from t0 to t1; t1 may come first."""

    def blossom(a: float, b: float, c: float) -> Points:
        p = cubic_mm
        for t in (a, b, c):
            p = (1.0 - t) * p[:-1] + t * p[1:]
        return np.asarray(p[0])

    return np.array(
        [blossom(t0, t0, t0), blossom(t0, t0, t1), blossom(t0, t1, t1), blossom(t1, t1, t1)]
    )


def path_of_cubics(
    cubics_mm: Iterable[ArrayLike], tolerance_mm: float = TOLERANCE_MM, *, closed: bool = False
) -> Path:
    """Make a path of pieces of 2 (straight) or 4 (cubic) control points, flattened on the grid."""
    at: list[tuple[int, int]] = []
    curves: list[Curve] = []
    pieces = [np.asarray(piece, np.float64) for piece in cubics_mm]
    on_grid = iter(to_grid(np.concatenate(pieces)).tolist() if pieces else ())  # all at once
    for p in pieces:
        start, *_, end = ((x, y) for x, y in islice(on_grid, len(p)))
        if not at:
            at.append(start)
        if len(p) == 2:
            if end != at[-1]:
                at.append(end)
            continue
        t = np.linspace(0.0, 1.0, n_steps(p, tolerance_mm) + 1)
        first = len(at) - 1
        kept = [0.0]
        for time, (x, y) in zip(t[1:].tolist(), to_grid(on_cubic(p, t[1:])).tolist(), strict=True):
            if (x, y) != at[-1]:
                at.append((x, y))
                kept.append(time)
        n = len(at) - 1 - first
        if n:
            whole = len(kept) == len(t)
            handles = ((float(p[1, 0]), float(p[1, 1])), (float(p[2, 0]), float(p[2, 1])))
            times = () if whole else (*kept[:-1], 1.0)
            curves.append(Curve(first, first + n, handles, times))
    vertices = np.array(at, np.int64).reshape(-1, 2)
    if closed and len(vertices) and (vertices[0] != vertices[-1]).any():
        vertices = np.vstack([vertices, vertices[:1]])
    return Path(vertices, tuple(curves))


def control_points(path: Path, curve: Curve) -> Points:
    """Return the four control points of a path's curve in mm."""
    ends = path.vertices[[curve.first, curve.last]] * UNIT_MM
    return np.array([ends[0], *curve.handles_mm, ends[1]])


def pieces_of(path: Path) -> list[Points]:
    """Return a path as pieces of 2 (straight) or 4 (cubic) control points in mm."""
    out: list[Points] = []
    k = 0
    points = path.points_mm
    starts = {c.first: c for c in path.curves}
    while k < len(path) - 1:
        curve = starts.get(k)
        if curve is None:
            out.append(points[k : k + 2])
            k += 1
        else:
            out.append(control_points(path, curve))
            k = curve.last
    return out


def with_handles(path: Path, index: int, handles_mm: tuple[Handle, Handle]) -> Path:
    """Return a path whose curve of that index has other handles, flattened anew."""
    pieces = pieces_of(path)
    which = [k for k, piece in enumerate(pieces) if len(piece) == 4][index]
    cubic = pieces[which].copy()
    cubic[1], cubic[2] = handles_mm
    pieces[which] = cubic
    return path_of_cubics(pieces)


def shifted(curve: Curve, by: int) -> Curve:
    """Return a curve whose vertices are counted from elsewhere."""
    return replace(curve, first=curve.first + by, last=curve.last + by)
