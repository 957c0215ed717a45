"""Files of 100,000 dots: how long each format takes, and how large it is; tours; checks.

python -m benchmarks.exports
"""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Callable

import numpy as np

from benchmarks.figures import Figure
from benchmarks.rendering import drawing
from benchmarks.tours import lkh, or_tools, two_opt
from stippler.drawing.drawing import Drawing
from stippler.export import values_for
from stippler.files.checks import Process, check
from stippler.files.write.estimate import estimate
from stippler.files.write.formats import format_named
from stippler.files.write.plate import LINE_EFFORT, plate_of
from stippler.stippling.tour import length_of, tour

_RANDOM_TOUR = 0.7124
"""The shortest tour of n random points in an area A tends to so much times the root of n A."""

_LARGE = """
import resource, sys
from benchmarks.rendering import drawing
from stippler.export import save
save(drawing(int(sys.argv[1]), sys.argv[2]), sys.argv[3], **eval(sys.argv[4]))
print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6)
"""


def figures(quick: bool = False) -> list[Figure]:
    """Measure all; `quick` leaves out what takes minutes."""
    repeats = 3 if quick else 7
    results = [*_formats(repeats), *_tours(repeats), _check(repeats), *_estimates()]
    if not quick:
        results += [*_beside_others(), *_large()]
    return results


def _formats(repeats: int) -> list[Figure]:
    n = 100_000
    page = drawing(n)
    a5 = drawing(n)  # the page of 200 x 125 mm has A5's area within a fifth
    rows: list[tuple[str, dict[str, object], float | None, float | None, str]] = [
        ("svg", {}, 0.5, 4.0, "as circles"),
        ("svg", {"round_dots": "compound"}, 0.5, 2.0, "as compound strokes"),
        ("svg", {"round_dots": "taps"}, 0.5, None, "as pen taps"),
        ("svgz", {}, None, 0.8, ""),
        ("pdf", {}, 0.6, 1.5, ""),
        ("eps", {}, None, None, ""),
        ("tif", {"dpi": 1200}, 2.0, None, "1 bit, 1200 dpi"),
        ("png", {"dpi": 3840 / 200 * 25.4}, 1.0, None, "3840 x 2400"),
        ("csv", {}, 0.3, None, ""),
        ("json", {}, None, None, ""),
        ("npz", {}, None, None, ""),
        ("dxf", {}, None, None, ""),
        ("gcode", {"pen_width": 1.0}, None, None, "taps, sorted"),
    ]
    results = []
    for name, options, reach_s, reach_mb, note in rows:
        seconds, size = _written(a5 if name == "tif" else page, name, options, repeats)
        what = f"{name.upper()} of {n:,} round dots{', ' + note if note else ''}"
        results.append(Figure(what, seconds, "s", reach_s))
        results.append(Figure(f"{what}, size", size / 1e6, "MB", reach_mb))
    return results


def _written(
    one: Drawing, name: str, options: dict[str, object], repeats: int
) -> tuple[float, int]:
    made = format_named(name)
    values = values_for(made, options)

    def write() -> int:
        what = one if made.is_data else plate_of(one, values)
        return sum(map(len, made.write(what, values)))

    return _fastest_s(write, repeats), write()


def _fastest_s(call: Callable[[], object], repeats: int) -> float:
    times = []
    for _ in range(repeats + 1):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times[1:])


def _tours(repeats: int) -> list[Figure]:
    rng = np.random.default_rng(0)
    many, some = rng.random((100_000, 2)), rng.random((60_000, 2))
    results = []
    for points, effort, reach_s, reach, what in (
        (many, 0.0, 3.0, 1.15, "plot order of 100,000 dots"),
        (some, LINE_EFFORT, 10.0, 1.08, "one line through 60,000 dots"),
    ):
        seconds = _fastest_s(lambda: tour(points, closed=True, effort=effort), max(repeats // 3, 1))  # noqa: B023
        order = tour(points, closed=True, effort=effort)
        longer = length_of(points, order, closed=True) / (_RANDOM_TOUR * len(points) ** 0.5)
        results.append(Figure(what, seconds, "s", reach_s))
        note = "of the constant that shortest tours of random points tend to"
        results.append(Figure(f"{what}, length", longer, "", reach, note=note))
    return results


def _beside_others() -> list[Figure]:
    """Lengths of ours over theirs, on the same points."""
    results = []
    for n, what, theirs, effort, reach in (
        (100_000, "plot order of 100,000 dots over a 2-opt tour of them", two_opt, 0.0, 1.10),
        (1_000, "one line through 1,000 dots over LKH's", lkh, LINE_EFFORT, 1.08),
        (
            2_000, "one line through 2,000 dots over OR-tools' of 20 s",
            lambda points: or_tools(points, 20), LINE_EFFORT, 1.08,
        ),
    ):  # fmt: skip
        points = np.random.default_rng(n).random((n, 2))
        found = theirs(points)
        if found is None:
            continue  # not installed
        ours = length_of(points, tour(points, closed=True, effort=effort), closed=True)
        ratio = ours / length_of(points, found, closed=True)
        results.append(Figure(what, ratio, "", reach))
    return results


def _estimates() -> list[Figure]:
    """Size and time that the dialog foretells, over those of the file."""
    results = []
    page = drawing(100_000)
    cases: tuple[tuple[str, dict[str, object]], ...] = (
        ("svg", {}),
        ("pdf", {}),
        ("tif", {}),
        ("png", {"dpi": 600}),
        ("csv", {}),
    )
    for name, options in cases:
        made = format_named(name)
        values = values_for(made, options)
        what = page if made.is_data else plate_of(page, values)
        told = estimate(made, what, values)
        seconds, size = _written(page, name, options, 3)
        results.append(Figure(f"estimated size of a {name.upper()}", told.n_bytes / size, "", 1.25))
        results.append(
            Figure(f"estimated time of a {name.upper()}", told.seconds / seconds, "", 3.0)
        )
    return results


def _check(repeats: int) -> Figure:
    page = drawing(200_000)
    process = Process(dpi=1200)
    seconds = _fastest_s(lambda: check(page, process), repeats)
    return Figure("checks of 200,000 dots, at 1200 dpi", seconds, "s", 1.0)


def _large() -> list[Figure]:
    results = []
    for n, kind, file, options, reach_s, what in (
        (1_000_000, "rough", "/dev/null", {"form": "svg"}, 6.0, "SVG of 1,000,000 deformed dots"),
        (
            60_000, "round", "/dev/null", {"form": "png", "dpi": 5600}, None,
            "PNG of 1.2 gigapixels, 60,000 dots",
        ),
    ):  # fmt: skip
        command = [sys.executable, "-c", _LARGE, str(n), kind, file, repr(options)]
        start = time.perf_counter()
        told = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        results.append(Figure(what, time.perf_counter() - start, "s", reach_s))
        results.append(Figure(f"{what}, memory", float(told), "GB", 1.0))
    return results
