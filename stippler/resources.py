"""The one place that finds `shaders/` and `assets/`, in a checkout or inside the wheel."""

from __future__ import annotations

from functools import cache
from pathlib import Path


@cache
def _root() -> Path:
    here = Path(__file__).resolve().parent
    packed = here / "_data"
    return packed if (packed / "shaders").is_dir() else here.parent  # kernels alone are no wheel


def shaders() -> Path:
    """Return the folder of shader sources."""
    return _root() / "shaders"


def assets() -> Path:
    """Return the folder of sample pictures, patterns and icons."""
    return _root() / "assets"


def benchmarks() -> Path:
    """Return the folder of the package `benchmarks`."""
    return _root() / "benchmarks"
