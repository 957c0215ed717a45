"""Dots from a table: our own, and what spreadsheets and other programs make of one.

Any encoding and separator, decimal commas, quotes, columns in any order, x and y alone.
"""

from __future__ import annotations

import csv
import io
import itertools
import math
import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from stippler.drawing.dots import FIXED, FREE, MAX_ELONGATION, NO_CURVE, Dots
from stippler.errors import TableError

DEFAULT_RADIUS_MM = 0.2
"""Of dots in a table that tells no sizes."""

NAMES = (
    "x_mm", "y_mm", "radius_mm", "elongation", "angle_rad", "roughness", "seed", "area", "fixed",
)  # fmt: skip
_MORE = ("diameter_mm", "constraint", "curve", "parameter", "id")
_ALIASES = {
    "x": "x_mm", "y": "y_mm", "r": "radius_mm", "r_mm": "radius_mm", "radius": "radius_mm",
    "angle": "angle_rad", "d": "diameter_mm", "d_mm": "diameter_mm", "diameter": "diameter_mm",
}  # fmt: skip
_DO = "save it again with stippler render -o NAME.csv"
_GIVE = "give columns x_mm and y_mm, and radius_mm if there are sizes"
_UNITS = re.compile(r"\s*[\[(]\s*(mm|rad)\s*[\])]$")
_WORDS = {"true": 1.0, "false": 0.0, "wahr": 1.0, "falsch": 0.0, "yes": 1.0, "no": 0.0}
_MARKS = ((b"\xef\xbb\xbf", "utf-8"), (b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"))
_NO_LIMIT = 2**31 - 1


@dataclass(frozen=True, slots=True)
class _Check:
    """What a column's values have to be, as a function of them, and what to say of others."""

    holds: Callable[[NDArray[np.float64]], NDArray[np.bool_]]
    says: str


def _whole(below: float) -> Callable[[NDArray[np.float64]], NDArray[np.bool_]]:
    return lambda v: (v >= 0) & (v < below) & (v == np.floor(v))


_FINITE = _Check(np.isfinite, "a position or angle that is not finite")
_CHECKS = {
    "x_mm": _FINITE,
    "y_mm": _FINITE,
    "angle_rad": _FINITE,
    "radius_mm": _Check(lambda v: (v > 0) & (v < math.inf), "a radius that is not above 0"),
    "elongation": _Check(lambda v: (v >= 1) & (v <= MAX_ELONGATION), "the shape of no dot"),
    "roughness": _Check(lambda v: (v >= 0) & (v <= 1), "the shape of no dot"),
    "seed": _Check(_whole(2.0**32), "a seed that is no whole number below 2³²"),
    "area": _Check(_whole(2.0**31), "an area that is no whole number"),
    "fixed": _Check(lambda v: (v == 0) | (v == 1), "a fixed that is neither 0 nor 1"),
    "constraint": _Check(lambda v: (v == 0) | (v == 1) | (v == 2), "a constraint that is none"),
    "curve": _Check(lambda v: (v >= NO_CURVE) & (v < 2**31) & (v == np.floor(v)), "no curve"),
    "parameter": _Check(np.isfinite, "a place on a curve that is not finite"),
    "id": _Check(_whole(2.0**53), "an id that is no whole number"),
}


def read_csv(path: str | Path) -> Dots:
    """Read a table of dots.

    Parameters
    ----------
    path : path
        Lines of values by comma, semicolon, tab or blanks; UTF-8, UTF-16 or Latin-1. Columns are
        found by name in any order, others are left out; without names there are two (x, y), three
        (and radius) or our nine. Without sizes dots have `DEFAULT_RADIUS_MM`.

    Raises
    ------
    TableError
        If there is no such file, or a line in it is no dot; says which.
    """
    path = Path(path)
    try:
        data = path.read_bytes()
    except FileNotFoundError:
        raise TableError("no such file", path, "check the name") from None
    except IsADirectoryError:
        raise TableError("is a folder", path, "name a table in it") from None
    except OSError as error:
        raise TableError(f"cannot be read ({error.strerror})", path, "check the file") from None
    return dots_of_table(data, path)


def dots_of_table(data: bytes, path: Path) -> Dots:
    """Return the dots of a table's bytes; as `read_csv`, which names `path` in errors."""
    text = _decoded(data)
    return _plain_table(text) or _dots(path, *_rows(path, text))


def _plain_table(text: str) -> Dots | None:
    """Read a table as we write it, at once; None where anything is otherwise."""
    head, _, body = text.partition("\n")
    names = head.split(",")
    if tuple(names[: len(NAMES)]) != NAMES or len({*names} & _CHECKS.keys()) < len(names):
        return None
    if not body:
        return Dots.none()
    try:
        values = np.loadtxt(io.StringIO(body), delimiter=",", comments=None, ndmin=2)
    except ValueError:
        return None
    if values.shape[1] != len(names):
        return None
    columns = dict(zip(names, values.T, strict=True))
    if not all(_CHECKS[name].holds(column).all() for name, column in columns.items()):
        return None
    return _made(columns)


# --- text to rows -----------------------------------------------------------------------------


def _decoded(data: bytes) -> str:
    """Return a file's text: by its mark, else UTF-8, else Latin-1."""
    for mark, name in (
        (b"\xef\xbb\xbf", "utf-8"),
        (b"\xff\xfe", "utf-16"),
        (b"\xfe\xff", "utf-16"),
    ):
        if data.startswith(mark):
            return data.decode(name, "replace").removeprefix("\ufeff")
    head = data[:1000]
    if len(head) > 3 and head[1::2].count(0) > len(head) // 3:
        return data.decode("utf-16-le", "replace")
    if len(head) > 3 and head[::2].count(0) > len(head) // 3:
        return data.decode("utf-16-be", "replace")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _rows(path: Path, text: str) -> tuple[list[list[str]], list[int]]:
    """Return the rows that hold anything, and the number of the line that each stands in."""
    lines = re.split(r"\r\n|\r|\n", text)
    first = 0
    told = re.fullmatch(r'"?sep=(.)"?', lines[0].strip(), re.IGNORECASE) if lines else None
    if told:
        first = 1
    separator = told[1] if told else _separator(line for line in lines if line.strip())
    csv.field_size_limit(_NO_LIMIT)
    if separator == " ":
        cut: Iterable[list[str]] = (line.split() for line in lines[first:])
    else:
        plain = (line.replace("\0", "\ufffd") for line in lines[first:])
        cut = csv.reader(plain, delimiter=separator, skipinitialspace=True)
    rows, numbers = [], []
    for number, row in enumerate(cut, first + 1):
        if any(cell.strip() for cell in row) and not row[0].lstrip().startswith("#"):
            rows.append(row)
            numbers.append(number)
    if not rows:
        raise TableError("holds no table", path, _GIVE)
    return rows, numbers


def _separator(lines: Iterable[str]) -> str:
    """Return what parts the values of a table's first lines."""
    head = " \n".join(itertools.islice(lines, 5))
    for separator in ("\t", ";", ","):
        if separator in head:
            return separator
    return " "


# --- rows to dots -----------------------------------------------------------------------------


def _dots(path: Path, rows: list[list[str]], numbers: list[int]) -> Dots:
    names = _names(path, rows[0], numbers[0])
    if names is None:
        names = _names_by_count(path, len(rows[0]))
    else:
        rows, numbers = rows[1:], numbers[1:]
    if not rows:
        return Dots.none()
    for row, number in zip(rows, numbers, strict=True):
        if len(row) != len(names):
            raise TableError(
                f"has {len(row)} values, not {len(names)}", f"{path}, line {number}", _DO
            )
    columns = {}
    for k, name in enumerate(names):
        if name:
            columns[name] = _column([row[k] for row in rows], path, numbers)
    if "diameter_mm" in columns:
        columns.setdefault("radius_mm", columns["diameter_mm"] / 2)
    for name, values in columns.items():
        if name in _CHECKS:
            _check(name, values, path, numbers)
    return _made(columns)


def _names(path: Path, row: Sequence[str], number: int) -> list[str] | None:
    """Return the columns that a header names, "" for those we have no use for; None if none."""
    if all(_is_number(cell) for cell in row):
        return None
    names = []
    for cell in row:
        name = _UNITS.sub(r"_\1", cell.strip().strip("\"'").lower()).replace(" ", "_")
        name = _ALIASES.get(name, name)
        names.append(name if name in (*NAMES, *_MORE) else "")
    if not {"x_mm", "y_mm"} <= set(names):
        raise TableError(
            "does not begin with the columns of a table of dots", f"{path}, line {number}", _GIVE
        )
    for name in set(names) - {""}:
        if names.count(name) > 1:
            raise TableError(f"names {name} twice", f"{path}, line {number}", "leave one out")
    return names


def _names_by_count(path: Path, n: int) -> list[str]:
    if n in (2, 3, len(NAMES)):
        return list(NAMES[:n])
    raise TableError(f"has {n} columns without names", f"{path}, line 1", _GIVE)


def _column(cells: list[str], path: Path, numbers: list[int]) -> NDArray[np.float64]:
    """Return a column's values; a decimal comma counts as a point."""
    try:
        return np.array(cells, np.float64)
    except ValueError:
        pass
    values = np.empty(len(cells))
    for k, cell in enumerate(cells):
        value = _value(cell)
        if value is None:
            shown = cell.strip()[:40] or "nothing"
            raise TableError(
                f"has a value that is no number ({shown})", f"{path}, line {numbers[k]}", _DO
            )
        values[k] = value
    return values


def _value(cell: str) -> float | None:
    text = cell.strip().strip("\"'").lower()
    if text in _WORDS:
        return _WORDS[text]
    if text.count(",") == 1 and "." not in text:
        text = text.replace(",", ".")
    try:
        return float(text.replace("\u2212", "-"))
    except ValueError:
        return None


def _is_number(cell: str) -> bool:
    return _value(cell) is not None


def _check(name: str, values: NDArray[np.float64], path: Path, numbers: list[int]) -> None:
    check = _CHECKS[name]
    with np.errstate(invalid="ignore"):
        bad = np.flatnonzero(~check.holds(values))
    if len(bad):
        value = values[bad[0]]
        raise TableError(f"has {check.says} ({value:g})", f"{path}, line {numbers[bad[0]]}", _DO)


def _made(columns: dict[str, NDArray[np.float64]]) -> Dots:
    place = np.stack([columns["x_mm"], columns["y_mm"]], axis=1)
    radius = columns.get("radius_mm", np.full(len(place), DEFAULT_RADIUS_MM))
    dots = Dots.round(place, radius)
    for name in ("elongation", "angle_rad", "roughness", "seed", "area"):
        if name in columns:
            getattr(dots, name)[:] = columns[name]
    if "fixed" in columns:
        dots.constraint[:] = np.where(columns["fixed"] > 0, FIXED, FREE)
    for name in ("constraint", "curve", "parameter"):
        if name in columns:
            getattr(dots, name)[:] = columns[name]
    if "id" in columns and len(np.unique(columns["id"])) == len(dots):
        dots.id[:] = columns["id"]
    return dots
