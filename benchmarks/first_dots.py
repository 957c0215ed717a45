"""Speed and memory of first dots and of solving the tone: ``python -m benchmarks.first_dots``."""

from __future__ import annotations

import time
import tracemalloc
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from benchmarks import part_of_page
from benchmarks.figures import Figure, median_s
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.stippling.halftone import FirstDots, pulse_density, supersampling
from stippler.stippling.page_raster import PageRaster
from stippler.stippling.radii import solve_radii
from stippler.stippling.stipple import stages
from stippler.stippling.tessellation import made

_PICTURE = Path(__file__).parents[1] / "tests/data/sphere_ramp.png"
_DOTS = 60_000


def figures(quick: bool = False) -> list[Figure]:
    """Time pulse-density modulation and tone solving on the sphere and ramp, 1 megapixel."""
    repeats = 3 if quick else 9
    darkness = read_darkness()
    raster = PageRaster.of(Reference(darkness, 1000.0), _DOTS, None, bleeds=False)
    density = raster.density()
    *_, relaxed = stages(Reference(darkness, 1000.0), Style(n_dots=_DOTS), snapshots=False)
    points = relaxed.position_mm
    results = [
        Figure(
            "pulse-density, 1 megapixel, 60,000 dots",
            1e3 * median_s(lambda: _all(density), repeats),
            "ms",
            150.0,
            60.0,
        ),
        Figure(
            "the same, from the border inwards",
            1e3 * median_s(lambda: _all(density, "border"), repeats),
            "ms",
        ),
        Figure(
            "tone of 60,000 relaxed dots solved",
            1e3 * median_s(lambda: solve_radii(made(raster.cells(points)), raster.rule), repeats),
            "ms",
            150.0,
        ),
        Figure("memory per super-sampled cell", _bytes_per_cell(density, "top"), "bytes", 12.0),
        Figure(
            "the same, from the border inwards", _bytes_per_cell(density, "border"), "bytes", 12.0
        ),
        Figure(
            "dots off the number asked for, worst of 100 to 100,000",
            _worst_count(darkness, quick),
            "%",
            1.0,
        ),
        Figure(
            "longest wait for a cancel, first dots and tone", 1e3 * _longest(darkness), "ms", 50.0
        ),
    ]
    if not quick:
        large = np.repeat(np.repeat(density / np.float32(16.0), 4, 0), 4, 1)
        slow = median_s(lambda: _all(large), 3)
        results.insert(1, Figure("pulse-density, 16 megapixels, 60,000 dots", slow, "s", 1.5))
    return results + part_of_page.figures(repeats)


def read_darkness(path: Path = _PICTURE) -> NDArray[np.float32]:
    """Return a picture's perceptual darkness."""
    grey = np.asarray(Image.open(path).convert("L"), np.float32)
    return np.float32(1.0) - grey / np.float32(255.0)


def _all(density: NDArray[np.float32], start: str = "top") -> FirstDots:
    *_, (_, first) = pulse_density(density, start=start)
    return first


def _bytes_per_cell(density: NDArray[np.float32], start: str) -> float:
    _all(density, start)
    tracemalloc.start()
    _all(density, start)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak / (density.size * supersampling(density) ** 2)


def _worst_count(darkness: NDArray[np.float32], quick: bool) -> float:
    worst = 0.0
    for n in (100, 3000) if quick else (100, 1000, 3000, 30_000, 100_000):
        for picture in (darkness, darkness[250:650, 250:650].copy()):
            style = Style(n_dots=n, iterations=2)
            *_, last = stages(Reference(picture, 100.0), style, snapshots=False)
            worst = max(worst, 100.0 * abs(len(last.position_mm) - n) / n)
    return worst


def _longest(darkness: NDArray[np.float32]) -> float:
    """Return the median over runs of the longest time between two snapshots.

    Of a page that bleeds; relaxation has a figure of its own.
    """
    cut = np.repeat(np.repeat(darkness[250:650, 250:650], 2, 0), 2, 1)

    def run() -> float:
        longest, before = 0.0, time.perf_counter()
        for progress in stages(Reference(cut, 148.0), Style(n_dots=_DOTS, iterations=1)):
            now = time.perf_counter()
            if progress.stage != "relax":
                longest = max(longest, now - before)
            before = now
        return longest

    run()
    return float(np.median([run() for _ in range(5)]))


if __name__ == "__main__":
    from benchmarks.all import main

    raise SystemExit(main(only="first_dots"))
