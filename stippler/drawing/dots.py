"""The dots of a drawing, as flat arrays of equal length."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.errors import ParameterError
from stippler.kernels.shapes.dot_shape import MAX_ELONGATION

__all__ = ["FIXED", "FREE", "MAX_ELONGATION", "NO_CURVE", "ON_CURVE", "Dots", "first_seeds"]

Index = NDArray[np.intp] | NDArray[np.bool_] | slice

FREE, FIXED, ON_CURVE = 0, 1, 2
"""What holds a dot: nothing, its place, or a curve that it may move along."""

NO_CURVE = -1


@dataclass(slots=True, eq=False)
class Dots:
    """Structure of arrays; row i of every array is dot i. 62 bytes a dot.

    Attributes
    ----------
    position_mm : (n, 2) float64
        Centres on the page, x right, y down.
    radius_mm : (n,) float32
        Radius of the round dot of the same area.
    elongation : (n,) float32
        Long axis over short axis, 1 (round) to `MAX_ELONGATION`.
    angle_rad : (n,) float32
        Direction of the long axis, from x towards y.
    roughness : (n,) float32
        0 (smooth outline) to 1.
    seed : (n,) uint32
        Chooses the rough outline.
    area : (n,) int32
        Id of the area that it lies in.
    constraint : (n,) int8
        `FREE`, `FIXED` or `ON_CURVE`; all shape the cells of others, only free ones move freely.
    curve : (n,) int32
        Id of the line that holds it; `NO_CURVE` for dots that are not on one.
    parameter : (n,) float64
        Where it lies along that line; 0 for dots that are not on one.
    id : (n,) int64
        Unique in the drawing and never used twice.
    """

    position_mm: NDArray[np.float64]
    radius_mm: NDArray[np.float32]
    elongation: NDArray[np.float32]
    angle_rad: NDArray[np.float32]
    roughness: NDArray[np.float32]
    seed: NDArray[np.uint32]
    area: NDArray[np.int32]
    constraint: NDArray[np.int8]
    curve: NDArray[np.int32]
    parameter: NDArray[np.float64]
    id: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.position_mm)

    @property
    def fixed(self) -> NDArray[np.bool_]:
        """Which dots do not move freely; a read-only copy of what `constraint` says of all."""
        held = np.asarray(self.constraint != FREE)
        held.flags.writeable = False
        return held

    def is_fixed(self, rows: Index) -> NDArray[np.bool_]:
        """Return which of some rows do not move freely, at the cost of these rows."""
        return np.asarray(self.constraint[rows] != FREE)

    @classmethod
    def round(
        cls,
        position_mm: ArrayLike,
        radius_mm: ArrayLike,
        *,
        area: int = 0,
        first_id: int = 0,
    ) -> Dots:
        """Make round, smooth, free dots with consecutive ids.

        Parameters
        ----------
        position_mm : (n, 2) array_like
        radius_mm : (n,) array_like or float
        """
        position = np.array(position_mm, dtype=np.float64).reshape(-1, 2)
        n = len(position)
        radius = np.array(np.broadcast_to(np.asarray(radius_mm, np.float32), (n,)))
        if not np.isfinite(position).all() or not (np.isfinite(radius) & (radius > 0)).all():
            raise ParameterError("dots need finite positions and radii above 0")
        ids = np.arange(first_id, first_id + n, dtype=np.int64)
        return cls(
            position_mm=position,
            radius_mm=radius,
            elongation=np.ones(n, np.float32),
            angle_rad=np.zeros(n, np.float32),
            roughness=np.zeros(n, np.float32),
            seed=first_seeds(ids),
            area=np.full(n, area, np.int32),
            constraint=np.zeros(n, np.int8),
            curve=np.full(n, NO_CURVE, np.int32),
            parameter=np.zeros(n),
            id=ids,
        )

    @classmethod
    def none(cls) -> Dots:
        """Make an empty set."""
        return cls.round(np.empty((0, 2)), np.empty(0))

    def by_id(self) -> Dots:
        """Return copies in the order of ids, which is what jobs go by."""
        in_order = bool((np.diff(self.id) > 0).all())
        return self.copy() if in_order else self.take(np.argsort(self.id))

    def take(self, which: Index) -> Dots:
        """Return copies of the rows chosen by an index, mask or slice."""
        return Dots(**{f.name: np.array(getattr(self, f.name)[which]) for f in fields(Dots)})

    def copy(self) -> Dots:
        """Return dots that share no memory with these."""
        return self.take(slice(None))


def first_seeds(ids: NDArray[np.int64]) -> NDArray[np.uint32]:
    """Return the seeds that new dots have."""
    mixed = ids.astype(np.uint64) * np.uint64(2654435761)
    return (mixed & np.uint64(0xFFFFFFFF)).astype(np.uint32)
