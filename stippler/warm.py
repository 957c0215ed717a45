"""Compiling all kernels once a machine, so that nothing waits for it later.

``python -m stippler.warm`` prints a line of progress and does nothing when the kernels are there.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

from stippler.kernels.cache import all_digest, cache_root


def is_warm() -> bool:
    """Return whether this version's kernels lie compiled on disk; cheap, imports no numba."""
    return _mark().exists()


def warm(show: Callable[[str, int, int], None]) -> None:
    """Compile every kernel by using it on something small; tell what is done, and how much."""
    parts = list(_parts())
    for k, (name, run) in enumerate(parts):
        show(name, k, len(parts))
        run()
    show("done", len(parts), len(parts))
    mark = _mark()
    mark.parent.mkdir(parents=True, exist_ok=True)
    mark.touch()


def _mark() -> Path:
    return cache_root() / f"complete-{all_digest()}"


def _parts() -> Iterator[tuple[str, Callable[[], object]]]:
    """Name what compiles, in the order a first drawing needs it."""
    import numpy as np

    from stippler.drawing.reference import Reference
    from stippler.stippling.stipple import Plan, stages

    ramp = np.linspace(0, 1, 64 * 64, dtype=np.float32).reshape(64, 64)
    reference = Reference(ramp, 20.0)

    def draw(**options: object) -> Callable[[], object]:
        plan = Plan(n_dots=200, iterations=3, **options)  # type: ignore[arg-type]
        return lambda: list(stages(reference, plan))

    yield "first dots, relaxation, tone", draw()


def _main() -> None:
    if is_warm():
        return
    start = time.perf_counter()

    def show(name: str, done: int, total: int) -> None:
        line = f"Compiling the kernels (once a machine): {done}/{total} {name}"
        end = "\n" if done == total else "\r"
        sys.stderr.write(f"{line:<78}{end}" if sys.stderr.isatty() else f"{line}\n")
        sys.stderr.flush()

    warm(show)
    sys.stderr.write(f"Ready after {time.perf_counter() - start:.0f} s.\n")


if __name__ == "__main__":
    _main()
