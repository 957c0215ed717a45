"""Patterns: polygons laid over an area, whose members become its compartments."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.deformation import Deformation
from stippler.errors import GeometryError, ParameterError

Points = NDArray[np.float64]

MOST_POLYGONS = 100_000
MOST_COPIES = 400

FREE, TONED, STYLED = "free", "toned", "styled"
BETWEEN = (FREE, TONED, STYLED)
"""What the cells between the polygons are: free of dots, one compartment as the area is, or one
in a style of its own."""


@dataclass(frozen=True, slots=True, eq=False)
class PolygonSet:
    """Polygons that a pattern is made of, in a square from 0 to 1 that can be repeated.

    Attributes
    ----------
    name : str
    corners : (n, 2) float64
        Of all polygons, one after the other, not repeated at their ends.
    start : (k + 1,) int64
        Where each begins.
    """

    name: str
    corners: Points
    start: NDArray[np.int64]
    _key: int = field(default=0, repr=False)

    def __post_init__(self) -> None:
        n = len(self.start) - 1
        if n < 1 or n > MOST_POLYGONS:
            raise GeometryError(
                f"has {max(n, 0):,} polygons",
                f"pattern {self.name}",
                f"give 1 to {MOST_POLYGONS:,}",
            )
        if not np.isfinite(self.corners).all() or (np.diff(self.start) < 3).any():
            raise GeometryError("has polygons that are none", f"pattern {self.name}")
        self.corners.flags.writeable = self.start.flags.writeable = False
        key = hash((self.name, self.corners.tobytes(), self.start.tobytes()))
        object.__setattr__(self, "_key", key)

    def __len__(self) -> int:
        return len(self.start) - 1

    def __hash__(self) -> int:
        return self._key

    def __eq__(self, other: object) -> bool:
        return (
            isinstance(other, PolygonSet)
            and self._key == other._key
            and np.array_equal(self.corners, other.corners)
            and np.array_equal(self.start, other.start)
        )

    @classmethod
    def of(cls, name: str, rings: Sequence[Points], finest: float = 0.04) -> Self:
        """Make a set of rings; long edges get vertices, so that they can be bent."""
        fine = [_densified(np.asarray(ring, np.float64), finest) for ring in rings]
        start = np.r_[0, np.cumsum([len(ring) for ring in fine])].astype(np.int64)
        return cls(name, np.concatenate(fine) if fine else np.empty((0, 2)), start)

    def rings(self) -> list[Points]:
        """Return the corners of each polygon."""
        return np.split(self.corners, self.start[1:-1])

    def repeated(self, columns: int, rows: int) -> tuple[Points, NDArray[np.int64]]:
        """Return corners and starts of copies side by side, over 0..columns, 0..rows."""
        shifts = [(i, j) for j in range(rows) for i in range(columns)]
        corners = np.concatenate([self.corners + np.array(s) for s in shifts])
        sizes = np.tile(np.diff(self.start), len(shifts))
        return corners, np.r_[0, np.cumsum(sizes)].astype(np.int64)

    def to_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        return {
            "name": self.name,
            "corners": self.corners.ravel().tolist(),
            "start": self.start.tolist(),
        }

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make it of plain values."""
        corners = np.array(data["corners"], np.float64).reshape(-1, 2)
        start = np.array(data["start"], np.int64)
        ok = len(start) and start[0] == 0 and start[-1] == len(corners)
        if not ok or (np.diff(start) < 3).any():
            raise GeometryError("has polygons that are none", "pattern", "the file is damaged")
        return cls(str(data["name"]), corners, start)


def _densified(ring: Points, finest: float) -> Points:
    following = np.concatenate([ring[1:], ring[:1]])
    n = np.maximum(np.ceil(np.hypot(*(following - ring).T) / finest), 1).astype(int)
    if n.max() == 1 or n.sum() > 4000:
        return ring + 0.0
    parts = [
        ring[k] + (following[k] - ring[k]) * (np.arange(n[k]) / n[k])[:, None]
        for k in range(len(ring))
    ]
    return np.concatenate(parts)


@dataclass(frozen=True, slots=True)
class Pattern:
    """A set of polygons, deformed and laid over an area.

    Attributes
    ----------
    area : int
        Which area's compartments they become.
    polygons : PolygonSet
    columns, rows : int
        How often the set is repeated across and down.
    deformation : Deformation
        From 0..columns, 0..rows to mm on the page.
    between : {"free", "toned", "styled"}
        What the cells between the polygons are.
    between_style : int or None
        Id of their style.
    """

    area: int
    polygons: PolygonSet
    columns: int = 1
    rows: int = 1
    deformation: Deformation = field(default_factory=Deformation)
    between: str = FREE
    between_style: int | None = None

    def __post_init__(self) -> None:
        if not (1 <= self.columns <= MOST_COPIES and 1 <= self.rows <= MOST_COPIES):
            raise ParameterError(f"1 to {MOST_COPIES} copies are possible", "pattern")
        if len(self.polygons) * self.columns * self.rows > MOST_POLYGONS:
            raise ParameterError(
                f"would have more than {MOST_POLYGONS:,} polygons", "pattern", "repeat it less"
            )
        if self.between not in BETWEEN:
            raise ParameterError(f"{self.between!r} is unknown", "between", f"of {BETWEEN}")

    @classmethod
    def over(
        cls, area: int, polygons: PolygonSet, box_mm: tuple[float, float, float, float],
        size_mm: float, **options: Any,
    ) -> Self:  # fmt: skip
        """Lay a set over a box, each copy of a size, one more beyond each side."""
        x0, y0, x1, y1 = box_mm
        if not (math.isfinite(size_mm) and size_mm > 0):
            raise ParameterError(f"{size_mm:g} mm is no size", "pattern")
        columns = max(1, math.ceil((x1 - x0) / size_mm)) + 2
        rows = max(1, math.ceil((y1 - y0) / size_mm)) + 2
        matrix = (size_mm, 0.0, x0 - size_mm, 0.0, size_mm, y0 - size_mm, 0.0, 0.0, 1.0)
        return cls(area, polygons, columns, rows, Deformation(matrix), **options)

    def rings_mm(self) -> tuple[Points, NDArray[np.int64]]:
        """Return corners of all polygons on the page, and where each begins."""
        corners, start = self.polygons.repeated(self.columns, self.rows)
        return self.deformation.apply(corners), start

    def to_json(self) -> dict[str, Any]:
        """Return it as plain values."""
        return {
            "area": self.area, "polygons": self.polygons.to_json(), "columns": self.columns,
            "rows": self.rows, "deformation": self.deformation.to_json(),
            "between": self.between, "between_style": self.between_style,
        }  # fmt: skip

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make it of plain values."""
        rest = {
            **data,
            "polygons": PolygonSet.from_json(data["polygons"]),
            "deformation": Deformation.from_json(data["deformation"]),
        }
        return cls(**rest)
