"""The journal: every finished edit of an open drawing, on disk before the next frame but one.

A file of checksummed records, each numbered; it is only ever appended to. A thread of its own
packs, writes and syncs, so that no frame waits for a disk. What a crash tears off the end is
dropped by the reader, and everything before it is kept. `docs/format.md` describes the bytes.

A sync that has failed is never tried again on the same file: the system may have thrown the data
away and call the next sync a success. The journal then counts as failed, for good; whoever keeps it
begins another, in a new file, from the drawing in memory.
"""

from __future__ import annotations

import os
import struct
import threading
import zlib
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from stippler.errors import DrawingFileError, StipplerError
from stippler.files.native.limits import DEFAULT_LIMITS, Limits

MAGIC = b"STIPJRNL"
VERSION = 1

_HEAD = struct.Struct("<8sI16sI")  # magic, version, drawing, crc of these
_RECORD = struct.Struct("<IIQ")  # packed bytes, crc of number and bytes, number
_NUMBER = struct.Struct("<Q")
_PLAIN, _DEFLATED = b"\0", b"\1"
_PACKED_FROM = 4096

Payload = Callable[[], bytes]
"""Makes a record's bytes, in the journal's thread, from what does not change any more."""


@dataclass(frozen=True, slots=True)
class Replay:
    """What a journal holds.

    Attributes
    ----------
    drawing : bytes
        16 bytes that the journal shares with the drawing it begins with.
    records : list of bytes
    n_torn : int
        Bytes at the end that are no whole record, and were dropped.
    """

    drawing: bytes
    records: list[bytes]
    n_torn: int


def read_journal(path: str | Path, limits: Limits = DEFAULT_LIMITS) -> Replay:
    """Return the whole records of a journal, up to the first that is torn or damaged.

    Raises
    ------
    DrawingFileError
        If the file cannot be read, or its head is none.
    """
    path = Path(path)
    try:
        size = path.stat().st_size
        if size > limits.file_bytes:
            raise DrawingFileError(f"has {size:,} bytes", path, "it is no journal")
        data = path.read_bytes()
    except OSError as error:
        raise DrawingFileError(
            f"cannot be read ({error.strerror or error})", path, "check the file and its folder"
        ) from error
    return parse_journal(data, str(path), limits)


def parse_journal(data: bytes, where: str, limits: Limits = DEFAULT_LIMITS) -> Replay:
    """Return the whole records of a journal's bytes; see `read_journal`."""
    if len(data) < _HEAD.size:
        raise DrawingFileError("has no head", where, "it is no journal")
    magic, version, drawing, crc = _HEAD.unpack_from(data)
    if magic != MAGIC or crc != zlib.crc32(data[: _HEAD.size - 4]):
        raise DrawingFileError("has no head", where, "it is no journal")
    if version != VERSION:
        raise DrawingFileError(
            f"is in version {version}; this program reads {VERSION}", where, "update Stippler"
        )
    records: list[bytes] = []
    at, room = _HEAD.size, limits.total_bytes
    while (found := _record(data, at, len(records), min(limits.member_bytes, room))) is not None:
        payload, at = found
        room -= len(payload)
        records.append(payload)
    return Replay(drawing, records, len(data) - at)


def _record(data: bytes, at: int, number: int, most: int) -> tuple[bytes, int] | None:
    """Return the record that begins at a place, and where it ends; None if it is not whole."""
    if at + _RECORD.size > len(data):
        return None
    n_bytes, crc, told = _RECORD.unpack_from(data, at)
    first, end = at + _RECORD.size, at + _RECORD.size + n_bytes
    if told != number or n_bytes < 1 or end > len(data):
        return None
    packed = data[first:end]
    if zlib.crc32(packed, zlib.crc32(_NUMBER.pack(number))) != crc:
        return None
    payload = _unpacked(packed, most)
    return None if payload is None else (payload, end)


def _packed(payload: bytes) -> bytes:
    if len(payload) < _PACKED_FROM:
        return _PLAIN + payload
    return _DEFLATED + zlib.compress(payload, 1)


def _unpacked(packed: bytes, most: int) -> bytes | None:
    """Return a record's bytes; None if they are none, or more than allowed."""
    way, rest = packed[:1], packed[1:]
    if way == _PLAIN:
        return rest if len(rest) <= most else None
    if way != _DEFLATED:
        return None
    unpacker = zlib.decompressobj()
    try:
        payload = unpacker.decompress(rest, most)
    except zlib.error:
        return None
    whole = unpacker.eof and not unpacker.unused_data and not unpacker.unconsumed_tail
    return payload if whole else None


class Journal:
    """Appends records to a file that it makes; for one thread, and a thread of its own.

    Parameters
    ----------
    path : Path
        Must not exist yet.
    drawing : bytes
        16 bytes that name the drawing it begins with.

    Raises
    ------
    StipplerError
        If the file cannot be made.
    """

    def __init__(self, path: Path, drawing: bytes) -> None:
        if len(drawing) != 16:
            raise ValueError("a drawing is named by 16 bytes")
        self._path = path
        self._lock = threading.Condition()
        self._todo: deque[Payload] = deque()
        self._n_asked = self._n_done = 0
        self._closing = False
        self._problem: StipplerError | None = None
        head = _HEAD.pack(MAGIC, VERSION, drawing, 0)[:-4]
        try:
            self._file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL | _BINARY, 0o600)
            self._write(head + struct.pack("<I", zlib.crc32(head)))
        except OSError as error:
            raise StipplerError(
                f"edits cannot be kept for recovery ({error.strerror or error})", path,
                "save the drawing often",
            ) from error  # fmt: skip
        self._thread = threading.Thread(target=self._work, name="journal", daemon=True)
        self._thread.start()

    @property
    def problem(self) -> StipplerError | None:
        """Why nothing is kept any more; None while all is well."""
        with self._lock:
            return self._problem

    @property
    def n_waiting(self) -> int:
        """How many records are not on disk yet."""
        with self._lock:
            return self._n_asked - self._n_done

    def append(self, payload: Payload) -> None:
        """Ask for a record; returns at once. After a failure or the end it changes nothing."""
        with self._lock:
            if self._problem is None and not self._closing:
                self._todo.append(payload)
                self._n_asked += 1
                self._lock.notify_all()

    def flush(self, timeout_s: float = 10.0) -> bool:
        """Wait until everything asked for is on disk; return whether it is."""
        with self._lock:
            self._lock.wait_for(
                lambda: self._n_done == self._n_asked or self._problem is not None, timeout_s
            )
            return self._n_done == self._n_asked and self._problem is None

    def close(self, timeout_s: float = 10.0) -> None:
        """Write what is asked for, and let go of the file."""
        with self._lock:
            if self._closing:
                return
            self._closing = True
            self._lock.notify_all()
        self._thread.join(timeout_s)

    def _work(self) -> None:
        number = 0
        while True:
            with self._lock:
                self._lock.wait_for(lambda: bool(self._todo) or self._closing)
                batch = list(self._todo)
                self._todo.clear()
            if not batch:
                os.close(self._file)
                return
            try:
                pieces = []
                for make in batch:
                    pieces.append(_framed(_packed(make()), number))
                    number += 1
                self._write(b"".join(pieces))
            except Exception as error:  # noqa: BLE001 - the editor lives on; the person is told
                os.close(self._file)
                self._fail(error)
                return
            with self._lock:
                self._n_done += len(batch)
                self._lock.notify_all()

    def _write(self, data: bytes) -> None:
        view = memoryview(data)
        while view:
            view = view[os.write(self._file, view) :]
        os.fsync(self._file)

    def _fail(self, error: Exception) -> None:
        why = getattr(error, "strerror", None) or str(error) or type(error).__name__
        with self._lock:
            self._problem = StipplerError(
                f"edits cannot be kept for recovery ({why})", self._path, "save the drawing now"
            )
            self._todo.clear()
            self._lock.notify_all()


_BINARY = getattr(os, "O_BINARY", 0)


def _framed(packed: bytes, number: int) -> bytes:
    crc = zlib.crc32(packed, zlib.crc32(_NUMBER.pack(number)))
    return _RECORD.pack(len(packed), crc, number) + packed
