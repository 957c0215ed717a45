"""A stroke's path: from what the pointer did to stamps by arc length and ticks by time.

Nothing here depends on how often the pointer was looked at, but for the shape of the path.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal, Protocol, get_args

SmoothingKind = Literal["none", "rope", "window"]
SMOOTHINGS: tuple[SmoothingKind, ...] = get_args(SmoothingKind)

_WINDOW_POINTS = 16


@dataclass(frozen=True, slots=True)
class PointerSample:
    """Where the pointer was, and how a pen was held.

    Attributes
    ----------
    x, y : float, mm
    pressure : float
        0..1; 1 where there is no pen.
    t : float, s
    """

    x: float
    y: float
    pressure: float = 1.0
    t: float = 0.0


@dataclass(frozen=True, slots=True)
class Stamp:
    """One application of the tip.

    Attributes
    ----------
    x, y : float, mm
    pressure : float
    direction_rad : float
        Of the stroke here; NaN before it has one.
    dx, dy : float, mm
        Way since the last stamp.
    dt : float, s
        Time this stamp stands for; 0 for one by arc length.
    """

    x: float
    y: float
    pressure: float = 1.0
    direction_rad: float = math.nan
    dx: float = 0.0
    dy: float = 0.0
    dt: float = 0.0


class Smoothing(Protocol):
    """Turns the pointer's path into a calmer one."""

    def feed(self, sample: PointerSample) -> Iterator[PointerSample]:
        """Take a sample; yield what the brush follows."""
        ...

    def end(self) -> Iterator[PointerSample]:
        """Yield what brings the brush to the pointer's last place, where that is wanted."""
        ...


class Direct:
    """No smoothing."""

    def feed(self, sample: PointerSample) -> Iterator[PointerSample]:
        """Follow the pointer."""
        yield sample

    def end(self) -> Iterator[PointerSample]:
        """Yield nothing: the brush is there."""
        yield from ()


class Rope:
    """The pointer pulls the brush by a rope; while that hangs loose the brush rests."""

    def __init__(self, length_mm: float) -> None:
        self._length = length_mm
        self._at: PointerSample | None = None

    def feed(self, sample: PointerSample) -> Iterator[PointerSample]:
        """Follow as far as the rope is short."""
        if self._at is None:
            self._at = sample
            yield sample
            return
        dx, dy = sample.x - self._at.x, sample.y - self._at.y
        distance = math.hypot(dx, dy)
        pull = max(distance - self._length, 0.0) / distance if distance else 0.0
        self._at = replace(sample, x=self._at.x + pull * dx, y=self._at.y + pull * dy)
        yield self._at

    def end(self) -> Iterator[PointerSample]:
        """Yield nothing: the brush rests where the rope left it."""
        yield from ()


class Window:
    """The brush goes through the mean of the last stretch of the pointer's path."""

    def __init__(self, length_mm: float) -> None:
        self._step = length_mm / _WINDOW_POINTS
        self._last: PointerSample | None = None
        self._left = 0.0  # way until the next point of the window
        self._points: deque[PointerSample] = deque(maxlen=_WINDOW_POINTS)

    def feed(self, sample: PointerSample) -> Iterator[PointerSample]:
        """Walk along the path in even steps."""
        if self._last is None:
            self._points.extend([sample] * _WINDOW_POINTS)
            self._last, self._left = sample, self._step
            yield sample
            return
        last = self._last
        length = math.hypot(sample.x - last.x, sample.y - last.y)
        while self._left <= length and length > 0.0:
            share = self._left / length
            self._points.append(between(last, sample, share))
            self._left += self._step
            yield self._mean()
        self._left -= length
        self._last = sample
        if length == 0.0:
            yield replace(self._mean(), t=sample.t)

    def end(self) -> Iterator[PointerSample]:
        """Go on to the pointer's last place."""
        if self._last is None:
            return
        for _ in range(_WINDOW_POINTS):
            self._points.append(self._last)
            yield self._mean()

    def _mean(self) -> PointerSample:
        n = len(self._points)
        x = sum(p.x for p in self._points) / n
        y = sum(p.y for p in self._points) / n
        return replace(self._points[-1], x=x, y=y)


def smoothing_of(kind: SmoothingKind, length_mm: float) -> Smoothing:
    """Make a smoothing; a length of 0 is none."""
    if kind == "none" or length_mm <= 0.0:
        return Direct()
    return Rope(length_mm) if kind == "rope" else Window(length_mm)


def between(a: PointerSample, b: PointerSample, share: float) -> PointerSample:
    """Return the sample a share of the way from a to b."""
    return PointerSample(
        a.x + share * (b.x - a.x),
        a.y + share * (b.y - a.y),
        a.pressure + share * (b.pressure - a.pressure),
        a.t + share * (b.t - a.t),
    )


class Spacer:
    """Stamps at even steps of arc length, the first where the stroke begins.

    That one has the direction in which the pointer came, if it is known.
    """

    def __init__(self, spacing_mm: float, heading_rad: float = math.nan) -> None:
        self._spacing, self._heading = spacing_mm, heading_rad
        self._last: PointerSample | None = None
        self._stamp: Stamp | None = None
        self._left = 0.0

    def feed(self, sample: PointerSample) -> Iterator[Stamp]:
        """Take the path's next point; yield the stamps on the way to it."""
        last, self._last = self._last, sample
        if last is None:
            self._left = self._spacing
            self._stamp = Stamp(sample.x, sample.y, sample.pressure, self._heading)
            yield self._stamp
            return
        length = math.hypot(sample.x - last.x, sample.y - last.y)
        if length == 0.0:
            return
        direction = math.atan2(sample.y - last.y, sample.x - last.x)
        at = self._left
        while at <= length:
            p, before = between(last, sample, at / length), self._stamp
            assert before is not None
            self._stamp = Stamp(p.x, p.y, p.pressure, direction, p.x - before.x, p.y - before.y)
            yield self._stamp
            at += self._spacing
        self._left = at - length


class Ticker:
    """Stamps at even steps of time, wherever the path is then."""

    def __init__(self, step_s: float) -> None:
        self._step = step_s
        self._last: PointerSample | None = None
        self._next_t = 0.0
        self._stamp: Stamp | None = None
        self._direction = math.nan

    def feed(self, sample: PointerSample) -> Iterator[Stamp]:
        """Take the path's next point; yield the stamps until its time."""
        last, self._last = self._last, sample
        if last is None:
            self._next_t = sample.t + self._step
            self._stamp = Stamp(sample.x, sample.y, sample.pressure, dt=self._step)
            yield self._stamp
            return
        if (sample.x, sample.y) != (last.x, last.y):
            self._direction = math.atan2(sample.y - last.y, sample.x - last.x)
        while self._next_t <= sample.t:
            share = (self._next_t - last.t) / (sample.t - last.t) if sample.t > last.t else 1.0
            p, before = between(last, sample, min(max(share, 0.0), 1.0)), self._stamp
            assert before is not None
            self._stamp = Stamp(
                p.x, p.y, p.pressure, self._direction, p.x - before.x, p.y - before.y, self._step
            )
            yield self._stamp
            self._next_t += self._step

    def rest(self, t: float) -> Iterator[Stamp]:
        """Let time go on with the pointer where it is."""
        if self._last is not None and t > self._last.t:
            yield from self.feed(replace(self._last, t=t))
