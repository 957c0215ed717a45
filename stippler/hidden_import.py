"""Imports without what they look for and can do without."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType
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


@contextmanager
def emptied(*names: str) -> Iterator[None]:
    """Let imports of modules that only do something find empty ones for a while."""
    names = tuple(name for name in names if name not in _modules)
    _modules.update({name: ModuleType(name) for name in names})
    try:
        yield
    finally:
        for name in names:
            del _modules[name]
