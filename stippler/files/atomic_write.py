"""Writing a file whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from stippler.errors import OutputError

_ADVICE = {
    errno.ENOENT: ("its folder does not exist", "make the folder or name another"),
    errno.ENOTDIR: ("its folder is a file", "name another folder"),
    errno.EISDIR: ("is a folder", "name a file in it"),
    errno.EACCES: ("may not be written", "choose a folder you may write to"),
    errno.EPERM: ("may not be written", "choose a folder you may write to"),
    errno.EROFS: ("is on a read-only disk", "choose a folder you may write to"),
    errno.ENOSPC: ("the disk is full", "make room, or choose another disk"),
    errno.EDQUOT: ("your disk quota is used up", "make room, or choose another disk"),
    errno.ENAMETOOLONG: ("the name is too long", "choose a shorter one"),
}


@contextmanager
def replacing(path: str | Path) -> Iterator[BinaryIO]:
    """Open a file to be written; it takes its name only when everything is on disk.

    Whatever goes wrong inside, an interrupt included, leaves what stood there before and no
    partial file. A device such as ``/dev/stdout`` is written directly.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    path = Path(path)
    try:
        target = _target(path)
        if not _is_regular(target):
            with path.open("wb") as device:
                yield device
            return
        part = target.with_name(f".{target.name[:100]}.{os.getpid()}.part")
        try:
            with part.open("xb") as stream:
                yield stream
                stream.flush()
                os.fsync(stream.fileno())
            os.replace(part, target)
        except BaseException:
            with contextlib.suppress(OSError):
                part.unlink()
            raise
    except OSError as error:
        raise _output_error(path, error) from error


def check_writable(path: str | Path) -> None:
    """Raise `OutputError` if a file of this name could not be written, before any work is done."""
    try:
        target = _target(Path(path))
        if _is_regular(target) and not os.access(target.parent, os.W_OK):
            raise PermissionError(errno.EACCES, "may not be written")
    except OSError as error:
        raise _output_error(path, error) from error


def _target(path: Path) -> Path:
    """Follow links, and refuse what cannot be replaced."""
    target = path.resolve()
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "is a folder")
    target.parent.stat()
    if not target.parent.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, "its folder is a file")
    if target.exists() and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, "may not be written")
    return target


def _is_regular(target: Path) -> bool:
    return not target.exists() or stat.S_ISREG(target.stat().st_mode)


def _output_error(path: str | Path, error: OSError) -> OutputError:
    if isinstance(error, OutputError):
        return error
    what, do = _ADVICE.get(error.errno or 0, (f"cannot be written ({error.strerror})", ""))
    return OutputError(what, path, do)
