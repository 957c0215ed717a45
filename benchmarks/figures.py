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

    @property
    def verdict(self) -> str:
        """Return "stretch", "reach" or "missed"; empty where nothing was promised."""
        if self.reach is None:
            return ""
        if self.stretch is not None and self._meets(self.stretch):
            return "stretch"
        return "reach" if self._meets(self.reach) else "missed"

    def _meets(self, promise: float) -> bool:
        return self.value >= promise if self.higher_is_better else self.value <= promise


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
