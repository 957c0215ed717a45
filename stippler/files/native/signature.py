"""What a drawing's file is told by, before anything is imported that reads it."""

from __future__ import annotations

from pathlib import Path

ENDING = ".stipple"
MIME = "application/x-stipple"


def is_container(path: Path) -> bool:
    """Return whether a file begins as a drawing does; False where it cannot be read."""
    try:
        with path.open("rb") as stream:
            head = stream.read(38 + len(MIME))
    except OSError:
        return False
    return head[:4] == b"PK\3\4" and head[38:] == MIME.encode()
