"""JSON of our files, read as strictly as it is written."""

from __future__ import annotations

import json
from typing import Any

from stippler.errors import DrawingFileError
from stippler.files.native.limits import DEFAULT_LIMITS, Limits


def to_bytes(value: object) -> bytes:
    """Return compact JSON in UTF-8; no NaN and no infinity.

    Raises
    ------
    ValueError
        If a number is not finite.
    """
    text = json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    return text.encode("utf-8", "surrogatepass")


def from_bytes(data: bytes, where: str, limits: Limits = DEFAULT_LIMITS) -> Any:
    """Return what JSON says.

    Raises
    ------
    DrawingFileError
        If it is too long, nests too deep, is broken, no UTF-8, names a key twice, or holds a number
        that is not finite.
    """
    if len(data) > limits.structure_bytes:
        raise DrawingFileError(f"is {len(data):,} bytes of structure", where, "it is no drawing")
    try:
        return json.loads(
            data.decode("utf-8", "surrogatepass"),
            object_pairs_hook=_without_doubles,
            parse_constant=_refuse_constant,
            parse_float=_finite,
            parse_int=_whole,
        )
    except RecursionError:
        raise DrawingFileError("nests too deep", where, _DO) from None
    except ValueError as error:
        raise DrawingFileError(f"is broken ({error})", where, _DO) from None


_DO = "open a backup of the drawing"
_LONGEST_INT = 20


def _without_doubles(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a key stands twice")
    return found


def _refuse_constant(name: str) -> None:
    raise ValueError(f"{name} is no number")


def _finite(text: str) -> float:
    value = float(text)
    if value - value != 0.0:
        raise ValueError(f"{text[:24]} is out of range")
    return value


def _whole(text: str) -> int:
    if len(text) > _LONGEST_INT:
        raise ValueError(f"{text[:24]}... is out of range")
    return int(text)
