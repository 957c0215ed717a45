"""A quicker import of numba, for our own programs.

Numba looks for a BLAS by importing `scipy.linalg` (a third of a second) so that kernels can
multiply matrices. Ours do not. A program that is nothing but Stippler asks for the short way with
`skip_blas`; as a library we leave numba as everybody else expects it.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext

from stippler.hidden_import import hidden

_PROBE = "scipy.linalg.cython_blas"
_wanted = False


def skip_blas() -> None:
    """Import numba without BLAS from now on; call it before the first kernel is imported."""
    global _wanted
    _wanted = True


def drop_useless_variables() -> None:
    """Take away a number of threads with which numba could not be imported at all.

    Our kernels never start its threads.
    """
    asked = os.environ.get("NUMBA_NUM_THREADS", "").strip()
    if asked.lstrip("+-").isdigit() and int(asked) < 1:
        del os.environ["NUMBA_NUM_THREADS"]


@contextmanager
def importing_numba() -> Iterator[None]:
    """Hide the BLAS while numba looks for it, if that was asked for."""
    if "numba" not in sys.modules:
        drop_useless_variables()
    with hidden(_PROBE) if _wanted else nullcontext():
        yield
