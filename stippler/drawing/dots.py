"""The dots of a drawing, as flat arrays of equal length."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import ArrayLike, NDArray

from stippler.errors import ParameterError

Index = NDArray[np.intp] | NDArray[np.bool_] | slice

MAX_ELONGATION = 4.0
"""Largest ratio of a dot's long axis to its short one."""


@dataclass(slots=True, eq=False)
class Dots:
    """Structure of arrays; row i of every array is dot i. 50 bytes a dot.

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
        Index into the drawing's areas.
    fixed : (n,) bool
        Fixed dots shape the cells of others and never move.
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
    fixed: NDArray[np.bool_]
    id: NDArray[np.int64]

    def __len__(self) -> int:
        return len(self.position_mm)

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
            fixed=np.zeros(n, np.bool_),
            id=ids,
        )

    @classmethod
    def none(cls) -> Dots:
        """Make an empty set."""
        return cls.round(np.empty((0, 2)), np.empty(0))

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
