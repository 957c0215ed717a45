"""Rows in one grey, and what *Relax all* does to tone: ``python -m benchmarks.grain``.

Ten thousand dots of a light, a middle and a dark grey, the mean of some seeds; what stands in
docs/quality.md.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import distance_transform_edt, gaussian_filter, label
from scipy.spatial import KDTree
from shapely.geometry import box

from benchmarks.figures import Figure
from benchmarks.quality import read_darkness
from benchmarks.scorer import measure
from stippler.analysis.grain import measure_grain
from stippler.analysis.spectrum import measure_spectrum
from stippler.analysis.tone_error import measure_tone
from stippler.drawing.reference import Reference
from stippler.drawing.style import Style
from stippler.files.read.picture import read_picture
from stippler.resources import assets
from stippler.stippling.pipeline import run
from stippler.stippling.relax import Relaxation
from stippler.stippling.stipple import stages
from stippler.stippling.task import RELAX, Standing, Task
from stippler.stippling.transport import evened_out

GREYS = {"light": 0.15, "middle": 0.4, "dark": 0.73}
SIDE = 1000
DOTS = 10_000

_PROMISED = {
    "rows_at_4": (0.006, 0.003),
    "rows_at_8": (0.004, 0.002),
    "least_distance": (0.77, 0.84),
    "distance_cv": (0.042, 0.020),
    "largest_hole": (1.27, 1.20),
    "clouds": (0.0012, 0.0003),
    "peak": (2.8, 2.4),
    "direction, dB": (0.2, 0.1),
}
_HIGHER = ("least_distance",)


def figures(quick: bool = False) -> list[Figure]:
    """Measure greys of even spacing beside Lloyd's, rest, *Relax all*, and a step's time."""
    seeds = range(1, 3 if quick else 9)
    results = []
    for spacing in ("even", "lloyd"):
        for name, darkness in GREYS.items():
            found = [_grey(darkness, spacing, seed) for seed in seeds]
            for key in found[0]:
                promised = _PROMISED.get(key, (None, None)) if spacing == "even" else (None, None)
                if key == "overlap" and name == "dark" and spacing == "even":
                    promised = (0.006, 0.002)
                value = float(np.mean([row[key] for row in found]))
                label = f"{name} grey, {spacing}: {key}"
                results.append(Figure(label, value, "", *promised, key in _HIGHER))  # type: ignore[call-arg]
    results += [_rows_in_windows(name) for name in ("honey-bee.jpg", "ammonite.png")]
    results += _steps_of_the_wedge()
    results += _very_pale()
    results += _from_chance()
    results += _after_many_steps()
    results += _relax_all(1 if quick else 10)
    results.append(_step_against_lloyd(3 if quick else 9))
    return results


def _grey(darkness: float, spacing: str, seed: int) -> dict[str, float]:
    reference = Reference(np.full((SIDE, SIDE), darkness, np.float32), float(SIDE))
    style = Style(n_dots=DOTS, spacing=spacing, seed=seed)
    *_, last = stages(reference, style, snapshots=False)
    points, radii = np.array(last.position_mm), last.radius_mm.astype(np.float64)
    grain = measure_grain(points)
    spectrum = measure_spectrum(points, (0.0, 0.0, float(SIDE), float(SIDE)))
    scored = measure(points, radii, np.asarray(reference.darkness, np.float64))
    return {
        "rows_at_4": grain.rows_at_4,
        "rows_at_8": grain.rows_at_8,
        "least_distance": grain.least_distance,
        "distance_cv": grain.distance_cv,
        "largest_hole": grain.largest_hole,
        "clouds": grain.clouds,
        "peak": spectrum.peak,
        "direction, dB": spectrum.direction_db,
        "overlap": scored["overlap"],
        "tone_rmse": scored["tone_rmse"],
        "detail_rmse": scored["detail_rmse"],
    }


def _drawn(name: str, n: int, tone: str) -> tuple[Reference, NDArray[np.float64]]:
    """Draw a sample 1,000 mm wide, as even as it gets; return the picture and the dots."""
    picture = read_picture(assets() / "samples" / name, tone=tone, width_mm=1000.0)
    *_, last = stages(picture, Style(n_dots=n), snapshots=False)
    return picture, np.array(last.position_mm)


def _rows_in_windows(name: str, side: float = 60.0, most: float = 0.05) -> Figure:
    """Measure rows where a picture's tone is even: in windows that differ by `most` at most."""
    picture, points = _drawn(name, 80_000, "perceptual")
    smooth = gaussian_filter(picture.darkness, 3.0 / picture.pixel_mm)
    rows, weights = [], []
    for x in np.arange(0.0, picture.width_mm - side, side / 2):
        for y in np.arange(0.0, picture.height_mm - side, side / 2):
            i, j = (int(v / picture.pixel_mm) for v in (y, x))
            under = smooth[
                i : i + int(side / picture.pixel_mm), j : j + int(side / picture.pixel_mm)
            ]
            inside = points[((points >= (x, y)) & (points < (x + side, y + side))).all(axis=1)]
            if len(inside) >= 120 and under.std() < most:
                rows.append(measure_grain(inside).rows_at_4)
                weights.append(len(inside))
    note = f"{len(rows)} windows"
    value = float(np.average(rows, weights=weights))
    return Figure(f"{Path(name).stem}, where even: rows_at_4", value, "", 0.012, 0.006, note=note)


def _steps_of_the_wedge(n: int = 10_000) -> list[Figure]:
    """Measure how even dots are within each step of the wedge; the worst of them."""
    picture, points = _drawn("step-wedge.png", n, "perceptual")
    level = np.rint(255 * picture.darkness).astype(np.intp)
    at = np.minimum((points / picture.pixel_mm).astype(np.intp), np.array(level.shape[::-1]) - 1)
    distance = np.asarray(KDTree(points).query(points, k=2)[0])[:, 1] / picture.pixel_mm
    least, variation = [], []
    for value in np.flatnonzero(np.bincount(level[level > 12]) > 0.01 * level.size):
        bars, n_bars = label(level == value)
        for bar in range(1, n_bars + 1):
            inside = bars == bar  # the black step's is one with the frames of all
            count = int(np.count_nonzero(inside[at[:, 1], at[:, 0]]))
            area = int(np.count_nonzero(inside))
            if area < 0.01 * level.size or count < 60:
                continue
            depth = np.asarray(distance_transform_edt(np.pad(inside, 1)))[1:-1, 1:-1]
            core = depth > np.sqrt(area / count * 2.0 / np.sqrt(3.0))  # a spacing off its border
            near = distance[core[at[:, 1], at[:, 0]]]
            spacing = float(np.sqrt(np.count_nonzero(core) / len(near) * 2.0 / np.sqrt(3.0)))
            least.append(near.min() / spacing)
            variation.append(near.std() / near.mean())
    note = f"the worst of {len(least)} steps"
    return [
        Figure("wedge, within a step: min_rel", min(least), "", 0.40, 0.55, True, note),
        Figure("wedge, within a step: rel_nn_cv", max(variation), "", 0.13, 0.11, note=note),
    ]


def _very_pale(n: int = 10_000) -> list[Figure]:
    """Measure a picture of 2 to 12 percent of darkness, by both spacings."""
    darkness = 0.02 + 0.1 * read_darkness(assets() / "samples" / "ammonite.png", 800)
    reference = Reference(darkness.astype(np.float32), 800.0)
    results = []
    for spacing in ("even", "lloyd"):
        *_, last = stages(reference, Style(n_dots=n, spacing=spacing), snapshots=False)
        points, radii = np.array(last.position_mm), last.radius_mm.astype(np.float64)
        scored = measure(points, radii, np.asarray(reference.darkness, np.float64))
        results += [
            Figure(f"very pale picture, {spacing}: {key}", scored[key], "")
            for key in ("tone_rmse", "detail_rmse")
        ]
    return results


def _from_chance(n: int = 10_000, steps: int = 20) -> list[Figure]:
    """Measure clouds of dots by chance after some steps, with and without transport before them."""
    side = 100.0
    xy = np.random.default_rng(1).random((n, 2)) * side
    results = []
    for name, start in (
        ("alone", xy),
        ("after transport", evened_out(xy, np.ones((200, 200)), 0.5)),
    ):
        engine = Relaxation(start, box(0, 0, side, side), method="even")
        for _ in range(steps):
            engine.step()
        clouds = measure_grain(engine.points).clouds
        label = f"dots by chance, {steps} steps {name}: clouds"
        results.append(Figure(label, clouds, "", *_PROMISED["clouds"] if start is not xy else ()))
    for n_dots in (100_000, 1_000_000):
        xy = np.random.default_rng(1).random((n_dots, 2)) * side
        began = time.process_time()
        evened_out(xy, np.ones((200, 200)), 0.5)
        spent = time.process_time() - began
        results.append(Figure(f"transport of {n_dots:,} dots, processor time", spent, "s"))
    return results


def _after_many_steps(n: int = 10_000, steps: int = 320) -> list[Figure]:
    side = 100.0
    xy = np.random.default_rng(1).random((n, 2)) * side
    engine = Relaxation(xy, box(0, 0, side, side), method="even")
    largest = 0.0
    for _ in range(steps):
        largest = engine.step().largest_mm
    rows = measure_grain(engine.points).rows_at_4
    spacing = side / n**0.5
    return [
        Figure(f"rows_at_4 after {steps} steps from chance", rows, "", 0.008, 0.005),
        Figure(f"largest move after {steps} steps", largest / spacing, "spacings", 0.005, 0.0005),
    ]


def _relax_all(presses: int) -> list[Figure]:
    darkness = read_darkness(assets() / "samples" / "honey-bee.jpg", 800)
    reference = Reference(darkness.astype(np.float32), 148.0)
    *_, last = stages(reference, Style(n_dots=20_000), snapshots=False)
    points, radii = np.array(last.position_mm), np.array(last.radius_mm)
    page = box(0.0, 0.0, reference.width_mm, reference.height_mm)

    def error(points: NDArray[np.float64], radii: NDArray[np.float32]) -> float:
        px = darkness.shape[1] / reference.width_mm
        return measure_tone(points * px, radii.astype(np.float64) * px, darkness).tone_rmse

    before, results = error(points, radii), []
    for k in range(presses):
        task = Task(Style(), reference, RELAX, (page,), Standing(points, radii), steps=20)
        *_, last = run(task, snapshots=False)
        points, radii = np.array(last.position_mm), np.array(last.radius_mm)
        if k in (0, presses - 1):
            name = f"bee, 20,000: tone error after {k + 1} Relax all, over that before"
            results.append(Figure(name, error(points, radii) / before, "", 1.0, 0.9))
    return results


def _step_against_lloyd(repeats: int) -> Figure:
    """Time steps of both in turn, once dots hardly move; the least of several runs."""
    xy = np.random.default_rng(0).random((50_000, 2))
    engines = [Relaxation(xy, box(0, 0, 1, 1), method=m) for m in ("lloyd", "even")]
    for engine in engines:
        for _ in range(20):
            engine.step()
    times = np.empty((2 * repeats, 2))
    for row in times:
        for k, engine in enumerate(engines):
            start = time.perf_counter()
            engine.step()
            row[k] = time.perf_counter() - start
    lloyd, even = times.min(axis=0)
    note = f"{1e3 * even:.1f} and {1e3 * lloyd:.1f} ms"
    return Figure("a step of 50k, over a Lloyd step", even / lloyd, "", 1.3, 1.0, note=note)


if __name__ == "__main__":
    from benchmarks.all import main

    raise SystemExit(main(only="grain"))
