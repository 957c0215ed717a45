"""What reads files, as functions of bytes: each returns, or raises `StipplerError`, and no more.

Where a drawing comes out, it has to be one that can be saved and opened again.
"""

from __future__ import annotations

import contextlib
import io
import json
import struct
import tempfile
import zlib
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from stippler.drawing import records
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.levels import Levels
from stippler.drawing.reference import Picture
from stippler.errors import DrawingFileError, StipplerError
from stippler.files.native import arrays, container, drawing_file, edit_log, journal, structure
from stippler.files.native.limits import Limits
from stippler.files.read import geojson, picture, svg_outlines, table

SMALL = Limits(
    file_bytes=1 << 20, member_bytes=1 << 20, total_bytes=1 << 21, members=64,
    structure_bytes=1 << 18,
)  # fmt: skip
MOST_PIXELS = 1 << 14
"""Of a picture here; the program's own limit is tested elsewhere."""
_MOST_DOTS = 64
_HERE = Path("here")


# --- our own files --------------------------------------------------------------------------------


def _container(data: bytes) -> None:
    container._read(io.BytesIO(data), "here", SMALL)


def _structure(data: bytes) -> None:
    value = structure.from_bytes(data, "here", SMALL)
    assert structure.from_bytes(structure.to_bytes(value), "there", SMALL) == value


def _arrays(data: bytes) -> None:
    arrays.unpack(data, "here", SMALL)


def _journal(data: bytes) -> None:
    """Read a journal; its checksums are mended first where the last byte is odd."""
    if data and data[-1] & 1:
        data = _mended(bytearray(data))
    journal.parse_journal(data, "here", SMALL)


def _mended(data: bytearray) -> bytes:
    """Return a journal whose sums and numbers are right, whatever else is in it."""
    if len(data) < 32:
        return bytes(data)
    data[:12] = b"STIPJRNL" + struct.pack("<I", 1)
    struct.pack_into("<I", data, 28, zlib.crc32(data[:28]))
    at, number = 32, 0
    while at + 16 < len(data):
        n = min(struct.unpack_from("<I", data, at)[0] & 0xFFF, len(data) - at - 16)
        packed = data[at + 16 : at + 16 + n]
        crc = zlib.crc32(packed, zlib.crc32(struct.pack("<Q", number)))
        struct.pack_into("<IIQ", data, at, n, crc, number)
        at, number = at + 16 + n, number + 1
    return bytes(data)


def _drawing(data: bytes) -> None:
    """Make a drawing of a document and of bytes for its arrays, cut to fit."""
    text, _, raw = data.partition(b"\0")
    members = {drawing_file.STRUCTURE: text, "pictures/a": b"picture", "strange/part": b"part"}
    with contextlib.suppress(DrawingFileError):
        document = structure.from_bytes(text, "here", SMALL)
        members |= _dot_members(document, raw)
        shape = document.get("pictures") if isinstance(document, dict) else None
        for about in shape.values() if isinstance(shape, dict) else ():
            if isinstance(about, dict) and isinstance(about.get("darkness"), str):
                members[about["darkness"]] = raw[:64].ljust(64, b"\0")
    drawing, _ = drawing_file.drawing_of(members, read_small, "here", SMALL)
    _save_and_open(drawing)


def _dot_members(document: Any, raw: bytes) -> dict[str, bytes]:
    """Return arrays of as many dots as a document tells, from bytes that may be too few."""
    about = document.get("dots") if isinstance(document, dict) else None
    n = about.get("n") if isinstance(about, dict) else None
    if type(n) is not int or not 0 <= n <= _MOST_DOTS:
        return {}
    found, at = {}, 0
    for name, kind, width in _COLUMNS:
        size = n * width
        found[f"dots/{name}.{kind}"] = raw[at : at + size].ljust(size, b"\0")
        at += size
    return found


_COLUMNS = (
    ("id", "i8", 8), ("position_mm", "f8", 16), ("radius_mm", "f4", 4), ("seed", "u4", 4),
    ("elongation", "f4", 4), ("angle_rad", "f4", 4), ("roughness", "f4", 4), ("area", "i4", 4),
    ("constraint", "i1", 1), ("curve", "i4", 4), ("parameter", "f8", 8),
)  # fmt: skip


def _replay(data: bytes) -> None:
    """Replay records, of which each has its length in two bytes before it."""
    found: list[bytes] = []
    while len(data) > 2 and len(found) < 16:
        n = int.from_bytes(data[:2], "little")
        found.append(data[2 : 2 + n])
        data = data[2 + n :]
    document = Document(_few_dots())
    edit_log.replay(document, found, read_small, SMALL)
    while document.undo():
        pass
    while document.redo():
        pass
    if zlib.crc32(data) % 4 == 0:  # dear
        _save_and_open(document.drawing)


def _few_dots() -> Drawing:
    drawing = Drawing.blank(Page(20.0, 10.0))
    drawing.dots = Dots.round([[1.0, 1.0], [5.0, 5.0], [9.0, 3.0]], 0.2)
    return drawing


def read_small(data: bytes, name: str, tone: str) -> Picture:
    """Stand in for the reader of pictures, which is fuzzed by itself."""
    if not data or len(name) > 100:
        raise StipplerError("is no picture", name)
    return Picture(Levels.of(np.full((2, 2), 0.5, np.float32)), tone, name, data)


def _save_and_open(drawing: Drawing) -> None:
    """What was opened is saved, and opened again to the same."""
    members = drawing_file.members_of(drawing)
    again, _ = drawing_file.drawing_of(members, read_small, "there", SMALL)
    assert drawing_file.members_of(again) == members


def _style(data: bytes) -> None:
    value = structure.from_bytes(data, "here", SMALL)
    drawing_file._read_value(records.STYLE, 0, value, {}, {}, "here")


# --- others' files --------------------------------------------------------------------------------


def _table(data: bytes) -> None:
    table.dots_of_table(data, _HERE)


def _svg(data: bytes) -> None:
    svg_outlines.outlines_of_svg(data, _HERE)


def _geojson(data: bytes) -> None:
    geojson.outlines_of_geojson(data, _HERE)


def _picture(data: bytes) -> None:
    before, picture.MAX_PIXELS = picture.MAX_PIXELS, MOST_PIXELS
    try:
        found = picture.picture_of_bytes(data, "here.png", "linear")
        assert found.levels.size <= MOST_PIXELS
    finally:
        picture.MAX_PIXELS = before


def on_disk(read_path: Callable[[Path], object], name: str) -> Callable[[bytes], None]:
    """Make a function of bytes of one that reads a file."""
    shared = Path("/dev/shm")
    folder = Path(
        tempfile.mkdtemp(prefix="stippler-fuzz-", dir=shared if shared.is_dir() else None)
    )

    def from_bytes(data: bytes) -> None:
        (folder / name).write_bytes(data)
        read_path(folder / name)

    return from_bytes


def _brushes(path: Path) -> None:
    from stippler.brushes.presets import load_brushes, save_brushes

    brushes, _ = load_brushes(path)
    if len(brushes) % 4:  # dear
        return
    save_brushes(path, brushes)
    assert load_brushes(path) == (brushes, "")


def _preferences(path: Path) -> None:
    from stippler.ui.preferences import Preferences

    kept = Preferences.load(path.parent)
    kept.keep()
    assert not Preferences.load(path.parent).problem


READERS: Mapping[str, Callable[[bytes], None]] = {
    "container": _container,
    "structure": _structure,
    "arrays": _arrays,
    "journal": _journal,
    "drawing": _drawing,
    "replay": _replay,
    "style": _style,
    "table": _table,
    "svg": _svg,
    "geojson": _geojson,
    "picture": _picture,
    "brushes": on_disk(_brushes, "brushes.json"),
    "preferences": on_disk(_preferences, "preferences.json"),
}

OF_JSON = ("structure", "drawing", "style", "geojson", "brushes", "preferences")
"""Whose inputs are JSON, or begin with it up to a zero byte."""


def read(name: str, data: bytes) -> None:
    """Let a reader read; a fault that it may not have is raised."""
    with contextlib.suppress(StipplerError), np.errstate(all="ignore"):
        READERS[name](data)


def tokens(name: str) -> list[str]:
    """Return words that a reader knows, for the fuzzer to try."""
    from tests.fuzz.seeds import seeds

    words: set[str] = set()
    for seed in seeds(name):
        if name in OF_JSON:
            _gather(json.loads(seed.partition(b"\0")[0]), words)
    return sorted(words)


def _gather(value: Any, words: set[str]) -> None:
    if isinstance(value, dict):
        words |= {key for key in value if len(key) < 30}
        for inside in value.values():
            _gather(inside, words)
    elif isinstance(value, list):
        for inside in value:
            _gather(inside, words)
    elif isinstance(value, str) and 0 < len(value) < 30:
        words.add(value)
