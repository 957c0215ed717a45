"""Dots moved, scaled and turned together: none leaves its area, none stays behind at an edge."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.document import Document
from stippler.drawing.shape_change import MAX_RADIUS_MM
from stippler.drawing.store import Rows

Point = tuple[float, float]
Floats = NDArray[np.float64]

_HALVINGS = 14  # a ten thousandth of the way


@dataclass(frozen=True, slots=True)
class Motion:
    """A shift, after scaling and turning about a point.

    Attributes
    ----------
    turn_rad : float
        Clockwise on the page, from x towards y.
    sizes : bool
        Whether dots are scaled, too, not only their places.
    """

    shift_mm: Point = (0.0, 0.0)
    scale: float = 1.0
    turn_rad: float = 0.0
    about_mm: Point = (0.0, 0.0)
    sizes: bool = True

    def part(self, share: float) -> Motion:
        """Return a share of it; 0 is none."""
        dx, dy = self.shift_mm
        return replace(
            self,
            shift_mm=(share * dx, share * dy),
            scale=math.exp(share * math.log(self.scale)),
            turn_rad=share * self.turn_rad,
        )

    def of(self, points: Floats) -> Floats:
        """Return where points come to lie."""
        cos, sin = self.scale * math.cos(self.turn_rad), self.scale * math.sin(self.turn_rad)
        x, y = points[..., 0] - self.about_mm[0], points[..., 1] - self.about_mm[1]
        moved = np.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)
        return np.asarray(moved + self.about_mm + self.shift_mm)


class Held:
    """Dots as they were when they were taken hold of; `put` brings them anywhere from there.

    Parameters
    ----------
    ids : ids of dots
        Free ones move; dots that are gone are left out.
    """

    def __init__(self, document: Document, ids: NDArray[np.int64]) -> None:
        self._document = document
        rows = document.rows(ids)
        rows = np.sort(rows[rows >= 0])
        dots = document.dots
        self._ids = dots.id[rows[~dots.is_fixed(rows)]].copy()
        rows = document.rows(self._ids)
        self._position = dots.position_mm[rows].copy()
        self._radius = dots.radius_mm[rows].copy()
        self._angle = dots.angle_rad[rows].copy()
        self._area = dots.area[rows].copy()

    def put(self, motion: Motion) -> Motion:
        """Bring the dots there, as far as all of them stay in their areas; return how far.

        Within a stroke. A shift slides along the page's edges.
        """
        if not len(self._ids):
            return motion
        motion = self._allowed(motion)
        document, rows = self._document, self._document.rows(self._ids)
        document.move(rows, motion.of(self._position), hops=True)
        if motion.sizes and motion.scale != 1.0:
            radius = np.minimum(self._radius * motion.scale, MAX_RADIUS_MM)
            document.change("radius_mm", rows, radius.astype(np.float32))
        if motion.turn_rad:
            document.change("angle_rad", rows, (self._angle + motion.turn_rad).astype(np.float32))
        return motion

    def _allowed(self, motion: Motion) -> Motion:
        if self._fits(motion):
            return motion
        page, (dx, dy) = self._document.drawing.page, motion.shift_mm
        low, high = self._position.min(axis=0), self._position.max(axis=0)
        if motion.scale == 1.0 and motion.turn_rad == 0.0:
            slid = (
                min(max(dx, -low[0]), page.width_mm - high[0]),
                min(max(dy, -low[1]), page.height_mm - high[1]),
            )
            motion = replace(motion, shift_mm=(float(slid[0]), float(slid[1])))
            if self._fits(motion):
                return motion
        share, step = 0.0, 0.5
        for _ in range(_HALVINGS):
            if self._fits(motion.part(share + step)):
                share += step
            step /= 2
        return motion.part(share)

    def _fits(self, motion: Motion) -> bool:
        area = self._document.partition.area_at(motion.of(self._position))
        return bool((area == self._area).all())


def moved(document: Document, rows: Rows, shift_mm: Point) -> None:
    """Move dots by a step, together, within a stroke."""
    Held(document, document.dots.id[rows]).put(Motion(shift_mm))
