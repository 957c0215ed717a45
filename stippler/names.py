"""Names of files as they can be shown."""

from __future__ import annotations

import os


def shown(name: str | os.PathLike[str]) -> str:
    """Return a file's name for people; bytes that are no UTF-8, and so no text, as �."""
    text = os.fspath(name)
    try:
        return text.encode("utf-8", "surrogateescape").decode("utf-8", "replace")
    except UnicodeEncodeError:  # half a pair, as JSON may have it
        return text.encode("utf-16", "surrogatepass").decode("utf-16", "replace")
