"""Making all kernels of a machine: from nothing, and from the store that is there then."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
import time

from benchmarks.figures import Figure

_WARM = [sys.executable, "-m", "stippler.warm"]
_LOAD = """
import time, numpy as np
from shapely.geometry import box
began = time.process_time()
from stippler.stippling.relax import relax
relax(np.random.default_rng(0).uniform(0, 1, (3000, 2)), box(0, 0, 1, 1), 3)
print(time.process_time() - began)
"""


def figures(quick: bool = False) -> list[Figure]:
    """Compile every kernel in a folder of their own, then load them there."""
    with tempfile.TemporaryDirectory() as folder:
        env = {**os.environ, "STIPPLER_CACHE_DIR": folder}
        before, began = _cpu_s(), time.perf_counter()
        subprocess.run(_WARM, env=env, check=True, capture_output=True)
        wall_s, made_s = time.perf_counter() - began, _cpu_s() - before
        loads = [_loaded_s(env) for _ in range(3 if quick else 7)]
    return [
        Figure("all kernels, cold compile, CPU time", made_s, "s", 12.0, 8.0),
        Figure("all kernels, cold compile, wall time", wall_s, "s"),
        Figure("relaxation's kernels, loaded from the store, CPU time", min(loads), "s", 0.3),
    ]


def _loaded_s(env: dict[str, str]) -> float:
    run = subprocess.run(
        [sys.executable, "-c", _LOAD], env=env, check=True, capture_output=True, text=True
    )
    return float(run.stdout)


def _cpu_s() -> float:
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime
