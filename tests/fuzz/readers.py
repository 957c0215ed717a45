"""What reads files, as functions of bytes: each returns, or raises `StipplerError`, and no more."""

from __future__ import annotations

import contextlib
import io
import tempfile
from collections.abc import Callable
from pathlib import Path

from stippler.errors import StipplerError
from stippler.files.native import arrays, container, journal, structure
from stippler.files.native.limits import Limits

SMALL = Limits(
    file_bytes=1 << 20, member_bytes=1 << 20, total_bytes=1 << 21, members=64,
    structure_bytes=1 << 18,
)  # fmt: skip


def _container(data: bytes) -> None:
    container._read(io.BytesIO(data), "here", SMALL)


def _structure(data: bytes) -> None:
    structure.from_bytes(data, "here", SMALL)


def _arrays(data: bytes) -> None:
    arrays.unpack(data, "here", SMALL)


def _journal(data: bytes) -> None:
    journal.parse_journal(data, "here", SMALL)


READERS: dict[str, Callable[[bytes], None]] = {
    "container": _container,
    "structure": _structure,
    "arrays": _arrays,
    "journal": _journal,
}


def read(name: str, data: bytes) -> None:
    """Let a reader read; a fault that it may not have is raised."""
    with contextlib.suppress(StipplerError):
        READERS[name](data)


def on_disk(read_path: Callable[[Path], object], ending: str) -> Callable[[bytes], None]:
    """Make a function of bytes of one that reads a file."""
    folder = Path(tempfile.mkdtemp(prefix="stippler-fuzz-"))

    def from_bytes(data: bytes) -> None:
        path = folder / f"one{ending}"
        path.write_bytes(data)
        read_path(path)

    return from_bytes


def seeds(name: str) -> list[bytes]:
    """Return whole inputs to begin with."""
    import numpy as np

    if name == "structure":
        return [structure.to_bytes({"a": [1, 2.5, None, True, "\u00e9"], "b": {"c": {}}})]
    packed = arrays.pack({"label": "x"}, {"a": np.arange(3.0), "b": np.array([True, False])})
    if name == "arrays":
        return [packed]
    if name == "container":
        stream = io.BytesIO()
        container.write_container(stream, {"document.json": b"{}", "dots/a.f8": bytes(400)}, "s 1")
        return [stream.getvalue()]
    if name == "journal":
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "one"
            one = journal.Journal(path, bytes(16))
            for record in (packed, bytes(5000)):
                one.append(lambda record=record: record)
            one.flush()
            one.close()
            return [path.read_bytes()]
    return []
