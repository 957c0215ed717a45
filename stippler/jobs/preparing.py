"""Making ready: kernels compiled, in a process of its own, and brushes loaded."""

from __future__ import annotations

import re
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator

from stippler.errors import StipplerError
from stippler.jobs.work import PREPARE, Work

_LOOK_S = 0.1  # between two looks at a pause or a stop


def make_ready(*, is_warm: Callable[[], bool]) -> Iterator[Work]:
    """Load everything that painting needs, and compile it where it is not."""
    if not is_warm():
        for n_ready, n_kernels in prepared_kernels():
            yield Work(PREPARE, n_ready, n_kernels)
    from stippler.brushes.warm_up import warm_up_brushes

    warm_up_brushes()
    yield Work(PREPARE, 1, 1)


def prepared_kernels() -> Iterator[tuple[int, int]]:
    """Compile the kernels in a process of its own; tell how many of how many are done."""
    lines: list[str] = []
    process = subprocess.Popen(
        [sys.executable, "-m", "stippler.warm"],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    output = process.stdout
    assert output is not None
    reader = threading.Thread(target=lambda: lines.extend(output), name="preparing", daemon=True)
    reader.start()
    try:
        while reader.is_alive():
            yield _ready(lines)
            reader.join(_LOOK_S)
        if process.wait():
            raise StipplerError(
                f"the kernels could not be compiled ({lines[-1] if lines else 'no reason given'})",
                do="run python -m stippler.warm to see why",
            )
    finally:
        process.kill()
        process.wait()
        reader.join()
        output.close()


def _ready(lines: list[str]) -> tuple[int, int]:
    """Find how many of how many kernels the last line tells of."""
    found = re.search(r"(\d+)/(\d+)", lines[-1]) if lines else None
    return (int(found[1]), int(found[2])) if found else (0, 0)
