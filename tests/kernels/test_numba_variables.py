"""Variables of numba that others set do not stop kernels that numba compiles."""

import os
import subprocess
import sys

import numpy as np
import pytest

from stippler.kernels.shapes.dot_shape import hash_unit

_DRAWN = """
import numpy as np
from stippler.kernels.shapes.dot_shape import hash_unit
print(hash_unit(np.arange(3, dtype=np.uint32), 7).round(6).tolist())
"""


@pytest.mark.parametrize("variable", ["NUM_THREADS=0", "NUM_THREADS=abc", "DISABLE_JIT=1"])
def test_what_others_set_for_numba_does_no_harm(variable: str) -> None:
    name, _, value = variable.partition("=")
    done = subprocess.run(
        [sys.executable, "-c", _DRAWN],
        env={**os.environ, "STIPPLER_KERNELS": "numba", f"NUMBA_{name}": value},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-500:]
    assert done.stdout == f"{hash_unit(np.arange(3, dtype=np.uint32), 7).round(6).tolist()}\n"
