"""What a benchmark hands back, and how it is timed."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Figure:
    """One measured figure beside what was promised; lower is better unless said otherwise."""

    name: str
    value: float
    unit: str
    reach: float | None = None
    stretch: float | None = None
    higher_is_better: bool = False
    note: str = ""


def median_s(call: Callable[[], object], repeats: int = 5, warm: int = 1) -> float:
    """Return the median wall time of a call, after `warm` uncounted ones."""
    for _ in range(warm):
        call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return statistics.median(times)
