"""Whole commands of this version against those of another checkout, in turns.

``python -m benchmarks.against FOLDER``: of a machine that is slower or busier than another, ratios
still tell. Kernels of both have to be compiled: ``python -m stippler.warm`` in each folder.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

_HERE = Path(__file__).parents[1]
_COMMANDS = (
    ("10,000 dots of the ammonite, to SVG", ("--dots", "10000"), 7),
    ("60,000 dots of the ammonite, to SVG", ("--dots", "60000"), 5),
    ("1,000,000 dots of the ammonite, to SVG", ("--dots", "1000000"), 2),
)


def main(other: str) -> None:
    """Print the least times of each command, ours and theirs, and ours over theirs."""
    with tempfile.TemporaryDirectory() as folder:
        for name, options, repeats in _COMMANDS:
            sample = str(_HERE / "assets" / "samples" / "ammonite.png")
            command = ["render", sample, "-o", f"{folder}/drawing.svg", *options]
            mine, theirs = [], []
            for _ in range(repeats):
                mine.append(_timed(_HERE, command))
                theirs.append(_timed(Path(other), command))
            wall, their_wall = min(mine)[0], min(theirs)[0]
            cpu, their_cpu = (min(cpu for _, cpu in turns) for turns in (mine, theirs))
            print(
                f"{name}: {wall:.3g} over {their_wall:.3g} s = {wall / their_wall:.3g} "
                f"({cpu:.3g} over {their_cpu:.3g} s of processor time)"
            )


def _timed(place: Path, command: list[str]) -> tuple[float, float]:
    """Run a command of the version in a folder; return its wall and processor time, seconds."""
    env = {**os.environ, "PYTHONPATH": str(place)}
    before, began = _cpu_s(), time.perf_counter()
    subprocess.run(
        [sys.executable, "-m", "stippler", *command], env=env, cwd=place, check=True,
        capture_output=True,
    )  # fmt: skip
    return time.perf_counter() - began, _cpu_s() - before


def _cpu_s() -> float:
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


if __name__ == "__main__":
    main(sys.argv[1])
