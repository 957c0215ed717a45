"""Names of files as they can be shown."""

from __future__ import annotations

import os


def shown(name: str | os.PathLike[str]) -> str:
    """Return a file's name for people; bytes that are no UTF-8, and so no text, as �."""
    return os.fspath(name).encode("utf-8", "surrogateescape").decode("utf-8", "replace")
