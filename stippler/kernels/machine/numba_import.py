"""A quicker import of numba, for our own programs.

Numba looks for a BLAS by importing `scipy.linalg` (a third of a second) so that kernels can
multiply matrices. Ours do not. A program that is nothing but Stippler asks for the short way with
`skip_blas`; as a library we leave numba as everybody else expects it.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_PROBE = "scipy.linalg.cython_blas"
_modules: dict[str, Any] = sys.modules
_wanted = False


def skip_blas() -> None:
    """Import numba without BLAS from now on; call it before the first kernel is imported."""
    global _wanted
    _wanted = True


@contextmanager
def importing_numba() -> Iterator[None]:
    """Hide the BLAS while numba looks for it, if that was asked for."""
    if not _wanted or _PROBE in _modules:
        yield
        return
    _modules[_PROBE] = None  # an import of it fails at once
    try:
        yield
    finally:
        del _modules[_PROBE]
