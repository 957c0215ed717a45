"""Writing a file whole or not at all: the one way in which anything of ours is written."""

from __future__ import annotations

import contextlib
import errno
import os
import re
import secrets
import shutil
import stat
import sys
import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from stippler.errors import OutputError

STDOUT = "-"
"""In place of a file's name: standard output."""

_ADVICE = {
    errno.ENOENT: ("its folder does not exist", "make the folder or name another"),
    errno.ENOTDIR: ("its folder is a file", "name another folder"),
    errno.EISDIR: ("is a folder", "name a file in it"),
    errno.EACCES: ("may not be written", "choose a folder you may write to"),
    errno.EPERM: ("may not be written", "choose a folder you may write to"),
    errno.EROFS: ("is on a read-only disk", "choose a folder you may write to"),
    errno.ENOSPC: ("the disk is full", "make room, or choose another disk"),
    errno.EDQUOT: ("your disk quota is used up", "make room, or choose another disk"),
    errno.EFBIG: ("the file would be larger than allowed here", "choose another disk"),
    errno.ENAMETOOLONG: ("the name is too long", "choose a shorter one"),
    errno.ELOOP: ("is a link that leads back to itself", "name another file"),
    errno.EPIPE: ("nobody reads it any more", ""),
    errno.EBADF: ("is closed", "name a file"),
}
_DESCRIPTOR = re.compile(r"/dev/fd/(\d+)|/proc/(?:self|thread-self)/fd/(\d+)")
_TOKEN = 12  # hexadecimal digits that tell one part from another
_OLD_S = 24 * 3600.0  # where files cannot be locked, a part of this age is nobody's


@contextmanager
def replacing(path: str | Path) -> Iterator[BinaryIO]:
    """Open a file to be written; it takes its name only when everything is on disk.

    Whatever goes wrong inside, an interrupt included, leaves what stood there before and no
    partial file. A file that was there keeps its mode, its owner and its other names; a link is
    followed. `STDOUT`, a device such as ``/dev/stdout`` and a pipe are written directly.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    path = Path(path)
    try:
        descriptor = _descriptor(path)
        if descriptor is not None:
            with os.fdopen(os.dup(descriptor), "wb") as stream:
                yield stream
            return
        target = _target(path)
        before = _status(target)
        if before is not None and not stat.S_ISREG(before.st_mode):
            with target.open("wb") as device:
                yield device
            return
        yield from _written_apart(target, before)
    except OSError as error:
        raise _output_error(path, error) from error


def check_writable(path: str | Path, inputs: Iterable[str | Path] = ()) -> None:
    """Raise `OutputError` if a file of this name could not be written, before any work is done.

    Parameters
    ----------
    inputs : paths
        What the work reads; the output may be none of them, by whatever name or link.
    """
    try:
        descriptor = _descriptor(Path(path))
        if descriptor is not None:
            os.fstat(descriptor)
        else:
            target = _target(Path(path))
            before = _status(target)
            regular = before is None or stat.S_ISREG(before.st_mode)
            if regular and not os.access(target.parent, os.W_OK):
                raise PermissionError(errno.EACCES, "may not be written")
        for read in inputs:
            if is_same_file(path, read):
                raise OutputError(
                    "is the very file that is read, which would be lost", path, "name another file"
                )
    except OSError as error:
        raise _output_error(path, error) from error


def is_same_file(one: str | Path, other: str | Path) -> bool:
    """Return whether two names lead to one file on disk, through links of both kinds."""
    first, second = _status_of_name(Path(one)), _status_of_name(Path(other))
    if first is None or second is None or not os.path.samestat(first, second):
        return False
    return stat.S_ISREG(first.st_mode)


# --- the part that becomes the file -----------------------------------------------------------


def _written_apart(target: Path, before: os.stat_result | None) -> Iterator[BinaryIO]:
    """Write beside the target, then put that in its place."""
    _remove_stale_parts(target)
    part, stream = _new_part(target)
    try:
        with stream:
            yield stream
            stream.flush()
            in_place = before is not None and not _made_alike(stream.fileno(), before)
            os.fsync(stream.fileno())
            if in_place:
                _copy_into(stream, target)
                os.unlink(part)
            else:
                if os.name == "nt":
                    stream.close()  # an open file cannot be renamed there
                os.replace(part, target)
    except BaseException:
        with contextlib.suppress(OSError):
            stream.close()
            os.unlink(part)
        raise
    _sync_folder(target.parent)


def _made_alike(descriptor: int, before: os.stat_result) -> bool:
    """Give a part the mode and owner of what it replaces; False if it cannot take its place.

    That is so where the file has other names (hard links), or an owner that we may not give.
    """
    if before.st_nlink > 1:
        return False
    if os.name == "nt":
        return True
    mine = os.fstat(descriptor)
    try:
        if (mine.st_uid, mine.st_gid) != (before.st_uid, before.st_gid):
            os.fchown(descriptor, before.st_uid, before.st_gid)
        os.fchmod(descriptor, stat.S_IMODE(before.st_mode))
    except PermissionError:
        return False
    return True


def _copy_into(whole: BinaryIO, target: Path) -> None:
    """Write a finished part into the file that is there; an interrupt waits for the end of it."""
    try:
        _copy(whole, target)
    except OSError:
        raise
    except BaseException:  # a signal that ends the process
        _copy(whole, target)
        raise


def _copy(whole: BinaryIO, target: Path) -> None:
    size = os.fstat(whole.fileno()).st_size
    with target.open("r+b") as there:
        _make_room(there.fileno(), size)
        whole.seek(0)
        shutil.copyfileobj(whole, there, 1 << 20)
        there.truncate(size)
        there.flush()
        os.fsync(there.fileno())


def _make_room(descriptor: int, size: int) -> None:
    """Have the disk set room aside, so that a full one is met before anything is overwritten."""
    before = os.fstat(descriptor).st_size
    if size <= before or not hasattr(os, "posix_fallocate"):
        return
    try:
        os.posix_fallocate(descriptor, 0, size)
    except OSError as error:
        os.ftruncate(descriptor, before)
        if error.errno in (errno.ENOSPC, errno.EDQUOT, errno.EFBIG):
            raise


def _new_part(target: Path) -> tuple[Path, BinaryIO]:
    """Open a file of its own beside the target, locked as long as it is being written."""
    while True:
        part = target.with_name(f"{_part_head(target)}{secrets.token_hex(_TOKEN // 2)}.part")
        try:
            # the mode that a new file has here; a mode of its own follows
            descriptor = os.open(part, os.O_RDWR | os.O_CREAT | os.O_EXCL | _BINARY, 0o666)
        except FileExistsError:
            continue
        stream = os.fdopen(descriptor, "w+b")
        # between the two it may have been taken for a stale one
        if _lock(descriptor) is not False and _status(part) is not None:
            return part, stream
        stream.close()


def _part_head(target: Path) -> str:
    """Return how the names of a target's parts begin, short enough for any disk."""
    return f".{os.fsencode(target.name)[:100].decode('utf-8', 'ignore')}."


def _remove_stale_parts(target: Path) -> None:
    """Remove what killed processes left; what is being written is locked, and stays."""
    head = _part_head(target)
    form = re.compile(re.escape(head) + rf"(?:[0-9a-f]{{{_TOKEN}}}|\d+)\.part")
    with contextlib.suppress(OSError), os.scandir(target.parent) as entries:
        for part in [Path(e.path) for e in entries if form.fullmatch(e.name)]:
            with contextlib.suppress(OSError), part.open("r+b") as stream:
                if _is_stale(stream.fileno()):
                    part.unlink()


def _is_stale(descriptor: int) -> bool:
    """Return whether nobody writes a part any more; takes its lock."""
    locked = _lock(descriptor)
    if locked is None:
        return time.time() - os.fstat(descriptor).st_mtime > _OLD_S
    return locked


def _lock(descriptor: int) -> bool | None:
    """Lock an open file; False if another holds the lock, None where files cannot be locked."""
    try:
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except (ImportError, OSError):
        return None
    return True


def _sync_folder(folder: Path) -> None:
    """Bring the new name to disk, too, where folders can be synced."""
    with contextlib.suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY | getattr(os, "O_DIRECTORY", 0))
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)


# --- names ------------------------------------------------------------------------------------


def _descriptor(path: Path) -> int | None:
    """Return the open file that a name such as ``-`` or ``/dev/fd/3`` stands for, if it does."""
    name = os.fspath(path)
    if name in (STDOUT, "/dev/stdout"):
        if sys.stdout is None:
            raise OSError(errno.EBADF, "is closed")
        with contextlib.suppress(OSError, ValueError):
            sys.stdout.flush()
        return 1
    if found := _DESCRIPTOR.fullmatch(name):
        return int(found[1] or found[2])
    return None


def _target(path: Path) -> Path:
    """Follow links, and refuse what cannot be replaced."""
    target = _followed(path)
    before = _status(target)
    if before is not None and stat.S_ISDIR(before.st_mode):
        raise IsADirectoryError(errno.EISDIR, "is a folder")
    if not stat.S_ISDIR(target.parent.stat().st_mode):
        raise NotADirectoryError(errno.ENOTDIR, "its folder is a file")
    if before is not None and not os.access(target, os.W_OK):
        if hasattr(os, "statvfs") and os.statvfs(target).f_flag & os.ST_RDONLY:
            raise OSError(errno.EROFS, "is on a read-only disk")
        raise PermissionError(errno.EACCES, "may not be written")
    return target


def _followed(path: Path) -> Path:
    try:
        return path.resolve()
    except RuntimeError:  # what Python 3.11 and 3.12 make of a loop
        raise OSError(errno.ELOOP, "is a link that leads back to itself") from None


def _status(path: Path) -> os.stat_result | None:
    """Return what there is of a name, or None if there is nothing."""
    try:
        return path.stat()
    except FileNotFoundError:
        return None


def _status_of_name(path: Path) -> os.stat_result | None:
    try:
        descriptor = _descriptor(path)
        return path.stat() if descriptor is None else os.fstat(descriptor)
    except OSError:
        return None


def _output_error(path: str | Path, error: OSError) -> OutputError:
    if isinstance(error, OutputError):
        return error
    what, do = _ADVICE.get(error.errno or 0, (f"cannot be written ({error.strerror})", ""))
    where = "standard output" if os.fspath(path) == STDOUT else path
    return OutputError(what, where, do)


_BINARY = getattr(os, "O_BINARY", 0)
