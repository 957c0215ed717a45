"""Imports without what they look for and can do without."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_modules: dict[str, Any] = sys.modules


@contextmanager
def hidden(name: str) -> Iterator[None]:
    """Let an import of a module fail at once for a while, unless it was imported before."""
    if name in _modules:
        yield
        return
    _modules[name] = None
    try:
        yield
    finally:
        del _modules[name]
