"""Whole processes, timed from the shell's side: rendering, help, memory."""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from benchmarks.figures import Figure
from stippler.resources import assets

_PLAIN = ("--tone", "linear", "--spacing", "lloyd")  # what versions can be compared by
_AMMONITE = assets() / "samples" / "ammonite.png"
_RUN = [sys.executable, "-m", "stippler"]


def figures(quick: bool = False) -> list[Figure]:
    """Time the command line on a 1-megapixel picture and weigh it on a 100-megapixel one."""
    repeats = 3 if quick else 5
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "picture.png"
        Image.fromarray(_shaded(1000)).save(picture)
        out = Path(folder) / "out.svg"

        def render(*options: str) -> float:
            return _median_s([*_RUN, "render", str(picture), "-o", str(out), *options], repeats)

        def ammonite(n_dots: str) -> float:
            return _median_s([*_RUN, "render", str(_AMMONITE), "-o", str(out), "--dots", n_dots],
                             repeats)  # fmt: skip

        results = [
            Figure("10,000 dots of the ammonite, to SVG", ammonite("10000"), "s", 0.4, 0.3),
            Figure("60,000 dots of the ammonite, to SVG", ammonite("60000"), "s", 0.65, 0.5),
            Figure("60,000 dots, 20 iterations, to SVG", render("--dots", "60000"), "s", 3.0),
            Figure("10,000 dots, 20 iterations, to SVG", render("--dots", "10000"), "s", 1.2),
            Figure("60,000 dots, Lloyd, linear", render("--dots", "60000", *_PLAIN), "s"),
            Figure("20,000 dots, Lloyd, linear", render("--dots", "20000", *_PLAIN), "s"),
            Figure("stippler --help", _median_s([*_RUN, "--help"], repeats), "s", 0.4),
            Figure("stippler info", _median_s([*_RUN, "info"], repeats), "s"),
        ]
        if not quick:
            many = ("--dots", "1000000", "--iterations", "5")
            seconds, gigabytes = _measure([*_RUN, "render", str(picture), "-o", str(out), *many])
            results += [
                Figure("1,000,000 dots, 5 iterations, to SVG", seconds, "s", 5.0, 4.0),
                Figure("1,000,000 dots, 5 iterations, peak memory", gigabytes, "GB", 0.7, 0.5),
            ]
            big = Path(folder) / "big.jpg"
            # enlarged, for a child's peak memory counts that of the process it was forked from
            Image.fromarray(_shaded(1000)).resize((10_000, 10_000)).convert("RGB").save(big)
            seconds, gigabytes = _measure([*_RUN, "render", str(big), "-o", str(out)])
            results += [
                Figure("100 megapixels, peak memory", gigabytes, "GB", 3.0),
                Figure("100 megapixels, 20,000 dots, to SVG", seconds, "s"),
            ]
    return results


def _shaded(size: int) -> np.ndarray[tuple[int, ...], np.dtype[np.uint8]]:
    """Make a ball on white with some grain: every tone, and much white."""
    y, x = np.mgrid[-1 : 1 : size * 1j, -1 : 1 : size * 1j].astype(np.float32)
    r2 = (x * x + y * y) / np.float32(0.64)
    z = np.sqrt(np.clip(1 - r2, 0, 1))
    light = np.clip(0.15 + 0.85 * (0.6 * z - 0.5 * x - 0.5 * y), 0.05, 1)
    grain = 0.03 * np.sin(90 * x) * np.sin(70 * y)
    return (255 * np.clip(np.where(r2 < 1, light + grain, 1), 0, 1)).astype(np.uint8)


def _median_s(command: Sequence[str], repeats: int) -> float:
    _measure(command)
    return statistics.median(_measure(command)[0] for _ in range(repeats))


def _measure(command: Sequence[str]) -> tuple[float, float]:
    """Run a command; return its wall time in seconds and its peak memory in gigabytes."""
    start = time.perf_counter()
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(command)} ended with {process.returncode}")
    return seconds, _gigabytes(usage)


def _gigabytes(usage: resource.struct_rusage) -> float:
    return usage.ru_maxrss * (1 if sys.platform == "darwin" else 1024) / 1e9
