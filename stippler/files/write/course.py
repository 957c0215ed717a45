"""What pens do in the course of time: when each path is drawn, and a picture of any moment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stippler.files.write.format import Values
from stippler.files.write.formats import HPGL
from stippler.files.write.pen_paths import Paths
from stippler.files.write.plotter import paths_by_layer
from stippler.files.write.proof import Window
from stippler.files.write.sheet import Sheet

NEVER = np.float32(np.inf)
_MOST_SAMPLES = 8_000_000
_STEP_PX = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """The points that pens pass, in order; each pen begins when the one before has ended.

    Attributes
    ----------
    names : tuple of str
        Of the pens.
    points_mm : (n, 2) float64
    at_s : (n,) float64
        When the pen is there.
    is_down : (n,) bool
        Whether the way to a point is drawn; the first of a path is not.
    pen : (n,) int32
    pen_mm : float
        Width of the pens.
    total_s : float
    """

    names: tuple[str, ...]
    points_mm: NDArray[np.float64]
    at_s: NDArray[np.float64]
    is_down: NDArray[np.bool_]
    pen: NDArray[np.int32]
    pen_mm: float
    total_s: float

    def at(self, time_s: float) -> int:
        """Return the last point that has been passed."""
        return max(int(np.searchsorted(self.at_s, time_s, "right")) - 1, 0)


def plotting_values(values: Values) -> dict[str, object]:
    """Return what a plotter is to do: values given, and a plotter's own for those that are not."""
    return {option.name: values.get(option.name, option.default) for option in HPGL.options}


def course_of(sheet: Sheet, values: Values) -> Course:
    """Return what pens do for a sheet; speeds are without acceleration."""
    plotting = plotting_values(values)
    names: list[str] = []
    points, at, down, pens, total = [], [], [], [], 0.0
    for name, paths in paths_by_layer(sheet, plotting):
        times, is_down, taken = _times(paths, plotting)
        at.append(times + total)
        total += taken
        pens.append(np.full(len(times), len(names), np.int32))
        names.append(name)
        points.append(paths.points_mm)
        down.append(is_down)
    if not names:
        none = np.empty(0)
        return Course((), np.empty((0, 2)), none, none.astype(bool), none.astype(np.int32),
                      float(plotting["pen_width"]), 0.0)  # type: ignore[arg-type]  # fmt: skip
    return Course(
        tuple(names), np.concatenate(points), np.concatenate(at), np.concatenate(down),
        np.concatenate(pens), float(plotting["pen_width"]), total,  # type: ignore[arg-type]
    )  # fmt: skip


def _times(paths: Paths, values: Values) -> tuple[NDArray[np.float64], NDArray[np.bool_], float]:
    """Return when each point is reached, which ways are drawn, and the time all takes."""
    step = np.hypot(*np.diff(paths.points_mm, axis=0, prepend=paths.points_mm[:1]).T)
    down = np.ones(len(step), np.bool_)
    down[paths.starts[:-1]] = False
    times = np.where(down, step / values["feed"], step / values["travel"]) * 60.0
    times[paths.starts[1:-1]] += values["lift_time"]  # of the path before
    passed = np.cumsum(times)
    return passed, down, float(passed[-1]) + values["lift_time"]


@dataclass(frozen=True, slots=True, eq=False)
class Moments:
    """When each pixel of a window is first drawn over, by which pen, and first travelled over."""

    drawn_s: NDArray[np.float32]
    pen: NDArray[np.uint8]
    travelled_s: NDArray[np.float32]


def moments_of(course: Course, window: Window) -> Moments:
    """Return the picture that shows any moment: what has a time of no more is drawn by then."""
    shape = window.rows, window.columns
    scale = window.columns / window.width_mm
    xy = (course.points_mm - (window.left, window.top)) * scale
    drawn = np.full(shape, NEVER)
    pen = np.zeros(shape, np.uint8)
    for k in range(len(course.names)):
        mine = _drawn(course, xy, k, scale, shape)
        first = mine < drawn
        drawn[first], pen[first] = mine[first], k
    travelled = _first(*_samples(xy, course.at_s, ~course.is_down, shape), shape, 0.0)
    return Moments(drawn, pen, travelled)


def _drawn(
    course: Course, xy: NDArray[np.float64], pen: int, scale: float, shape: tuple[int, int]
) -> NDArray[np.float32]:
    mine = course.pen == pen
    points, times = _samples(xy, course.at_s, course.is_down & mine, shape)
    taps = np.flatnonzero(mine & ~course.is_down)  # the first points of paths
    points = np.concatenate([xy[taps], points])
    times = np.concatenate([course.at_s[taps], times])
    order = np.argsort(times, kind="stable")
    return _first(points[order], times[order], shape, course.pen_mm * scale / 2)


def _samples(
    xy: NDArray[np.float64], at_s: NDArray[np.float64], which: NDArray[np.bool_],
    shape: tuple[int, int],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:  # fmt: skip
    """Return points along the ways to the points chosen, and their times."""
    to = np.flatnonzero(which)
    to = to[to > 0]
    low, high = np.minimum(xy[to - 1], xy[to]), np.maximum(xy[to - 1], xy[to])
    seen = ((high > -8) & (low < (shape[1] + 8, shape[0] + 8))).all(axis=1)
    to = to[seen]
    length = np.hypot(*(xy[to] - xy[to - 1]).T)
    step = max(_STEP_PX, float(length.sum()) / _MOST_SAMPLES)
    n = np.maximum(np.ceil(length / step), 1).astype(np.int64)
    row = np.repeat(np.arange(len(to)), n)
    share = ((np.arange(len(row)) - np.repeat(np.cumsum(n) - n, n) + 1) / n[row])[:, None]
    end = to[row]
    points = xy[end - 1] * (1 - share) + xy[end] * share
    times = at_s[end - 1] * (1 - share[:, 0]) + at_s[end] * share[:, 0]
    return points, times


def _first(
    points: NDArray[np.float64], times: NDArray[np.float64], shape: tuple[int, int], reach: float
) -> NDArray[np.float32]:
    """Return when each pixel is first within reach of a point; times grow."""
    first = np.full(shape, NEVER)
    far = int(reach)
    for dy in range(-far, far + 1):
        for dx in range(-far, far + 1):
            if dx * dx + dy * dy > reach * reach:
                continue
            at = np.floor(points).astype(np.int64) + np.array([dx, dy])
            inside = ((at >= 0) & (at < (shape[1], shape[0]))).all(axis=1)
            flat = at[inside, 1] * shape[1] + at[inside, 0]
            mine = np.full(shape[0] * shape[1], NEVER)
            mine[flat[::-1]] = times[inside][::-1]  # the earliest is written last
            np.minimum(first, mine.reshape(shape), out=first)
    return first
