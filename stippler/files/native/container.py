"""The container of a drawing: a zip of named members, each with its checksum in a manifest.

`docs/format.md` describes it. Whatever bytes are given, reading them ends soon, takes no more
memory than `Limits` allow, and either returns the members whole or raises `DrawingFileError`.
"""

from __future__ import annotations

import hashlib
import io
import re
import struct
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import BinaryIO

from stippler.errors import DrawingFileError
from stippler.files.native import structure
from stippler.files.native.limits import DEFAULT_LIMITS, Limits
from stippler.files.native.signature import MIME

VERSION = 1
"""Of the format; a program refuses files of a later one."""

MANIFEST = "manifest.json"
_MIMETYPE = "mimetype"
_NAME = re.compile(r"[A-Za-z0-9_][A-Za-z0-9_.\-]*(/[A-Za-z0-9_][A-Za-z0-9_.\-]*){0,7}")
_LONGEST_NAME = 200
_FIRST_DAY = (1980, 1, 1, 0, 0, 0)  # the same drawing gives the same bytes
_PACKED_FROM = 256  # bytes; less is not worth it
_SAMPLE = 1 << 14
_WORTH = 0.7  # of its size is what a sample has to shrink to
_DO = "open a backup of the drawing"

Members = Mapping[str, bytes]


def write_container(stream: BinaryIO, members: Members, program: str) -> None:
    """Write members in their order, with a manifest of their sizes and checksums.

    Parameters
    ----------
    stream : binary file
        Need not be seekable.
    members : mapping of name to bytes
    program : str
        Name and version of what writes.

    Raises
    ------
    ValueError
        If a name is none that `read_container` takes.
    """
    for name in members:
        _check_name(name, "the drawing")
    manifest = {
        "format": "stipple",
        "version": VERSION,
        "program": program,
        "members": {
            name: {"bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}
            for name, data in members.items()
        },
    }
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive:
        _add(archive, _MIMETYPE, MIME.encode(), pack=False)
        _add(archive, MANIFEST, structure.to_bytes(manifest), pack=True)
        for name, data in members.items():
            _add(archive, name, data, pack=_shrinks(data))


def _add(archive: zipfile.ZipFile, name: str, data: bytes, *, pack: bool) -> None:
    entry = zipfile.ZipInfo(name, _FIRST_DAY)
    entry.external_attr = 0o644 << 16
    method = zipfile.ZIP_DEFLATED if pack else zipfile.ZIP_STORED
    archive.writestr(entry, data, method, compresslevel=1)


def _shrinks(data: bytes) -> bool:
    """Return whether deflate makes data smaller, by a sample from its middle."""
    if len(data) < _PACKED_FROM:
        return False
    middle = max(len(data) // 2 - _SAMPLE // 2, 0)
    sample = data[middle : middle + _SAMPLE]
    return len(zlib.compress(sample, 1)) < _WORTH * len(sample)


def read_container(path: str | Path, limits: Limits = DEFAULT_LIMITS) -> dict[str, bytes]:
    """Return the members of a file, whole and as they were written.

    Raises
    ------
    DrawingFileError
        If the file is no container, is cut off or changed, exceeds a limit, or is of a later
        version of the format.
    """
    path = Path(path)
    try:
        with path.open("rb") as stream:
            size = stream.seek(0, io.SEEK_END)
            if size > limits.file_bytes:
                raise DrawingFileError(f"has {size:,} bytes", path, "it is too large to open")
            stream.seek(0)
            return _read(stream, str(path), limits)
    except FileNotFoundError:
        raise DrawingFileError("no such file", path, "check the name") from None
    except IsADirectoryError:
        raise DrawingFileError("is a folder", path, "name a drawing in it") from None
    except OSError as error:
        raise DrawingFileError(
            f"cannot be read ({error.strerror or error})", path, "check the file and its folder"
        ) from error


def _read(stream: BinaryIO, where: str, limits: Limits) -> dict[str, bytes]:
    try:
        with zipfile.ZipFile(stream) as archive:
            entries = _entries(archive, where, limits)
            manifest = _manifest(archive, entries, where, limits)
            found = {
                name: _member(archive, entries, name, told, where)
                for name, told in manifest.items()
            }
            for name, entry in entries.items():  # what another program has put in is kept
                if name not in found and name not in (_MIMETYPE, MANIFEST):
                    found[name] = _unpacked(archive, entry, entry.file_size, where)
            return found
    except DrawingFileError:
        raise
    except _BROKEN as error:
        why = str(error).partition("\n")[0][:80] or type(error).__name__
        raise DrawingFileError(f"is broken or no drawing ({why})", where, _DO) from None


_BROKEN = (
    zipfile.BadZipFile,
    zipfile.LargeZipFile,
    zlib.error,
    struct.error,
    EOFError,
    NotImplementedError,  # a way of packing that zipfile does not know
    RuntimeError,  # encrypted
    ValueError,
    OverflowError,
    KeyError,
)


def _entries(archive: zipfile.ZipFile, where: str, limits: Limits) -> dict[str, zipfile.ZipInfo]:
    """Return what the directory lists, if it keeps the limits."""
    listed = archive.infolist()
    if len(listed) > limits.members:
        raise DrawingFileError(f"lists {len(listed):,} members", where, "it is no drawing")
    entries: dict[str, zipfile.ZipInfo] = {}
    total = 0
    for entry in listed:
        name = entry.orig_filename  # zipfile cuts the other at a nul
        _check_name(name, where)
        if name in entries:
            raise DrawingFileError(f"lists {name!r} twice", where, _DO)
        if entry.flag_bits & 1:
            raise DrawingFileError(f"{name} is encrypted", where, _DO)
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise DrawingFileError(f"{name} is packed in an unknown way", where, _DO)
        total += entry.file_size
        if entry.file_size > limits.member_bytes or total > limits.total_bytes:
            raise DrawingFileError(f"{name} is too large", where, "it is no drawing")
        if entry.file_size > limits.ratio * max(entry.compress_size, 1):
            raise DrawingFileError(f"{name} is packed too tight", where, "it is no drawing")
        entries[name] = entry
    return entries


def _check_name(name: str, where: str) -> None:
    if len(name) > _LONGEST_NAME or not _NAME.fullmatch(name):
        raise DrawingFileError(f"{name[:60]!r} is no name of a member", where, "it is no drawing")


def _manifest(
    archive: zipfile.ZipFile, entries: Mapping[str, zipfile.ZipInfo], where: str, limits: Limits
) -> dict[str, tuple[int, str]]:
    """Return size and checksum of each member, by the manifest."""
    if _MIMETYPE not in entries or MANIFEST not in entries:
        raise DrawingFileError("is no drawing of this program", where, "open another file")
    if _unpacked(archive, entries[_MIMETYPE], len(MIME), where) != MIME.encode():
        raise DrawingFileError("is no drawing of this program", where, "open another file")
    size = entries[MANIFEST].file_size
    if size > limits.structure_bytes:
        raise DrawingFileError("has too long a manifest", where, "it is no drawing")
    place = f"{where}, {MANIFEST}"
    manifest = structure.from_bytes(
        _unpacked(archive, entries[MANIFEST], size, where), place, limits
    )
    if not isinstance(manifest, dict) or manifest.get("format") != "stipple":
        raise DrawingFileError("names another format", place, "open another file")
    version = manifest.get("version")
    if type(version) is not int or version < 1:
        raise DrawingFileError("names no version", place, _DO)
    if version > VERSION:
        program = str(manifest.get("program", "a later program"))[:60]
        raise DrawingFileError(
            f"was written by {program}, in version {version} of the format; this program reads "
            f"up to {VERSION}",
            where,
            "update Stippler; the file is left as it is",
        )
    members = manifest.get("members")
    if not isinstance(members, dict):
        raise DrawingFileError("lists no members", place, _DO)
    found: dict[str, tuple[int, str]] = {}
    for name, told in members.items():
        if name in (_MIMETYPE, MANIFEST) or name not in entries:
            raise DrawingFileError(f"lists {name[:60]!r}, which is missing", place, _DO)
        if not isinstance(told, dict):
            raise DrawingFileError(f"says nothing of {name}", place, _DO)
        n_bytes, digest = told.get("bytes"), told.get("sha256")
        if type(n_bytes) is not int or not isinstance(digest, str):
            raise DrawingFileError(f"says nothing of {name}", place, _DO)
        found[name] = n_bytes, digest
    return found


def _member(
    archive: zipfile.ZipFile,
    entries: Mapping[str, zipfile.ZipInfo],
    name: str,
    told: tuple[int, str],
    where: str,
) -> bytes:
    n_bytes, digest = told
    if entries[name].file_size != n_bytes:
        raise DrawingFileError("has another size than the manifest says", f"{where}, {name}", _DO)
    data = _unpacked(archive, entries[name], n_bytes, where)
    if hashlib.sha256(data).hexdigest() != digest:
        raise DrawingFileError("has been changed or damaged", f"{where}, {name}", _DO)
    return data


def _unpacked(archive: zipfile.ZipFile, entry: zipfile.ZipInfo, n_bytes: int, where: str) -> bytes:
    """Return a member's bytes, and never more than were declared."""
    with archive.open(entry) as stream:
        data = stream.read(n_bytes + 1)
    if len(data) != n_bytes:
        raise DrawingFileError("is cut off", f"{where}, {entry.filename}", _DO)
    return data
