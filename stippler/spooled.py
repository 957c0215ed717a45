"""Inputs that can be read only once, such as pipes, put into a file that can be read at will."""

from __future__ import annotations

import contextlib
import os
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from stippler.errors import PictureError, StipplerError

STDIN = "-"
"""In place of a file's name: standard input."""

MAX_BYTES = 2**31
_NAMES = (STDIN, "/dev/stdin", "/dev/fd/0", "/proc/self/fd/0")
_PIECE = 1 << 20


@contextmanager
def at_hand(path: Path) -> Iterator[Path]:
    """Yield the path of a file that can be read again and again, with what is in `path`.

    Files are that already. A pipe, a device or standard input is copied into a temporary file;
    what is said of that afterwards names the source.

    Raises
    ------
    PictureError
        If there is no standard input, or more in it than `MAX_BYTES`.
    """
    if not _is_stream(path):
        yield path
        return
    import tempfile  # late: it takes longer to import than all else here

    name = "standard input" if os.fspath(path) in _NAMES else os.fspath(path)
    with tempfile.TemporaryDirectory(prefix="stippler-") as folder:
        copy = Path(folder) / "standard-input"
        try:
            with _opened(path, name) as source, copy.open("wb") as target:
                _copy(source, target, name)
        except OSError as error:
            if isinstance(error, StipplerError):
                raise
            raise PictureError(f"cannot be read ({error.strerror})", name) from None
        try:
            yield copy
        except StipplerError as error:
            raise _of(error, str(copy), name) from None


def _is_stream(path: Path) -> bool:
    if os.fspath(path) == STDIN:
        return True
    try:
        mode = path.stat().st_mode
    except OSError:  # told by whoever opens it
        return False
    return not (stat.S_ISREG(mode) or stat.S_ISDIR(mode))


def _opened(path: Path, name: str) -> contextlib.AbstractContextManager[BinaryIO]:
    if os.fspath(path) not in _NAMES:
        return path.open("rb")
    if sys.stdin is None or sys.stdin.closed:
        raise PictureError("is closed", name, "name a file, or pipe one into it")
    if sys.stdin.isatty():
        raise PictureError("is a terminal", name, "name a file, or pipe one into it")
    return contextlib.nullcontext(sys.stdin.buffer)


def _copy(source: BinaryIO, target: BinaryIO, name: str) -> None:
    import shutil

    left = MAX_BYTES
    while piece := source.read(_PIECE):
        left -= len(piece)
        if left < 0 or shutil.disk_usage(target.name).free < 2 * _PIECE:
            raise PictureError(f"does not end after {(MAX_BYTES - left) >> 20} MB", name)
        target.write(piece)


def _of(error: StipplerError, copy: str, name: str) -> StipplerError:
    """Return the same error about the source of a copy."""
    where = error.where.replace(copy, name)
    return type(error)(error.what, where, error.do)
