"""Processes killed at random moments of a save: ``python tests/long/kills.py saves 1000``.

After each kill the file has to open, as the old drawing or as the new one.
"""

from __future__ import annotations

import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from stippler.atomic_write import replacing
from stippler.files.native.container import read_container, write_container

N_BYTES = 60_000


def members(version: int) -> dict[str, bytes]:
    """Make a drawing that says which version it is, in every byte."""
    return {"document.json": b"%d" % version, "dots/a.u1": bytes([version % 251]) * N_BYTES}


def save(path: Path, version: int) -> None:
    """Save a version as the program does."""
    with replacing(path) as stream:
        write_container(stream, members(version), "stippler")


def kill_saves(n_kills: int, seed: int = 1) -> Counter[str]:
    """Kill a saving process again and again; count whether the old or a new version was there."""
    dice, seen = random.Random(seed), Counter[str]()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "one.stipple"
        one_s = max(_time_of_a_forked_save(path) for _ in range(3))
        at = 0
        for _ in range(n_kills):
            process = os.fork()
            if process == 0:
                try:
                    version = at
                    while True:
                        version += 1
                        save(path, version)
                finally:
                    os._exit(1)
            time.sleep(dice.uniform(0.0, 4.0 * one_s + 0.005))
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
            found = read_container(path)
            now = int(found["document.json"])
            assert found == members(now), "a file of two versions"
            assert now >= at, "an older file came back"
            seen["old" if now == at else "new"] += 1
            at = now
        save(path, at + 1)
        left = [file.name for file in Path(folder).iterdir()]
        assert left == ["one.stipple"], f"parts are left: {left}"
    return seen


def _time_of_a_forked_save(path: Path) -> float:
    """Return how long a new process takes for its first save: memory it shares slows it down."""
    began = time.perf_counter()
    process = os.fork()
    if process == 0:
        try:
            save(path, 0)
        finally:
            os._exit(0)
    os.waitpid(process, 0)
    return time.perf_counter() - began


if __name__ == "__main__":
    n = int(sys.argv[2]) if len(sys.argv) > 2 else 1000
    print(f"{n} kills: {dict(kill_saves(n))}")
