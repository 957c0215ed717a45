"""A picture as weight of the dots: its levels, and by area what each level weighs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.levels import N_LEVELS, Curve
from stippler.drawing.reference import Reference
from stippler.errors import ParameterError


@dataclass(frozen=True, slots=True, eq=False)
class PictureField:
    """A picture kept once as levels, and tables that say what they weigh; outside it is 0.

    Relaxation and tessellations sum up only the parts of it that their compartments lie in, so
    their cost follows these and not the page. Areas of different styles share a run: each reads
    the picture through a table of its own.

    Attributes
    ----------
    levels : (h, w) uint16
    tables : (k, 65536) float32, >= 0
    pixel_mm : (float, float)
        Width and height of a pixel.
    origin_mm : (float, float)
        Position of the corner of pixel (0, 0).
    table_of_shape : (s,) int64
        The table of each shape that compartments are made of; none if all have the first.
    bleed : int
        How many pixels around the picture repeat it, mirrored; no more than its shorter side.
    """

    levels: NDArray[np.uint16]
    tables: NDArray[np.float32]
    pixel_mm: tuple[float, float]
    origin_mm: tuple[float, float] = (0.0, 0.0)
    table_of_shape: NDArray[np.int64] | None = None
    bleed: int = 0

    def __post_init__(self) -> None:
        if self.levels.ndim != 2 or self.levels.size == 0 or self.levels.dtype != np.uint16:
            raise ParameterError("levels are a 2-d field of 16-bit numbers", "density")
        if self.tables.ndim != 2 or self.tables.shape[1] != N_LEVELS:
            raise ParameterError(f"a table has {N_LEVELS:,} entries", "density")
        if not (np.isfinite(self.tables).all() and float(self.tables.min()) >= 0.0):
            raise ParameterError("has to be finite and not below 0", "density")
        if not 0 <= self.bleed <= min(self.levels.shape):
            raise ParameterError(f"{self.bleed} pixels are beside the picture", "bleed")
        of_shape = self.table_of_shape
        if of_shape is not None and not ((of_shape >= 0) & (of_shape < len(self.tables))).all():
            raise ParameterError(f"there are {len(self.tables)} tables", "table of shape")

    @classmethod
    def of(
        cls,
        reference: Reference,
        curves: Sequence[Sequence[Curve]] = ((),),
        table_of_shape: NDArray[np.integer] | Sequence[int] | None = None,
        bleed_mm: float = 0.0,
    ) -> PictureField:
        """Weigh a page's reference, as it is adjusted, by curves.

        Parameters
        ----------
        reference : Reference
        curves : sequence of sequences of callables
            For each table what darkness goes through, one after the other: a style's tone curve,
            then ``rule.density``, or ``numpy.square``. None at all: darkness itself.
        table_of_shape : (s,) int, optional
            Which of them each shape (area) has that the run is given; all the first if left out.
        bleed_mm : float
            How far around the page the picture goes on, mirrored, as far as its shorter side.
        """
        tables = np.stack([reference.table(*steps) for steps in curves])
        of_shape = None if table_of_shape is None else np.asarray(table_of_shape, np.int64)
        side = reference.pixel_mm
        levels = reference.source.levels.of_pixel
        bleed = min(math.ceil(bleed_mm / side), *levels.shape)
        return cls(levels, tables, (side, side), table_of_shape=of_shape, bleed=bleed)
