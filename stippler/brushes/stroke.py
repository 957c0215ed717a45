"""A stroke under way: samples in, changes of the drawing out."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from stippler.brushes.brush import Brush
from stippler.brushes.effects import EFFECTS, Touch
from stippler.brushes.followed_sizes import FollowedSizes
from stippler.brushes.scatter import Count
from stippler.brushes.stroke_path import PointerSample, Spacer, Stamp, Ticker, smoothing_of
from stippler.drawing.document import Document
from stippler.drawing.edit import Edit

_TICKS_PER_S = 60.0


class Stroke:
    """One press-to-release of a brush; whatever fails within it takes all of it back.

    Parameters
    ----------
    document : Document
        Not in a stroke.
    seed : int
        Of all that is left to chance in this stroke.
    heading_rad : float
        Direction in which the pointer came; NaN if it is not known.

    Attributes
    ----------
    end : PointerSample
        The last sample.
    """

    def __init__(
        self,
        document: Document,
        brush: Brush,
        first: PointerSample,
        seed: int,
        heading_rad: float = math.nan,
    ) -> None:
        self._document, self._brush = document, brush
        self._rng = np.random.default_rng(seed)
        self._smoothing = smoothing_of(brush.smoothing, brush.smoothing_mm)
        about = brush.about
        per_s = brush.value("per_s") if about.rhythm == "time" else _TICKS_PER_S
        self._count = Count(per_s)
        step_s = 1.0 / (per_s if about.most_ticks else _TICKS_PER_S)
        self._ticker = Ticker(step_s) if about.rhythm == "time" else None
        self._spacer = Spacer(brush.spacing * brush.radius_mm, heading_rad)
        self._sizes = FollowedSizes()
        self._dragged: tuple[int, float, float] | None = None
        self._pressed = False
        self.end = first
        document.begin(brush.name)
        self.follow(first)

    @property
    def is_timed(self) -> bool:
        """Whether it goes on while the pointer rests."""
        return self._ticker is not None

    def follow(self, sample: PointerSample) -> None:
        """Take where the pointer is now."""
        self.end = sample
        self._guarded(self._stamps(sample))

    def rest(self, t: float) -> None:
        """Let time go on."""
        if self._ticker is not None:
            self._guarded(self._ticker.rest(t))

    def commit(self, sample: PointerSample) -> Edit:
        """End the stroke where the pointer is."""
        self.follow(sample)
        if self._document.in_stroke:
            self._guarded(stamp for p in self._smoothing.end() for stamp in self._pace(p))
            self._end()
        return self._document.commit()

    def _end(self) -> None:
        """Do what waits for the last stamp."""
        try:
            self._sizes.solve(self._document)
        except BaseException:
            self.cancel()
            raise

    def cancel(self) -> None:
        """Take back all of it."""
        if self._document.in_stroke:
            self._document.cancel()

    def _guarded(self, stamps: Iterable[Stamp]) -> None:
        try:
            due = list(stamps)
            due = due[-self._brush.about.most_ticks :]  # all, where there is no limit
            for stamp in due:
                self._apply(stamp)
        except BaseException:
            self.cancel()
            raise

    def _stamps(self, sample: PointerSample) -> Iterable[Stamp]:
        rhythm = self._brush.about.rhythm
        if rhythm in ("click", "drag"):
            first, self._pressed = not self._pressed, True
            if first or rhythm == "drag":
                yield Stamp(sample.x, sample.y, sample.pressure)
            return
        for point in self._smoothing.feed(sample):
            yield from self._pace(point)

    def _pace(self, point: PointerSample) -> Iterable[Stamp]:
        return (self._ticker or self._spacer).feed(point)

    def _apply(self, stamp: Stamp) -> None:
        if self._brush.about.rhythm == "drag":
            self._drag(stamp)
            return
        brush, document = self._brush, self._document
        reach = brush.tip.reach(brush.radius_mm)
        box = (stamp.x - reach, stamp.y - reach, stamp.x + reach, stamp.y + reach)
        rows = document.in_box(box)
        offset = document.dots.position_mm[rows] - (stamp.x, stamp.y)
        weight = brush.tip.weight(offset, brush.radius_mm)
        under = weight > 0.0
        rows, weight = rows[under], weight[under] * stamp.pressure
        touch = Touch(document, brush, stamp, self._rng, rows, weight, self._count, self._sizes)
        EFFECTS[brush.kind](touch)

    def _drag(self, stamp: Stamp) -> None:
        """Take hold of the nearest free dot; then take it along."""
        dots = self._document.dots
        if self._dragged is None:
            row = self._document.nearest(stamp.x, stamp.y, self._brush.radius_mm)
            if row is None or dots.is_fixed(np.array([row]))[0]:
                self._dragged = (-1, 0.0, 0.0)
                return
            x, y = dots.position_mm[row]
            self._dragged = (int(dots.id[row]), x - stamp.x, y - stamp.y)
        held, dx, dy = self._dragged
        if held >= 0:
            rows = self._document.rows(np.array([held]))
            self._document.move(rows, np.array([(stamp.x + dx, stamp.y + dy)]), hops=True)
