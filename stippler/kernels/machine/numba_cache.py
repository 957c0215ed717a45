"""Numba's cache on disk, as one that may be missing, cut or read-only.

A power cut leaves empty files, a full disk none, and some users have no folder to write to. What
cannot be read is made again; what cannot be written is done without.
"""

from __future__ import annotations

import contextlib
from typing import Any

from numba.core.caching import FunctionCache


class _LenientCache(FunctionCache):
    """A cache that never stops a program."""

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        try:
            return super().load_overload(sig, target_context)
        except Exception:  # noqa: BLE001  # whatever unpickling what is left of a file comes to
            with contextlib.suppress(Exception):
                self._cache_file._save_index({})
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        try:
            super().save_overload(sig, data)
        except Exception:  # noqa: BLE001  # an index that was cut stops the saving, too
            with contextlib.suppress(Exception):
                self._cache_file._save_index({})


def keep_on_disk(dispatcher: Any) -> None:
    """Let a dispatcher keep its machine code where numba's settings say, if it can be kept."""
    with contextlib.suppress(RuntimeError, OSError):  # "no locator available": nowhere to write
        dispatcher._cache = _LenientCache(dispatcher.py_func)
