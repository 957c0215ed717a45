"""Arrays as bytes: little-endian, row by row, of a few kinds of numbers."""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stippler.errors import DrawingFileError
from stippler.files.native import structure
from stippler.files.native.limits import DEFAULT_LIMITS, Limits

Array = NDArray[Any]

KINDS = {
    "f8": "<f8", "f4": "<f4", "i8": "<i8", "i4": "<i4", "i2": "<i2", "u8": "<u8", "u4": "<u4",
    "u2": "<u2", "i1": "|i1", "u1": "|u1", "b1": "|b1",
}  # fmt: skip
"""Kinds of numbers by the names that files use, and as numpy has them."""

_MOST_DIMENSIONS = 4
_HEAD = struct.Struct("<I")


def kind_of(array: Array) -> str:
    """Return the name of an array's kind of numbers.

    Raises
    ------
    ValueError
        If files have no such kind.
    """
    name = f"{array.dtype.kind}{array.dtype.itemsize}"
    if name not in KINDS:
        raise ValueError(f"an array of {array.dtype} has no place in a file")
    return name


def to_bytes(array: Array) -> bytes:
    """Return the numbers of an array."""
    return np.ascontiguousarray(array, KINDS[kind_of(array)]).tobytes()


def from_bytes(data: bytes | memoryview, kind: object, shape: object, where: str) -> Array:
    """Return the array that bytes hold, as a read-only view of them.

    Raises
    ------
    DrawingFileError
        If kind or shape are none, do not fit the bytes, or a bool is neither 0 nor 1.
    """
    if not isinstance(kind, str) or kind not in KINDS:
        raise DrawingFileError(f"{str(kind)[:40]!r} is no kind of numbers", where, _DO)
    sides = shape if isinstance(shape, list) else None
    if (
        sides is None
        or len(sides) > _MOST_DIMENSIONS
        or not all(type(side) is int and 0 <= side < 2**40 for side in sides)
    ):
        raise DrawingFileError(f"{str(shape)[:40]} is no shape", where, _DO)
    dtype = np.dtype(KINDS[kind])
    wanted = math.prod(sides) * dtype.itemsize
    if wanted != len(data):
        raise DrawingFileError(f"has {len(data):,} bytes, not {wanted:,}", where, _DO)
    if kind == "b1":
        raw = np.frombuffer(data, np.uint8)
        if raw.size and raw.max() > 1:
            raise DrawingFileError("has a value that is neither true nor false", where, _DO)
    return np.frombuffer(data, dtype).astype(dtype.newbyteorder("="), copy=False).reshape(sides)


def pack(head: Mapping[str, Any], arrays: Mapping[str, Array]) -> bytes:
    """Return a JSON object and named arrays as one piece of bytes; `unpack` undoes it."""
    listed = [[name, kind_of(array), list(array.shape)] for name, array in arrays.items()]
    text = structure.to_bytes({"head": dict(head), "arrays": listed})
    return b"".join([_HEAD.pack(len(text)), text, *map(to_bytes, arrays.values())])


def unpack(
    data: bytes | memoryview, where: str, limits: Limits = DEFAULT_LIMITS
) -> tuple[dict[str, Any], dict[str, Array]]:
    """Return what `pack` was given; arrays are read-only views.

    Raises
    ------
    DrawingFileError
        If the bytes are not such a piece, all of it and nothing more.
    """
    view = memoryview(data)
    if len(view) < _HEAD.size:
        raise DrawingFileError("is cut off", where, _DO)
    (n_text,) = _HEAD.unpack_from(view)
    at = _HEAD.size + n_text
    if at > len(view):
        raise DrawingFileError("is cut off", where, _DO)
    document = structure.from_bytes(bytes(view[_HEAD.size : at]), where, limits)
    if not isinstance(document, dict) or not isinstance(document.get("head"), dict):
        raise DrawingFileError("has no head", where, _DO)
    arrays: dict[str, Array] = {}
    for name, kind, shape in _listed(document.get("arrays"), where):
        n_bytes = _n_bytes(kind, shape)
        if at + n_bytes > len(view):
            raise DrawingFileError(f"{name[:40]} is cut off", where, _DO)
        arrays[name] = from_bytes(view[at : at + n_bytes], kind, shape, f"{where}, {name[:40]}")
        at += n_bytes
    if at != len(view):
        raise DrawingFileError("has bytes left over", where, _DO)
    return document["head"], arrays


def _listed(listed: object, where: str) -> list[tuple[str, Any, Any]]:
    """Return the list of arrays, if it is one."""
    if not isinstance(listed, list):
        raise DrawingFileError("has no list of arrays", where, _DO)
    seen: set[str] = set()
    for entry in listed:
        if not (isinstance(entry, list) and len(entry) == 3 and isinstance(entry[0], str)):
            raise DrawingFileError("has a list of arrays that is none", where, _DO)
        if entry[0] in seen:
            raise DrawingFileError(f"names {entry[0][:40]!r} twice", where, _DO)
        seen.add(entry[0])
    return [(name, kind, shape) for name, kind, shape in listed]


def _n_bytes(kind: object, shape: object) -> int:
    """Return how many bytes an array of a kind and shape has; 0 where `from_bytes` refuses it."""
    if not (isinstance(kind, str) and kind in KINDS and isinstance(shape, list)):
        return 0
    if not all(type(side) is int and 0 <= side < 2**40 for side in shape[:_MOST_DIMENSIONS]):
        return 0
    return math.prod(shape[:_MOST_DIMENSIONS]) * np.dtype(KINDS[kind]).itemsize


_DO = "open a backup of the drawing"
